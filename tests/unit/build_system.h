/* build_system.h - a DALCS from dense matrices, as the papers print them. */
#ifndef DALCS_TEST_BUILD_SYSTEM_H
#define DALCS_TEST_BUILD_SYSTEM_H

#include "run_tests.h"
#include "system.h"

#include <stdlib.h>

/* Rows of A: I, then II, over x, z, lambda. NULL stands for 0, P NULL for the identity. */
struct dense_system {
    int n, p, m, k; /* k inputs besides the constant 1 */
    const double *P, *A, *E, *C, *F, *storage;
};

static inline void fill(struct dalcs_csr *rows, int n_rows, int n_columns, const double *value,
                        int skip) {
    struct dalcs_triplets t = {0};
    for (int i = 0; value != NULL && i < n_rows; i++) {
        for (int j = 0; j < n_columns - skip; j++) {
            if (value[i * (n_columns - skip) + j] != 0.0) {
                ck_assert_int_eq(
                    dalcs_triplets_add(&t, i, skip + j, value[i * (n_columns - skip) + j]),
                    DALCS_OK);
            }
        }
    }
    ck_assert_int_eq(dalcs_csr_compress(rows, n_rows, n_columns, &t), DALCS_OK);
    dalcs_triplets_finish(&t);
}

static const char *const state_names[] = {"x1", "x2", "x3", "x4"};
static const char *const algebraic_names[] = {"z1", "z2"};
static const char *const pair_names[] = {"d1", "d2", "d3", "d4"};
static const char *const source_names[] = {"u1", "u2", "u3"};

static inline void build_system(struct dalcs_system *s, const struct dense_system *d) {
    const int n = d->n + d->p;
    const double unit[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    double identity[16];
    for (int i = 0; i < d->n; i++) {
        for (int j = 0; j < d->n; j++) {
            identity[i * d->n + j] = unit[i * 4 + j];
        }
    }
    *s = (struct dalcs_system){.n_x = d->n, .n_z = d->p, .n_pairs = d->m, .n_inputs = d->k + 1};
    fill(&s->P, d->n, d->n, d->P == NULL ? identity : d->P, 0);
    fill(&s->A, n, n + d->m, d->A, 0);
    fill(&s->E, n, d->k + 1, d->E, 1);
    fill(&s->C, d->m, n + d->m, d->C, 0);
    fill(&s->F, d->m, d->k + 1, d->F, 1);
    fill(&s->storage, d->n, d->n, d->storage, 0);
    fill(&s->control, d->m, n + d->m, NULL, 0);
    fill(&s->direct_control, d->m, d->k + 1, NULL, 0);
    s->dual = dalcs_alloc((size_t)n, sizeof(*s->dual));
    s->forest_root = dalcs_alloc((size_t)n, sizeof(*s->forest_root));
    s->column_is_current = dalcs_alloc((size_t)(n + d->m), sizeof(bool));
    s->row_is_current = dalcs_alloc((size_t)n, sizeof(bool));
    s->row = dalcs_alloc((size_t)n, sizeof(*s->row));
    s->column = dalcs_alloc((size_t)n, sizeof(*s->column));
    s->pair = dalcs_alloc((size_t)d->m, sizeof(*s->pair));
    s->stimulus = dalcs_alloc((size_t)d->k + 1, sizeof(*s->stimulus));
    s->input_element = dalcs_alloc((size_t)d->k + 1, sizeof(*s->input_element));
    for (int i = 0; i < n; i++) {
        s->dual[i] = s->forest_root[i] = i;
        s->column[i] = (struct dalcs_label){i < d->n ? state_names[i] : algebraic_names[i - d->n],
                                            i < d->n ? DALCS_LABEL_STATE : DALCS_LABEL_BRANCH};
        s->row[i] = s->column[i];
    }
    for (int i = 0; i < d->m; i++) {
        s->pair[i] = (struct dalcs_pair){.kind = DALCS_PAIR_DIODE, .element = pair_names[i]};
    }
    for (int j = 0; j <= d->k; j++) {
        s->stimulus[j] = -1;
        s->input_element[j] = j == 0 ? NULL : source_names[j - 1];
    }
}

#endif
