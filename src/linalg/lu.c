/* lu.c - the seam to KLU: analyse and factor there, solve here. */
#include "lu_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Elements that grow beyond those of the matrix cost digits, one for each ten times: pivots of other values may cost one. A
 * current of a nanoampere beside voltages of functions has few to spare. */
static const double least_reciprocal_growth = 0.1;

void dalcs_lu_common_init(klu_common *common) {
    klu_defaults(common);
    common->halt_if_singular = 1;
    common->scale = -1; /* the caller has balanced and checked the entries */
}

void dalcs_lu_pivot_carefully(klu_common *common) {
    common->tol = 0.1;
}

void dalcs_lu_keep_diagonal(klu_common *common, bool keep) {
    common->btf = keep ? 0 : 1;
}

/* The estimate compares pivots of different columns, which parts of a circuit with conductances far
 * apart make differ; a pivot that is this many times rcond_min of its own column is no rounding. */
static const double clear_of_rounding = 100.0;

enum dalcs_status dalcs_lu_analyze(klu_symbolic **symbolic, klu_common *common,
                                   const struct dalcs_columns *a) {
    *symbolic = klu_analyze(a->n, a->p, a->i, common);
    if (*symbolic == NULL) {
        return common->status == KLU_SINGULAR ? DALCS_SINGULAR : DALCS_E_NOMEM;
    }
    if ((*symbolic)->structural_rank >= 0 && (*symbolic)->structural_rank < a->n) {
        klu_free_symbolic(symbolic, common);
        return DALCS_SINGULAR;
    }
    return DALCS_OK;
}

/* The matrix to factor. */
struct values {
    klu_common *common;
    klu_symbolic *symbolic;
    const struct dalcs_columns *a;
    double rcond_min;
};

static bool is_well_conditioned(const struct values *v, klu_numeric *numeric) {
    if (v->a->is_complex) {
        klu_z_rcond(v->symbolic, numeric, v->common);
    } else {
        klu_rcond(v->symbolic, numeric, v->common);
    }
    return v->common->rcond >= v->rcond_min;
}

static enum dalcs_status factor(const struct values *v, klu_numeric **numeric) {
    *numeric = v->a->is_complex ? klu_z_factor(v->a->p, v->a->i, v->a->x, v->symbolic, v->common)
                                : klu_factor(v->a->p, v->a->i, v->a->x, v->symbolic, v->common);
    if (v->common->status == KLU_OUT_OF_MEMORY || v->common->status == KLU_TOO_LARGE) {
        return DALCS_E_NOMEM;
    }
    bool is_regular = *numeric != NULL && v->common->status != KLU_SINGULAR;
    return is_regular ? DALCS_OK : DALCS_SINGULAR;
}

static double magnitude(const struct values *v, const double *real, const double *imaginary,
                        int k) {
    return v->a->is_complex ? hypot(real[k], imaginary[k]) : fabs(real[k]);
}

/* The least pivot over the largest element of its column, in the matrix and in U. */
static double least_relative_pivot(const struct values *v, const struct dalcs_lu *lu,
                                   const struct dalcs_lu_extracted *e) {
    double least = INFINITY;
    for (int c = 0; c < lu->n; c++) {
        double largest = 0.0;
        double pivot = 0.0;
        for (int k = e->Up[c]; k < e->Up[c + 1]; k++) {
            double a = magnitude(v, e->Ux, e->Ux + e->Up[lu->n], k);
            largest = fmax(largest, a);
            pivot = e->Ui[k] == c ? a : pivot;
        }
        for (int k = v->a->p[lu->to[c]]; k < v->a->p[lu->to[c] + 1]; k++) {
            largest = fmax(largest, v->a->is_complex ? hypot(v->a->x[2 * k], v->a->x[2 * k + 1])
                                                     : fabs(v->a->x[k]));
        }
        least = fmin(least, pivot / largest);
    }
    return least;
}

/* Do the pivots of other values serve these? */
static bool refactor(const struct values *v, klu_numeric *numeric) {
    klu_common *c = v->common;
    int done = v->a->is_complex ? klu_z_refactor(v->a->p, v->a->i, v->a->x, v->symbolic, numeric, c)
                                : klu_refactor(v->a->p, v->a->i, v->a->x, v->symbolic, numeric, c);
    if (!done || c->status != KLU_OK || !is_well_conditioned(v, numeric)) {
        return false;
    }
    if (v->a->is_complex) {
        klu_z_rgrowth(v->a->p, v->a->i, v->a->x, v->symbolic, numeric, c);
    } else {
        klu_rgrowth(v->a->p, v->a->i, v->a->x, v->symbolic, numeric, c);
    }
    return c->rgrowth >= least_reciprocal_growth;
}

void dalcs_lu_drop(klu_numeric **kept, bool is_complex, klu_common *common) {
    if (is_complex) {
        klu_z_free_numeric(kept, common);
    } else {
        klu_free_numeric(kept, common);
    }
}

enum dalcs_status dalcs_lu_factor_analyzed(struct dalcs_lu *lu, klu_common *common,
                                           klu_symbolic *symbolic, klu_numeric **kept,
                                           const struct dalcs_columns *a, double rcond_min) {
    *lu = (struct dalcs_lu){.n = symbolic->n, .is_complex = a->is_complex};
    const struct values v = {common, symbolic, a, rcond_min};
    klu_numeric *numeric = kept != NULL ? *kept : NULL;
    enum dalcs_status status = DALCS_OK;
    bool is_doubtful = false;
    if (numeric == NULL || !refactor(&v, numeric)) {
        dalcs_lu_drop(&numeric, a->is_complex, common);
        status = factor(&v, &numeric);
        is_doubtful = status == DALCS_OK && !is_well_conditioned(&v, numeric);
    }
    if (status == DALCS_OK) {
        struct dalcs_lu_extracted e;
        status = dalcs_lu_extract(&e, lu, symbolic, numeric, common);
        if (status == DALCS_OK && is_doubtful &&
            least_relative_pivot(&v, lu, &e) < clear_of_rounding * rcond_min) {
            status = DALCS_SINGULAR;
        }
        if (status == DALCS_OK) {
            dalcs_lu_arrange(lu, &e);
        }
        free(e.storage);
    }
    if (kept == NULL || status != DALCS_OK) {
        dalcs_lu_drop(&numeric, a->is_complex, common);
    }
    if (kept != NULL) {
        *kept = numeric;
    }
    if (status != DALCS_OK) {
        dalcs_lu_finish(lu);
    }
    return status;
}

/* btf_maxtrans matches a column to its first entry whose row is still free. */
static void list_matched_rows_first(const struct dalcs_columns *a, const int *row_of_column) {
    const int *p = a->p;
    int *i = a->i;
    double *x = a->x;
    for (int c = 0; c < a->n; c++) {
        for (int k = p[c]; k < p[c + 1]; k++) {
            if (i[k] == row_of_column[c]) {
                double value = x[k];
                i[k] = i[p[c]];
                x[k] = x[p[c]];
                i[p[c]] = row_of_column[c];
                x[p[c]] = value;
                break;
            }
        }
    }
}

enum dalcs_status dalcs_lu_factor(struct dalcs_lu *lu, klu_common *common,
                                  const struct dalcs_columns *a, int *row_of_column,
                                  double rcond_min) {
    *lu = (struct dalcs_lu){.n = a->n};
    if (a->n == 0) {
        return DALCS_OK;
    }
    if (row_of_column != NULL) {
        list_matched_rows_first(a, row_of_column);
    }
    klu_symbolic *symbolic;
    enum dalcs_status status = dalcs_lu_analyze(&symbolic, common, a);
    if (status != DALCS_OK) {
        dalcs_lu_finish(lu);
        return status;
    }
    for (int k = 0; row_of_column != NULL && k < a->n; k++) {
        row_of_column[symbolic->Q[k]] = symbolic->P[k];
    }
    status = dalcs_lu_factor_analyzed(lu, common, symbolic, NULL, a, rcond_min);
    klu_free_symbolic(&symbolic, common);
    return status;
}

size_t dalcs_lu_bytes(const struct dalcs_lu *lu) {
    if (lu->lower_p == NULL) {
        return 0;
    }
    size_t n = (size_t)lu->n;
    size_t entries = (size_t)lu->lower_p[lu->n] + (size_t)lu->upper_p[lu->n];
    size_t number = (lu->is_complex ? 2 : 1) * sizeof(double);
    return entries * (number + sizeof(int)) + n * (4 * sizeof(int) + 2 * number) +
           (size_t)lu->n_blocks * sizeof(int);
}

void dalcs_lu_finish(struct dalcs_lu *lu) {
    free(lu->storage);
    *lu = (struct dalcs_lu){0};
}
