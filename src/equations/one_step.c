/* one_step.c - the one-step problem of implicit Euler for given h, reduced to lambda: with sigma = 1/h and
 *
 *     N(sigma) = [sigma P - A_I  -B_I; -A_II  -B_II],
 *     w = M lambda + q,   M(sigma) = D + (C_I C_II) N(sigma)^-1 (Bbar_I; Bbar_II),
 *     q = F s + (C_I C_II) N(sigma)^-1 (sigma P x_k + E_I s; E_II s)
 *
 * (Brogliato 2022, eq. (3.2); Heemels, Schumacher and Weiland 1999, whose M(s) this is at s = 1/h). */
#include "eliminate.h"
#include "equations.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static const double least_rcond = 1e-16;

struct work {
    double *N, *right; /* [n][n], [n][n_pairs + n_x + n_inputs] */
    double *row, *column;
    lapack_int *pivot;
};

static void fill(const struct dalcs_system *s, double sigma, struct work *w, size_t n,
                 size_t n_right) {
    for (size_t i = 0; i < n; i++) {
        int r = (int)i;
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            size_t c = (size_t)s->A.j[k];
            if (c < n) {
                w->N[i * n + c] -= s->A.x[k];
            } else {
                w->right[i * n_right + (c - n)] += s->A.x[k];
            }
        }
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            w->N[i * n + (size_t)s->P.j[k]] += sigma * s->P.x[k];
            w->right[i * n_right + (size_t)(s->n_pairs + s->P.j[k])] += sigma * s->P.x[k];
        }
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            w->right[i * n_right + (size_t)(s->n_pairs + s->n_x + s->E.j[k])] += s->E.x[k];
        }
    }
}

/* By powers of 2, rows then columns. */
static void balance(struct work *w, size_t n, size_t n_right) {
    for (int by_column = 0; by_column < 2; by_column++) {
        for (size_t i = 0; i < n; i++) {
            double largest = 0.0;
            for (size_t j = 0; j < n; j++) {
                largest = fmax(largest, fabs(w->N[by_column ? j * n + i : i * n + j]));
            }
            int power = 0;
            (void)frexp(largest, &power);
            double scale = largest > 0.0 ? ldexp(1.0, -power) : 1.0;
            (by_column ? w->column : w->row)[i] = scale;
            for (size_t j = 0; j < n; j++) {
                w->N[by_column ? j * n + i : i * n + j] *= scale;
            }
            for (size_t j = 0; j < n_right && !by_column; j++) {
                w->right[i * n_right + j] *= scale;
            }
        }
    }
}

/* right becomes N^-1 right; false when N is singular. */
static enum dalcs_status solve(struct work *w, size_t n, size_t n_right, bool *is_singular) {
    lapack_int order = (lapack_int)n;
    double rcond = 0.0;
    double norm = dalcs_dense_one_norm(w->N, n);
    lapack_int info = LAPACKE_dgetrf(LAPACK_ROW_MAJOR, order, order, w->N, order, w->pivot);
    if (info == 0) {
        info = LAPACKE_dgecon(LAPACK_ROW_MAJOR, '1', order, w->N, order, norm, &rcond);
    }
    if (info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR) {
        return DALCS_E_NOMEM;
    }
    *is_singular = info != 0 || rcond < least_rcond;
    if (*is_singular) {
        return DALCS_OK;
    }
    info = LAPACKE_dgetrs(LAPACK_ROW_MAJOR, 'N', order, (lapack_int)n_right, w->N, order, w->pivot,
                          w->right, (lapack_int)n_right);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n_right; j++) {
            w->right[i * n_right + j] *= w->column[i];
        }
    }
    return info == 0 ? DALCS_OK : DALCS_E_NOMEM;
}

/* An entry that is this part of what it is summed from is rounding. */
static const double rounding = 1e-14;

/* Pair d's coefficient of column j of `right`. */
static double coefficient(const struct dalcs_system *s, const struct work *w, int d, size_t j,
                          size_t n_right) {
    const size_t n = (size_t)dalcs_system_n_equations(s);
    double sum = 0.0;
    double size = 0.0;
    for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
        size_t c = (size_t)s->C.j[k];
        double factor = c < n ? w->right[c * n_right + j] : c - n == j ? 1.0 : 0.0;
        sum += s->C.x[k] * factor;
        size = fmax(size, fabs(s->C.x[k] * factor));
    }
    size_t first_input = (size_t)(s->n_pairs + s->n_x);
    for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
        double factor = first_input + (size_t)s->F.j[k] == j ? s->F.x[k] : 0.0;
        sum += factor;
        size = fmax(size, fabs(factor));
    }
    return fabs(sum) <= rounding * size ? 0.0 : sum;
}

/* What N^-1 left of 0, beside the rest of its column. */
static void drop_rounding(double *a, size_t n_rows, size_t n_columns) {
    for (size_t j = 0; j < n_columns; j++) {
        double largest = 0.0;
        for (size_t i = 0; i < n_rows; i++) {
            largest = fmax(largest, fabs(a[i * n_columns + j]));
        }
        for (size_t i = 0; i < n_rows; i++) {
            double *value = &a[i * n_columns + j];
            *value = fabs(*value) <= 1e-15 * largest ? 0.0 : *value;
        }
    }
}

static void read_off(struct dalcs_one_step *step, const struct work *w, size_t n_right) {
    const struct dalcs_system *s = step->system;
    for (int d = 0; d < s->n_pairs; d++) {
        double *const target[] = {step->M + (size_t)d * (size_t)s->n_pairs,
                                  step->of_x + (size_t)d * (size_t)s->n_x,
                                  step->of_s + (size_t)d * (size_t)s->n_inputs};
        const int width[] = {s->n_pairs, s->n_x, s->n_inputs};
        size_t from = 0;
        for (int part = 0; part < 3; part++) {
            for (int j = 0; j < width[part]; j++) {
                target[part][j] = coefficient(s, w, d, from++, n_right);
            }
        }
    }
    size_t n_pairs = (size_t)s->n_pairs;
    drop_rounding(step->M, n_pairs, n_pairs);
    drop_rounding(step->of_x, n_pairs, (size_t)s->n_x);
    drop_rounding(step->of_s, n_pairs, (size_t)s->n_inputs);
}

enum dalcs_status dalcs_one_step_of(struct dalcs_one_step *step, const struct dalcs_system *s,
                                    double h) {
    size_t n = (size_t)dalcs_system_n_equations(s);
    size_t n_pairs = (size_t)s->n_pairs;
    size_t n_right = n_pairs + (size_t)s->n_x + (size_t)s->n_inputs;
    *step = (struct dalcs_one_step){.system = s, .sigma = 1.0 / h};
    step->M = dalcs_alloc(n_pairs * n_pairs, sizeof *step->M);
    step->of_x = dalcs_alloc(n_pairs * (size_t)s->n_x, sizeof *step->of_x);
    step->of_s = dalcs_alloc(n_pairs * (size_t)s->n_inputs, sizeof *step->of_s);
    struct work w = {.N = dalcs_alloc(n * n, sizeof *w.N),
                     .right = dalcs_alloc(n * n_right, sizeof *w.right),
                     .row = dalcs_alloc(n, sizeof *w.row),
                     .column = dalcs_alloc(n, sizeof *w.column),
                     .pivot = dalcs_alloc(n, sizeof *w.pivot)};
    enum dalcs_status status = DALCS_E_NOMEM;
    if (step->M != NULL && step->of_x != NULL && step->of_s != NULL && w.N != NULL &&
        w.right != NULL && w.row != NULL && w.column != NULL && w.pivot != NULL) {
        fill(s, step->sigma, &w, n, n_right);
        balance(&w, n, n_right);
        status = n == 0 ? DALCS_OK : solve(&w, n, n_right, &step->is_singular);
        if (status == DALCS_OK && !step->is_singular) {
            read_off(step, &w, n_right);
        }
    }
    free(w.N);
    free(w.right);
    free(w.row);
    free(w.column);
    free(w.pivot);
    if (status != DALCS_OK) {
        dalcs_one_step_finish(step);
    }
    return status;
}

void dalcs_one_step_finish(struct dalcs_one_step *step) {
    free(step->M);
    free(step->of_x);
    free(step->of_s);
    *step = (struct dalcs_one_step){0};
}
