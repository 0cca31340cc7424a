/* cone_storage.c - the storage of a described system. */
#include "cone_assembly.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Systems up to this size are looked at densely. */
enum { DENSE = 500 };

bool dalcs_storage_is_regular(struct dalcs_reading *r, const struct dalcs_assembly *a) {
    const struct dalcs_csr *P = &a->s->P;
    size_t n = (size_t)a->s->n_x;
    if (n == 0 || n > DENSE) {
        return true;
    }
    double *dense = dalcs_alloc(n * n, sizeof *dense);
    lapack_int *pivot = dalcs_alloc(n, sizeof *pivot);
    bool ok = false;
    if (dense == NULL || pivot == NULL) {
        r->builder.out_of_memory = true;
    } else {
        for (size_t i = 0; i < n; i++) {
            for (int k = P->p[i]; k < P->p[i + 1]; k++) {
                dense[i * n + (size_t)P->j[k]] = P->x[k];
            }
        }
        ok = LAPACKE_dgetrf(LAPACK_ROW_MAJOR, (lapack_int)n, (lapack_int)n, dense, (lapack_int)n,
                            pivot) == 0;
        if (!ok) {
            dalcs_builder_error(&r->builder, a->from->token,
                                "what has no derivative is an unknown of its own",
                                "the matrix P (of a mechanical system: the mass) is singular");
        }
    }
    free(dense);
    free(pivot);
    return ok;
}

static enum dalcs_status multiply(struct dalcs_csr *a, const struct dalcs_csr *S) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int i = 0; i < a->n_rows && status == DALCS_OK; i++) {
        if (i >= S->n_rows) {
            for (int k = a->p[i]; k < a->p[i + 1] && status == DALCS_OK; k++) {
                status = dalcs_triplets_add(&t, i, a->j[k], a->x[k]);
            }
            continue;
        }
        for (int e = S->p[i]; e < S->p[i + 1]; e++) {
            int from = S->j[e];
            for (int k = a->p[from]; k < a->p[from + 1] && status == DALCS_OK; k++) {
                status = dalcs_triplets_add(&t, i, a->j[k], S->x[e] * a->x[k]);
            }
        }
    }
    struct dalcs_csr product = {0};
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(&product, a->n_rows, a->n_columns, &t);
    }
    if (status == DALCS_OK) {
        dalcs_csr_finish(a);
        *a = product;
    }
    dalcs_triplets_finish(&t);
    return status;
}

enum dalcs_status dalcs_scale_by_storage(struct dalcs_assembly *a) {
    const struct dalcs_block *block = a->from->block;
    struct dalcs_system *s = a->s;
    if (block[DALCS_BLOCK_P].card != NULL || block[DALCS_BLOCK_STORAGE].card == NULL ||
        a->from->n_coordinates > 0) {
        return DALCS_OK;
    }
    dalcs_csr_finish(&s->A_rest);
    DALCS_TRY(multiply(&s->A, &s->storage));
    DALCS_TRY(multiply(&s->E, &s->storage));
    return multiply(&s->P, &s->storage);
}
