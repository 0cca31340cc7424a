/* system.c - the life of a DALCS, and what its sums are beyond their digits. */
#include "system.h"

#include <stdlib.h>

const char *dalcs_label_equation(enum dalcs_label_kind kind) {
    static const char *const what[] = {[DALCS_LABEL_STATE] = "branch",
                                       [DALCS_LABEL_NODE] = "KCL at",
                                       [DALCS_LABEL_BRANCH] = "branch",
                                       [DALCS_LABEL_REFERENCE] = "reference"};
    return what[kind];
}

/* Leaves the entries of a that b has, too. */
static void keep_entries_of(struct dalcs_csr *a, const struct dalcs_csr *b) {
    int out = 0;
    for (int r = 0, k = 0; r < a->n_rows; r++) {
        int at = b->p[r];
        for (; k < a->p[r + 1]; k++) {
            while (at < b->p[r + 1] && b->j[at] < a->j[k]) {
                at++;
            }
            if (at < b->p[r + 1] && b->j[at] == a->j[k]) {
                a->j[out] = a->j[k];
                a->x[out++] = a->x[k];
            }
        }
        a->p[r + 1] = out;
    }
}

enum dalcs_status dalcs_system_find_rest(struct dalcs_system *system, struct dalcs_triplets *sums) {
    struct dalcs_csr *rest = &system->A_rest;
    const struct dalcs_csr *rounded = &system->A;
    for (int r = 0; r < rounded->n_rows; r++) {
        for (int k = rounded->p[r]; k < rounded->p[r + 1]; k++) {
            DALCS_TRY(dalcs_triplets_add(sums, r, rounded->j[k], -rounded->x[k]));
        }
    }
    DALCS_TRY(dalcs_csr_compress(rest, rounded->n_rows, rounded->n_columns, sums));
    keep_entries_of(rest, rounded); /* what is nothing but rounding has no rest */
    return DALCS_OK;
}

void dalcs_system_finish(struct dalcs_system *system) {
    dalcs_csr_finish(&system->P);
    dalcs_csr_finish(&system->A);
    dalcs_csr_finish(&system->A_rest);
    dalcs_csr_finish(&system->E);
    dalcs_csr_finish(&system->C);
    dalcs_csr_finish(&system->F);
    dalcs_csr_finish(&system->storage);
    dalcs_csr_finish(&system->control);
    dalcs_csr_finish(&system->direct_control);
    free(system->smooth);
    free(system->is_part);
    dalcs_csr_finish(&system->reads);
    free(system->dual);
    free(system->forest_root);
    free(system->column_is_current);
    free(system->row_is_current);
    free(system->row);
    free(system->column);
    free(system->pair);
    free(system->stimulus);
    free(system->input_element);
    free(system->reader);
    *system = (struct dalcs_system){0};
}
