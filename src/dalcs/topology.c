/* topology.c - shorts, independent parts, floating islands and the capacitor forest, each by one
 * union-find over the nodes. */
#include "topology.h"

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
    for (int i = 0; r->circuit->n_smooth > 0 && i < r->circuit->n_devices && !r->found; i++) {
        const struct dalcs_device *part = &r->circuit->device[i];
        if (part->behaviour != NULL && part->behaviour->is_part && part->node[0] == term->index) {
            dalcs_behaviour_visit(part->behaviour, note_terminal, r);
        }
    }
}

/* Does the device tie the voltages of its two terminals, in some mode or at some step? Current
 * sources do not: an island that hangs on them alone floats. One whose formula reads the voltage it
 * feeds is a resistance. */
static bool conducts(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    struct self_reading r = {.circuit = c, .device = d};
    dalcs_behaviour_visit(d->behaviour, note_terminal, &r);
    return (d->kind != DALCS_ISOURCE && d->kind != DALCS_CCCS && d->kind != DALCS_VCCS) || r.found;
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
    for (int i = 1; i < c->n_devices && c->is_whole; i++) {
        dalcs_union_join(parent, c->n_nodes, c->n_nodes + i);
    }
}

/* Components hang together through anything but ground. Devices are vertices too, so that one
 * between ground and ground, or one that a coupling or a current control reaches, has its place. What
 * .ic says of two nodes takes one equation for both. */
static void find_components(struct dalcs_topology *t, const struct dalcs_circuit *c, int *parent,
                            int *number /* both [n_nodes + n_devices] */) {
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
    for (int n = 0; n < c->n_nodes; n++) {
        t->node_component[n] = -1;
    }
    /* Number them in the order of their first device. */
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

/* Which nodes have a voltage that sources alone fix, for switches that such a voltage commands: breadth first from
 * ground, along lists of the ends of sources at each node. End e of device i has the number 2 i + e. An E source with
 * a number for its gain is one more from when the two nodes that control it are such nodes. */
struct potentials {
    struct dalcs_topology *t;
    const struct dalcs_circuit *c;
    int *first, *next; /* [n_nodes] an end, [2 n_devices] the next end at its node; -1 */
    int *first_control, *next_control; /* likewise of the nodes that control an E source */
    int *n_terms;                      /* [n_nodes] sources that the voltage is a sum of, at most */
    int *queue;                        /* [n_nodes] those with a source, and ground */
    int n_queued;
};

/* A sum of more than this is not made: E sources that control each other can double it from one to the next. */
enum { MOST_TERMS = 64 };

/* Of an end. */
enum { NONE = -1, NOT_LISTED = -2 };

static bool is_fixed(const struct potentials *p, int n) {
    return n == 0 || p->t->potential_source[n] >= 0;
}

static int node_at(const struct potentials *p, int device, int end) {
    return p->t->node_of[p->c->device[device].node[end]];
}

static bool has_gain(const struct dalcs_device *d) {
    return d->kind == DALCS_VCVS && d->behaviour == NULL;
}

static int terms_of(const struct potentials *p, int device) {
    return has_gain(&p->c->device[device])
               ? p->n_terms[node_at(p, device, 2)] + p->n_terms[node_at(p, device, 3)]
               : 1;
}

/* From one end of a source to the other. */
static void go_along(struct potentials *p, int end) {
    const int from = node_at(p, end / 2, end % 2);
    const int other = node_at(p, end / 2, 1 - end % 2);
    const int n_terms = p->n_terms[from] + terms_of(p, end / 2);
    const bool is_short = !has_gain(&p->c->device[end / 2]) || n_terms <= MOST_TERMS;
    if (is_fixed(p, from) && !is_fixed(p, other) && is_short) {
        p->t->potential_source[other] = end / 2;
        p->n_terms[other] = n_terms;
        p->queue[p->n_queued++] = other;
    }
}

static void add_end(int *first, int *next, int node, int end) {
    next[end] = first[node];
    first[node] = end;
}

static void list_ends(struct potentials *p) {
    for (int end = 2 * p->c->n_devices - 1; end >= 0; end--) {
        const struct dalcs_device *d = &p->c->device[end / 2];
        if (dalcs_device_is_decided(d)) {
            add_end(p->first, p->next, node_at(p, end / 2, end % 2), end);
        } else if (has_gain(d)) {
            add_end(p->first_control, p->next_control, node_at(p, end / 2, 2 + end % 2), end);
            p->next[end] = NOT_LISTED;
        }
    }
}

/* A node is fixed: the E sources that it controls, with another one or alone, are sources from now on. */
static void control(struct potentials *p, int n) {
    for (int of = p->first_control[n]; of != NONE; of = p->next_control[of]) {
        const int device = of / 2;
        const int with = node_at(p, device, 3 - of % 2);
        if (!is_fixed(p, with) || p->next[2 * device] != NOT_LISTED) {
            continue;
        }
        for (int end = 2 * device; end < 2 * device + 2; end++) {
            add_end(p->first, p->next, node_at(p, device, end % 2), end);
            go_along(p, end);
        }
    }
}

static enum dalcs_status find_potentials(struct potentials *p) {
    const size_t n_nodes = (size_t)p->c->n_nodes;
    const size_t n_ends = 2 * (size_t)p->c->n_devices;
    int *work = dalcs_alloc(4 * n_nodes + 2 * n_ends, sizeof(*work));
    if (work == NULL) {
        return DALCS_E_NOMEM;
    }
    p->n_terms = work;
    p->queue = work + n_nodes;
    p->first = work + 2 * n_nodes;
    p->first_control = work + 3 * n_nodes;
    p->next = work + 4 * n_nodes;
    p->next_control = p->next + n_ends;
    for (size_t n = 0; n < 2 * n_nodes; n++) {
        p->first[n] = NONE;
    }
    list_ends(p);
    p->queue[p->n_queued++] = 0;
    for (int q = 0; q < p->n_queued; q++) {
        for (int end = p->first[p->queue[q]]; end != NONE; end = p->next[end]) {
            go_along(p, end);
        }
        control(p, p->queue[q]);
    }
    free(work);
    return DALCS_OK;
}

static enum dalcs_status find_commanding_potentials(struct dalcs_topology *t,
                                                    const struct dalcs_circuit *c) {
    bool has_switch = false;
    for (int i = 0; i < c->n_devices; i++) {
        has_switch = has_switch || c->device[i].kind == DALCS_SWITCH;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        t->potential_source[n] = -1;
    }
    struct potentials p = {.t = t, .c = c};
    return has_switch ? find_potentials(&p) : DALCS_OK;
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
        .forest_root = dalcs_alloc(n_nodes, sizeof(int)),
    };
    int *parent = dalcs_alloc(n_nodes + n_devices, sizeof(*parent));
    int *number = dalcs_alloc(n_nodes + n_devices, sizeof(*number));
    if (t->potential_source == NULL || t->node_of == NULL || t->node_component == NULL ||
        t->device_component == NULL || t->is_reference == NULL || t->reference_of == NULL ||
        t->in_forest == NULL || t->has_current == NULL || t->is_idle == NULL ||
        t->forest_root == NULL || parent == NULL || number == NULL) {
        free(parent);
        free(number);
        dalcs_topology_finish(t);
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < circuit->n_devices; i++) {
        t->has_current[i] = circuit->device[i].kind == DALCS_CAPACITOR && wants_current[i];
    }
    merge_shorts(t, circuit, wants_current, parent);
    find_components(t, circuit, parent, number);
    find_references(t, circuit, parent);
    build_forest(t, circuit, wants_current, parent);
    free(parent);
    free(number);
    enum dalcs_status status = find_commanding_potentials(t, circuit);
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
    free(t->forest_root);
    *t = (struct dalcs_topology){0};
}
