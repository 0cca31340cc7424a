/* measured.c - the signals that .meas and .four name, among those that are shown or behind them. */

#include "result_cards.h"

#include <stdlib.h>

/* Where signals are shown. */
struct shown {
    int *
        place; /* [n_nodes + n_devices] of each node's voltage, of each device's current; -1: nowhere */

    struct difference {
        int node[2], place;
    } * difference; /* [n] voltages between two nodes, in the order of these */

    size_t n;
};

static int compare_differences(const void *left, const void *right) {
    const struct difference *a = left;
    const struct difference *b = right;
    int first = a->node[0] != b->node[0] ? a->node[0] - b->node[0] : a->node[1] - b->node[1];
    return first != 0 ? first : a->place - b->place;
}

/* In scratch; false: out of memory. */
static bool list_shown(struct dalcs_builder *builder, struct shown *shown) {
    const struct dalcs_circuit *circuit = builder->circuit;
    const int n = circuit->n_nodes + circuit->n_devices;
    shown->place = dalcs_arena_alloc(&builder->scratch, (size_t)n, sizeof *shown->place);
    shown->difference = dalcs_arena_alloc(&builder->scratch, (size_t)circuit->results.n_shown,
                                          sizeof *shown->difference);
    if (shown->place == NULL || shown->difference == NULL) {
        return false;
    }
    for (int k = 0; k < n; k++) {
        shown->place[k] = -1;
    }
    for (int k = circuit->results.n_shown - 1; k >= 0; k--) {
        const struct dalcs_signal *s = &circuit->results.signal[k];
        if (s->kind == DALCS_SIGNAL_CURRENT) {
            shown->place[circuit->n_nodes + s->device] = k;
        } else if (s->node[1] == 0) {
            shown->place[s->node[0]] = k;
        }
    }
    shown->n = 0;
    for (int k = 0; k < circuit->results.n_shown; k++) {
        const struct dalcs_signal *s = &circuit->results.signal[k];
        if (s->kind != DALCS_SIGNAL_CURRENT && s->node[1] != 0) {
            shown->difference[shown->n++] = (struct difference){{s->node[0], s->node[1]}, k};
        }
    }
    qsort(shown->difference, shown->n, sizeof *shown->difference, compare_differences);
    return true;
}

/* The first place where a signal is shown, -1 when it is not. */
static int place_of(const struct dalcs_circuit *circuit, const struct shown *shown,
                    const struct dalcs_signal *signal) {
    if (signal->kind == DALCS_SIGNAL_CURRENT) {
        return shown->place[circuit->n_nodes + signal->device];
    }
    if (signal->node[1] == 0) {
        return shown->place[signal->node[0]];
    }
    size_t low = 0;
    size_t high = shown->n;
    const struct difference wanted = {{signal->node[0], signal->node[1]}, 0};
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        bool is_before = compare_differences(&shown->difference[middle], &wanted) < 0;
        *(is_before ? &low : &high) = is_before ? middle + 1 : middle;
    }
    const struct difference *found = low < shown->n ? &shown->difference[low] : NULL;
    bool is_same =
        found != NULL && found->node[0] == wanted.node[0] && found->node[1] == wanted.node[1];
    return is_same ? found->place : -1;
}

enum dalcs_status dalcs_measured_collect(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_arena *arena = &circuit->arena;
    const size_t n = builder->signals.n_measured;
    circuit->results.n_measured = (int)n;
    circuit->results.measured = dalcs_arena_alloc(arena, n, sizeof *circuit->results.measured);
    circuit->results.measure =
        dalcs_arena_alloc(arena, builder->results.n_measures, sizeof *circuit->results.measure);
    circuit->results.fourier =
        dalcs_arena_alloc(arena, builder->results.n_fouriers, sizeof *circuit->results.fourier);
    if (circuit->results.measured == NULL || circuit->results.measure == NULL ||
        circuit->results.fourier == NULL) {
        return DALCS_E_NOMEM;
    }
    struct shown shown;
    if (n > 0 && !list_shown(builder, &shown)) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        int place = place_of(circuit, &shown, &builder->signals.measured[k]);
        if (place < 0) {
            place = circuit->results.n_signals++;
            circuit->results.signal[place] = builder->signals.measured[k];
        }
        circuit->results.measured[k] = place;
    }
    circuit->results.computed =
        dalcs_arena_alloc(arena, builder->signals.n_computed, sizeof *circuit->results.computed);
    if (circuit->results.computed == NULL) {
        return DALCS_E_NOMEM;
    }
    circuit->results.n_computed = (int)builder->signals.n_computed;
    for (size_t k = 0; k < builder->signals.n_computed; k++) {
        circuit->results.computed[k] = builder->signals.computed[k];
    }
    if (builder->signals.n_computed > 0) {
        circuit->results.n_shown =
            circuit->results.n_signals; /* what they are computed from is in the rows */
    }
    circuit->results.n_measures = (int)builder->results.n_measures;
    for (size_t k = 0; k < builder->results.n_measures; k++) {
        circuit->results.measure[k] = builder->results.measure[k];
    }
    circuit->results.n_fouriers = (int)builder->results.n_fouriers;
    for (size_t k = 0; k < builder->results.n_fouriers; k++) {
        circuit->results.fourier[k] = builder->results.fourier[k];
    }
    return DALCS_OK;
}
