/* held_coils.c - currents of coils around loops in which .ic holds a voltage.
 *
 * While an operating point is computed what holds a voltage is a source, a coil is a short, and around a
 * loop of the two any current may go. It is the source's, as in ngspice: the coil starts with the least
 * that Kirchhoff's law lets it have, which is 0 across a held node alone. With nodes that sources, held
 * voltages and shorts tie together made one, currents that are potential differences have the least
 * squares of all with the same sums at the nodes. */
#include "session_internal.h"

#include "union_find.h"

#include <math.h>

/* What is less than this part of the largest current is no current around a loop. */
static const double no_loop = 1e-9;

/* Residuals fall to this part of the first. */
static const double solved = 1e-14;

struct coil {
    int end[2];    /* nodes of the graph */
    double *y, *u; /* the state; u is to be the same */
    double current;
};

struct graph {
    int n_nodes, n;
    int *parent; /* [n_nodes] */
    struct coil *coil;
    double *potential, *rest, *way, *image; /* [n_nodes] */
};

static void tie_nodes(struct graph *g, const struct dalcs_circuit *c) {
    dalcs_union_reset(g->parent, g->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_VSOURCE || (d->kind == DALCS_RESISTOR && d->value == 0.0)) {
            dalcs_union_join(g->parent, d->node[0], d->node[1]);
        }
    }
    for (int k = 0; k < c->n_initial_conditions; k++) {
        const int *node = c->initial_condition[k].node;
        dalcs_union_join(g->parent, node[0], node[1]);
    }
}

/* Coils whose current is a state. With perfect coupling the currents of some follow from others. */
static void list_coils(struct graph *g, const struct dalcs_circuit *c, struct dalcs_euler *held) {
    const struct dalcs_state *state = held->network->state;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        state += d->kind == DALCS_CAPACITOR ? 1 : 0;
        if (d->kind != DALCS_INDUCTOR) {
            continue;
        }
        const struct dalcs_probe *probe = &state++->probe;
        if (probe->system < 0 || probe->n_terms != 1 || probe->n_inputs != 0) {
            continue;
        }
        const struct dalcs_component *component = &held->component[probe->system];
        int column = probe->term[0].index;
        if (column < component->system->n_x && probe->term[0].coefficient == 1.0) {
            g->coil[g->n++] = (struct coil){
                {dalcs_union_find(g->parent, d->node[0]), dalcs_union_find(g->parent, d->node[1])},
                &component->y[column],
                &component->u[column],
                component->y[column]};
        }
    }
}

/* image = what flows out of each node when coils carry the differences of v. */
static void apply(const struct graph *g, const double *v, double *image) {
    for (int i = 0; i < g->n_nodes; i++) {
        image[i] = 0.0;
    }
    for (int k = 0; k < g->n; k++) {
        const int *end = g->coil[k].end;
        double current = v[end[0]] - v[end[1]];
        image[end[0]] += current;
        image[end[1]] -= current;
    }
}

static double dot(const struct graph *g, const double *a, const double *b) {
    double sum = 0.0;
    for (int i = 0; i < g->n_nodes; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Potentials with the sums at the nodes that the currents have: by conjugate gradients. */
static void find_potentials(const struct graph *g) {
    for (int k = 0; k < g->n; k++) {
        g->rest[g->coil[k].end[0]] += g->coil[k].current;
        g->rest[g->coil[k].end[1]] -= g->coil[k].current;
    }
    for (int i = 0; i < g->n_nodes; i++) {
        g->way[i] = g->rest[i];
    }
    double square = dot(g, g->rest, g->rest);
    const double goal = solved * solved * square;
    for (int round = 0; round < g->n_nodes && square > goal; round++) {
        apply(g, g->way, g->image);
        double length = square / dot(g, g->way, g->image);
        if (!isfinite(length)) {
            return;
        }
        for (int i = 0; i < g->n_nodes; i++) {
            g->potential[i] += length * g->way[i];
            g->rest[i] -= length * g->image[i];
        }
        double before = square;
        square = dot(g, g->rest, g->rest);
        for (int i = 0; i < g->n_nodes; i++) {
            g->way[i] = g->rest[i] + square / before * g->way[i];
        }
    }
}

static void take_currents(const struct graph *g) {
    double largest = 0.0;
    for (int k = 0; k < g->n; k++) {
        largest = fmax(largest, fabs(g->coil[k].current));
    }
    for (int k = 0; k < g->n; k++) {
        const struct coil *coil = &g->coil[k];
        double current = g->potential[coil->end[0]] - g->potential[coil->end[1]];
        if (fabs(coil->current - current) > no_loop * largest) {
            *coil->y = *coil->u = fabs(current) > no_loop * largest ? current : 0.0;
        }
    }
}

enum dalcs_status dalcs_held_coils_rest(const struct dalcs_circuit *circuit,
                                        struct dalcs_euler *held) {
    struct dalcs_arena work = {0};
    struct graph g = {.n_nodes = circuit->n_nodes};
    size_t n = (size_t)circuit->n_nodes;
    g.parent = dalcs_arena_alloc(&work, n, sizeof(int));
    g.coil = dalcs_arena_alloc(&work, (size_t)circuit->n_devices, sizeof(*g.coil));
    g.potential = dalcs_arena_alloc(&work, 4 * n, sizeof(double));
    enum dalcs_status status =
        g.parent != NULL && g.coil != NULL && g.potential != NULL ? DALCS_OK : DALCS_E_NOMEM;
    if (status == DALCS_OK) {
        g.rest = g.potential + n;
        g.way = g.rest + n;
        g.image = g.way + n;
        tie_nodes(&g, circuit);
        list_coils(&g, circuit, held);
        if (g.n > 0) {
            find_potentials(&g);
            take_currents(&g);
        }
    }
    dalcs_arena_finish(&work);
    return status;
}
