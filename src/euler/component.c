/* component.c - sampling the sources and commanding the switches around one OSNSP. */
#include "component.h"

#include "magnitudes.h"

#include <math.h>

enum dalcs_status dalcs_component_setup(struct dalcs_component *c,
                                        const struct dalcs_circuit *circuit,
                                        const struct dalcs_system *system,
                                        const struct dalcs_osnsp_options *options) {
    *c = (struct dalcs_component){
        .system = system, .circuit = circuit, .failure.overgrown = -1, .failure.restless.pair = -1};
    DALCS_TRY(dalcs_osnsp_setup(&c->osnsp, system, options));
    size_t n_u = (size_t)(system->n_x + system->n_inputs);
    size_t n_columns = (size_t)dalcs_system_n_columns(system);
    c->u = dalcs_arena_alloc(&c->arena, n_u, sizeof(double));
    c->probe_u = dalcs_arena_alloc(&c->arena, n_u, sizeof(double));
    c->probe_y = dalcs_arena_alloc(&c->arena, n_columns, sizeof(double));
    c->largest = dalcs_arena_alloc(&c->arena, (size_t)system->n_x, sizeof(double));
    c->y = dalcs_arena_alloc(&c->arena, n_columns, sizeof(double));
    c->y_before = dalcs_arena_alloc(&c->arena, n_columns, sizeof(double));
    c->scratch = dalcs_arena_alloc(&c->arena, n_columns, sizeof(double));
    c->saved_mode = dalcs_arena_alloc(&c->arena, (size_t)c->osnsp.n_words, sizeof(*c->saved_mode));
    c->varying.input = dalcs_arena_alloc(&c->arena, (size_t)system->n_inputs, sizeof(int));
    c->varying.piece =
        dalcs_arena_alloc(&c->arena, (size_t)system->n_inputs, sizeof(*c->varying.piece));
    c->switches.pair = dalcs_arena_alloc(&c->arena, (size_t)system->n_pairs, sizeof(int));
    if (c->u == NULL || c->probe_u == NULL || c->probe_y == NULL || c->y == NULL ||
        c->y_before == NULL || c->largest == NULL || c->scratch == NULL || c->saved_mode == NULL ||
        c->varying.input == NULL || c->varying.piece == NULL || c->switches.pair == NULL) {
        dalcs_component_finish(c);
        return DALCS_E_NOMEM;
    }
    for (int k = 1; k < system->n_inputs; k++) {
        if (circuit->stimulus[system->stimulus[k]].kind != DALCS_STIMULUS_DC) {
            enum dalcs_stimulus_kind kind = circuit->stimulus[system->stimulus[k]].kind;
            bool is_linear = kind == DALCS_STIMULUS_PULSE || kind == DALCS_STIMULUS_PWL;
            c->varying.piece[c->varying.n] =
                (struct dalcs_input_piece){.is_linear = is_linear, .to = -1.0};
            c->varying.input[c->varying.n++] = k;
        }
    }
    for (int d = 0; d < system->n_pairs; d++) {
        if (system->pair[d].kind == DALCS_PAIR_SWITCH) {
            c->switches.pair[c->switches.n++] = d;
            dalcs_osnsp_command(&c->osnsp, d, system->pair[d].initially_on);
        }
    }
    DALCS_TRY(dalcs_positions_setup(&c->positions, &c->osnsp, &c->arena));
    c->is_static = system->n_x == 0 && c->varying.n == 0;
    dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->u);
    dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->probe_u);
    return DALCS_OK;
}

void dalcs_component_finish(struct dalcs_component *c) {
    if (c->system != NULL) {
        dalcs_osnsp_finish(&c->osnsp);
        dalcs_positions_finish(&c->positions);
    }
    dalcs_arena_finish(&c->arena);
    *c = (struct dalcs_component){0};
}

/* Here the source itself is asked: only it knows whether a time that is a rounding before or behind an edge means that edge,
 * and where it says that the next one is follows from that. Farther away that is as right, and slower. */
static bool is_at_end(const struct dalcs_input_piece *piece, double t) {
    return fabs(t - piece->to) <= dalcs_alike * t;
}

/* Time only moves forward: from piece to piece, over the edges between. */
static double sample_linear(const struct dalcs_stimulus *s, struct dalcs_input_piece *piece,
                            double t, enum dalcs_side side) {
    while (t > piece->to && !is_at_end(piece, t)) {
        piece->from = piece->to < 0.0 ? 0.0 : piece->to;
        piece->to = dalcs_stimulus_next_edge(s, piece->from);
        piece->first = dalcs_stimulus_value(s, piece->from, DALCS_RIGHT);
        piece->last =
            isfinite(piece->to) ? dalcs_stimulus_value(s, piece->to, DALCS_LEFT) : piece->first;
    }
    if (is_at_end(piece, t)) {
        return dalcs_stimulus_value(s, t, side);
    }
    if (piece->first == piece->last) {
        return piece->last;
    }
    double part = (t - piece->from) / (piece->to - piece->from);
    return piece->first + part * (piece->last - piece->first);
}

void dalcs_component_sample(struct dalcs_component *c, double t, enum dalcs_side side, double *u) {
    const struct dalcs_system *s = c->system;
    double *inputs = u + s->n_x;
    inputs[0] = 1.0;
    if (t == 0.0) {
        for (int k = 1; k < s->n_inputs; k++) {
            inputs[k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, side);
        }
        return;
    }
    for (int i = 0; i < c->varying.n; i++) {
        int k = c->varying.input[i];
        const struct dalcs_stimulus *stimulus = &c->circuit->stimulus[s->stimulus[k]];
        inputs[k] = c->varying.piece[i].is_linear
                        ? sample_linear(stimulus, &c->varying.piece[i], t, side)
                        : dalcs_stimulus_value(stimulus, t, side);
    }
}

void dalcs_component_disturb(struct dalcs_component *c, double t) {
    for (int i = 0; i < c->varying.n && t > 0.0; i++) {
        struct dalcs_input_piece *piece = &c->varying.piece[i];
        if (piece->is_linear) { /* it ends at t, and is taken anew there */
            const int k = c->system->stimulus[c->varying.input[i]];
            piece->last = dalcs_stimulus_value(&c->circuit->stimulus[k], t, DALCS_LEFT);
            piece->first = piece->last;
            piece->from = piece->to = t;
        }
    }
}

void dalcs_component_look_ahead(const struct dalcs_component *c, double t, enum dalcs_side side,
                                double *u) {
    const struct dalcs_system *s = c->system;
    for (int i = 0; i < c->varying.n; i++) {
        int k = c->varying.input[i];
        u[s->n_x + k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, side);
    }
}

double dalcs_component_next_edge(const struct dalcs_component *c, double since) {
    double next = INFINITY;
    for (int i = 0; i < c->varying.n; i++) {
        const int k = c->system->stimulus[c->varying.input[i]];
        next = fmin(next, dalcs_stimulus_next_edge(&c->circuit->stimulus[k], since));
    }
    return next;
}

bool dalcs_component_jumps_at_start(const struct dalcs_component *c) {
    bool jumps = false;
    for (int i = 0; i < c->varying.n && !jumps; i++) {
        int input = c->system->stimulus[c->varying.input[i]];
        jumps = dalcs_stimulus_jumps_at(&c->circuit->stimulus[input], 0.0);
    }
    return jumps;
}

void dalcs_component_sample_operating(const struct dalcs_component *c, bool transient_follows,
                                      double *u) {
    const struct dalcs_system *s = c->system;
    double *inputs = u + s->n_x;
    inputs[0] = 1.0;
    for (int k = 1; k < s->n_inputs; k++) {
        inputs[k] = dalcs_stimulus_operating_value(&c->circuit->stimulus[s->stimulus[k]],
                                                   transient_follows);
    }
}

/* Moves the switches that sources alone control. */
static void obey_sources(struct dalcs_component *c, const double *inputs) {
    const struct dalcs_system *s = c->system;
    for (int i = 0; i < c->switches.n; i++) {
        int d = c->switches.pair[i];
        const struct dalcs_pair *pair = &s->pair[d];
        if (!pair->is_direct) {
            continue;
        }
        double control = dalcs_csr_row_dot(&s->direct_control, d, inputs);
        bool is_on = dalcs_osnsp_is_on(&c->osnsp, d);
        bool wants = dalcs_switch_closes(s, c->osnsp.mode, d, is_on, control, 0.0);
        if (wants != is_on) {
            dalcs_osnsp_command(&c->osnsp, d, wants);
            c->commands.moved = true;
        }
    }
}

void dalcs_component_command_behind(struct dalcs_component *c, double t) {
    dalcs_component_sample(c, t, DALCS_RIGHT, c->probe_u);
    obey_sources(c, c->probe_u + c->system->n_x);
}

enum dalcs_status dalcs_component_solve(struct dalcs_component *c, double sigma, const double *u,
                                        double *y) {
    c->commands.moved = false;
    obey_sources(c, u + c->system->n_x);
    DALCS_TRY(sigma > 0.0 ? dalcs_positions_solve(&c->positions, sigma, u, y)
                          : dalcs_positions_solve_at_rest(&c->positions, u, y));
    c->commands.moved = c->commands.moved || c->positions.moved;
    if (!c->positions.settled && c->commands.n_delayed++ == 0) {
        c->commands.restless = dalcs_positions_restless(&c->positions, y);
    }
    const char *held = NULL;
    if (sigma > 0.0) {
        DALCS_TRY(dalcs_positions_find_held(&c->positions, sigma, u, y, &held));
    }
    if (held != NULL && c->commands.n_held++ == 0) {
        c->commands.held = held;
    }
    return DALCS_OK;
}

/* V, A: what gains of up to 1e60 make of no more than this are still numbers. */
static const double largest_state = 1e240;

bool dalcs_component_overgrows(struct dalcs_component *c, const double *x) {
    for (int k = 0; k < c->system->n_x; k++) {
        if (!(fabs(x[k]) <= largest_state)) {
            c->failure.overgrown = k;
            return true;
        }
    }
    return false;
}
