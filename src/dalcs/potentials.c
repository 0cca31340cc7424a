/* potentials.c - voltages that sources alone fix. */
#include "potentials.h"

#include <stdlib.h>

/* Between which nodes sources alone fix the voltage, for switches that such a voltage commands: trees of sources, breadth
 * first from ground and then from each floating node at a source, along lists of the ends of sources at each node. End e
 * of device i has the number 2 i + e. An E source with a number for its gain is one more from when one tree holds the two
 * nodes that control it. One that would join two trees leaves them apart: what it fixes between them is not used. */
struct potentials {
    struct dalcs_topology *t;
    const struct dalcs_circuit *c;
    int *first, *next; /* [n_nodes] an end, [2 n_devices] the next end at its node; -1 */
    int *first_control, *next_control; /* likewise of the nodes that control an E source */
    int *n_terms;                      /* [n_nodes] sources that the voltage is a sum of, at most */
    int *queue; /* [n_nodes] nodes of trees, in the order in which they were found */
    int n_queued, n_done;
    int *
        waiting; /* [n_devices] nodes at an E source that has become one between nodes of no tree */
    int n_waiting;
};

/* A sum of more than this is not made: E sources that control each other can double it from one to the next. */
enum { MOST_TERMS = 64 };

/* Of an end. */
enum { NONE = -1, NOT_LISTED = -2 };

static bool is_fixed(const struct potentials *p, int n) {
    return p->t->potential_root[n] >= 0;
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
        p->t->potential_root[other] = p->t->potential_root[from];
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

/* A node is in a tree: the E sources that it controls, with another one of the tree or alone, are sources from now on. */
static void control(struct potentials *p, int n) {
    for (int of = p->first_control[n]; of != NONE; of = p->next_control[of]) {
        const int device = of / 2;
        const int with = node_at(p, device, 3 - of % 2);
        if (p->t->potential_root[with] != p->t->potential_root[n] ||
            p->next[2 * device] != NOT_LISTED) {
            continue;
        }
        for (int end = 2 * device; end < 2 * device + 2; end++) {
            add_end(p->first, p->next, node_at(p, device, end % 2), end);
            go_along(p, end);
        }
        if (!is_fixed(p, node_at(p, device, 0))) {
            p->waiting[p->n_waiting++] = node_at(p, device, 0);
        }
    }
}

/* The tree of ground, or of a node that is in none and at a source. */
static void grow_from(struct potentials *p, int root) {
    if (is_fixed(p, root) || (p->first[root] == NONE && root != 0)) {
        return;
    }
    p->t->potential_root[root] = root;
    p->queue[p->n_queued++] = root;
    while (p->n_done < p->n_queued) {
        const int n = p->queue[p->n_done++];
        for (int end = p->first[n]; end != NONE; end = p->next[end]) {
            go_along(p, end);
        }
        control(p, n);
    }
}

static void grow_all(struct potentials *p) {
    for (int n = 0; n < p->c->n_nodes; n++) {
        grow_from(p, n);
        while (p->n_waiting > 0) {
            grow_from(p, p->waiting[--p->n_waiting]);
        }
    }
}

static enum dalcs_status find_potentials(struct potentials *p) {
    const size_t n_nodes = (size_t)p->c->n_nodes;
    const size_t n_ends = 2 * (size_t)p->c->n_devices;
    int *work = dalcs_alloc(4 * n_nodes + 3 * n_ends, sizeof(*work));
    if (work == NULL) {
        return DALCS_E_NOMEM;
    }
    p->n_terms = work;
    p->queue = work + n_nodes;
    p->first = work + 2 * n_nodes;
    p->first_control = work + 3 * n_nodes;
    p->next = work + 4 * n_nodes;
    p->next_control = p->next + n_ends;
    p->waiting = p->next_control + n_ends;
    for (size_t n = 0; n < 2 * n_nodes; n++) {
        p->first[n] = NONE;
    }
    list_ends(p);
    grow_all(p);
    free(work);
    return DALCS_OK;
}

enum dalcs_status dalcs_commanding_potentials_find(struct dalcs_topology *t,
                                                   const struct dalcs_circuit *c) {
    bool has_switch = false;
    for (int i = 0; i < c->n_devices; i++) {
        has_switch = has_switch || c->device[i].kind == DALCS_SWITCH;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        t->potential_source[n] = -1;
        t->potential_root[n] = -1;
    }
    struct potentials p = {.t = t, .c = c};
    return has_switch ? find_potentials(&p) : DALCS_OK;
}
