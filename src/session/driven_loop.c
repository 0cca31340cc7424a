/* driven_loop.c - the loop around which sources drive a current that nothing limits.
 *
 * The elements that a witness names carry current without resistance: sources add their voltage in
 * one direction and take it in the other, diodes conduct in one, at their threshold. The loop is a
 * cycle of positive gain, found by the paths of Bellman and Ford. */
#include "refusal.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* More arcs than this are named without an order: the search is quadratic. */
enum { MOST_ARCS = 4000 };

struct search {
    struct dalcs_loop_arc *arc;
    int n;
    double *gain; /* [n_nodes] of the best way to a node */
    int *by;      /* [n_nodes] the last arc of that way, -1 */
};

static void add_arc(struct search *g, int device, int from, int to, double gain) {
    if (g->n < MOST_ARCS) {
        g->arc[g->n++] = (struct dalcs_loop_arc){device, from, to, gain};
    }
}

static void add_diode(struct search *g, const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    const struct dalcs_diode_model *m = &c->models.of_diode[d->model];
    if (m->ron == 0.0) {
        add_arc(g, device, d->node[0], d->node[1], -m->vfwd);
    }
    if (isfinite(m->vrev) && m->rrev == 0.0) {
        add_arc(g, device, d->node[1], d->node[0], -m->vrev);
    }
}

/* A source's current leaves at its first terminal, the plus, when it drives. */
static void list_arcs(const struct dalcs_refusal *r, struct search *g) {
    const struct dalcs_circuit *c = r->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (!r->is_named[i] || (d->kind == DALCS_INDUCTOR && !r->is_static)) {
            continue; /* but for a short, a coil is part of a loop only with those it is coupled to */
        }
        if (d->kind == DALCS_DIODE) {
            add_diode(g, c, i);
            continue;
        }
        double v = d->kind == DALCS_VSOURCE ? r->value[d->stimulus] : 0.0;
        add_arc(g, i, d->node[1], d->node[0], v);
        add_arc(g, i, d->node[0], d->node[1], -v);
    }
    for (size_t k = 0; k < r->n_elements; k++) {
        if (r->element[k][0] != '.') {
            continue;
        }
        for (int i = 0; i < c->n_initial_conditions; i++) {
            const struct dalcs_initial_condition *ic = &c->initial_condition[i];
            add_arc(g, ~i, ic->node[1], ic->node[0], ic->value);
            add_arc(g, ~i, ic->node[0], ic->node[1], -ic->value);
        }
        break;
    }
}

/* One round over all arcs. Returns an arc that improved a way, -1 when none did. */
static int improve(struct search *g, double tolerance) {
    int improved = -1;
    for (int k = 0; k < g->n; k++) {
        const struct dalcs_loop_arc *a = &g->arc[k];
        double gain = g->gain[a->from] + a->gain;
        if (a->from != a->to && gain > g->gain[a->to] + tolerance) {
            g->gain[a->to] = gain;
            g->by[a->to] = k;
            improved = k;
        }
    }
    return improved;
}

/* The cycle that the best ways run into behind this node, from its strongest arc on. */
static int follow_back(const struct search *g, int node, struct dalcs_loop_arc *arc) {
    for (int k = 0; k < g->n + 2; k++) {
        if (g->by[node] < 0) {
            return 0;
        }
        node = g->arc[g->by[node]].from;
    }
    int n = 0;
    int strongest = 0;
    int end = node;
    do {
        n++;
        node = g->arc[g->by[node]].from;
    } while (node != end);
    for (int k = n - 1; k >= 0; k--) {
        arc[k] = g->arc[g->by[node]];
        node = arc[k].from;
    }
    for (int k = 1; k < n; k++) {
        strongest = arc[k].gain > arc[strongest].gain ? k : strongest;
    }
    for (int k = 0; k < strongest; k++) {
        struct dalcs_loop_arc first = arc[0];
        for (int i = 1; i < n; i++) {
            arc[i - 1] = arc[i];
        }
        arc[n - 1] = first;
    }
    return n;
}

static int find_cycle(struct search *g, struct dalcs_loop_arc *arc) {
    double size = 0.0;
    for (int k = 0; k < g->n; k++) {
        const struct dalcs_loop_arc *a = &g->arc[k];
        size += fabs(a->gain);
        if (a->from == a->to && a->gain > 0.0) {
            arc[0] = *a;
            return 1;
        }
    }
    int improved = 0;
    for (int round = 0; round < g->n + 2 && improved >= 0; round++) {
        improved = improve(g, 2.0 * DBL_EPSILON * size);
    }
    return improved < 0 ? 0 : follow_back(g, g->arc[improved].to, arc);
}

enum dalcs_status dalcs_driven_loop_find(const struct dalcs_refusal *r, struct dalcs_loop_arc *arc,
                                         int *n_arcs) {
    size_t n_nodes = (size_t)r->circuit->n_nodes;
    struct search g = {.arc = dalcs_alloc(MOST_ARCS, sizeof(*g.arc)),
                       .gain = dalcs_alloc(n_nodes, sizeof(*g.gain)),
                       .by = dalcs_alloc(n_nodes, sizeof(*g.by))};
    bool complete = g.arc != NULL && g.gain != NULL && g.by != NULL;
    *n_arcs = 0;
    if (complete) {
        for (size_t i = 0; i < n_nodes; i++) {
            g.by[i] = -1;
        }
        list_arcs(r, &g);
        *n_arcs = g.n < MOST_ARCS ? find_cycle(&g, arc) : 0;
    }
    free(g.arc);
    free(g.gain);
    free(g.by);
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}
