/* lu.c - the seam to KLU: analyse and factor there, solve here. */
#include "lu.h"

#include <stdlib.h>

void dalcs_lu_common_init(klu_common *common) {
    klu_defaults(common);
    common->halt_if_singular = 1;
    common->scale = 0; /* the caller balances: no division by row scales in every solve */
}

/* What klu_extract fills: L and U by columns with their diagonals, F by columns. */
struct extracted {
    int *Lp, *Li, *Up, *Ui, *Fp, *Fi;
    double *Lx, *Ux, *Fx;
};

static void extracted_finish(struct extracted *e) {
    free(e->Lp);
    free(e->Li);
    free(e->Lx);
    free(e->Up);
    free(e->Ui);
    free(e->Ux);
    free(e->Fp);
    free(e->Fi);
    free(e->Fx);
}

static enum dalcs_status extract(struct extracted *e, struct dalcs_lu *lu, klu_symbolic *symbolic,
                                 klu_numeric *numeric, klu_common *common) {
    size_t n = (size_t)lu->n;
    size_t lnz = (size_t)numeric->lnz;
    size_t unz = (size_t)numeric->unz;
    size_t nzoff = (size_t)numeric->nzoff;
    *e = (struct extracted){
        .Lp = dalcs_alloc(n + 1, sizeof(int)),
        .Li = dalcs_alloc(lnz, sizeof(int)),
        .Lx = dalcs_alloc(lnz, sizeof(double)),
        .Up = dalcs_alloc(n + 1, sizeof(int)),
        .Ui = dalcs_alloc(unz, sizeof(int)),
        .Ux = dalcs_alloc(unz, sizeof(double)),
        .Fp = dalcs_alloc(n + 1, sizeof(int)),
        .Fi = dalcs_alloc(nzoff, sizeof(int)),
        .Fx = dalcs_alloc(nzoff, sizeof(double)),
    };
    lu->n_blocks = symbolic->nblocks;
    lu->block = dalcs_alloc((size_t)lu->n_blocks + 1, sizeof(int));
    lu->from = dalcs_alloc(n, sizeof(int));
    lu->to = dalcs_alloc(n, sizeof(int));
    lu->lower_p = dalcs_alloc(n + 1, sizeof(int));
    lu->lower_j = dalcs_alloc(lnz - n + nzoff, sizeof(int));
    lu->lower_x = dalcs_alloc(lnz - n + nzoff, sizeof(double));
    lu->upper_p = dalcs_alloc(n + 1, sizeof(int));
    lu->upper_j = dalcs_alloc(unz - n, sizeof(int));
    lu->upper_x = dalcs_alloc(unz - n, sizeof(double));
    lu->pivot_inverse = dalcs_alloc(n, sizeof(double));
    lu->work = dalcs_alloc(n, sizeof(double));
    if (e->Lp == NULL || e->Li == NULL || e->Lx == NULL || e->Up == NULL || e->Ui == NULL ||
        e->Ux == NULL || e->Fp == NULL || e->Fi == NULL || e->Fx == NULL || lu->block == NULL ||
        lu->from == NULL || lu->to == NULL || lu->lower_p == NULL || lu->lower_j == NULL ||
        lu->lower_x == NULL || lu->upper_p == NULL || lu->upper_j == NULL || lu->upper_x == NULL ||
        lu->pivot_inverse == NULL || lu->work == NULL) {
        return DALCS_E_NOMEM;
    }
    if (!klu_extract(numeric, symbolic, e->Lp, e->Li, e->Lx, e->Up, e->Ui, e->Ux, e->Fp, e->Fi,
                     e->Fx, lu->from, lu->to, NULL, lu->block, common)) {
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

/* Columns (p, i, x) into rows, the diagonal apart. `row_p` counts already, shifted by one. */
static void scatter_rows(int n, const int *p, const int *i, const double *x, int *next, int *row_j,
                         double *row_x) {
    for (int c = 0; c < n; c++) {
        for (int k = p[c]; k < p[c + 1]; k++) {
            if (i[k] != c) {
                row_j[next[i[k]]] = c;
                row_x[next[i[k]]++] = x[k];
            }
        }
    }
}

static void count_rows(int n, const int *p, const int *i, int *row_p) {
    for (int c = 0; c < n; c++) {
        for (int k = p[c]; k < p[c + 1]; k++) {
            if (i[k] != c) {
                row_p[i[k] + 1]++;
            }
        }
    }
}

static void accumulate(int n, int *row_p) {
    for (int r = 0; r < n; r++) {
        row_p[r + 1] += row_p[r];
    }
}

static void restore(int n, int *row_p) {
    for (int r = n; r > 0; r--) {
        row_p[r] = row_p[r - 1];
    }
    row_p[0] = 0;
}

static void arrange(struct dalcs_lu *lu, const struct extracted *e) {
    int n = lu->n;
    count_rows(n, e->Fp, e->Fi, lu->lower_p);
    count_rows(n, e->Lp, e->Li, lu->lower_p);
    accumulate(n, lu->lower_p);
    scatter_rows(n, e->Fp, e->Fi, e->Fx, lu->lower_p, lu->lower_j, lu->lower_x);
    scatter_rows(n, e->Lp, e->Li, e->Lx, lu->lower_p, lu->lower_j, lu->lower_x);
    restore(n, lu->lower_p);
    count_rows(n, e->Up, e->Ui, lu->upper_p);
    accumulate(n, lu->upper_p);
    scatter_rows(n, e->Up, e->Ui, e->Ux, lu->upper_p, lu->upper_j, lu->upper_x);
    restore(n, lu->upper_p);
    for (int c = 0; c < n; c++) {
        for (int k = e->Up[c]; k < e->Up[c + 1]; k++) {
            if (e->Ui[k] == c) {
                lu->pivot_inverse[c] = 1.0 / e->Ux[k];
            }
        }
    }
}

enum dalcs_status dalcs_lu_factor(struct dalcs_lu *lu, klu_common *common, int n, int *p, int *i,
                                  double *x, double rcond_min) {
    *lu = (struct dalcs_lu){.n = n};
    if (n == 0) {
        return DALCS_OK;
    }
    enum dalcs_status status = DALCS_OK;
    klu_numeric *numeric = NULL;
    klu_symbolic *symbolic = klu_analyze(n, p, i, common);
    if (symbolic == NULL) {
        status = common->status == KLU_SINGULAR ? DALCS_SINGULAR : DALCS_E_NOMEM;
    } else if (symbolic->structural_rank >= 0 && symbolic->structural_rank < n) {
        status = DALCS_SINGULAR;
    } else {
        numeric = klu_factor(p, i, x, symbolic, common);
        if (common->status == KLU_OUT_OF_MEMORY || common->status == KLU_TOO_LARGE) {
            status = DALCS_E_NOMEM;
        } else if (numeric == NULL || common->status == KLU_SINGULAR) {
            status = DALCS_SINGULAR;
        } else {
            klu_rcond(symbolic, numeric, common);
            status = common->rcond >= rcond_min ? DALCS_OK : DALCS_SINGULAR;
        }
    }
    if (status == DALCS_OK) {
        struct extracted e;
        status = extract(&e, lu, symbolic, numeric, common);
        if (status == DALCS_OK) {
            arrange(lu, &e);
        }
        extracted_finish(&e);
    }
    klu_free_symbolic(&symbolic, common);
    klu_free_numeric(&numeric, common);
    if (status != DALCS_OK) {
        dalcs_lu_finish(lu);
    }
    return status;
}

void dalcs_lu_solve_ordered(const struct dalcs_lu *lu) {
    double *restrict x = lu->work;
    const int *restrict lower_p = lu->lower_p;
    const int *restrict lower_j = lu->lower_j;
    const double *restrict lower_x = lu->lower_x;
    const int *restrict upper_p = lu->upper_p;
    const int *restrict upper_j = lu->upper_j;
    const double *restrict upper_x = lu->upper_x;
    for (int block = lu->n_blocks - 1; block >= 0; block--) {
        int begin = lu->block[block];
        int end = lu->block[block + 1];
        /* Forward: what later blocks contribute through F, then L. */
        for (int i = begin; i < end; i++) {
            double sum = x[i];
            for (int k = lower_p[i]; k < lower_p[i + 1]; k++) {
                sum -= lower_x[k] * x[lower_j[k]];
            }
            x[i] = sum;
        }
        for (int i = end - 1; i >= begin; i--) {
            double sum = x[i];
            for (int k = upper_p[i]; k < upper_p[i + 1]; k++) {
                sum -= upper_x[k] * x[upper_j[k]];
            }
            x[i] = sum * lu->pivot_inverse[i];
        }
    }
}

void dalcs_lu_solve(const struct dalcs_lu *lu, double *b) {
    for (int i = 0; i < lu->n; i++) {
        lu->work[i] = b[lu->from[i]];
    }
    dalcs_lu_solve_ordered(lu);
    for (int i = 0; i < lu->n; i++) {
        b[lu->to[i]] = lu->work[i];
    }
}

size_t dalcs_lu_bytes(const struct dalcs_lu *lu) {
    if (lu->lower_p == NULL) {
        return 0;
    }
    size_t n = (size_t)lu->n;
    size_t entries = (size_t)lu->lower_p[lu->n] + (size_t)lu->upper_p[lu->n];
    return entries * (sizeof(double) + sizeof(int)) + n * (4 * sizeof(int) + 2 * sizeof(double)) +
           (size_t)lu->n_blocks * sizeof(int);
}

void dalcs_lu_finish(struct dalcs_lu *lu) {
    free(lu->block);
    free(lu->from);
    free(lu->to);
    free(lu->lower_p);
    free(lu->lower_j);
    free(lu->lower_x);
    free(lu->upper_p);
    free(lu->upper_j);
    free(lu->upper_x);
    free(lu->pivot_inverse);
    free(lu->work);
    *lu = (struct dalcs_lu){0};
}
