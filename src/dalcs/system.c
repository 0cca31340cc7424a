/* system.c - the life of a DALCS. */
#include "system.h"

#include <stdlib.h>

const char *dalcs_label_equation(enum dalcs_label_kind kind) {
    static const char *const what[] = {[DALCS_LABEL_STATE] = "branch",
                                       [DALCS_LABEL_NODE] = "KCL at",
                                       [DALCS_LABEL_BRANCH] = "branch",
                                       [DALCS_LABEL_REFERENCE] = "reference"};
    return what[kind];
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
