/* topology.c - shorts, independent parts, floating islands and the capacitor forest, each by one
 * union-find over the nodes. */
#include "topology.h"

#include "potentials.h"
#include "union_find.h"

#include <stdlib.h>

static int controlling_nodes(const struct dalcs_device *d) {
    return d->kind == DALCS_VCVS || d->kind == DALCS_VCCS || d->kind == DALCS_SWITCH ? 2 : 0;
}

/* Does a term read the voltage of a terminal, or what a part of the formula makes of it? */
struct self_reading {
    const struct dalcs_circuit *circuit;
    const struct dalcs_device *device;
    bool found;
};

static void note_terminal(void *to, const struct dalcs_affine_term *term) {
    struct self_reading *r = to;
    if (r->found || term->kind != DALCS_QUANTITY_VOLTAGE) {
        return;
    }
    r->found = term->index == r->device->node[0] || term->index == r->device->node[1];
    for (int i = 0; r->circuit->control.n_smooth > 0 && i < r->circuit->n_devices && !r->found;
         i++) {
        const struct dalcs_device *part = &r->circuit->device[i];
        if (part->behaviour != NULL && part->behaviour->is_part && part->node[0] == term->index) {
            dalcs_behaviour_visit(dalcs_device_written(part), note_terminal, r);
        }
    }
}

/* Does the device tie the voltages of its two terminals, in some mode or at some step? Current
 * sources do not: an island that hangs on them alone floats. One whose formula reads the voltage it
 * feeds is a resistance, and the first winding of a transformer is what its other windings are tied to. */
static bool conducts(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    struct self_reading r = {.circuit = c, .device = d};
    dalcs_behaviour_visit(d->behaviour, note_terminal, &r);
    return (d->kind != DALCS_ISOURCE && d->kind != DALCS_CCCS && d->kind != DALCS_VCCS) ||
           d->is_transformer || r.found;
}

static void merge_shorts(struct dalcs_topology *t, const struct dalcs_circuit *c,
                         const bool *wants_current, int *parent) {
    dalcs_union_reset(parent, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (dalcs_device_is_short(d)) {
            t->has_current[i] = wants_current[i];
            if (!wants_current[i]) {
                dalcs_union_join(parent, d->node[0], d->node[1]);
            }
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        t->node_of[n] = dalcs_union_find(parent, n);
    }
}

/* What a formula reads belongs to its source, also where it is known beforehand: a source that nothing else needs is a
 * bystander there, and would be a part of its own here. */
struct reader {
    struct dalcs_topology *topology;
    const struct dalcs_circuit *circuit;
    int *parent;
    int device;
};

static void join_term(void *to, const struct dalcs_affine_term *term) {
    const struct reader *r = to;
    int n_nodes = r->circuit->n_nodes;
    if (term->kind == DALCS_QUANTITY_VOLTAGE && r->topology->node_of[term->index] != 0) {
        dalcs_union_join(r->parent, r->topology->node_of[term->index], n_nodes + r->device);
    } else if (term->kind == DALCS_QUANTITY_CURRENT) {
        dalcs_union_join(r->parent, n_nodes + term->index, n_nodes + r->device);
    }
}

static void join_all(const struct dalcs_circuit *c, int *parent) {
    for (int i = 1; i < c->n_devices && c->control.is_whole; i++) {
        dalcs_union_join(parent, c->n_nodes, c->n_nodes + i);
    }
}

/* Components hang together through anything but ground. Devices are vertices too, so that one
 * between ground and ground, or one that a coupling or a current control reaches, has its place. What
 * .ic says of two nodes takes one equation for both. */
static void join_components(struct dalcs_topology *t, const struct dalcs_circuit *c,
                            int *parent /* [n_nodes + n_devices] */) {
    dalcs_union_reset(parent, c->n_nodes + c->n_devices);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        for (int k = 0; k < 2 + controlling_nodes(d); k++) {
            int n = t->node_of[d->node[k]];
            if (n != 0) {
                dalcs_union_join(parent, n, c->n_nodes + i);
            }
        }
        if (d->control >= 0) {
            dalcs_union_join(parent, c->n_nodes + i, c->n_nodes + d->control);
        }
        struct reader reader = {t, c, parent, i};
        dalcs_behaviour_visit(dalcs_device_written(d), join_term, &reader);
    }
    for (int k = 0; k < c->n_couplings; k++) {
        dalcs_union_join(parent, c->n_nodes + c->coupling[k].inductor[0],
                         c->n_nodes + c->coupling[k].inductor[1]);
    }
    for (int k = 0; k < c->n_initial_conditions; k++) {
        int a = t->node_of[c->initial_condition[k].node[0]];
        int b = t->node_of[c->initial_condition[k].node[1]];
        if (a != 0 && b != 0) {
            dalcs_union_join(parent, a, b);
        }
    }
    join_all(c, parent);
}

/* In the order of their first device. */
static void number_components(struct dalcs_topology *t, const struct dalcs_circuit *c, int *parent,
                              int *number /* both [n_nodes + n_devices] */) {
    for (int n = 0; n < c->n_nodes; n++) {
        t->node_component[n] = -1;
    }
    for (int n = 0; n < c->n_nodes + c->n_devices; n++) {
        number[n] = -1;
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        t->device_component[i] = -1;
        if (dalcs_device_is_short(d) && !t->has_current[i]) {
            continue;
        }
        int *slot = &number[dalcs_union_find(parent, c->n_nodes + i)];
        if (*slot < 0) {
            *slot = t->n_components++;
        }
        t->device_component[i] = *slot;
        for (int k = 0; k < 2 + controlling_nodes(d); k++) {
            int n = t->node_of[d->node[k]];
            if (n != 0) {
                t->node_component[n] = *slot;
            }
        }
    }
}

static void find_references(struct dalcs_topology *t, const struct dalcs_circuit *c, int *parent) {
    dalcs_union_reset(parent, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (t->device_component[i] >= 0 && conducts(c, d)) {
            dalcs_union_join(parent, t->node_of[d->node[0]], t->node_of[d->node[1]]);
        }
    }
    for (int n = 1; n < c->n_nodes; n++) {
        t->reference_of[n] = dalcs_union_find(parent, n);
        t->is_reference[n] =
            t->node_component[n] >= 0 && t->node_of[n] == n && t->reference_of[n] == n;
    }
}

static void build_forest(struct dalcs_topology *t, const struct dalcs_circuit *c,
                         const bool *wants_current, int *parent) {
    dalcs_union_reset(parent, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind != DALCS_CAPACITOR || t->device_component[i] < 0) {
            continue;
        }
        t->in_forest[i] = !wants_current[i] &&
                          dalcs_union_join(parent, t->node_of[d->node[0]], t->node_of[d->node[1]]);
        t->has_current[i] = !t->in_forest[i];
    }
    for (int n = 0; n < c->n_nodes; n++) {
        t->forest_root[n] = dalcs_union_find(parent, n);
    }
}

enum dalcs_status dalcs_topology_build(struct dalcs_topology *t,
                                       const struct dalcs_circuit *circuit,
                                       const bool *wants_current) {
    size_t n_nodes = (size_t)circuit->n_nodes;
    size_t n_devices = (size_t)circuit->n_devices;
    *t = (struct dalcs_topology){
        .node_of = dalcs_alloc(n_nodes, sizeof(int)),
        .node_component = dalcs_alloc(n_nodes, sizeof(int)),
        .device_component = dalcs_alloc(n_devices, sizeof(int)),
        .is_reference = dalcs_alloc(n_nodes, sizeof(bool)),
        .reference_of = dalcs_alloc(n_nodes, sizeof(int)),
        .in_forest = dalcs_alloc(n_devices, sizeof(bool)),
        .has_current = dalcs_alloc(n_devices, sizeof(bool)),
        .is_idle = dalcs_alloc(n_devices, sizeof(bool)),
        .potential_source = dalcs_alloc(n_nodes, sizeof(int)),
        .potential_root = dalcs_alloc(n_nodes, sizeof(int)),
        .forest_root = dalcs_alloc(n_nodes, sizeof(int)),
    };
    int *parent = dalcs_alloc(n_nodes + n_devices, sizeof(*parent));
    int *number = dalcs_alloc(n_nodes + n_devices, sizeof(*number));
    if (t->potential_source == NULL || t->potential_root == NULL || t->node_of == NULL ||
        t->node_component == NULL || t->device_component == NULL || t->is_reference == NULL ||
        t->reference_of == NULL || t->in_forest == NULL || t->has_current == NULL ||
        t->is_idle == NULL || t->forest_root == NULL || parent == NULL || number == NULL) {
        free(parent);
        free(number);
        dalcs_topology_finish(t);
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < circuit->n_devices; i++) {
        t->has_current[i] = circuit->device[i].kind == DALCS_CAPACITOR && wants_current[i];
    }
    merge_shorts(t, circuit, wants_current, parent);
    join_components(t, circuit, parent);
    number_components(t, circuit, parent, number);
    find_references(t, circuit, parent);
    build_forest(t, circuit, wants_current, parent);
    free(parent);
    free(number);
    enum dalcs_status status = dalcs_commanding_potentials_find(t, circuit);
    if (status != DALCS_OK) {
        dalcs_topology_finish(t);
    }
    return status;
}

void dalcs_topology_finish(struct dalcs_topology *t) {
    free(t->node_of);
    free(t->node_component);
    free(t->device_component);
    free(t->is_reference);
    free(t->reference_of);
    free(t->in_forest);
    free(t->has_current);
    free(t->is_idle);
    free(t->potential_source);
    free(t->potential_root);
    free(t->forest_root);
    *t = (struct dalcs_topology){0};
}
