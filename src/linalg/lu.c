/* lu.c - the seam to KLU: analyse and factor, solve, free. */
#include "lu.h"

void dalcs_lu_common_init(klu_common *common) {
    klu_defaults(common);
    common->halt_if_singular = 1;
}

enum dalcs_status dalcs_lu_factor(struct dalcs_lu *lu, klu_common *common, int n, int *p, int *i,
                                  double *x, double rcond_min) {
    *lu = (struct dalcs_lu){.n = n};
    if (n == 0) {
        return DALCS_OK;
    }
    enum dalcs_status status = DALCS_OK;
    lu->symbolic = klu_analyze(n, p, i, common);
    if (lu->symbolic == NULL) {
        status = common->status == KLU_SINGULAR ? DALCS_SINGULAR : DALCS_E_NOMEM;
    } else if (lu->symbolic->structural_rank >= 0 && lu->symbolic->structural_rank < n) {
        status = DALCS_SINGULAR;
    } else {
        lu->numeric = klu_factor(p, i, x, lu->symbolic, common);
        if (common->status == KLU_OUT_OF_MEMORY || common->status == KLU_TOO_LARGE) {
            status = DALCS_E_NOMEM;
        } else if (lu->numeric == NULL || common->status == KLU_SINGULAR) {
            status = DALCS_SINGULAR;
        } else {
            klu_rcond(lu->symbolic, lu->numeric, common);
            if (!(common->rcond >= rcond_min)) {
                status = DALCS_SINGULAR;
            }
        }
    }
    if (status != DALCS_OK) {
        dalcs_lu_finish(lu, common);
    }
    return status;
}

void dalcs_lu_solve(const struct dalcs_lu *lu, klu_common *common, int n_rhs, double *b) {
    if (lu->n > 0) {
        klu_solve(lu->symbolic, lu->numeric, lu->n, n_rhs, b, common);
    }
}

size_t dalcs_lu_bytes(const struct dalcs_lu *lu) {
    if (lu->numeric == NULL) {
        return 0;
    }
    size_t n = (size_t)lu->n;
    size_t entries = (size_t)lu->numeric->lnz + (size_t)lu->numeric->unz +
                     (size_t)lu->numeric->nzoff;
    return entries * (sizeof(double) + sizeof(int)) + n * 24 * sizeof(double);
}

void dalcs_lu_finish(struct dalcs_lu *lu, klu_common *common) {
    klu_free_symbolic(&lu->symbolic, common);
    klu_free_numeric(&lu->numeric, common);
    *lu = (struct dalcs_lu){0};
}
