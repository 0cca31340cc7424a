/* response_formula.c - what a formula makes of small signals: the slopes of its pairs and its smooth functions.
 *
 * As in file_formula.c, a pair is a kink 0 <= lambda _|_ lambda / g - a >= 0, and two are a saturation or a jump,
 *     0 <= lambda _|_ nu + lambda / g - a >= 0    and    0 <= nu _|_ H - lambda >= 0.
 * Each lambda follows the argument a with the slope that it has there. */
#include "response_internal.h"

/* ---- At one set of values ------------------------------------------------------------------------ */

static double complex stimulus_of(const struct dalcs_response_audit *a, int stimulus,
                                  bool is_point) {
    const struct dalcs_stimulus *s = &a->circuit->stimulus[stimulus];
    if (is_point) {
        return isnan(a->t) ? dalcs_stimulus_operating_value(s, false)
                           : dalcs_stimulus_value(s, a->t, DALCS_RIGHT);
    }
    return a->source != NULL ? a->source[stimulus] : s->ac_real + s->ac_imaginary * I;
}

/* Without the constant and the lambdas from `first_left_out` on. */
static struct response_sum evaluate(struct dalcs_response_audit *a,
                                    const struct dalcs_response_values *is,
                                    const struct dalcs_affine *f, int first_left_out,
                                    bool is_point) {
    struct response_sum sum = {0};
    for (int k = 0; k < f->n; k++) {
        const struct dalcs_affine_term *t = &f->term[k];
        double complex x = 0.0;
        double size = 0.0;
        if (t->kind == DALCS_QUANTITY_VOLTAGE) {
            x = is->v[t->index];
            size = response_size(a, x);
        } else if (t->kind == DALCS_QUANTITY_CURRENT) {
            x = is->i[t->index];
            size = is->size[t->index];
            a->work.is_known = a->work.is_known && size >= 0.0;
        } else if (t->kind == DALCS_QUANTITY_PAIR && t->index < first_left_out) {
            x = a->work.lambda[t->index];
            size = a->work.lambda_size[t->index];
        } else if (t->kind == DALCS_QUANTITY_STIMULUS) {
            x = stimulus_of(a, t->index, is_point);
        }
        sum.value += t->coefficient * x;
        sum.scale += fabs(t->coefficient) * response_magnitude(x);
        sum.size += fabs(t->coefficient) * fmax(response_magnitude(x), size);
    }
    return sum;
}

static bool is_cell(const struct dalcs_behaviour *b, int k) {
    return k + 1 < b->n_pairs && dalcs_affine_of_pair(&b->w[k], k + 1) != 0.0;
}

/* ---- At the operating point ---------------------------------------------------------------------- */

static bool is_near(double x, double corner, double margin) {
    return fabs(x - corner) <= margin;
}

/* The slopes of a pair, or of two, and their values there. */
static void find_cell(struct dalcs_response_audit *a, const struct dalcs_response_values *at,
                      const struct dalcs_behaviour *b, double *slope, int k) {
    a->work.is_known = true;
    const struct response_sum sum = evaluate(a, at, &b->w[k], k, true);
    const double argument = -creal(sum.value) - b->w[k].constant;
    const double margin = a->tolerance * (sum.scale + fabs(b->w[k].constant));
    const double resistance = dalcs_affine_of_pair(&b->w[k], k);
    const double height = is_cell(b, k) ? b->w[k + 1].constant : INFINITY;
    const double top = resistance > 0.0 ? height * resistance : 0.0;
    const bool is_corner = !a->work.is_known || is_near(argument, 0.0, margin) ||
                           (is_cell(b, k) && is_near(argument, top, margin));
    const bool is_between = resistance > 0.0 && argument > 0.0 && argument < top;
    slope[k] = is_corner ? NAN : is_between ? 1.0 / resistance : 0.0;
    a->work.lambda[k] = argument <= 0.0 ? 0.0 : is_between ? argument / resistance : height;
    a->work.lambda_size[k] = response_magnitude(a->work.lambda[k]);
    if (is_cell(b, k)) {
        slope[k + 1] = is_corner ? NAN : argument > top ? 1.0 : 0.0;
        a->work.lambda[k + 1] = fmax(argument - top, 0.0);
        a->work.lambda_size[k + 1] = response_magnitude(a->work.lambda[k + 1]);
    }
}

/* The gradient, and within the tolerance of the arguments the least and the largest. */
static void find_gradient(const struct dalcs_response_audit *a,
                          const struct dalcs_response_values *at, const struct dalcs_smooth *f,
                          double gradient[2][3]) {
    double x[2];
    double g[2];
    for (int k = 0; k < 2; k++) {
        const bool is_read = k < f->n && f->node[k] >= 0;
        x[k] = is_read ? creal(at->v[f->node[k]]) : f->number[k];
    }
    dalcs_smooth_gradient(f->kind, x, g);
    for (int k = 0; k < f->n; k++) {
        for (int n = 0; n < 3; n++) {
            gradient[k][n] = g[k];
        }
    }
    for (int side = 0; side < 2 * f->n; side++) {
        double near[2] = {x[0], x[1]};
        near[side / 2] += (side % 2 == 0 ? 1.0 : -1.0) * a->tolerance * fabs(x[side / 2]);
        dalcs_smooth_gradient(f->kind, near, g);
        for (int k = 0; k < f->n; k++) {
            gradient[k][0] = fmin(gradient[k][0], g[k]);
            gradient[k][1] = fmax(gradient[k][1], g[k]);
        }
    }
}

enum dalcs_status response_find_slopes(struct dalcs_response_audit *a,
                                       const struct dalcs_response_values *at, int device) {
    const struct dalcs_behaviour *b = dalcs_device_written(&a->circuit->device[device]);
    struct response_lines *l = &a->lines[device];
    if (b == NULL) {
        return DALCS_OK;
    }
    if (b->smooth != NULL) {
        find_gradient(a, at, b->smooth, l->gradient);
        return DALCS_OK;
    }
    l->slope = l->slope != NULL
                   ? l->slope
                   : dalcs_arena_alloc(&a->arena, (size_t)b->n_pairs + 1, sizeof(double));
    if (l->slope == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < b->n_pairs; k += is_cell(b, k) ? 2 : 1) {
        find_cell(a, at, b, l->slope, k);
    }
    return DALCS_OK;
}

/* ---- Of small signals ---------------------------------------------------------------------------- */

static bool smooth_output(const struct dalcs_response_audit *a,
                          const struct dalcs_response_values *is, const struct dalcs_smooth *f,
                          const double gradient[2][3], struct response_sum *output, double *doubt) {
    bool is_known = true;
    for (int k = 0; k < f->n; k++) {
        const double complex x = f->node[k] >= 0 ? is->v[f->node[k]] : 0.0;
        const double *g = gradient[k];
        output->value += x == 0.0 ? 0.0 : g[2] * x;
        output->scale += x == 0.0 ? 0.0 : fabs(g[2]) * response_magnitude(x);
        output->size += x == 0.0 ? 0.0 : fabs(g[2]) * response_size(a, x);
        *doubt += x == 0.0 ? 0.0 : (g[1] - g[0]) * response_magnitude(x);
        is_known = is_known && (x == 0.0 || (isfinite(g[0]) && isfinite(g[1])));
    }
    return is_known;
}

bool response_formula(struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                      int device, struct response_sum *output, double *doubt) {
    const struct dalcs_behaviour *b = dalcs_device_written(&a->circuit->device[device]);
    const double *slope = a->lines[device].slope;
    *output = (struct response_sum){0};
    *doubt = 0.0;
    if (b->smooth != NULL) {
        return smooth_output(a, is, b->smooth, a->lines[device].gradient, output, doubt);
    }
    a->work.is_known = true;
    for (int k = 0; k < b->n_pairs;) {
        const struct response_sum argument = evaluate(a, is, &b->w[k], k, false);
        const int n = is_cell(b, k) ? 2 : 1;
        for (int m = k; m < k + n; m++) {
            const bool may_slide =
                dalcs_affine_of_pair(&b->w[k], k) == 0.0; /* a jump: then any lambda */
            if (isnan(slope[m]) && (argument.value != 0.0 || may_slide)) {
                return false;
            }
            a->work.lambda[m] = isnan(slope[m]) ? 0.0 : -slope[m] * argument.value;
            a->work.lambda_size[m] = isnan(slope[m]) ? 0.0 : slope[m] * argument.size;
        }
        k += n;
    }
    *output = evaluate(a, is, &b->output, b->n_pairs, false);
    return a->work.is_known;
}
