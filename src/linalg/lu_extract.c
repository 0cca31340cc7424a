/* lu_extract.c - the factors that KLU has made, row by row in the order of its pivots, as lu_solve.c goes through them. */
#include "lu_internal.h"

#include <stdlib.h>
#include <string.h>

static size_t lay_out_extracted(struct dalcs_lu_extracted *e, const struct dalcs_lu *lu,
                                const klu_numeric *numeric) {
    size_t n = (size_t)lu->n;
    size_t lnz = (size_t)numeric->lnz;
    size_t unz = (size_t)numeric->unz;
    size_t nzoff = (size_t)numeric->nzoff;
    size_t number = (lu->is_complex ? 2 : 1) * sizeof(double);
    size_t used = 0;
    e->Lx = dalcs_carve(e->storage, &used, lnz, number);
    e->Ux = dalcs_carve(e->storage, &used, unz, number);
    e->Fx = dalcs_carve(e->storage, &used, nzoff, number);
    e->Lp = dalcs_carve(e->storage, &used, n + 1, sizeof(int));
    e->Li = dalcs_carve(e->storage, &used, lnz, sizeof(int));
    e->Up = dalcs_carve(e->storage, &used, n + 1, sizeof(int));
    e->Ui = dalcs_carve(e->storage, &used, unz, sizeof(int));
    e->Fp = dalcs_carve(e->storage, &used, n + 1, sizeof(int));
    e->Fi = dalcs_carve(e->storage, &used, nzoff, sizeof(int));
    return used;
}

size_t dalcs_lu_lay_out(struct dalcs_lu *lu, size_t lower, size_t upper) {
    size_t n = (size_t)lu->n;
    size_t number = (lu->is_complex ? 2 : 1) * sizeof(double);
    size_t used = 0;
    lu->lower_p = dalcs_carve(lu->storage, &used, n + 1, sizeof(int));
    lu->upper_p = dalcs_carve(lu->storage, &used, n + 1, sizeof(int));
    lu->lower_x = dalcs_carve(lu->storage, &used, lower, number);
    lu->upper_x = dalcs_carve(lu->storage, &used, upper, number);
    lu->pivot_inverse = dalcs_carve(lu->storage, &used, n, number);
    lu->work = dalcs_carve(lu->storage, &used, n + DALCS_LU_SPARE, number);
    lu->lower_j = dalcs_carve(lu->storage, &used, lower, sizeof(int));
    lu->upper_j = dalcs_carve(lu->storage, &used, upper, sizeof(int));
    lu->from = dalcs_carve(lu->storage, &used, n, sizeof(int));
    lu->to = dalcs_carve(lu->storage, &used, n, sizeof(int));
    lu->block = dalcs_carve(lu->storage, &used, (size_t)lu->n_blocks + 1, sizeof(int));
    return used;
}

/* All is written, but for row pointers: not zeroed, for that would take as long as a solve. */
enum dalcs_status dalcs_lu_extract(struct dalcs_lu_extracted *e, struct dalcs_lu *lu,
                                   klu_symbolic *symbolic, klu_numeric *numeric,
                                   klu_common *common) {
    *e = (struct dalcs_lu_extracted){.storage = NULL};
    lu->n_blocks = symbolic->nblocks;
    size_t lower = (size_t)numeric->lnz - (size_t)lu->n + (size_t)numeric->nzoff;
    size_t upper = (size_t)numeric->unz - (size_t)lu->n;
    e->storage = malloc(lay_out_extracted(e, lu, numeric));
    lu->storage = malloc(dalcs_lu_lay_out(lu, lower, upper));
    if (e->storage == NULL || lu->storage == NULL) {
        return DALCS_E_NOMEM;
    }
    lay_out_extracted(e, lu, numeric);
    dalcs_lu_lay_out(lu, lower, upper);
    memset(lu->lower_p, 0, (size_t)((char *)lu->lower_x - (char *)lu->lower_p));
    size_t lnz = (size_t)numeric->lnz;
    size_t unz = (size_t)numeric->unz;
    size_t nzoff = (size_t)numeric->nzoff;
    int done = lu->is_complex
                   ? klu_z_extract(numeric, symbolic, e->Lp, e->Li, e->Lx, e->Lx + lnz, e->Up,
                                   e->Ui, e->Ux, e->Ux + unz, e->Fp, e->Fi, e->Fx, e->Fx + nzoff,
                                   lu->from, lu->to, NULL, lu->block, common)
                   : klu_extract(numeric, symbolic, e->Lp, e->Li, e->Lx, e->Up, e->Ui, e->Ux, e->Fp,
                                 e->Fi, e->Fx, lu->from, lu->to, NULL, lu->block, common);
    return done ? DALCS_OK : DALCS_E_NOMEM;
}

/* Columns (p, i, x) into rows, the diagonal apart. `next` counts already, shifted by one. */
static void scatter_rows(const struct dalcs_lu *lu, const int *p, const int *i, const double *x,
                         int *next, int *row_j, double *row_x) {
    int n = lu->n;
    const double *imaginary = x + p[n];
    for (int c = 0; c < n; c++) {
        for (int k = p[c]; k < p[c + 1]; k++) {
            if (i[k] == c) {
                continue;
            }
            int to = next[i[k]]++;
            row_j[to] = c;
            if (lu->is_complex) {
                row_x[2 * to] = x[k];
                row_x[2 * to + 1] = imaginary[k];
            } else {
                row_x[to] = x[k];
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

static void invert_pivots(struct dalcs_lu *lu, const struct dalcs_lu_extracted *e) {
    const double *imaginary = e->Ux + e->Up[lu->n];
    for (int c = 0; c < lu->n; c++) {
        for (int k = e->Up[c]; k < e->Up[c + 1]; k++) {
            if (e->Ui[k] != c) {
                continue;
            }
            if (lu->is_complex) {
                double size = e->Ux[k] * e->Ux[k] + imaginary[k] * imaginary[k];
                lu->pivot_inverse[2 * c] = e->Ux[k] / size;
                lu->pivot_inverse[2 * c + 1] = -imaginary[k] / size;
            } else {
                lu->pivot_inverse[c] = 1.0 / e->Ux[k];
            }
        }
    }
}

void dalcs_lu_arrange(struct dalcs_lu *lu, const struct dalcs_lu_extracted *e) {
    int n = lu->n;
    count_rows(n, e->Fp, e->Fi, lu->lower_p);
    count_rows(n, e->Lp, e->Li, lu->lower_p);
    accumulate(n, lu->lower_p);
    scatter_rows(lu, e->Fp, e->Fi, e->Fx, lu->lower_p, lu->lower_j, lu->lower_x);
    scatter_rows(lu, e->Lp, e->Li, e->Lx, lu->lower_p, lu->lower_j, lu->lower_x);
    restore(n, lu->lower_p);
    count_rows(n, e->Up, e->Ui, lu->upper_p);
    accumulate(n, lu->upper_p);
    scatter_rows(lu, e->Up, e->Ui, e->Ux, lu->upper_p, lu->upper_j, lu->upper_x);
    restore(n, lu->upper_p);
    invert_pivots(lu, e);
}
