/* excitation.c - the functions of time in a system's equations, and their coefficients. */
#include "excitation.h"

#include "history.h"

#include "pi.h"

#include <math.h>
#include <string.h>

/* Does input k enter an equation or a threshold? */
static bool acts(const struct dalcs_excitation *excitation, int k) {
    const struct dalcs_system *s = excitation->system;
    bool found = false;
    for (int r = 0; r < s->E.n_rows && !found; r++) {
        for (int i = s->E.p[r]; i < s->E.p[r + 1] && !excitation->bystanders.row[r]; i++) {
            found = found || s->E.j[i] == k;
        }
    }
    for (int i = 0; i < s->F.p[s->F.n_rows] && !found; i++) {
        found = s->F.j[i] == k;
    }
    return found;
}

static void add_function(struct dalcs_excitation *excitation, struct dalcs_excitation_wave *wave,
                         enum dalcs_excitation_shape shape,
                         const struct dalcs_stimulus_term *term) {
    excitation->function[excitation->n_functions++] = (struct dalcs_excitation_function){
        .input = wave->input,
        .shape = shape,
        .decay = term != NULL ? term->decay : 0.0,
        .omega = term != NULL ? term->omega : 0.0,
    };
    wave->n_functions++;
}

static void add_wave(struct dalcs_excitation *excitation, int input,
                     const struct dalcs_stimulus *stimulus) {
    struct dalcs_excitation_wave *wave = &excitation->wave[excitation->n_waves++];
    *wave = (struct dalcs_excitation_wave){
        .input = input, .stimulus = stimulus, .first = excitation->n_functions, .smooth = -1};
    wave->piece.term = excitation->term + excitation->n_terms;
    dalcs_stimulus_piece_at(stimulus, 0.0, &wave->piece);
    excitation->n_terms += wave->piece.n_terms;
    wave->is_curved = wave->piece.n_terms > 0;
    excitation->is_curved = excitation->is_curved || wave->is_curved;
    /* Later pieces may have a level, and those of a sum a slope, where this one has none. */
    const bool has_others = isfinite(wave->piece.to);
    wave->has_ramp = !wave->is_curved || wave->piece.slope != 0.0 ||
                     (has_others && stimulus->kind == DALCS_STIMULUS_FORMULA);
    wave->has_level = wave->has_ramp || has_others || wave->piece.level != 0.0;
    if (wave->has_level) {
        add_function(excitation, wave, DALCS_EXCITATION_LEVEL, NULL);
    }
    if (wave->has_ramp) {
        add_function(excitation, wave, DALCS_EXCITATION_RAMP, NULL);
    }
    for (int k = 0; k < wave->piece.n_terms; k++) {
        const struct dalcs_stimulus_term *term = &wave->piece.term[k];
        add_function(excitation, wave, DALCS_EXCITATION_COSINE, term);
        if (term->omega != 0.0) {
            add_function(excitation, wave, DALCS_EXCITATION_SINE, term);
            excitation->shortest_period =
                fmin(excitation->shortest_period, dalcs_two_pi / fabs(term->omega));
        }
    }
}

/* What is given by its values at the nodes of a step. */
static void add_nodes(struct dalcs_excitation *excitation, struct dalcs_excitation_wave *wave,
                      const struct dalcs_collocation *method) {
    wave->first = excitation->n_functions;
    wave->is_curved = true;
    wave->n_functions = method->s + 2;
    for (int node = 0; node <= method->s + 1; node++) {
        excitation->function[excitation->n_functions++] = (struct dalcs_excitation_function){
            .input = wave->input,
            .shape = node <= method->s ? DALCS_EXCITATION_NODE : DALCS_EXCITATION_BETWEEN,
            .node = node,
            .method = method};
    }
    excitation->is_curved = true;
}

/* A function of columns. */
static void add_smooth(struct dalcs_excitation *excitation, int k,
                       const struct dalcs_collocation *method) {
    struct dalcs_excitation_wave *wave = &excitation->wave[excitation->n_waves++];
    *wave =
        (struct dalcs_excitation_wave){.input = excitation->system->smooth[k].input, .smooth = k};
    add_nodes(excitation, wave, method);
}

/* What a signal was. */
static void add_delayed(struct dalcs_excitation *excitation, int input,
                        const struct dalcs_stimulus *stimulus,
                        const struct dalcs_collocation *method) {
    struct dalcs_excitation_wave *wave = &excitation->wave[excitation->n_waves++];
    *wave = (struct dalcs_excitation_wave){.input = input,
                                           .stimulus = stimulus,
                                           .is_delayed = true,
                                           .smooth = -1,
                                           .piece.to = dalcs_stimulus_next_edge(stimulus, 0.0)};
    add_nodes(excitation, wave, method);
}

/* Room for all waves. */
static enum dalcs_status allocate(struct dalcs_excitation *excitation,
                                  const struct dalcs_circuit *circuit,
                                  const struct dalcs_system *system) {
    enum { FUNCTIONS_OF_SMOOTH = DALCS_MAX_NODES + 2 };

    size_t n = (size_t)system->n_inputs;
    size_t n_smooth = (size_t)system->n_smooth;
    size_t n_delayed = 0;
    size_t n_terms = 0;
    int most = 0;
    for (int k = 1; k < system->n_inputs; k++) {
        int n_of_wave = dalcs_stimulus_n_terms(&circuit->stimulus[system->stimulus[k]]);
        n_delayed += circuit->stimulus[system->stimulus[k]].kind == DALCS_STIMULUS_DELAYED;
        n_terms += (size_t)n_of_wave;
        most = n_of_wave > most ? n_of_wave : most;
    }
    excitation->wave = dalcs_arena_alloc(&excitation->arena, n, sizeof(*excitation->wave));
    excitation->function = dalcs_arena_alloc(
        &excitation->arena, 2 * n + 2 * n_terms + (n_smooth + n_delayed) * FUNCTIONS_OF_SMOOTH,
        sizeof(*excitation->function));
    excitation->smooth =
        dalcs_arena_alloc(&excitation->arena, n_smooth * FUNCTIONS_OF_SMOOTH, sizeof(double));
    excitation->term =
        dalcs_arena_alloc(&excitation->arena, n_terms + (size_t)most, sizeof(*excitation->term));
    excitation->constant = dalcs_arena_alloc(&excitation->arena, n, sizeof(double));
    if (excitation->wave == NULL || excitation->function == NULL || excitation->term == NULL ||
        excitation->constant == NULL || excitation->smooth == NULL) {
        return DALCS_E_NOMEM;
    }
    excitation->scratch = excitation->term + n_terms;
    return DALCS_OK;
}

enum dalcs_status dalcs_excitation_setup(struct dalcs_excitation *excitation,
                                         const struct dalcs_circuit *circuit,
                                         const struct dalcs_system *system,
                                         const struct dalcs_collocation *method) {
    *excitation = (struct dalcs_excitation){.system = system, .shortest_period = INFINITY};
    enum dalcs_status status = allocate(excitation, circuit, system);
    if (status == DALCS_OK) {
        status = dalcs_bystanders_find(&excitation->bystanders, circuit, system);
    }
    if (status != DALCS_OK) {
        dalcs_excitation_finish(excitation);
        return status;
    }
    excitation->constant[0] = 1.0;
    for (int k = 1; k < system->n_inputs; k++) {
        const struct dalcs_stimulus *stimulus = &circuit->stimulus[system->stimulus[k]];
        if (stimulus->kind == DALCS_STIMULUS_DC) {
            excitation->constant[k] = stimulus->dc;
        } else if (stimulus->kind == DALCS_STIMULUS_DELAYED) {
            add_delayed(excitation, k, stimulus, method);
        } else if (acts(excitation, k)) {
            add_wave(excitation, k, stimulus);
        }
    }
    excitation->first_smooth = excitation->n_functions;
    for (int k = 0; k < system->n_smooth; k++) {
        add_smooth(excitation, k, method);
    }
    dalcs_excitation_enter(excitation, 0.0);
    return DALCS_OK;
}

void dalcs_excitation_finish(struct dalcs_excitation *excitation) {
    dalcs_arena_finish(&excitation->arena);
    dalcs_bystanders_finish(&excitation->bystanders);
    *excitation = (struct dalcs_excitation){0};
}

void dalcs_excitation_enter(struct dalcs_excitation *excitation, double t) {
    const double edge = excitation->next_edge;
    excitation->next_edge = INFINITY;
    excitation->jumps = false;
    for (int k = 0; k < excitation->n_waves; k++) {
        struct dalcs_excitation_wave *wave = &excitation->wave[k];
        if (wave->smooth >= 0) {
            continue;
        }
        bool ends = wave->piece.to <= fmax(t, edge);
        excitation->jumps =
            excitation->jumps || (ends && dalcs_stimulus_jumps_at(wave->stimulus, wave->piece.to));
        dalcs_stimulus_piece_at(wave->stimulus, t, &wave->piece);
        wave->from = t;
        excitation->next_edge = fmin(excitation->next_edge, wave->piece.to);
    }
}

/* Those of the present piece, not of the neighbour that rounding may put t into. */
static void find_terms(const struct dalcs_excitation_wave *wave, double t,
                       struct dalcs_stimulus_term *term) {
    if (isinf(wave->piece.to)) {
        dalcs_stimulus_terms_at(wave->stimulus, t, term);
        return;
    }
    for (int i = 0; i < wave->piece.n_terms; i++, term++) {
        *term = wave->piece.term[i];
        double factor = exp(-term->decay * (t - wave->from));
        double c = cos(term->omega * (t - wave->from));
        double s = sin(term->omega * (t - wave->from));
        double cosine = factor * (term->cosine * c + term->sine * s);
        term->sine = factor * (term->sine * c - term->cosine * s);
        term->cosine = cosine;
    }
}

/* out[s + 2]: the values at the nodes, and what the polynomial through them misses. */
static void find_delayed(const struct dalcs_excitation *excitation,
                         const struct dalcs_excitation_wave *wave, double t, double h,
                         double *out) {
    const struct dalcs_collocation *method = excitation->function[wave->first].method;
    for (int k = 0; k <= method->s; k++) {
        const enum dalcs_side side = k == 0 ? DALCS_RIGHT : DALCS_LEFT;
        out[k] = dalcs_stimulus_value(wave->stimulus, t + h * method->node[k], side);
    }
    out[method->s + 1] = dalcs_history_missed(wave->stimulus->u.history, t, h, out);
}

void dalcs_excitation_coefficients(const struct dalcs_excitation *excitation, double t, double h,
                                   double *coefficient) {
    for (int k = 0; k < excitation->n_waves; k++) {
        const struct dalcs_excitation_wave *wave = &excitation->wave[k];
        double *out = coefficient + wave->first;
        if (wave->smooth >= 0) {
            memcpy(out, excitation->smooth + wave->smooth * wave->n_functions,
                   (size_t)wave->n_functions * sizeof(*out));
            continue;
        }
        if (wave->is_delayed) {
            find_delayed(excitation, wave, t, h, out);
            continue;
        }
        if (wave->has_level) {
            *out++ = wave->piece.level + wave->piece.slope * (t - wave->from);
        }
        if (wave->has_ramp) {
            *out++ = wave->piece.slope * h;
        }
        if (!wave->is_curved) {
            continue;
        }
        const struct dalcs_stimulus_term *now = wave->piece.term;
        if (t != wave->from) {
            find_terms(wave, t, excitation->scratch);
            now = excitation->scratch;
        }
        for (int i = 0; i < wave->piece.n_terms; i++) {
            *out++ = now[i].cosine;
            if (now[i].omega != 0.0) {
                *out++ = now[i].sine;
            }
        }
    }
}

void dalcs_excitation_inputs(const struct dalcs_excitation *excitation, double t, double tau,
                             double *inputs) {
    for (int k = 0; k < excitation->system->n_inputs; k++) {
        inputs[k] = excitation->constant[k];
    }
    for (int k = 0; k < excitation->n_waves; k++) {
        const struct dalcs_excitation_wave *wave = &excitation->wave[k];
        const struct dalcs_stimulus_piece *piece = &wave->piece;
        if (wave->smooth >= 0) { /* who solves finds it */
            inputs[wave->input] = 0.0;
        } else if (!wave->is_curved) {
            inputs[wave->input] = piece->level + piece->slope * ((t - wave->from) + tau);
        } else if (wave->is_delayed || isinf(piece->to)) {
            inputs[wave->input] = dalcs_stimulus_value(wave->stimulus, t + tau, DALCS_RIGHT);
        } else {
            double since = (t - wave->from) + tau;
            double value = piece->level + piece->slope * since;
            for (int i = 0; i < piece->n_terms; i++) {
                const struct dalcs_stimulus_term *term = &piece->term[i];
                value += exp(-term->decay * since) * (term->cosine * cos(term->omega * since) +
                                                      term->sine * sin(term->omega * since));
            }
            inputs[wave->input] = value;
        }
    }
}
