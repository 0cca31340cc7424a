/* orbit_gates.c - instants of gates, kept. */
#include "orbit_gates.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_orbit_gates_setup(struct dalcs_orbit_gates *g, struct dalcs_arena *arena,
                                          const struct dalcs_radau *radau,
                                          struct dalcs_logic_run *logic,
                                          const struct dalcs_logic_memory *m) {
    *g = (struct dalcs_orbit_gates){
        .memory = m, .logic = logic, .network = radau->base->network, .arena = arena};
    g->since = dalcs_arena_alloc(arena, (size_t)(m->n_pulses + m->n_due) + 1, sizeof(long));
    g->term = dalcs_arena_alloc(arena, DALCS_STIMULUS_MOST_TERMS, sizeof *g->term);
    g->first.rate = dalcs_arena_alloc(arena, (size_t)m->n_taken + 1, sizeof(double));
    g->first.rests = dalcs_arena_alloc(arena, (size_t)m->n_pins + 1, sizeof(bool));
    return g->since != NULL && g->term != NULL && g->first.rate != NULL && g->first.rests != NULL
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

static void find_resting(const struct dalcs_orbit_gates *g, double t, bool *rests) {
    const struct dalcs_logic_memory *m = g->memory;
    for (int k = 0; k < m->n_pins; k++) {
        rests[k] = !m->pin[k].holds &&
                   dalcs_slope_behind(&m->circuit->stimulus[m->pin[k].stimulus], t, g->term) == 0.0;
    }
}

enum dalcs_status dalcs_orbit_instant_begin(const struct dalcs_orbit_gates *g,
                                            struct dalcs_orbit_instant *at,
                                            const struct dalcs_radau_part *part, double t) {
    const struct dalcs_logic_memory *m = g->memory;
    *at = (struct dalcs_orbit_instant){0};
    at->by = dalcs_arena_alloc(g->arena, (size_t)m->n_pins + 1, sizeof(double));
    at->rate = dalcs_arena_alloc(g->arena, (size_t)m->n_taken + 1, sizeof(double));
    at->rests = dalcs_arena_alloc(g->arena, (size_t)m->n_pins + 1, sizeof(bool));
    if (at->by == NULL || at->rate == NULL || at->rests == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < m->n_taken; k++) {
        const struct dalcs_output *out = dalcs_logic_read_by(m, g->network, k);
        at->rate[k] = dalcs_orbit_probe_rate(part, &out->plus, false, g->term) -
                      dalcs_orbit_probe_rate(part, &out->minus, false, g->term);
    }
    find_resting(g, t, at->rests);
    return DALCS_OK;
}

static enum dalcs_status keep_cause(struct dalcs_orbit_gates *g, long number, long cause) {
    DALCS_TRY(dalcs_grow(&g->cause, &g->cause_capacity, (size_t)number + 1, sizeof *g->cause));
    while (g->n < number) {
        g->cause[++g->n] = 0;
    }
    g->cause[number] = cause;
    return DALCS_OK;
}

enum dalcs_status dalcs_orbit_gates_note(struct dalcs_orbit_gates *g,
                                         struct dalcs_orbit_instant *at,
                                         const struct dalcs_logic_instant *instant) {
    const size_t n_pins = (size_t)g->memory->n_pins;
    const long cause = instant->n_causes > 0 ? instant->cause[0] : 0;
    DALCS_TRY(keep_cause(g, instant->number, cause));
    for (size_t k = 0; k < instant->n_pulses; k++) {
        DALCS_TRY(keep_cause(g, instant->pulse[k].number, instant->number));
    }
    if (at == NULL) {
        return DALCS_OK;
    }
    at->number = instant->number;
    at->cause = cause;
    at->decides = true;
    at->pin = dalcs_arena_alloc(g->arena, n_pins + 1, sizeof *at->pin);
    at->pulse = dalcs_arena_alloc(g->arena, instant->n_pulses + 1, sizeof *at->pulse);
    at->is_positive = dalcs_arena_alloc(g->arena, instant->n_pulses + 1, sizeof(bool));
    if (at->pin == NULL || at->pulse == NULL || at->is_positive == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(at->pin, instant->pin, n_pins * sizeof *at->pin);
    at->n_pulses = instant->n_pulses;
    for (size_t k = 0; k < instant->n_pulses; k++) {
        const int gate = instant->pulse[k].gate;
        at->pulse[k] = instant->pulse[k];
        at->is_positive[k] =
            g->memory->circuit->control.gate[gate].sampled >= 0 && g->logic->taken[gate] > 0.0;
    }
    find_resting(g, instant->t, at->rests);
    return DALCS_OK;
}

enum dalcs_status dalcs_orbit_gates_close(struct dalcs_orbit_gates *g) {
    const struct dalcs_logic_memory *m = g->memory;
    int n = 0;
    for (int k = 0; k < m->n_pulses; k++, n++) {
        const struct dalcs_logic_output *o = &g->logic->output[m->pulse[k]];
        g->since[n] = isfinite(o->ends) ? o->ends_since : 0;
    }
    for (int k = 0; k < g->logic->network.n; k++) {
        const struct dalcs_logic_output *o = &g->logic->output[k];
        for (size_t i = 0; i < o->n_due && n < m->n_pulses + m->n_due; i++, n++) {
            g->since[n] = o->due[o->first_due + i].since;
        }
    }
    return DALCS_OK;
}
