/* topology_check.c - warnings about the network as a whole: loose ends and loops of one element.
 *
 * None of these is an error: such circuits have solutions. They are what a slip of the pen leaves. */

#include "element_cards.h"

#include <stdlib.h>

static int n_terminals(enum dalcs_device_kind kind) {
    return kind == DALCS_VCVS || kind == DALCS_VCCS || kind == DALCS_SWITCH ? 4 : 2;
}

/* What touches a node. */
struct touch {
    int n_terminals;
    int n_controls;
    int device; /* the last one */
};

/* Counts the nodes that a formula reads as controls. */
struct reading {
    struct touch *touch;
    int device;
};

static void touch_term(void *to, const struct dalcs_affine_term *term) {
    const struct reading *r = to;
    if (term->kind == DALCS_QUANTITY_VOLTAGE) {
        r->touch[term->index].n_controls++;
        r->touch[term->index].device = r->device;
    }
}

static void check_nodes(struct dalcs_builder *builder, const struct touch *touch) {
    const struct dalcs_circuit *circuit = builder->circuit;
    for (int k = 1; k < circuit->n_nodes; k++) {
        const struct touch *t = &touch[k];
        if (t->n_terminals == 0) {
            dalcs_builder_warn(builder, builder->elements.node_token[k],
                               "it is taken for 0 V: connect what drives it, or ground",
                               "node '%s' only controls '%s': nothing sets its voltage",
                               circuit->node_name[k], circuit->device[t->device].name);
        } else if (t->n_terminals + t->n_controls == 1 &&
                   !dalcs_names_is_inner(circuit->node_name[k])) {
            dalcs_builder_warn(builder, builder->elements.node_token[k], NULL,
                               "node '%s' has one connection only, '%s'", circuit->node_name[k],
                               circuit->device[t->device].name);
        }
    }
}

void dalcs_topology_check(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    struct touch *touch = dalcs_alloc((size_t)circuit->n_nodes, sizeof *touch);
    if (touch == NULL) {
        builder->out_of_memory = true;
        return;
    }
    for (int k = 0; k < circuit->n_devices; k++) {
        const struct dalcs_device *device = &circuit->device[k];
        for (int j = 0; j < n_terminals(device->kind); j++) {
            struct touch *t = &touch[device->node[j]];
            t->device = k;
            if (j < 2) {
                t->n_terminals++;
            } else {
                t->n_controls++;
            }
        }
        struct reading reading = {touch, k};
        dalcs_behaviour_visit(dalcs_device_written(device), touch_term, &reading);
        if (device->node[0] == device->node[1]) {
            dalcs_builder_warn(builder, builder->elements.device_token[k], NULL,
                               "both ends of '%s' are on node '%s'", device->name,
                               circuit->node_name[device->node[0]]);
        }
    }
    for (size_t k = 0; k < builder->logic.n_nodes_of_gates; k++) {
        touch[k].n_controls += builder->logic.read_by_gates[k];
    }
    check_nodes(builder, touch);
    free(touch);
}
