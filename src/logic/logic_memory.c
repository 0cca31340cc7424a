/* logic_memory.c - the state of gates to and fro. */
#include "logic_memory.h"

#include "logic_outputs.h"

#include <math.h>

enum { COUNT_BITS = 30, DUE_BITS = 12, FLAGS = 6, BITS = FLAGS + COUNT_BITS + DUE_BITS };

/* Changes on their way, of a gate that has a delay: there and back in each period that the delay lasts, and in the one
 * at hand; more than so many periods of delay nobody draws. */
enum { MOST_PERIODS = 64 };

enum dalcs_logic_number dalcs_logic_number_kind(const struct dalcs_logic_memory *m, int number,
                                                int *gate) {
    *gate = -1;
    if (number < m->n_pins) {
        *gate = m->pin[number].gate;
        return DALCS_NUMBER_PIN;
    }
    number -= m->n_pins;
    if (number < m->n_taken) {
        *gate = m->taken[number];
        return DALCS_NUMBER_TAKEN;
    }
    number -= m->n_taken;
    if (number < m->n_pulses) {
        *gate = m->pulse[number];
        return DALCS_NUMBER_PULSE;
    }
    return DALCS_NUMBER_DUE;
}

int dalcs_logic_pin_of(const struct dalcs_logic_memory *m, int stimulus) {
    int pin = -1;
    for (int k = 0; k < m->n_pins && pin < 0; k++) {
        pin = m->pin[k].stimulus == stimulus ? k : -1;
    }
    return pin;
}

static int count_due(const struct dalcs_logic_gate *g, double period) {
    enum { OTHERS = 4 };

    const double longest =
        fmax(fmax(g->delay[0], g->delay[1]), fmax(g->forced_delay[0], g->forced_delay[1]));
    const double periods = period > 0.0 ? ceil(longest / period) : 1.0;
    return longest > 0.0 ? OTHERS + 2 * (int)fmin(periods, MOST_PERIODS) : 0;
}

enum dalcs_status dalcs_logic_memory_setup(struct dalcs_logic_memory *m, struct dalcs_arena *arena,
                                           const struct dalcs_circuit *circuit, double period) {
    const size_t n = (size_t)circuit->control.n_gates;
    *m = (struct dalcs_logic_memory){.circuit = circuit};
    m->pin = dalcs_arena_alloc(arena, 2 * n + 1, sizeof *m->pin);
    m->taken = dalcs_arena_alloc(arena, n + 1, sizeof *m->taken);
    m->pulse = dalcs_arena_alloc(arena, n + 1, sizeof *m->pulse);
    if (m->pin == NULL || m->taken == NULL || m->pulse == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < circuit->control.n_gates; k++) {
        const struct dalcs_logic_gate *g = &circuit->control.gate[k];
        for (int which = 0; which < 2; which++) {
            if (g->output[which] >= 0) {
                const bool holds = g->kind == DALCS_GATE_SAMPLE && which == 0;
                m->pin[m->n_pins++] = (struct dalcs_logic_pin){k, which, g->output[which], holds};
            }
        }
        if (g->sampled >= 0) {
            m->taken[m->n_taken++] = k;
        }
        if (g->kind == DALCS_GATE_MONOSTABLE) {
            m->pulse[m->n_pulses++] = k;
        }
        m->n_due += count_due(g, period);
    }
    m->n_numbers = m->n_pins + m->n_taken + m->n_pulses + m->n_due;
    m->n_bits = BITS * circuit->control.n_gates;
    return DALCS_OK;
}

/* ---- Bits ------------------------------------------------------------------------------------------------ */

static void put_count(bool **bit, int width, unsigned count) {
    for (int k = 0; k < width; k++) {
        *(*bit)++ = (count >> k & 1U) != 0;
    }
}

static unsigned take_count(const bool **bit, int width) {
    unsigned count = 0;
    for (int k = 0; k < width; k++) {
        count |= (*(*bit)++ ? 1U : 0U) << k;
    }
    return count;
}

static void put_bits(const struct dalcs_logic_state *state, const struct dalcs_logic_output *o,
                     bool *bit) {
    *bit++ = state->q;
    *bit++ = state->seen;
    *bit++ = state->clock;
    *bit++ = state->is_forced;
    *bit++ = o->shown;
    *bit++ = isfinite(o->ends);
    put_count(&bit, COUNT_BITS, (unsigned)state->count);
    put_count(&bit, DUE_BITS, (unsigned)o->n_due);
}

/* *lasts: a pulse does. */
static void take_bits(struct dalcs_logic_state *state, struct dalcs_logic_output *o,
                      const bool *bit, bool *lasts) {
    *state = (struct dalcs_logic_state){0};
    state->q = *bit++;
    state->seen = *bit++;
    state->clock = *bit++;
    state->is_forced = *bit++;
    o->shown = *bit++;
    *lasts = *bit++;
    state->count = (int)take_count(&bit, COUNT_BITS);
    o->n_due = take_count(&bit, DUE_BITS);
}

/* ---- To and fro ------------------------------------------------------------------------------------------- */

enum dalcs_status dalcs_logic_memory_save(const struct dalcs_logic_memory *m,
                                          const struct dalcs_logic_run *l, double t, double *number,
                                          bool *bit) {
    int n = 0;
    for (int k = 0; k < m->n_pins; k++) {
        number[n++] =
            dalcs_stimulus_value(&l->circuit->stimulus[m->pin[k].stimulus], t, DALCS_LEFT);
    }
    for (int k = 0; k < m->n_taken; k++) {
        number[n++] = l->taken[m->taken[k]];
    }
    for (int k = 0; k < m->n_pulses; k++) {
        const double ends = l->output[m->pulse[k]].ends;
        number[n++] = isfinite(ends) ? ends - t : 0.0;
    }
    for (int k = 0; k < l->network.n; k++) {
        const struct dalcs_logic_output *o = &l->output[k];
        put_bits(&l->network.state[k], o, bit + (size_t)BITS * (size_t)k);
        for (size_t i = 0; i < o->n_due; i++) {
            if (n == m->n_numbers || o->n_due >= 1U << DUE_BITS) {
                return DALCS_NOT_CONVERGED;
            }
            number[n++] = o->due[o->first_due + i].t - t;
        }
    }
    while (n < m->n_numbers) {
        number[n++] = 0.0;
    }
    return DALCS_OK;
}

static enum dalcs_status restore_dues(const struct dalcs_logic_memory *m,
                                      struct dalcs_logic_output *o, const double *number, int *n) {
    const size_t n_due = o->n_due;
    o->n_due = o->first_due = 0;
    DALCS_TRY(dalcs_grow(&o->due, &o->due_capacity, n_due + 1, sizeof *o->due));
    for (size_t i = 0; i < n_due && *n < m->n_numbers; i++, ++*n) {
        o->due[i] = (struct dalcs_logic_due){fmax(0.0, number[*n]), -1L - *n};
        o->n_due++;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_memory_restore(const struct dalcs_logic_memory *m,
                                             struct dalcs_logic_run *l, const double *number,
                                             const bool *bit) {
    int n = m->n_pins;
    for (int k = 0; k < m->n_taken; k++) {
        l->taken[m->taken[k]] = number[n++];
    }
    const int first_pulse = n;
    n += m->n_pulses;
    for (int k = 0; k < l->network.n; k++) {
        bool lasts;
        take_bits(&l->network.state[k], &l->output[k], bit + (size_t)BITS * (size_t)k, &lasts);
        l->output[k].ends = INFINITY;
        for (int i = 0; i < m->n_pulses && lasts; i++) {
            if (m->pulse[i] == k) {
                l->output[k].ends = fmax(0.0, number[first_pulse + i]);
                l->output[k].ends_since = -1L - (first_pulse + i);
            }
        }
        DALCS_TRY(restore_dues(m, &l->output[k], number, &n));
        if (l->output[k].n_due > 0 || isfinite(l->output[k].ends)) {
            dalcs_logic_set_add(&l->waits, k);
        }
    }
    dalcs_logic_touch_all(&l->network);
    for (int k = 0; k < m->n_pins; k++) {
        DALCS_TRY(dalcs_logic_output_restore(l, &m->pin[k], number[k]));
    }
    for (int k = 0; l->radau != NULL && k < l->radau->n_parts; k++) {
        dalcs_excitation_enter(&l->radau->part[k].excitation, 0.0);
    }
    return DALCS_OK;
}
