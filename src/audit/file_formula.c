/* file_formula.c - what a formula puts out at a row: its pairs, one behind the other, from what they read.
 *
 * circuit/pairs.c makes of a kink 0 <= lambda _|_ lambda / g - a >= 0, and of a saturation or a jump two pairs,
 *     0 <= lambda _|_ nu + lambda / g - a >= 0    and    0 <= nu _|_ H - lambda >= 0.
 * An argument a has lambdas of earlier pairs only. */
#include "file_internal.h"

#include "rounding.h"

static struct file_number term_value(const struct file_audit *a, const struct file_row *row,
                                     const struct dalcs_affine_term *term) {
    switch (term->kind) {
    case DALCS_QUANTITY_VOLTAGE:
        return row->v[term->index];
    case DALCS_QUANTITY_CURRENT:
        return row->i[term->index];
    case DALCS_QUANTITY_PAIR:
        return (struct file_number){a->formulas.value[term->index], a->formulas.error[term->index],
                                    true};
    default:
        return file_stimulus(a, row, term->index);
    }
}

/* Without the lambdas from `first_left_out` on. What cancels leaves its rounding: 5 V - 5 V of a saturation. */
static struct file_number evaluate(const struct file_audit *a, const struct file_row *row,
                                   const struct dalcs_affine *f, int first_left_out) {
    struct file_number sum = file_exactly(f->constant);
    double sizes = fabs(f->constant);
    for (int k = 0; k < f->n; k++) {
        if (f->term[k].kind != DALCS_QUANTITY_PAIR || f->term[k].index < first_left_out) {
            const struct file_number term = term_value(a, row, &f->term[k]);
            sum = file_add(sum, f->term[k].coefficient, term);
            sizes += fabs(f->term[k].coefficient * term.value);
        }
    }
    sum.error += dalcs_sum_rounded * sizes;
    return sum;
}

/* What the tolerance makes of an argument: a jump may come that much sooner or later, a steep slope is as far off
 * as it lets it be. */
static double tolerance_of(const struct file_audit *a, const struct file_row *row,
                           const struct dalcs_affine *f) {
    double sum = 0.0;
    for (int k = 0; k < f->n; k++) {
        const struct dalcs_affine_term *term = &f->term[k];
        const bool is_given = term->kind == DALCS_QUANTITY_VOLTAGE &&
                              a->columns.given_by[term->index] >= 0; /* in its error */
        const double scale = is_given                               ? 0.0
                             : term->kind == DALCS_QUANTITY_VOLTAGE ? a->scale.v[term->index]
                             : term->kind == DALCS_QUANTITY_CURRENT ? a->scale.i[term->index]
                             : term->kind == DALCS_QUANTITY_PAIR
                                 ? 0.0 /* in its error */
                                 : fabs(term_value(a, row, term).value);
        sum += a->promise.tolerance * fabs(term->coefficient) * scale;
    }
    return sum;
}

static void set_lambda(struct file_audit *a, int pair, double low, double high) {
    a->formulas.value[pair] = 0.5 * (low + high);
    a->formulas.error[pair] = 0.5 * (high - low);
}

/* How large a lambda is for an argument: 1/g is its resistance. */
static double lambda_at(double argument, double resistance, double height, bool is_high) {
    if (resistance > 0.0) {
        return fmin(fmax(argument / resistance, 0.0), height);
    }
    return argument > 0.0 || (argument == 0.0 && is_high) ? height : 0.0;
}

/* The pair number k, and the one behind it where the two are one cell: how many. */
static int solve_cell(struct file_audit *a, const struct file_row *row,
                      const struct dalcs_behaviour *b, int k, bool *is_known) {
    struct file_number argument = evaluate(a, row, &b->w[k], k);
    *is_known = *is_known && argument.known;
    argument.value = -argument.value;
    argument.error += tolerance_of(a, row, &b->w[k]);
    const double resistance = dalcs_affine_of_pair(&b->w[k], k);
    const bool is_cell = k + 1 < b->n_pairs && dalcs_affine_of_pair(&b->w[k], k + 1) != 0.0;
    const double height = is_cell ? b->w[k + 1].constant : INFINITY;
    const double low = argument.value - argument.error, high = argument.value + argument.error;
    set_lambda(a, k, lambda_at(low, resistance, height, false),
               lambda_at(high, resistance, height, true));
    if (is_cell) {
        set_lambda(a, k + 1, fmax(low - height * resistance, 0.0),
                   fmax(high - height * resistance, 0.0));
    }
    return is_cell ? 2 : 1;
}

/* What v(node) may be off by; a voltage that a formula gives has the tolerance in its error. */
static double error_at(const struct file_audit *a, const struct file_row *row, int node,
                       bool with_tolerance) {
    const bool is_column = with_tolerance && a->columns.given_by[node] < 0;
    return row->v[node].error + (is_column ? a->promise.tolerance * a->scale.v[node] : 0.0);
}

/* What an argument may be off by makes of the value: at most what the larger slope at both ends of it does. */
static struct file_number smooth_value(const struct file_audit *a, const struct file_row *row,
                                       const struct dalcs_smooth *smooth, bool with_tolerance) {
    double x[2];
    double gradient[2];
    struct file_number f = {.known = true};
    for (int k = 0; k < 2; k++) {
        const bool is_read = k < smooth->n && smooth->node[k] >= 0;
        x[k] = is_read ? row->v[smooth->node[k]].value : smooth->number[k];
        f.known = f.known && (!is_read || row->v[smooth->node[k]].known);
    }
    f.value = dalcs_smooth_value(smooth->kind, x);
    for (int k = 0; k < smooth->n && f.known; k++) {
        if (smooth->node[k] < 0) {
            continue;
        }
        const double error = error_at(a, row, smooth->node[k], with_tolerance);
        double steepest = 0.0;
        for (int side = -1; side <= 1; side++) {
            double at[2] = {x[0], x[1]};
            at[k] += side * error;
            dalcs_smooth_gradient(smooth->kind, at, gradient);
            steepest = isnan(gradient[k]) ? INFINITY : fmax(steepest, fabs(gradient[k]));
        }
        f.error += error > 0.0 ? steepest * error : 0.0;
    }
    f.known = f.known && isfinite(f.value) && isfinite(f.error);
    return f;
}

struct file_number file_formula(struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_behaviour *own = a->circuit->device[device].behaviour;
    const struct dalcs_behaviour *b = own->is_implicit ? own->written : own;
    if (b->smooth != NULL) {
        return smooth_value(a, row, b->smooth, false);
    }
    bool is_known = true;
    for (int k = 0; k < b->n_pairs;) {
        k += solve_cell(a, row, b, k, &is_known);
    }
    struct file_number output = evaluate(a, row, &b->output, b->n_pairs);
    output.known = output.known && is_known && isfinite(output.error);
    return output;
}

/* ---- Voltages that no column has ---------------------------------------------------------------- */

/* Products and functions, what they are of, and the sums of POLY are nodes of the program's own (circuit/smooth_parts.c,
 * poly.c). */
void file_find_given(struct file_audit *a) {
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        const int node = device->node[0];
        const bool is_output = device->kind == DALCS_VCVS && !device->is_delay;
        if (is_output && node > 0 && a->columns.potential_of[node] < 0 &&
            a->columns.given_by[node] < 0) {
            a->columns.given_by[node] = d;
            a->columns.given[a->columns.n_given++] = d;
        }
    }
}

struct file_number file_output(struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (d->behaviour == NULL) {
        const int *node = d->node;
        struct file_number read = file_add(row->v[node[2]], -1.0, row->v[node[3]]);
        read.error = error_at(a, row, node[2], true) + error_at(a, row, node[3], true);
        return file_add(file_exactly(0.0), d->value, read);
    }
    if (d->behaviour->smooth != NULL) {
        return smooth_value(a, row, d->behaviour->smooth, true);
    }
    struct file_number output = file_formula(a, row, device);
    output.error += tolerance_of(a, row, &d->behaviour->output);
    return output;
}

struct file_number file_formula_given(struct file_audit *a, const struct file_row *row,
                                      int device) {
    return file_add(file_output(a, row, device), 1.0, row->v[a->circuit->device[device].node[1]]);
}

/* One may read another one that comes later. */
void file_take_given(struct file_audit *a, struct file_row *row) {
    bool is_new = a->columns.n_given > 0;
    bool has_any = false;
    while (is_new) {
        is_new = false;
        for (int k = 0; k < a->columns.n_given; k++) {
            const int node = a->circuit->device[a->columns.given[k]].node[0];
            if (!row->v[node].known) {
                row->v[node] = file_formula_given(a, row, a->columns.given[k]);
                is_new = is_new || row->v[node].known;
                a->coverage.ever_given[node] = a->coverage.ever_given[node] || row->v[node].known;
            }
        }
        has_any = has_any || is_new;
    }
    for (int d = 0; d < a->circuit->n_devices && has_any; d++) {
        const int *node = a->circuit->device[d].node;
        row->u[d] = file_add(row->v[node[0]], -1.0, row->v[node[1]]);
    }
}
