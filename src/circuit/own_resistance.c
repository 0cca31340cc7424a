/* own_resistance.c - controlled sources that are resistors.
 *
 * A current source of g siemens by its own voltage, g > 0, obeys i = g v: it is a resistor of 1/g ohms,
 * and so is a voltage source of r ohms by the current that flows through itself, v = r i. They are made
 * resistors here, once, so that whatever is said of passive circuits holds for them: jumps, monotone
 * systems, storage functions. Negative ones give energy and stay what they are.
 *
 * "Own" is meant as the circuit has it: nodes that shorts join are one, and a current is one's own if it
 * flows through all elements between, each behind the other at nodes where nothing else ends (there
 * Kirchhoff's law has two terms). */

#include "element_cards.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>

/* One end of a device. */
struct end {
    int device, side;
};

struct wiring {
    struct dalcs_circuit *circuit;
    int *node_of;         /* [n_nodes] shorts joined */
    int *n_ends;          /* [n_nodes] terminals there, of all but shorts */
    struct end (*end)[2]; /* [n_nodes] the first two of them */
    int *chain;           /* [n_devices] those in series have the same; -1: not known yet */
    signed char *sense;   /* [n_devices] 1: its current flows along the chain, -1: against it */
    bool *is_read;        /* [n_devices] F, H or W of another card name its current */
    bool has_chains;      /* chain and sense are known */
};

static void join_shorts(struct wiring *w) {
    const struct dalcs_circuit *c = w->circuit;
    dalcs_union_reset(w->node_of, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        if (dalcs_device_is_short(&c->device[i])) {
            dalcs_union_join(w->node_of, c->device[i].node[0], c->device[i].node[1]);
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        w->node_of[n] = dalcs_union_find(w->node_of, n);
    }
}

static void list_ends(struct wiring *w) {
    const struct dalcs_circuit *c = w->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        for (int side = 0; side < 2 && !dalcs_device_is_short(&c->device[i]); side++) {
            int n = w->node_of[c->device[i].node[side]];
            if (w->n_ends[n] < 2) {
                w->end[n][w->n_ends[n]] = (struct end){i, side};
            }
            w->n_ends[n]++;
        }
        int control = c->device[i].control;
        if (control >= 0 && control != i) {
            w->is_read[control] = true;
        }
    }
}

/* Gives the chain's number to what follows on `from`, whose current leaves it at that end with `sense`. */
static void follow(struct wiring *w, struct end from, int chain, signed char sense) {
    for (;;) {
        int n = w->node_of[w->circuit->device[from.device].node[from.side]];
        if (w->n_ends[n] != 2) {
            return;
        }
        bool is_first = w->end[n][0].device == from.device && w->end[n][0].side == from.side;
        struct end next = w->end[n][is_first ? 1 : 0];
        if (w->chain[next.device] >= 0) {
            return;
        }
        sense = next.side != from.side ? sense : (signed char)-sense;
        w->chain[next.device] = chain;
        w->sense[next.device] = sense;
        from = (struct end){next.device, 1 - next.side};
    }
}

static void find_chains(struct wiring *w) {
    for (int i = 0; i < w->circuit->n_devices && !w->has_chains; i++) {
        w->chain[i] = -1;
    }
    for (int i = 0; i < w->circuit->n_devices && !w->has_chains; i++) {
        if (w->chain[i] < 0) {
            w->chain[i] = i;
            w->sense[i] = 1;
            follow(w, (struct end){i, 1}, i, 1);
            follow(w, (struct end){i, 0}, i, 1);
        }
    }
    w->has_chains = true;
}

/* i = g v of the device's own voltage: g, else 0. */
static double conductance_of(const struct wiring *w, const struct dalcs_device *d) {
    const int a = w->node_of[d->node[0]], b = w->node_of[d->node[1]];
    if (a == b) {
        return 0.0;
    }
    if (d->behaviour == NULL) {
        const int plus = w->node_of[d->node[2]], minus = w->node_of[d->node[3]];
        return plus == a && minus == b ? d->value : plus == b && minus == a ? -d->value : 0.0;
    }
    const struct dalcs_affine *output = &d->behaviour->output;
    double by[2] = {0.0, 0.0};
    for (int k = 0; k < output->n; k++) {
        const struct dalcs_affine_term *term = &output->term[k];
        const int n = term->kind == DALCS_QUANTITY_VOLTAGE ? w->node_of[term->index] : 0;
        if (term->kind != DALCS_QUANTITY_VOLTAGE || (n != 0 && n != a && n != b)) {
            return 0.0;
        }
        by[0] += n == a ? term->coefficient : 0.0;
        by[1] += n == b ? term->coefficient : 0.0;
    }
    return a == 0 ? -by[1] : b == 0 ? by[0] : by[0] == -by[1] ? by[0] : 0.0;
}

/* v = r i of the device's own current: r, else 0. */
static double resistance_of(struct wiring *w, const struct dalcs_device *d) {
    const int self = (int)(d - w->circuit->device);
    const struct dalcs_affine_term *term = d->behaviour != NULL ? d->behaviour->output.term : NULL;
    if (d->behaviour != NULL &&
        (d->behaviour->output.n != 1 || term->kind != DALCS_QUANTITY_CURRENT)) {
        return 0.0;
    }
    const int control = term != NULL ? term->index : d->control;
    const double gain = term != NULL ? term->coefficient : d->value;
    if (control == self || w->node_of[d->node[0]] == w->node_of[d->node[1]]) {
        return control == self ? gain : 0.0;
    }
    find_chains(w);
    return w->chain[control] != w->chain[self]   ? 0.0
           : w->sense[control] == w->sense[self] ? gain
                                                 : -gain;
}

static bool may_be_one(const struct dalcs_device *d) {
    const bool is_linear = d->behaviour == NULL ||
                           (d->behaviour->n_pairs == 0 && d->behaviour->output.constant == 0.0);
    return is_linear && (d->kind == DALCS_VCCS || d->kind == DALCS_CCVS ||
                         (d->kind == DALCS_VCVS && d->behaviour != NULL));
}

static void replace(struct wiring *w, struct dalcs_device *d) {
    const double resistance =
        d->kind == DALCS_VCCS ? 1.0 / conductance_of(w, d) : resistance_of(w, d);
    if (!isnormal(resistance) || resistance < 0.0 || w->is_read[d - w->circuit->device]) {
        return;
    }
    d->kind = DALCS_RESISTOR;
    d->value = resistance;
    d->behaviour = NULL;
    d->control = -1;
    d->valve = -1;
    d->node[2] = d->node[3] = 0;
}

void dalcs_own_resistance_replace(struct dalcs_builder *builder) {
    struct dalcs_circuit *c = builder->circuit;
    const size_t n_nodes = (size_t)c->n_nodes, n_devices = (size_t)c->n_devices;
    bool any = false;
    for (int i = 0; i < c->n_devices; i++) {
        any = any || may_be_one(&c->device[i]);
    }
    if (!any) {
        return;
    }
    struct wiring w = {
        .circuit = c,
        .node_of = dalcs_alloc(n_nodes, sizeof *w.node_of),
        .n_ends = dalcs_alloc(n_nodes, sizeof *w.n_ends),
        .end = dalcs_alloc(n_nodes, sizeof *w.end),
        .chain = dalcs_alloc(n_devices, sizeof *w.chain),
        .sense = dalcs_alloc(n_devices, sizeof *w.sense),
        .is_read = dalcs_alloc(n_devices, sizeof *w.is_read),
    };
    const bool complete = w.node_of != NULL && w.n_ends != NULL && w.end != NULL &&
                          w.chain != NULL && w.sense != NULL && w.is_read != NULL;
    builder->out_of_memory = builder->out_of_memory || !complete;
    if (complete) {
        join_shorts(&w);
        list_ends(&w);
    }
    for (int i = 0; i < c->n_devices && complete; i++) {
        if (may_be_one(&c->device[i])) {
            replace(&w, &c->device[i]);
        }
    }
    free(w.node_of);
    free(w.n_ends);
    free(w.end);
    free(w.chain);
    free(w.sense);
    free(w.is_read);
}
