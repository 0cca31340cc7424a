/* periodic_flow.c - what takes a small perturbation through a period: set up, and how a mode begins. */
#include "periodic_flow.h"

#include "magnitudes.h"
#include "periodic_smooth.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BRIEFER = 5 };

/* ---- How a mode begins --------------------------------------------------------------------------- */

/* What the polynomial through the stages, which do not see what the mode does not allow, is at the start. */
static void extrapolate(const struct dalcs_periodic_flow *flow, const struct dalcs_flow_map *map,
                        struct dalcs_flow_start *start) {
    const struct dalcs_collocation *c = flow->stages.method;
    const size_t size = dalcs_periodic_flow_size(flow);
    for (int x = 0; x < flow->n_x; x++) {
        start->by_source[x] = 0.0;
        for (int i = 0; i < c->n_stages; i++) {
            for (int q = 0; q < flow->drive.n_turns; q++) {
                const double *drive = map->drive + (size_t)(q * (c->s + 1)) * size;
                start->by_source[x] += flow->drive.turn[q] * c->back[i] *
                                       drive[dalcs_periodic_flow_at(flow, i + 1, x)];
            }
        }
        for (int k = 0; k < flow->n_columns; k++) {
            double sum = 0.0;
            for (int i = 0; i < c->n_stages; i++) {
                sum += c->back[i] *
                       map->state[(size_t)k * size + dalcs_periodic_flow_at(flow, i + 1, x)];
            }
            start->P[k * flow->n_x + x] = sum;
        }
    }
}

/* The largest difference, in units in which energies are alike. */
static double differ(const struct dalcs_periodic_flow *flow, const double *a, const double *b) {
    double most = 0.0;
    for (int k = 0; k < flow->n_columns; k++) {
        const double unit = k < flow->n_x ? flow->unit[k] : 1.0;
        for (int x = 0; x < flow->n_x; x++) {
            double other = b != NULL ? b[k * flow->n_x + x] : (x == k ? 1.0 : 0.0);
            double off = fabs(a[k * flow->n_x + x] - other) * flow->unit[x] / unit;
            most = fmax(most, off);
        }
    }
    return most;
}

/* What rounding leaves in P, likewise. */
static double noise_of(const struct dalcs_periodic_flow *flow, const struct dalcs_flow_map *map) {
    const struct dalcs_collocation *c = flow->stages.method;
    double sum = 0.0;
    double most = 0.0;
    for (int i = 0; i < c->n_stages; i++) {
        sum += fabs(c->back[i]);
    }
    for (int k = 0; k < flow->n_columns; k++) {
        most = fmax(most, map->noise[k] / (k < flow->n_x ? flow->unit[k] : 1.0));
    }
    return sum * most;
}

static bool start_setup(struct dalcs_periodic_flow *flow, struct dalcs_flow_start *start) {
    const size_t n_x = (size_t)flow->n_x;
    start->P = dalcs_arena_alloc(&flow->arena, (size_t)flow->n_columns * n_x, sizeof(double));
    start->by_source = dalcs_arena_alloc(&flow->arena, n_x, sizeof(double complex));
    return start->P != NULL && start->by_source != NULL;
}

/* From ever briefer steps, until two of them agree. Voltages that take a current away go with 1 / h, and rounding with
 * them: where they agree to rounding the longer one is better. */
static enum dalcs_status make_start(struct dalcs_periodic_flow *flow,
                                    const struct dalcs_orbit_span *span,
                                    struct dalcs_flow_start *start) {
    struct dalcs_flow_start before = {.mode = span->mode};
    struct dalcs_flow_start now = before;
    if (!start_setup(flow, &before) || !start_setup(flow, &now)) {
        return DALCS_E_NOMEM;
    }
    double h = (span->to - span->from) * dalcs_slight;
    double noise = 0.0;
    for (int k = 0; k < MOST_BRIEFER; k++, h *= dalcs_slight) {
        struct dalcs_flow_map *map;
        DALCS_TRY(dalcs_periodic_flow_map(flow, span, span->from, h, &map));
        extrapolate(flow, map, &now);
        const double off = k > 0 ? differ(flow, now.P, before.P) : INFINITY;
        if (off > dalcs_alike && off <= noise_of(flow, map)) {
            break;
        }
        noise = noise_of(flow, map);
        const struct dalcs_flow_start other = before;
        before = now;
        now = other;
        if (off <= dalcs_alike) {
            break;
        }
    }
    *start = before;
    start->changes_nothing = differ(flow, start->P, NULL) <= fmax(dalcs_alike, noise);
    return DALCS_OK;
}

enum dalcs_status dalcs_periodic_flow_start(struct dalcs_periodic_flow *flow,
                                            const struct dalcs_orbit_span *span,
                                            const struct dalcs_flow_start **found) {
    struct dalcs_flow_start *start = flow->smooth == NULL ? flow->made.start : NULL;
    while (start != NULL && !dalcs_mode_is(start->mode, span->mode, flow->stages.n_words)) {
        start = start->next;
    }
    if (start == NULL) {
        start = dalcs_arena_alloc(&flow->arena, 1, sizeof *start);
        if (start == NULL) {
            return DALCS_E_NOMEM;
        }
        DALCS_TRY(make_start(flow, span, start));
        start->next = flow->made.start;
        flow->made.start = start;
    }
    *found = start->changes_nothing ? NULL : start;
    return DALCS_OK;
}

/* ---- Set up -------------------------------------------------------------------------------------- */

static void add_wave(struct dalcs_excitation *e, int input, int n_nodes) {
    e->wave[e->n_waves++] = (struct dalcs_excitation_wave){
        .input = input, .first = e->n_functions, .n_functions = n_nodes, .has_level = true};
    for (int degree = 0; degree < n_nodes; degree++) {
        e->function[e->n_functions++] = (struct dalcs_excitation_function){
            .input = input, .shape = DALCS_EXCITATION_LEGENDRE, .degree = degree};
    }
}

/* Outputs of gates, each a level that is off for a while. */
static void add_pins(struct dalcs_periodic_flow *flow) {
    struct dalcs_excitation *e = &flow->excitation;
    for (int k = 0; k < flow->n_columns - flow->n_x; k++) {
        flow->drive.pin[k] = -1;
    }
    for (int i = 1; i < flow->system->n_inputs && flow->n_columns > flow->n_x; i++) {
        const int pin =
            dalcs_logic_pin_of(flow->orbit->log->gates->memory, flow->system->stimulus[i]);
        if (pin >= 0) {
            flow->drive.pin[pin] = e->n_functions;
            e->wave[e->n_waves++] = (struct dalcs_excitation_wave){
                .input = i, .first = e->n_functions, .n_functions = 1, .has_level = true};
            e->function[e->n_functions++] =
                (struct dalcs_excitation_function){.input = i, .shape = DALCS_EXCITATION_LEVEL};
        }
    }
}

/* Waves of the sources with a small signal, along Legendre polynomials, and of smooth sources; all else is no small
 * signal. */
static enum dalcs_status drive_setup(struct dalcs_periodic_flow *flow, int n_nodes) {
    struct dalcs_excitation *e = &flow->excitation;
    const size_t n = (size_t)flow->system->n_inputs;
    *e = (struct dalcs_excitation){
        .system = flow->system, .shortest_period = INFINITY, .next_edge = INFINITY};
    e->wave = dalcs_arena_alloc(&e->arena, 2 * n, sizeof *e->wave);
    e->function =
        dalcs_arena_alloc(&e->arena, n * (size_t)n_nodes + (size_t)(flow->n_columns - flow->n_x),
                          sizeof *e->function);
    e->constant = dalcs_arena_alloc(&e->arena, n, sizeof(double));
    if (e->wave == NULL || e->function == NULL || e->constant == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 1; k < flow->system->n_inputs; k++) {
        if (flow->drive.source[k] != 0.0) {
            add_wave(e, k, n_nodes);
        }
    }
    flow->drive.n = e->n_functions;
    add_pins(flow);
    for (int k = 0; k < flow->system->n_smooth; k++) {
        add_wave(e, flow->system->smooth[k].input, n_nodes);
    }
    return DALCS_OK;
}

/* flow->legendre: the inverse of the polynomials at the nodes. */
static enum dalcs_status legendre_setup(struct dalcs_periodic_flow *flow) {
    const int n = flow->stages.method->s + 1;
    double a[DALCS_MAX_NODES * DALCS_MAX_NODES];
    double inverse[DALCS_MAX_NODES * DALCS_MAX_NODES] = {0.0};
    int pivot[DALCS_MAX_NODES];
    for (int k = 0; k < n; k++) {
        const struct dalcs_excitation_function p = {.shape = DALCS_EXCITATION_LEGENDRE,
                                                    .degree = k};
        for (int i = 0; i < n; i++) {
            a[k * n + i] = dalcs_excitation_function_at(&p, 1.0, flow->stages.method->node[i]);
        }
        inverse[k * n + k] = 1.0;
    }
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, n, a, n, pivot, inverse, n) != 0) {
        return DALCS_SINGULAR;
    }
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < n; i++) {
            flow->legendre[k][i] = inverse[i * n + k];
        }
    }
    return DALCS_OK;
}

/* Stages of its own: those of the run have columns for the sources themselves. A map is made once and has all that is
 * asked of its factors, unless there are smooth sources, which have a map for each piece of one length. */
static enum dalcs_status stages_setup(struct dalcs_periodic_flow *flow) {
    const struct dalcs_stages *of = &flow->orbit->rates.part->stages;
    const struct dalcs_collocation *method =
        dalcs_collocation_of(DALCS_RADAU_IIA, DALCS_MAX_STAGES);
    DALCS_TRY(drive_setup(flow, method->s + 1));
    const size_t most_bytes = flow->system->n_smooth > 0 ? of->cache.most_bytes : 0;
    const struct dalcs_stage_limits limits = {of->dense_limit, of->rcond_min, most_bytes};
    DALCS_TRY(dalcs_stages_setup(&flow->stages, flow->system, &flow->excitation, method, &limits));
    flow->stages.block_of = of->block_of;
    return legendre_setup(flow);
}

/* flow->drive.turn: small signals of one phase are real beside it. */
static void find_turns(struct dalcs_periodic_flow *flow) {
    double complex first = 1.0;
    bool alike = true;
    for (int k = flow->system->n_inputs - 1; k > 0; k--) {
        first = flow->drive.source[k] != 0.0 ? flow->drive.source[k] / cabs(flow->drive.source[k])
                                             : first;
    }
    for (int k = 1; k < flow->system->n_inputs; k++) {
        alike = alike && cimag(flow->drive.source[k] * conj(first)) == 0.0;
    }
    flow->drive.n_turns = alike ? 1 : 2;
    flow->drive.turn[0] = alike ? first : 1.0;
    flow->drive.turn[1] = I;
}

static enum dalcs_status setup(struct dalcs_periodic_flow *flow, const double complex *source) {
    const size_t n_x = (size_t)flow->n_x;
    const size_t n_inputs = (size_t)flow->system->n_inputs;
    flow->drive.source = dalcs_arena_alloc(&flow->arena, n_inputs, sizeof *flow->drive.source);
    flow->drive.pin = dalcs_arena_alloc(&flow->arena, (size_t)(flow->n_columns - flow->n_x) + 1,
                                        sizeof *flow->drive.pin);
    if (flow->drive.source == NULL || flow->drive.pin == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(flow->drive.source, source, n_inputs * sizeof *source);
    find_turns(flow);
    DALCS_TRY(stages_setup(flow));
    const size_t n_out = dalcs_stages_room(&flow->stages);
    flow->M = dalcs_arena_alloc(&flow->arena, n_x * n_x, sizeof(double));
    DALCS_TRY(dalcs_periodic_flow_rows(flow));
    flow->work.rows =
        dalcs_arena_alloc(&flow->arena, dalcs_periodic_flow_size(flow), sizeof(double));
    flow->work.in = dalcs_arena_alloc(&flow->arena, (size_t)flow->stages.n_in, sizeof(double));
    flow->work.out = dalcs_arena_alloc(&flow->arena, n_out, sizeof(double));
    if (flow->M == NULL || flow->work.rows == NULL || flow->work.in == NULL ||
        flow->work.out == NULL) {
        return DALCS_E_NOMEM;
    }
    if (flow->system->n_smooth > 0) {
        const int n_pins = flow->n_columns - flow->n_x;
        int first = flow->drive.n;
        for (int k = 0; k < n_pins; k++) {
            first += flow->drive.pin[k] >= 0 ? 1 : 0;
        }
        DALCS_TRY(dalcs_flow_smooth_setup(flow, first));
    }
    return dalcs_periodic_pieces_make(flow);
}

enum dalcs_status dalcs_periodic_flow_setup(struct dalcs_periodic_flow *flow,
                                            const struct dalcs_orbit_part *orbit,
                                            const struct dalcs_periodic_flow_asked *asked) {
    const struct dalcs_system *system = orbit->rates.part->component->system;
    const struct dalcs_orbit_gates *gates = orbit->log->gates;
    const int n_pins = gates != NULL ? gates->memory->n_pins : 0;
    *flow = (struct dalcs_periodic_flow){.orbit = orbit,
                                         .system = system,
                                         .asked = *asked,
                                         .fastest = asked->fastest,
                                         .period = asked->period,
                                         .n_x = system->n_x,
                                         .n_columns = system->n_x + n_pins,
                                         .unit = orbit->rates.unit};
    enum dalcs_status status = setup(flow, asked->source);
    if (status != DALCS_OK) {
        dalcs_periodic_flow_finish(flow);
    }
    return status;
}

void dalcs_periodic_flow_finish(struct dalcs_periodic_flow *flow) {
    if (flow->stages.system != NULL) {
        dalcs_stages_finish(&flow->stages);
    }
    HASH_CLEAR(hh, flow->made.map);
    dalcs_arena_finish(&flow->excitation.arena);
    dalcs_arena_finish(&flow->arena);
    free(flow->pieces.piece);
    *flow = (struct dalcs_periodic_flow){0};
}
