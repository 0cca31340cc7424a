/* gate_variation.c - what outputs of gates are off by in segments, and what samples read where these end. */
#include "gate_variation.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

static int pin_of(const struct dalcs_gate_variation *g, int input) {
    return dalcs_logic_pin_of(g->memory, g->part->component->system->stimulus[input]);
}

/* ---- Set up ------------------------------------------------------------------------------------------------ */

static void find_functions(struct dalcs_gate_variation *g) {
    const struct dalcs_excitation *e = &g->part->excitation;
    for (int k = 0; k < g->memory->n_pins; k++) {
        g->function[k] = -1;
    }
    for (int k = 0; k < e->n_waves; k++) {
        const struct dalcs_excitation_wave *wave = &e->wave[k];
        const int pin = wave->smooth < 0 ? pin_of(g, wave->input) : -1;
        if (pin >= 0 && wave->has_level) {
            g->function[pin] = g->n_x + 1 + wave->first;
        }
    }
}

enum dalcs_status dalcs_gate_variation_setup(struct dalcs_gate_variation *g,
                                             struct dalcs_arena *arena, struct dalcs_radau *radau,
                                             struct dalcs_logic_run *logic,
                                             const struct dalcs_logic_memory *m) {
    *g = (struct dalcs_gate_variation){.memory = m,
                                       .network = radau->base->network,
                                       .part = &radau->part[0],
                                       .logic = logic,
                                       .n_x = radau->part[0].component->system->n_x,
                                       .resolution = radau->resolution,
                                       .ended = -1.0,
                                       .arena = arena};
    g->n_columns = g->n_x + m->n_numbers;
    const size_t n = (size_t)g->n_columns;
    const size_t n_pins = (size_t)m->n_pins + 1;
    const size_t n_taken = (size_t)m->n_taken + 1;
    g->function = dalcs_arena_alloc(arena, n_pins, sizeof(int));
    g->pin = dalcs_arena_alloc(arena, n_pins * n, sizeof(double));
    g->taken = dalcs_arena_alloc(arena, n_taken * n, sizeof(double));
    g->rate = dalcs_arena_alloc(arena, n_taken, sizeof(double));
    g->ends.rate = dalcs_arena_alloc(arena, n_taken, sizeof(double));
    g->ends.first = dalcs_arena_alloc(arena, n_pins, sizeof(double));
    g->ends.last = dalcs_arena_alloc(arena, n_pins, sizeof(double));
    g->due = dalcs_arena_alloc(arena, n, sizeof(double));
    g->work = dalcs_arena_alloc(arena, n, sizeof(double));
    g->term = dalcs_arena_alloc(arena, DALCS_STIMULUS_MOST_TERMS, sizeof *g->term);
    if (g->function == NULL || g->pin == NULL || g->taken == NULL || g->rate == NULL ||
        g->ends.rate == NULL || g->ends.first == NULL || g->ends.last == NULL || g->due == NULL ||
        g->work == NULL || g->term == NULL) {
        return DALCS_E_NOMEM;
    }
    find_functions(g);
    for (int k = 0; k < m->n_pins; k++) {
        dalcs_gate_row(g->pin, g, k)[g->n_x + k] = 1.0;
    }
    for (int k = 0; k < m->n_taken; k++) {
        dalcs_gate_row(g->taken, g, k)[g->n_x + m->n_pins + k] = 1.0;
    }
    return dalcs_logic_watch_start(&g->watch, logic, m, g, dalcs_gate_variation_seen);
}

void dalcs_gate_variation_finish(struct dalcs_gate_variation *g) {
    dalcs_logic_watch_finish(&g->watch);
}

/* ---- Segments ---------------------------------------------------------------------------------------------- */

static double slope_behind(const struct dalcs_gate_variation *g, int pin, double t) {
    return dalcs_slope_behind(&g->memory->circuit->stimulus[g->memory->pin[pin].stimulus], t,
                              g->term);
}

static double slope_before(const struct dalcs_gate_variation *g, int pin, double t) {
    return dalcs_slope_before(&g->memory->circuit->stimulus[g->memory->pin[pin].stimulus], t,
                              g->term);
}

/* Sum of factor * what inputs are off by, of one column. */
static double of_inputs(const struct dalcs_gate_variation *g, const double *factor, int column) {
    const int n_inputs = g->part->component->system->n_inputs;
    double sum = 0.0;
    for (int i = 1; i < n_inputs; i++) {
        const int pin = factor[i] != 0.0 ? pin_of(g, i) : -1;
        sum += pin >= 0 ? factor[i] * g->pin[(size_t)pin * (size_t)g->n_columns + (size_t)column]
                        : 0.0;
    }
    return sum;
}

static double probe_value(const struct dalcs_gate_variation *g, const struct dalcs_probe *probe,
                          int column, const double *weight, const double *out) {
    const int n_inputs = g->part->component->system->n_inputs;
    double sum = 0.0;
    for (int k = 0; probe->system >= 0 && k < probe->n_terms + probe->n_inputs; k++) {
        const int index = probe->term[k].index;
        double value;
        if (k >= probe->n_terms) {
            const int pin = pin_of(g, index);
            value = pin >= 0 ? g->pin[(size_t)pin * (size_t)g->n_columns + (size_t)column] : 0.0;
        } else {
            const int bystander = dalcs_orbit_bystander(g->part, index);
            value = bystander < 0 ? dalcs_orbit_weigh(&g->part->stages.layout, weight, out, index)
                                  : of_inputs(g,
                                              g->part->excitation.bystanders.gain +
                                                  (size_t)bystander * (size_t)n_inputs,
                                              column);
        }
        sum += probe->term[k].coefficient * value;
    }
    return sum;
}

void dalcs_gate_variation_begin(struct dalcs_gate_variation *g) {
    const double t = g->part->segment.t;
    for (int k = 0; k < g->memory->n_pins; k++) {
        const double slope = slope_behind(g, k, t);
        if (slope == 0.0 && !g->memory->pin[k].holds) {
            memset(dalcs_gate_row(g->pin, g, k), 0, (size_t)g->n_columns * sizeof(double));
        }
        g->ends.first[k] = g->ends.begun ? g->ends.first[k] : slope;
    }
    for (int k = 0; k < g->memory->n_taken && !g->ends.begun; k++) {
        const struct dalcs_output *out = dalcs_logic_read_by(g->memory, g->network, k);
        g->ends.rate[k] = dalcs_orbit_probe_rate(g->part, &out->plus, true, g->term) -
                          dalcs_orbit_probe_rate(g->part, &out->minus, true, g->term);
    }
    g->ends.begun = true;
}

void dalcs_gate_variation_drive(const struct dalcs_gate_variation *g, int column, double *in) {
    for (int k = 0; k < g->memory->n_pins; k++) {
        if (g->function[k] >= 0) {
            in[g->function[k]] = g->pin[(size_t)k * (size_t)g->n_columns + (size_t)column];
        }
    }
}

void dalcs_gate_variation_read(struct dalcs_gate_variation *g, int column, const double *weight,
                               const double *out) {
    for (int k = 0; k < g->memory->n_taken; k++) {
        const struct dalcs_output *of = dalcs_logic_read_by(g->memory, g->network, k);
        dalcs_gate_row(g->taken, g, k)[column] = probe_value(g, &of->plus, column, weight, out) -
                                                 probe_value(g, &of->minus, column, weight, out);
    }
}

/* A command along a ramp of outputs that are off is late; one at an edge of other sources is not. */
static bool find_command(struct dalcs_gate_variation *g, int pair, double t) {
    const struct dalcs_control *control = &g->part->commands.control;
    const struct dalcs_csr *a = &g->part->component->system->direct_control;
    const double left = dalcs_control_value(control, pair, t, DALCS_LEFT);
    const double right = dalcs_control_value(control, pair, t, DALCS_RIGHT);
    double size = 0.0;
    double slope = 0.0;
    bool moves = false;
    memset(g->due, 0, (size_t)g->n_columns * sizeof(double));
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        const int pin = s != NULL ? pin_of(g, a->j[k]) : -1;
        size += s != NULL ? fabs(a->x[k] * dalcs_stimulus_value(s, t, DALCS_RIGHT)) : 0.0;
        slope += s != NULL ? a->x[k] * dalcs_slope_before(s, t, g->term) : 0.0;
        for (int c = 0; c < g->n_columns && pin >= 0; c++) {
            g->due[c] -= a->x[k] * dalcs_gate_row(g->pin, g, pin)[c];
            moves = moves || g->due[c] != 0.0;
        }
    }
    if (fabs(left - right) > dalcs_alike * size || slope == 0.0) {
        return false; /* it jumps there */
    }
    for (int c = 0; c < g->n_columns; c++) {
        g->due[c] /= slope;
    }
    return moves;
}

void dalcs_gate_variation_end(struct dalcs_gate_variation *g, bool *moves) {
    const struct dalcs_radau_part *part = g->part;
    const struct dalcs_commands *c = &part->commands;
    const double t = part->segment.t_end;
    for (int k = 0; k < g->memory->n_taken; k++) {
        const struct dalcs_output *out = dalcs_logic_read_by(g->memory, g->network, k);
        g->rate[k] = dalcs_orbit_probe_rate(g->part, &out->plus, false, g->term) -
                     dalcs_orbit_probe_rate(g->part, &out->minus, false, g->term);
    }
    for (int k = 0; k < g->memory->n_pins; k++) {
        g->ends.last[k] = slope_before(g, k, t);
    }
    g->ended = t;
    *moves = false;
    for (int k = 0; k < c->n && !*moves; k++) {
        const struct dalcs_command *m = &c->command[k];
        *moves = m->moves && m->next <= t + g->resolution && find_command(g, m->pair, t);
    }
    if (*moves) {
        memcpy(g->event.dt, g->due, (size_t)g->n_columns * sizeof(double));
    }
}
