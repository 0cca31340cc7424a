/* impulses.c - jumps of parts as impulses of elements. */
#include "impulses.h"

#include "magnitudes.h"
#include "memory.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A source with a formula says what it puts out: it may jump of its own. */
static void hold(struct dalcs_impulses *impulses) {
    const struct dalcs_circuit *c = impulses->circuit;
    dalcs_union_reset(impulses->held, c->n_nodes);
    for (bool grows = true; grows;) {
        grows = false;
        for (int k = 0; k < c->n_devices; k++) {
            const struct dalcs_device *d = &c->device[k];
            const bool reads = d->behaviour == NULL && d->kind == DALCS_VCVS;
            if (dalcs_holds_voltage(d) &&
                (!reads || dalcs_union_find(impulses->held, d->node[2]) ==
                               dalcs_union_find(impulses->held, d->node[3]))) {
                grows = dalcs_union_join(impulses->held, d->node[0], d->node[1]) || grows;
            }
        }
    }
}

static size_t most_pairs(const struct dalcs_circuit *c) {
    int most = 0;
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_behaviour *b = c->device[k].behaviour;
        most = b != NULL && b->n_pairs > most ? b->n_pairs : most;
    }
    return (size_t)most;
}

enum dalcs_status dalcs_impulses_setup(struct dalcs_impulses *impulses,
                                       const struct dalcs_circuit *circuit,
                                       const struct dalcs_network *network, double near) {
    const size_t n = (size_t)circuit->n_devices;
    const size_t n_nodes = (size_t)circuit->n_nodes;
    *impulses = (struct dalcs_impulses){.circuit = circuit, .network = network, .near = near};
    impulses->change = dalcs_alloc(4 * n, sizeof(double));
    impulses->node = dalcs_alloc(4 * n_nodes, sizeof(double));
    impulses->pair = dalcs_alloc(most_pairs(circuit), sizeof(double));
    impulses->n_open = dalcs_alloc(2 * n_nodes, sizeof(int));
    if (impulses->change == NULL || impulses->node == NULL || impulses->n_open == NULL ||
        impulses->pair == NULL) {
        return DALCS_E_NOMEM;
    }
    impulses->level = impulses->change + n;
    impulses->charge = impulses->level + n;
    impulses->across = impulses->charge + n;
    impulses->sum = impulses->node + n_nodes;
    impulses->size = impulses->sum + n_nodes;
    impulses->moved = impulses->size + n_nodes;
    impulses->held = impulses->n_open + n_nodes;
    hold(impulses);
    return dalcs_device_map_setup(&impulses->devices, circuit, network);
}

void dalcs_impulses_finish(struct dalcs_impulses *impulses) {
    dalcs_device_map_finish(&impulses->devices);
    free(impulses->change);
    free(impulses->node);
    free(impulses->n_open);
    free(impulses->pair);
    *impulses = (struct dalcs_impulses){0};
}

/* Smaller than what a one-step problem may be off by is none, as in the log of jumps. */
static void note_pairs(struct dalcs_impulses *impulses, const struct dalcs_euler_jump *j) {
    const struct dalcs_system *s = &impulses->network->system[j->system];
    double largest[2] = {0.0, 0.0};
    for (int d = 0; d < s->n_pairs; d++) {
        largest[0] = fmax(largest[0], fabs(j->charge[d]));
        largest[1] = fmax(largest[1], fabs(j->flux[d]));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        const int k = impulses->devices.of_pair[j->system][d];
        const bool is_back = s->pair[d].is_breakdown;
        if (k >= 0 && fabs(j->charge[d]) > dalcs_alike * largest[0]) {
            impulses->charge[k] += is_back ? -j->charge[d] : j->charge[d];
        }
        if (k >= 0 && !is_back && fabs(j->flux[d]) > dalcs_alike * largest[1]) {
            impulses->across[k] -= j->flux[d]; /* w is a voltage in reverse */
        }
    }
}

void dalcs_impulses_note(struct dalcs_impulses *impulses, const struct dalcs_euler_jump *j) {
    static const double no_inputs[1] = {1.0}; /* states are columns only */
    const struct dalcs_network *n = impulses->network;
    if (!impulses->is_noted || fabs(impulses->time - j->time) > impulses->near) {
        memset(impulses->change, 0, 4 * (size_t)impulses->circuit->n_devices * sizeof(double));
    }
    impulses->is_noted = true;
    impulses->is_solved = false;
    impulses->time = j->time;
    for (int i = 0; i < n->n_states; i++) {
        const struct dalcs_probe *probe = &n->state[i].probe;
        const int k = impulses->devices.of_state[i];
        if (probe->system == j->system && k >= 0) {
            const bool is_known = dalcs_probe_is_known(probe, j->n_known);
            const double before = dalcs_probe_value(probe, j->before, no_inputs);
            const double after = dalcs_probe_value(probe, j->after, no_inputs);
            impulses->change[k] += is_known ? after - before : (double)NAN;
            impulses->level[k] += is_known ? fabs(before) + fabs(after) : 0.0;
        }
    }
    note_pairs(impulses, j);
}

bool dalcs_impulses_at(struct dalcs_impulses *impulses, double time) {
    if (!impulses->is_noted || fabs(impulses->time - time) > impulses->near) {
        return false;
    }
    if (!impulses->is_solved) {
        dalcs_impulses_solve(impulses);
        impulses->is_solved = true;
    }
    return true;
}

bool dalcs_impulses_is_held(const struct dalcs_impulses *impulses, int device) {
    const int *node = impulses->circuit->device[device].node;
    return dalcs_union_find(impulses->held, node[0]) == dalcs_union_find(impulses->held, node[1]);
}

double dalcs_impulses_of(const struct dalcs_impulses *impulses, const struct dalcs_signal *signal) {
    if (signal->kind == DALCS_SIGNAL_CURRENT) {
        return impulses->charge[signal->device];
    }
    const double plus = impulses->node[signal->node[0]];
    const double minus = impulses->node[signal->node[1]];
    const bool is_rounding = fabs(plus - minus) <= dalcs_alike * fmax(fabs(plus), fabs(minus));
    return is_rounding ? 0.0 : plus - minus;
}

double dalcs_impulses_change(const struct dalcs_impulses *impulses,
                             const struct dalcs_signal *signal) {
    return signal->kind == DALCS_SIGNAL_CURRENT
               ? (double)NAN
               : impulses->moved[signal->node[0]] - impulses->moved[signal->node[1]];
}
