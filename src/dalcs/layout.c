/* layout.c - room for where everything of a circuit goes, and lists of what goes into each component. */
#include "layout.h"

#include <stdlib.h>

void dalcs_layout_finish(struct dalcs_layout *l) {
    dalcs_topology_finish(&l->topology);
    dalcs_initial_voltages_finish(&l->initial_voltages);
    free(l->held_start);
    free(l->held);
    for (int g = 0; g < l->n_groups; g++) {
        free(l->group[g].L);
        dalcs_inductance_finish(&l->group[g].split);
    }
    free(l->group);
    free(l->group_of);
    free(l->grouped_coil);
    free(l->node_column);
    free(l->kcl_row);
    free(l->state_column);
    free(l->current_column);
    free(l->branch_row);
    free(l->pair);
    free(l->input);
    *l = (struct dalcs_layout){0};
}

enum dalcs_status dalcs_layout_setup(struct dalcs_layout *l) {
    size_t n_nodes = (size_t)l->circuit->n_nodes;
    size_t n_devices = (size_t)l->circuit->n_devices;
    int **per_node[] = {&l->node_column, &l->kcl_row};
    int **per_device[] = {&l->state_column, &l->current_column, &l->branch_row,
                          &l->pair,         &l->input,          &l->group_of};
    for (size_t k = 0; k < sizeof(per_node) / sizeof(per_node[0]); k++) {
        *per_node[k] = dalcs_alloc(n_nodes, sizeof(int));
        if (*per_node[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        for (size_t i = 0; i < n_nodes; i++) {
            (*per_node[k])[i] = -1;
        }
    }
    for (size_t k = 0; k < sizeof(per_device) / sizeof(per_device[0]); k++) {
        *per_device[k] = dalcs_alloc(n_devices, sizeof(int));
        if (*per_device[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        for (size_t i = 0; i < n_devices; i++) {
            (*per_device[k])[i] = -1;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_list_members(int n_items, const int *part, int n_parts, int **start,
                                     int **item) {
    *start = dalcs_alloc((size_t)n_parts + 2, sizeof(**start));
    *item = dalcs_alloc((size_t)n_items, sizeof(**item));
    if (*start == NULL || *item == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n_items; i++) {
        if (part[i] >= 0) {
            (*start)[part[i] + 2]++;
        }
    }
    for (int k = 0; k < n_parts; k++) {
        (*start)[k + 2] += (*start)[k + 1];
    }
    for (int i = 0; i < n_items; i++) {
        if (part[i] >= 0) {
            (*item)[(*start)[part[i] + 1]++] = i;
        }
    }
    return DALCS_OK;
}

/* The component that holds a .ic voltage; -1 when there is nothing to hold, because a short joins
 * its nodes or no equation has one of them. */
static int holding_component(const struct dalcs_layout *l,
                             const struct dalcs_initial_condition *ic) {
    const struct dalcs_topology *t = &l->topology;
    const int node[2] = {t->node_of[ic->node[0]], t->node_of[ic->node[1]]};
    int component = -1;
    for (int e = 0; e < 2; e++) {
        if (node[e] != 0 && t->node_component[node[e]] < 0) {
            return -1;
        }
        component = node[e] != 0 ? t->node_component[node[e]] : component;
    }
    return node[0] == node[1] ? -1 : component;
}

enum dalcs_status dalcs_layout_list_held(struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    if (!l->options->clamp_initial_conditions) {
        return DALCS_OK;
    }
    int *component = dalcs_alloc((size_t)c->n_initial_conditions, sizeof(*component));
    if (component == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->n_initial_conditions; k++) {
        component[k] = holding_component(l, &c->initial_condition[k]);
    }
    enum dalcs_status status = dalcs_list_members(
        c->n_initial_conditions, component, l->topology.n_components, &l->held_start, &l->held);
    free(component);
    return status;
}
