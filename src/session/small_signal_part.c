/* small_signal_part.c - the complex matrix of a system, filled and solved at a frequency. */
#include "small_signal_part.h"

#include "pi.h"
#include "smooth_newton.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- The matrix -------------------------------------------------------------------------------- */

struct entry {
    int row, column;
    double re, im;
};

static int compare_entries(const void *a, const void *b) {
    const struct entry *x = a;
    const struct entry *y = b;
    return x->column != y->column ? (x->column < y->column ? -1 : 1)
                                  : (x->row > y->row) - (x->row < y->row);
}

/* All entries, unordered; returns how many. */
static int list_entries(const struct dalcs_component *c, struct entry *entry) {
    const struct dalcs_system *s = c->system;
    const int n_equations = dalcs_system_n_equations(s);
    int n = 0;
    for (int i = 0; i < s->n_x; i++) {
        for (int k = s->P.p[i]; k < s->P.p[i + 1]; k++) {
            entry[n++] = (struct entry){i, s->P.j[k], 0.0, s->P.x[k]};
        }
    }
    for (int i = 0; i < n_equations; i++) {
        for (int k = s->A.p[i]; k < s->A.p[i + 1]; k++) {
            entry[n++] = (struct entry){i, s->A.j[k], -s->A.x[k], 0.0};
        }
    }
    for (int k = 0; k < s->n_smooth; k++) { /* by their tangents at the operating point */
        const struct dalcs_smooth_input *of = &s->smooth[k];
        double gradient[2];
        dalcs_smooth_gradient(of->kind, c->osnsp.smooth.newton->x[k], gradient);
        for (int j = 0; j < of->n; j++) {
            if (of->column[j] >= 0) {
                const double line = of->entry[j] != NULL ? -*of->entry[j] : 0.0; /* that A has */
                entry[n++] = (struct entry){of->row, of->column[j], gradient[j] - line, 0.0};
            }
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (!dalcs_osnsp_is_on(&c->osnsp, d)) {
            entry[n++] = (struct entry){n_equations + d, n_equations + d, 1.0, 0.0};
            continue;
        }
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            entry[n++] = (struct entry){n_equations + d, s->C.j[k], s->C.x[k], 0.0};
        }
    }
    return n;
}

static enum dalcs_status compress(struct dalcs_small_signal_part *part) {
    const struct dalcs_system *s = part->component->system;
    const size_t most = (size_t)(s->n_x > 0 ? s->P.p[s->n_x] : 0) +
                        (size_t)s->A.p[dalcs_system_n_equations(s)] + (size_t)s->C.p[s->n_pairs] +
                        (size_t)s->n_pairs + 2 * (size_t)s->n_smooth;
    struct entry *entry = dalcs_alloc(most, sizeof *entry);
    part->p = dalcs_alloc((size_t)part->n + 1, sizeof(int));
    part->i = dalcs_alloc(most, sizeof(int));
    part->re = dalcs_alloc(most, sizeof(double));
    part->im = dalcs_alloc(most, sizeof(double));
    part->x = dalcs_alloc(2 * most, sizeof(double));
    if (entry == NULL || part->p == NULL || part->i == NULL || part->re == NULL ||
        part->im == NULL || part->x == NULL) {
        free(entry);
        return DALCS_E_NOMEM;
    }
    const int n = list_entries(part->component, entry);
    qsort(entry, (size_t)n, sizeof *entry, compare_entries);
    int kept = 0;
    for (int k = 0; k < n; k++) {
        const bool repeats =
            k > 0 && entry[k].row == entry[k - 1].row && entry[k].column == entry[k - 1].column;
        if (!repeats) {
            part->i[kept++] = entry[k].row;
            part->p[entry[k].column + 1] = kept;
        }
        part->re[kept - 1] += entry[k].re;
        part->im[kept - 1] += entry[k].im;
    }
    for (int j = 0; j < part->n; j++) {
        part->p[j + 1] = part->p[j + 1] > part->p[j] ? part->p[j + 1] : part->p[j];
    }
    free(entry);
    return DALCS_OK;
}

void dalcs_small_signal_part_finish(struct dalcs_small_signal_part *part) {
    if (part->symbolic != NULL) {
        klu_free_symbolic(&part->symbolic, &part->common);
    }
    free(part->p);
    free(part->i);
    free(part->re);
    free(part->im);
    free(part->x);
    free(part->row_scale);
    free(part->column_scale);
    free(part->right);
    free(part->residual);
    for (int k = 0; k < 2; k++) {
        free(part->y[k]);
        free(part->s[k]);
    }
}

enum dalcs_status dalcs_small_signal_part_setup(struct dalcs_small_signal_part *part,
                                                const struct dalcs_component *c) {
    const struct dalcs_system *s = c->system;
    const size_t n = (size_t)dalcs_system_n_columns(s);
    *part = (struct dalcs_small_signal_part){.component = c, .n = (int)n};
    dalcs_lu_common_init(&part->common);
    part->row_scale = dalcs_alloc(n, sizeof(double));
    part->column_scale = dalcs_alloc(n, sizeof(double));
    part->right = dalcs_alloc(2 * n, sizeof(double));
    part->residual = dalcs_alloc(2 * n, sizeof(double));
    bool complete = part->row_scale != NULL && part->column_scale != NULL && part->right != NULL &&
                    part->residual != NULL;
    for (int k = 0; k < 2; k++) {
        part->y[k] = dalcs_alloc(n, sizeof(double));
        part->s[k] = dalcs_alloc((size_t)s->n_inputs, sizeof(double));
        complete = complete && part->y[k] != NULL && part->s[k] != NULL;
    }
    if (!complete) {
        return DALCS_E_NOMEM;
    }
    for (int k = 1; k < s->n_inputs; k++) {
        const struct dalcs_stimulus *source = &c->circuit->stimulus[s->stimulus[k]];
        part->s[0][k] = source->ac_real;
        part->s[1][k] = source->ac_imaginary;
    }
    const int n_equations = dalcs_system_n_equations(s);
    for (int i = 0; i < n_equations; i++) {
        part->right[2 * i] = dalcs_csr_row_dot(&s->E, i, part->s[0]);
        part->right[2 * i + 1] = dalcs_csr_row_dot(&s->E, i, part->s[1]);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (dalcs_osnsp_is_on(&c->osnsp, d)) {
            part->right[2 * (n_equations + d)] = -dalcs_csr_row_dot(&s->F, d, part->s[0]);
            part->right[2 * (n_equations + d) + 1] = -dalcs_csr_row_dot(&s->F, d, part->s[1]);
        }
    }
    DALCS_TRY(compress(part));
    /* what is shorted has no unknowns, and KLU takes no matrix without rows */
    return part->n == 0 ? DALCS_OK
                        : dalcs_lu_analyze(
                              &part->symbolic, &part->common,
                              &(struct dalcs_columns){.n = part->n, .p = part->p, .i = part->i});
}

/* ---- One frequency ------------------------------------------------------------------------------ */

static double power_of_two_below(double x) {
    return x > 0.0 && isfinite(x) ? ldexp(1.0, -ilogb(x)) : 1.0;
}

/* Fills part->x, rows and columns scaled. */
static void balance(struct dalcs_small_signal_part *part, double omega) {
    for (int i = 0; i < part->n; i++) {
        part->row_scale[i] = 0.0;
    }
    for (int k = 0; k < part->p[part->n]; k++) {
        const double size = fabs(part->re[k]) + omega * fabs(part->im[k]);
        part->row_scale[part->i[k]] = fmax(part->row_scale[part->i[k]], size);
    }
    for (int i = 0; i < part->n; i++) {
        part->row_scale[i] = power_of_two_below(part->row_scale[i]);
    }
    for (int j = 0; j < part->n; j++) {
        double largest = 0.0;
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            const double size = fabs(part->re[k]) + omega * fabs(part->im[k]);
            largest = fmax(largest, size * part->row_scale[part->i[k]]);
        }
        part->column_scale[j] = power_of_two_below(largest);
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            const double scale = part->row_scale[part->i[k]] * part->column_scale[j];
            part->x[2 * k] = part->re[k] * scale;
            part->x[2 * k + 1] = omega * part->im[k] * scale;
        }
    }
}

/* y += the solution for the residual. */
static void correct(struct dalcs_small_signal_part *part, const struct dalcs_lu *lu) {
    for (int i = 0; i < part->n; i++) {
        const int from = lu->from[i];
        lu->work[2 * i] = part->residual[2 * from] * part->row_scale[from];
        lu->work[2 * i + 1] = part->residual[2 * from + 1] * part->row_scale[from];
    }
    dalcs_lu_solve_ordered_complex(lu);
    for (int i = 0; i < part->n; i++) {
        const int to = lu->to[i];
        part->y[0][to] += lu->work[2 * i] * part->column_scale[to];
        part->y[1][to] += lu->work[2 * i + 1] * part->column_scale[to];
    }
}

static void find_residual(struct dalcs_small_signal_part *part, double omega) {
    memcpy(part->residual, part->right, 2 * (size_t)part->n * sizeof(double));
    for (int j = 0; j < part->n; j++) {
        const double re = part->y[0][j];
        const double im = part->y[1][j];
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            const double a = part->re[k];
            const double b = omega * part->im[k];
            part->residual[2 * part->i[k]] -= a * re - b * im;
            part->residual[2 * part->i[k] + 1] -= a * im + b * re;
        }
    }
}

enum dalcs_status dalcs_small_signal_part_solve(struct dalcs_small_signal_part *part,
                                                double frequency, double rcond_min) {
    const double omega = dalcs_two_pi * frequency;
    struct dalcs_lu lu;
    if (part->n == 0) {
        return DALCS_OK;
    }
    balance(part, omega);
    const struct dalcs_columns a = {
        .n = part->n, .p = part->p, .i = part->i, .x = part->x, .is_complex = true};
    DALCS_TRY(dalcs_lu_factor_analyzed(&lu, &part->common, part->symbolic, NULL, &a, rcond_min));
    memset(part->y[0], 0, (size_t)part->n * sizeof(double));
    memset(part->y[1], 0, (size_t)part->n * sizeof(double));
    for (int round = 0; round < 2; round++) { /* once more, for what rounding left */
        find_residual(part, omega);
        correct(part, &lu);
    }
    dalcs_lu_finish(&lu);
    return DALCS_OK;
}

/* ---- Rounding ----------------------------------------------------------------------------------- */

/* The sum of the sizes of a row's terms, by columns. */
static double row_size(const struct dalcs_small_signal_part *part, int row) {
    double sum = 0.0;
    for (int j = 0; j < part->n; j++) {
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            sum += part->i[k] == row ? fabs(part->re[k] * part->y[0][j]) : 0.0;
        }
    }
    return sum;
}

/* Each equation bounds it: what the other terms have lost is in it. */
double dalcs_small_signal_part_rounding(const struct dalcs_small_signal_part *part, int column) {
    double least = INFINITY;
    for (int k = part->p[column]; k < part->p[column + 1]; k++) {
        if (part->re[k] != 0.0) {
            least = fmin(least, DBL_EPSILON * row_size(part, part->i[k]) / fabs(part->re[k]));
        }
    }
    return isfinite(least) ? least : 0.0;
}
