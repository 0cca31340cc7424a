/* build_network.h - for the tests: the systems of a netlist text, and their entries by name. */
#ifndef DALCS_TEST_BUILD_NETWORK_H
#define DALCS_TEST_BUILD_NETWORK_H

#include "run_tests.h"
#include "text_network.h"

/* Builds what must be free of errors. */
static inline void build_good_network(struct text_network *t, const char *text) {
    const enum dalcs_status status = text_network_build(t, text);
    for (size_t k = 0; k < t->diag.n; k++) {
        ck_assert_msg(t->diag.item[k].severity != DALCS_ERROR, "%s", t->diag.item[k].text);
    }
    ck_assert_int_eq(status, DALCS_OK);
}

/* The place of a label, -1 when there is none. */
static inline int find_label(const struct dalcs_label *label, int n, enum dalcs_label_kind kind,
                             const char *name) {
    for (int k = 0; k < n; k++) {
        if (label[k].kind == kind && strcmp(label[k].element, name) == 0) {
            return k;
        }
    }
    return -1;
}

static inline int find_column(const struct dalcs_system *s, enum dalcs_label_kind kind,
                              const char *name) {
    return find_label(s->column, dalcs_system_n_equations(s), kind, name);
}

static inline int find_row(const struct dalcs_system *s, enum dalcs_label_kind kind,
                           const char *name) {
    return find_label(s->row, dalcs_system_n_equations(s), kind, name);
}

static inline int find_pair(const struct dalcs_system *s, const char *name) {
    for (int d = 0; d < s->n_pairs; d++) {
        if (strcmp(s->pair[d].element, name) == 0) {
            return d;
        }
    }
    return -1;
}

static inline double entry_of(const struct dalcs_csr *a, int row, int column) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        if (a->j[k] == column) {
            return a->x[k];
        }
    }
    return 0.0;
}

/* Numbers in (-1, 1) that are the same on every machine. */
static inline double next_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)*state / 0x1p63;
}

#endif
