/* fed_part.c - the part of a circuit into which current sources force a current that cannot leave it.
 *
 * What conducts both ways makes its two nodes one. Of what is left, diodes that the witness names let
 * current pass one way. A part that no diode leaves, and that the sources fill, is the reason; or one
 * that no diode enters and the sources drain. The smallest of them is named. */
#include "refusal.h"

#include "union_find.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { MOST_TRIES = 200 };

struct search {
    const struct dalcs_refusal *r;
    int *whole;      /* [n_nodes] union-find: nodes that conduction makes one */
    double *fill;    /* [n_nodes] A into each, at its representative */
    bool *contains;  /* [n_nodes] the part being looked at, by representatives */
    bool is_forward; /* it is one that no diode leaves; else that none enters */
    int fewest;      /* nodes of the best so far */
};

static bool is_current_source(const struct dalcs_device *d) {
    return d->kind == DALCS_ISOURCE || d->kind == DALCS_CCCS || d->kind == DALCS_VCCS;
}

static bool may_separate(const struct dalcs_refusal *r, int device) {
    const struct dalcs_device *d = &r->circuit->device[device];
    bool has_sides = d->kind == DALCS_DIODE || d->kind == DALCS_SWITCH;
    return is_current_source(d) || (has_sides && r->is_named[device]) ||
           (d->kind == DALCS_CAPACITOR && r->is_static);
}

static void merge(struct search *g) {
    const struct dalcs_circuit *c = g->r->circuit;
    dalcs_union_reset(g->whole, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        if (!may_separate(g->r, i)) {
            dalcs_union_join(g->whole, c->device[i].node[0], c->device[i].node[1]);
        }
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_ISOURCE) {
            g->fill[dalcs_union_find(g->whole, d->node[0])] -= g->r->value[d->stimulus];
            g->fill[dalcs_union_find(g->whole, d->node[1])] += g->r->value[d->stimulus];
        }
    }
}

/* Adds the nodes that the current reaches through diodes, or comes from. */
static void close_part(struct search *g) {
    const struct dalcs_circuit *c = g->r->circuit;
    for (bool more = true; more;) {
        more = false;
        for (int i = 0; i < c->n_devices; i++) {
            const struct dalcs_device *d = &c->device[i];
            if (d->kind != DALCS_DIODE || !g->r->is_named[i]) {
                continue;
            }
            int from = dalcs_union_find(g->whole, d->node[g->is_forward ? 0 : 1]);
            int to = dalcs_union_find(g->whole, d->node[g->is_forward ? 1 : 0]);
            if (g->contains[from] && !g->contains[to]) {
                g->contains[to] = true;
                more = true;
            }
        }
    }
}

/* Is the part in g filled or drained without a way out? Keeps it if it is the smallest so far. */
static void judge(struct search *g, struct dalcs_fed_part *part) {
    const struct dalcs_circuit *c = g->r->circuit;
    double net = 0.0;
    double size = 0.0;
    int n = 0;
    close_part(g);
    bool is_possible = !g->contains[dalcs_union_find(g->whole, 0)];
    for (int i = 0; i < c->n_devices && is_possible; i++) {
        const struct dalcs_device *d = &c->device[i];
        bool crosses = g->contains[dalcs_union_find(g->whole, d->node[0])] !=
                       g->contains[dalcs_union_find(g->whole, d->node[1])];
        is_possible = !crosses || !is_current_source(d) || d->kind == DALCS_ISOURCE;
    }
    for (int k = 0; k < c->n_nodes; k++) {
        n += g->contains[dalcs_union_find(g->whole, k)] ? 1 : 0;
        net += g->contains[k] ? g->fill[k] : 0.0;
        size += g->contains[k] ? fabs(g->fill[k]) : 0.0;
    }
    double pressed = g->is_forward ? net : -net;
    if (!is_possible || !(pressed > 8.0 * DBL_EPSILON * size) || (part->found && n >= g->fewest)) {
        return;
    }
    g->fewest = n;
    part->found = true;
    part->is_filled = g->is_forward;
    part->net = net;
    for (int k = 0; k < c->n_nodes; k++) {
        part->contains[k] = g->contains[dalcs_union_find(g->whole, k)];
    }
}

/* From one node, or from all that are filled (drained) where that is -1. */
static void try_from(struct search *g, int node, bool is_forward, struct dalcs_fed_part *part) {
    g->is_forward = is_forward;
    for (int k = 0; k < g->r->circuit->n_nodes; k++) {
        g->contains[k] = node >= 0 ? k == dalcs_union_find(g->whole, node)
                                   : (is_forward ? g->fill[k] : -g->fill[k]) > 0.0;
    }
    judge(g, part);
}

static void try_all(struct search *g, struct dalcs_fed_part *part) {
    const struct dalcs_circuit *c = g->r->circuit;
    int tries = 0;
    for (int i = 0; i < c->n_devices && tries < MOST_TRIES; i++) {
        const struct dalcs_device *d = &c->device[i];
        for (int e = 0; e < 2 && d->kind == DALCS_ISOURCE && g->r->is_named[i]; e++) {
            try_from(g, d->node[e], true, part);
            try_from(g, d->node[e], false, part);
            tries++;
        }
    }
    if (!part->found) {
        try_from(g, -1, true, part);
        try_from(g, -1, false, part);
    }
}

static void list_borders(const struct dalcs_refusal *r, struct dalcs_fed_part *part) {
    for (int i = 0; i < r->circuit->n_devices; i++) {
        const struct dalcs_device *d = &r->circuit->device[i];
        if (part->contains[d->node[0]] == part->contains[d->node[1]]) {
            continue;
        }
        double value = d->kind == DALCS_ISOURCE ? r->value[d->stimulus] : 0.0;
        if (value != 0.0) {
            part->into[i] = part->contains[d->node[1]] ? value : -value;
            part->n_sources++;
        } else if (d->kind != DALCS_ISOURCE) {
            part->blocks[i] = true;
            part->n_blockers++;
        }
    }
}

enum dalcs_status dalcs_fed_part_find(const struct dalcs_refusal *r, struct dalcs_fed_part *part) {
    size_t n_nodes = (size_t)r->circuit->n_nodes;
    size_t n_devices = (size_t)r->circuit->n_devices;
    struct dalcs_arena *arena = &r->s->arena;
    struct search g = {.r = r,
                       .whole = dalcs_alloc(n_nodes, sizeof(*g.whole)),
                       .fill = dalcs_alloc(n_nodes, sizeof(*g.fill)),
                       .contains = dalcs_alloc(n_nodes, sizeof(*g.contains))};
    *part = (struct dalcs_fed_part){
        .contains = dalcs_arena_alloc(arena, n_nodes, sizeof(*part->contains)),
        .into = dalcs_arena_alloc(arena, n_devices, sizeof(*part->into)),
        .blocks = dalcs_arena_alloc(arena, n_devices, sizeof(*part->blocks))};
    bool complete = g.whole != NULL && g.fill != NULL && g.contains != NULL &&
                    part->contains != NULL && part->into != NULL && part->blocks != NULL;
    if (complete) {
        merge(&g);
        try_all(&g, part);
        if (part->found) {
            list_borders(r, part);
        }
    }
    free(g.whole);
    free(g.fill);
    free(g.contains);
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}
