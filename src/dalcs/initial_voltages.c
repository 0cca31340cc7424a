/* initial_voltages.c - lists of the conditions at each node. */
#include "initial_voltages.h"

#include <stdlib.h>

enum dalcs_status dalcs_initial_voltages_setup(struct dalcs_initial_voltages *v,
                                               const struct dalcs_circuit *c, const int *node_of) {
    *v = (struct dalcs_initial_voltages){0};
    if (c->n_initial_conditions == 0) {
        return DALCS_OK;
    }
    v->of_node = dalcs_alloc((size_t)c->n_nodes, sizeof(*v->of_node));
    v->first = dalcs_alloc((size_t)c->n_nodes, sizeof(*v->first));
    v->next = dalcs_alloc(2 * (size_t)c->n_initial_conditions, sizeof(*v->next));
    if (v->of_node == NULL || v->first == NULL || v->next == NULL) {
        dalcs_initial_voltages_finish(v);
        return DALCS_E_NOMEM;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        v->first[n] = -1;
    }
    for (int k = 0; k < c->n_initial_conditions; k++) {
        const struct dalcs_initial_condition *ic = &c->initial_condition[k];
        if (node_of[ic->node[1]] == 0) {
            v->of_node[node_of[ic->node[0]]] = ic->value;
        }
    }
    for (int end = 2 * c->n_initial_conditions - 1; end >= 0; end--) {
        const struct dalcs_initial_condition *ic = &c->initial_condition[end / 2];
        if (node_of[ic->node[1]] != 0) {
            int *place = &v->first[node_of[ic->node[end % 2]]];
            v->next[end] = *place;
            *place = end;
        }
    }
    return DALCS_OK;
}

double dalcs_initial_voltages_between(const struct dalcs_initial_voltages *v,
                                      const struct dalcs_circuit *c, const int *node_of, int a,
                                      int b) {
    if (v->first == NULL) {
        return 0.0;
    }
    /* Along both lists at once: the shorter one decides. */
    for (int i = v->first[a], j = v->first[b]; i >= 0 && j >= 0; i = v->next[i], j = v->next[j]) {
        for (int e = 0; e < 2; e++) {
            int end = e == 0 ? i : j;
            const struct dalcs_initial_condition *ic = &c->initial_condition[end / 2];
            if (node_of[ic->node[1 - end % 2]] == (e == 0 ? b : a)) {
                return end % 2 == e ? ic->value : -ic->value;
            }
        }
    }
    return v->of_node[a] - v->of_node[b];
}

void dalcs_initial_voltages_finish(struct dalcs_initial_voltages *v) {
    free(v->of_node);
    free(v->first);
    free(v->next);
    *v = (struct dalcs_initial_voltages){0};
}
