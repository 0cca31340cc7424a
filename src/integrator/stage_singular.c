/* stage_singular.c - the stages of a mode that leaves something open.
 *
 * All pairs are present, with small weights (as in the OSNSP, proximal.c),
 *     closed:  w + (eps/G) lambda = 0,     open:  lambda + (eps G) w = 0,
 * so that the matrix is regular; far smaller ones on the unknowns help where no pair does. The
 * solution is then moved until the weights no longer matter. Those of unknowns and switches are
 * taken away first, so that diodes alone decide what is open; then the diodes are pulled towards
 * where they are and no longer towards 0, which leaves in place what only they determined (the
 * proximal-point iteration of Rockafellar 1976, from 0). What is left of the residual says by
 * how much the equations disagree. */
#include "stage_factors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a pair, in balanced units; that of unknowns and switches is smaller by the second number,
 * which is also how far each round takes them away. */
static const double pair_weight = 1e-6;
static const double lesser_weight = 1e-4;

/* How far the local conductance of a pair may pull its weight from the common one. */
static const double weight_spread = 1e3;

/* A residual this small, relatively, is rounding. */
static const double rounding = 1e-14;

/* Nor is it worth while to go on where the solution moves by less than this part. */
static const double unmoved = 1e-12;

enum { LESSER_ROUNDS = 5, FINAL_ROUNDS = 3 };

static double weight_of_unknowns(void) {
    return pair_weight * lesser_weight;
}

/* Equal diodes are weighted equally in amperes and volts, as far as the conductances around
 * allow. */
static void choose_weights(const struct dalcs_system *s, const struct dalcs_stage_entry *entry,
                           struct dalcs_stage_singular *g) {
    int n_equations = dalcs_system_n_equations(s);
    double sum = 0.0;
    for (int d = 0; d < s->n_pairs; d++) {
        int at = n_equations + d;
        sum += ilogb(g->matrix.row_scale[at] * g->matrix.column_scale[at]);
    }
    double common = exp2(rint(sum / s->n_pairs));
    for (int d = 0; d < s->n_pairs; d++) {
        int at = n_equations + d;
        double ratio = g->matrix.row_scale[at] * g->matrix.column_scale[at] / common;
        ratio = fmin(fmax(ratio, 1.0 / weight_spread), weight_spread);
        double kind = s->pair[d].kind == DALCS_PAIR_DIODE ? 1.0 : lesser_weight;
        g->weight[d] = pair_weight * kind * (dalcs_stage_is_on(entry, d) ? ratio : 1.0 / ratio);
    }
}

/* Unknowns without memory, paired with equations without. */
static void list_unknowns(const struct dalcs_system *s, int *unknown_of) {
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        unknown_of[r] = r >= s->n_x && s->dual[r] >= s->n_x ? s->dual[r] : -1;
    }
}

struct weighted {
    int *p, *i;
    double *x;
};

static void weighted_finish(struct weighted *a) {
    free(a->p);
    free(a->i);
    free(a->x);
}

/* The value at (row, column) of the weighted matrix; from m->values. */
static double weighted_value(const struct dalcs_system *s, const struct dalcs_stage_entry *entry,
                             const struct dalcs_stage_singular *g, int row, double value) {
    int d = row - dalcs_system_n_equations(s);
    return d >= 0 && !dalcs_stage_is_on(entry, d) ? g->weight[d] * value : value;
}

/* M with its weights, as a pattern that is the same in all modes. */
static void put_weights(const struct dalcs_system *s, const struct dalcs_stage_entry *entry,
                        const struct dalcs_stage_singular *g, const int *row_of, int stride,
                        struct weighted *a) {
    const struct dalcs_stage_matrix *m = &g->matrix;
    int n_equations = dalcs_system_n_equations(s);
    int out = 0;
    for (int c = 0; c < m->n; c++) {
        int extra = c < n_equations ? row_of[c] : c;
        double diagonal = weight_of_unknowns();
        if (c >= n_equations) {
            int d = c - n_equations;
            diagonal = dalcs_stage_is_on(entry, d) ? g->weight[d] : 1.0;
        }
        bool seen = extra < 0;
        for (int k = m->p[c]; k < m->p[c + 1]; k++, out++) {
            a->i[out] = m->i[k];
            for (int part = 0; part < stride; part++) {
                double value = m->values[stride * k + part];
                a->x[stride * out + part] = weighted_value(s, entry, g, m->i[k], value);
            }
            if (m->i[k] == extra) {
                a->x[stride * out] += diagonal;
                seen = true;
            }
        }
        if (!seen) {
            a->i[out] = extra;
            a->x[stride * out] = diagonal;
            if (stride == 2) {
                a->x[stride * out + 1] = 0.0;
            }
            out++;
        }
        a->p[c + 1] = out;
    }
}

static enum dalcs_status factor_all(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                                    struct dalcs_stage_factors *f, const int *row_of,
                                    struct weighted *a) {
    struct dalcs_stage_singular *g = f->singular;
    struct dalcs_stage_analysis *known = NULL;
    for (int q = 0; q < f->n_systems; q++) {
        dalcs_stage_factors_eigenvalue(stages, entry->h, q, &g->re[q], &g->im[q]);
        dalcs_stage_matrix_at(&g->matrix, g->re[q], g->im[q], q > 0);
        put_weights(stages->system, entry, g, row_of, q > 0 ? 2 : 1, a);
        if (q == 0) {
            DALCS_TRY(dalcs_stage_plan_analyze(stages, NULL, f->n, g->matrix.row, g->matrix.column,
                                               a->p, a->i, &known));
        }
        DALCS_TRY(dalcs_lu_factor_analyzed(&f->lu[q], q > 0 ? &stages->klu_complex : &stages->klu,
                                           known->symbolic, NULL, q > 0, a->p, a->i, a->x, 0.0));
        DALCS_TRY(dalcs_stage_factors_order(stages->plan, &g->matrix, f, q));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_stage_singular_build(struct dalcs_stages *stages,
                                             struct dalcs_stage_entry *entry,
                                             struct dalcs_stage_factors *f) {
    const struct dalcs_system *s = stages->system;
    int n_equations = dalcs_system_n_equations(s);
    struct dalcs_stage_singular *g = dalcs_alloc(1, sizeof(*g));
    if (g == NULL) {
        return DALCS_E_NOMEM;
    }
    f->singular = g;
    f->n = n_equations + s->n_pairs;
    f->n_pairs = s->n_pairs;
    for (int d = 0; d < s->n_pairs; d++) {
        f->pair[d] = d;
    }
    DALCS_TRY(dalcs_stage_matrix_build(&g->matrix, stages->plan, f->n_pairs, f->pair, entry->h));
    g->weight = dalcs_alloc((size_t)s->n_pairs, sizeof(double));
    g->unknown_of = dalcs_alloc((size_t)n_equations, sizeof(int));
    int *row_of = dalcs_alloc((size_t)n_equations, sizeof(int));
    size_t capacity = (size_t)g->matrix.p[f->n] + (size_t)f->n;
    struct weighted a = {.p = dalcs_alloc((size_t)f->n + 1, sizeof(int)),
                         .i = dalcs_alloc(capacity, sizeof(int)),
                         .x = dalcs_alloc(capacity, 2 * sizeof(double))};
    enum dalcs_status status = DALCS_E_NOMEM;
    if (g->weight != NULL && g->unknown_of != NULL && row_of != NULL && a.p != NULL &&
        a.i != NULL && a.x != NULL) {
        choose_weights(s, entry, g);
        list_unknowns(s, g->unknown_of);
        for (int r = 0; r < n_equations; r++) {
            row_of[r] = -1;
        }
        for (int r = 0; r < n_equations; r++) {
            if (g->unknown_of[r] >= 0) {
                row_of[g->unknown_of[r]] = r;
            }
        }
        memcpy(f->column_scale, g->matrix.column_scale, (size_t)f->n * sizeof(double));
        status = factor_all(stages, entry, f, row_of, &a);
    }
    free(row_of);
    weighted_finish(&a);
    return status;
}

/* plan->product = M plan->solution. */
static void multiply(const struct dalcs_stage_plan *plan, const struct dalcs_stage_singular *g,
                     int system) {
    const struct dalcs_stage_matrix *m = &g->matrix;
    const double *y = plan->solution;
    double *t = plan->product;
    int stride = system > 0 ? 2 : 1;
    memset(t, 0, (size_t)(m->n * stride) * sizeof(double));
    for (int c = 0; c < m->n; c++) {
        for (int k = m->p[c]; k < m->p[c + 1]; k++) {
            int r = m->i[k];
            double re = m->base[k] + g->re[system] * m->P[k];
            if (stride == 1) {
                t[r] += re * y[c];
            } else {
                double im = g->im[system] * m->P[k];
                t[2 * r] += re * y[2 * c] - im * y[2 * c + 1];
                t[2 * r + 1] += re * y[2 * c + 1] + im * y[2 * c];
            }
        }
    }
}

/* plan->product = what the equations, with the weights that are held, miss at plan->solution. Held
 * diodes are pulled towards their centre, which `recentre` first moves to where they are: then they
 * are not pulled at all. Returns the largest. */
static double find_residual(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_entry *entry,
                            const struct dalcs_stage_singular *g, int system, bool hold_all,
                            bool recentre) {
    const struct dalcs_system *s = plan->stages->system;
    int n_equations = dalcs_system_n_equations(s);
    int stride = system > 0 ? 2 : 1;
    double largest = 0.0;
    multiply(plan, g, system);
    for (int k = 0; k < n_equations * stride; k++) {
        int column = g->unknown_of[k / stride];
        double missed = plan->right[k] - plan->product[k];
        if (hold_all && column >= 0) {
            missed -= weight_of_unknowns() * plan->solution[column * stride + k % stride];
        }
        plan->product[k] = missed;
        largest = fmax(largest, fabs(missed));
    }
    for (int k = n_equations * stride; k < g->matrix.n * stride; k++) {
        int d = k / stride - n_equations;
        double *centre = plan->centre + k - n_equations * stride;
        bool is_on = dalcs_stage_is_on(entry, d);
        double w = plan->product[k] - plan->right[k];
        double lambda = plan->solution[k];
        double held = is_on ? lambda : w;
        if (recentre) {
            *centre = held;
        }
        double pull = hold_all || s->pair[d].kind == DALCS_PAIR_DIODE ? held - *centre : 0.0;
        double missed = -(is_on ? w : lambda) - g->weight[d] * pull;
        plan->product[k] = missed;
        largest = fmax(largest, fabs(missed));
    }
    return largest;
}

static double largest_of(const double *v, int n) {
    double largest = 0.0;
    for (int k = 0; k < n; k++) {
        largest = fmax(largest, fabs(v[k]));
    }
    return largest;
}

/* Solves for plan->product and adds that to the solution. Returns the largest change. */
static double add_correction(const struct dalcs_stage_plan *plan,
                             const struct dalcs_stage_factors *f, int system) {
    const struct dalcs_lu *lu = &f->lu[system];
    if (system == 0) {
        for (int i = 0; i < f->n; i++) {
            lu->work[i] = plan->product[lu->from[i]];
        }
        dalcs_lu_solve_ordered(lu);
        for (int i = 0; i < f->n; i++) {
            plan->solution[lu->to[i]] += lu->work[i];
        }
        return largest_of(lu->work, f->n);
    }
    for (int i = 0; i < f->n; i++) {
        lu->work[2 * i] = plan->product[2 * lu->from[i]];
        lu->work[2 * i + 1] = plan->product[2 * lu->from[i] + 1];
    }
    dalcs_lu_solve_ordered_complex(lu);
    for (int i = 0; i < f->n; i++) {
        plan->solution[2 * lu->to[i]] += lu->work[2 * i];
        plan->solution[2 * lu->to[i] + 1] += lu->work[2 * i + 1];
    }
    return largest_of(lu->work, 2 * f->n);
}

void dalcs_stage_singular_solve(const struct dalcs_stage_plan *plan,
                                const struct dalcs_stage_entry *entry,
                                const struct dalcs_stage_factors *f, int system) {
    const struct dalcs_lu *lu = &f->lu[system];
    int stride = system > 0 ? 2 : 1;
    int n = f->n * stride;
    for (int k = 0; k < n; k++) {
        plan->right[lu->from[k / stride] * stride + k % stride] = lu->work[k];
    }
    memset(plan->solution, 0, (size_t)n * sizeof(double));
    memset(plan->centre, 0, (size_t)(f->n_pairs * stride) * sizeof(double));
    (void)find_residual(plan, entry, f->singular, system, true, false);
    for (int round = 0;; round++) {
        for (int inner = 0; inner < LESSER_ROUNDS; inner++) {
            double moved = add_correction(plan, f, system);
            if (inner > 0 && moved <= unmoved * largest_of(plan->solution, n)) {
                break;
            }
            (void)find_residual(plan, entry, f->singular, system, false, false);
        }
        double residual = find_residual(plan, entry, f->singular, system, false, true);
        double size = fmax(largest_of(plan->solution, n), largest_of(plan->right, n));
        if (residual <= rounding * size || round == FINAL_ROUNDS) {
            break;
        }
    }
    int part = system > 0 ? 2 * system - 1 : 0;
    for (int k = 0; k < n; k++) {
        plan->left[(part + k % stride) * plan->n_rows + k / stride] = plan->product[k];
        lu->work[k] = plan->solution[lu->to[k / stride] * stride + k % stride];
    }
}

double dalcs_stage_singular_residual(const struct dalcs_stage_plan *plan,
                                     const struct dalcs_stage_entry *entry,
                                     const struct dalcs_stage_factors *f) {
    double worst = 0.0;
    for (int q = 0; q < f->n_systems; q++) {
        int n = f->n * (q > 0 ? 2 : 1);
        for (int k = 0; k < n; k++) { /* anything that has all frequencies in it */
            plan->right[k] = cos(1.0 + k * (double)k);
        }
        memset(plan->solution, 0, (size_t)n * sizeof(double));
        memset(plan->centre, 0, (size_t)f->n_pairs * 2 * sizeof(double));
        double before = find_residual(plan, entry, f->singular, q, true, false);
        (void)add_correction(plan, f, q);
        double after = find_residual(plan, entry, f->singular, q, true, false);
        double size = fmax(before, largest_of(plan->solution, n));
        worst = fmax(worst, after / size);
    }
    return worst;
}

void dalcs_stage_singular_destroy(struct dalcs_stage_singular *g) {
    if (g == NULL) {
        return;
    }
    dalcs_stage_matrix_finish(&g->matrix);
    free(g->weight);
    free(g->unknown_of);
    free(g);
}

size_t dalcs_stage_singular_bytes(const struct dalcs_stage_singular *g) {
    if (g == NULL) {
        return 0;
    }
    return sizeof(*g) + dalcs_stage_matrix_bytes(&g->matrix) +
           (size_t)g->matrix.n * (sizeof(double) + sizeof(int));
}
