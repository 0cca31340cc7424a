/* periodic_gates.c - late edges and samples at one frequency. */
#include "periodic_gates.h"

#include <string.h>

enum dalcs_status dalcs_periodic_gates_setup(struct dalcs_periodic_gates *g,
                                             struct dalcs_arena *arena,
                                             const struct dalcs_periodic_flow *flow) {
    const struct dalcs_orbit_gates *log = flow->orbit->log->gates;
    const struct dalcs_logic_memory *m = log->memory;
    const size_t n = (size_t)log->n + 1;
    *g = (struct dalcs_periodic_gates){.log = log, .flow = flow};
    g->number = dalcs_arena_alloc(arena, (size_t)(m->n_numbers - m->n_pins) + 1, sizeof *g->number);
    g->taken = dalcs_arena_alloc(arena, (size_t)m->n_taken + 1, sizeof *g->taken);
    g->next = dalcs_arena_alloc(arena, (size_t)(m->n_pulses + m->n_due) + 1, sizeof *g->next);
    g->late = dalcs_arena_alloc(arena, n, sizeof *g->late);
    g->is_known = dalcs_arena_alloc(arena, n, sizeof *g->is_known);
    return g->number != NULL && g->taken != NULL && g->next != NULL && g->late != NULL &&
                   g->is_known != NULL
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

/* An instant at which the circuit has no part is as late as what comes due then. */
static double complex late_of(const struct dalcs_periodic_gates *g, long number) {
    while (number > 0 && !g->is_known[number]) {
        number = g->log->cause[number];
    }
    return number < 0   ? g->number[-1 - number - g->log->memory->n_pins]
           : number > 0 ? g->late[number]
                        : 0.0;
}

static void change_pins(const struct dalcs_periodic_gates *g, const struct dalcs_orbit_instant *at,
                        double complex dt, double complex *pin) {
    const struct dalcs_logic_memory *m = g->log->memory;
    for (int k = 0; k < m->n_pins && at->decides; k++) {
        const struct dalcs_pin_change *change = &at->pin[k];
        int taken = 0;
        while (change->takes && m->taken[taken] != m->pin[k].gate) {
            taken++;
        }
        if (change->takes) {
            pin[k] = g->taken[taken] + at->rate[taken] * dt;
        } else if (change->jumps) {
            pin[k] = 0.0;
        } else if (!m->pin[k].holds) {
            pin[k] = (change->left == 0.0 ? 0.0 : pin[k]) + (change->left - change->right) * dt;
        }
    }
    for (int k = 0; k < m->n_pins; k++) {
        pin[k] = at->rests[k] ? 0.0 : pin[k];
    }
}

static void note_late(struct dalcs_periodic_gates *g, const struct dalcs_orbit_instant *at,
                      double complex dt) {
    const struct dalcs_logic_memory *m = g->log->memory;
    if (!at->decides) {
        return;
    }
    g->late[at->number] = dt;
    g->is_known[at->number] = true;
    for (size_t k = 0; k < at->n_pulses; k++) {
        const long number = at->pulse[k].number;
        g->late[number] = dt;
        g->is_known[number] = true;
        for (int s = 0; s < m->n_taken && at->is_positive[k]; s++) {
            if (m->taken[s] == at->pulse[k].gate) {
                g->late[number] += g->taken[s] + at->rate[s] * dt;
            }
        }
    }
}

void dalcs_periodic_gates_begin(struct dalcs_periodic_gates *g, double complex *pin) {
    const struct dalcs_orbit_instant *first = &g->log->first;
    memset(g->is_known, 0, (size_t)(g->log->n + 1) * sizeof *g->is_known);
    for (int k = 0; k < g->log->memory->n_taken; k++) {
        g->taken[k] = g->number[k];
    }
    const double complex dt = late_of(g, first->cause);
    note_late(g, first, dt);
    change_pins(g, first, dt, pin);
}

static double complex read_probe(const struct dalcs_periodic_gates *g,
                                 const struct dalcs_probe *probe, const struct dalcs_piece_end *end,
                                 const double complex *pin) {
    const struct dalcs_periodic_flow *flow = g->flow;
    double complex sum = 0.0;
    for (int k = 0; probe->system >= 0 && k < probe->n_terms + probe->n_inputs; k++) {
        const int index = probe->term[k].index;
        double complex value;
        if (k < probe->n_terms) {
            value = end->row(end->user, index);
        } else {
            const int at = dalcs_logic_pin_of(g->log->memory, flow->system->stimulus[index]);
            value = at >= 0 ? pin[at] : flow->drive.source[index] * end->phase;
        }
        sum += probe->term[k].coefficient * value;
    }
    return sum;
}

static void read_samples(struct dalcs_periodic_gates *g, const struct dalcs_piece_end *end,
                         const double complex *pin) {
    for (int k = 0; k < g->log->memory->n_taken; k++) {
        const struct dalcs_output *out = dalcs_logic_read_by(g->log->memory, g->log->network, k);
        g->taken[k] = read_probe(g, &out->plus, end, pin) - read_probe(g, &out->minus, end, pin);
    }
}

void dalcs_periodic_gates_meet(struct dalcs_periodic_gates *g, const struct dalcs_orbit_span *span,
                               const struct dalcs_piece_end *end, const double complex *pin,
                               double complex *dt) {
    const struct dalcs_orbit_instant *at = span->gates;
    bool is_own = span->row >= 0 || span->moved[0] != 0.0 || span->moved[1] != 0.0;
    read_samples(g, end, pin);
    for (int k = 0; k < g->log->memory->n_pins && span->row < 0; k++) {
        *dt += at->by[k] * pin[k];
        is_own = is_own || at->by[k] != 0.0;
    }
    if (!is_own) {
        *dt = late_of(g, at->cause);
    }
    note_late(g, at, *dt);
}

void dalcs_periodic_gates_pass(struct dalcs_periodic_gates *g, const struct dalcs_orbit_span *span,
                               double complex dt, double complex *pin) {
    change_pins(g, span->gates, dt, pin);
}

void dalcs_periodic_gates_end(struct dalcs_periodic_gates *g, const struct dalcs_piece_end *end,
                              const double complex *pin) {
    const struct dalcs_logic_memory *m = g->log->memory;
    const size_t n_times = (size_t)(m->n_pulses + m->n_due);
    read_samples(g, end, pin);
    for (size_t k = 0; k < n_times; k++) {
        g->next[k] = late_of(g, g->log->since[k]);
    }
    memcpy(g->number, g->taken, (size_t)m->n_taken * sizeof *g->taken);
    memcpy(g->number + m->n_taken, g->next, n_times * sizeof *g->next);
}
