/* euler.c - the time loop of implicit Euler over all components. */
#include "euler_internal.h"

#include <math.h>
#include <string.h>

/* A vanishing step over a step: 2^-MICRO. */
enum { MICRO = 20 };

enum dalcs_status dalcs_euler_setup(struct dalcs_euler *e, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_osnsp_options *options, double h,
                                    double stop) {
    *e = (struct dalcs_euler){.circuit = circuit,
                              .network = network,
                              .h = h,
                              .failure.system = -1,
                              .worst.certificate.where = -1};
    size_t n = (size_t)network->n_systems;
    size_t columns = 1;
    size_t pairs = 1;
    enum dalcs_status status = DALCS_OK;
    e->component = dalcs_arena_alloc(&e->arena, n, sizeof(*e->component));
    if (e->component == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_osnsp_options share = *options;
    share.cache_bytes = options->cache_bytes / (n > 0 ? n : 1);
    for (int k = 0; k < network->n_systems && status == DALCS_OK; k++) {
        const struct dalcs_system *s = &network->system[k];
        size_t n_columns = (size_t)dalcs_system_n_columns(s);
        columns = n_columns > columns ? n_columns : columns;
        pairs = (size_t)s->n_pairs > pairs ? (size_t)s->n_pairs : pairs;
        status = dalcs_component_setup(&e->component[k], circuit, s, &share);
        e->n_components = k + 1;
    }
    e->after = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->charge = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    e->flux = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    e->telling.to = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->telling.from = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->telling.noise = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->jump.after = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->jump.charge = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    e->jump.flux = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    bool complete = e->after != NULL && e->charge != NULL && e->flux != NULL &&
                    e->telling.to != NULL && e->telling.from != NULL && e->telling.noise != NULL &&
                    e->jump.after != NULL && e->jump.charge != NULL && e->jump.flux != NULL;
    if (status == DALCS_OK && !complete) {
        status = DALCS_E_NOMEM;
    }
    if (status != DALCS_OK) {
        dalcs_euler_finish(e);
        return status;
    }
    dalcs_grid_init(&e->grid, h, stop, circuit->n_stimuli, circuit->stimulus);
    return DALCS_OK;
}

void dalcs_euler_finish(struct dalcs_euler *e) {
    for (int k = 0; k < e->n_components; k++) {
        dalcs_component_finish(&e->component[k]);
    }
    dalcs_arena_finish(&e->arena);
    dalcs_jumps_finish(&e->jumps);
    *e = (struct dalcs_euler){0};
}

static void note_failure(struct dalcs_euler *e, int k, double sigma, const double *u) {
    struct dalcs_component *c = &e->component[k];
    c->failure.sigma = sigma;
    c->failure.u = u;
    c->failure.restless.pair = -1;
    e->failure.system = k;
    e->failure.time = e->t;
    e->failure.h = sigma > 0.0 ? 1.0 / sigma : e->h;
}

enum dalcs_status dalcs_euler_solve(struct dalcs_euler *e, int k, double sigma, const double *u,
                                    double *y) {
    struct dalcs_component *c = &e->component[k];
    enum dalcs_status status = dalcs_component_solve(c, sigma, u, y);
    if (status != DALCS_OK) {
        note_failure(e, k, sigma, u);
        return status;
    }
    if (c->osnsp.certificate.worst > e->worst.certificate.worst) {
        e->worst.certificate = c->osnsp.certificate;
        e->worst.time = e->t;
        e->worst.system = k;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_euler_tell_open(struct dalcs_euler *e, int k) {
    struct dalcs_component *c = &e->component[k];
    struct dalcs_osnsp *p = &c->osnsp;
    if (e->listener.on_open == NULL || !dalcs_osnsp_is_open(p)) {
        return DALCS_OK;
    }
    double scale[2];
    bool vanishes;
    dalcs_osnsp_find_ties(p, c->u, c->y, scale);
    return e->listener.on_open(
        e->listener.open_user,
        &(struct dalcs_open_instant){.time = e->t,
                                     .engine = e,
                                     .system = k,
                                     .at_operating_point = e->failure.at_operating_point,
                                     .mode = p->mode,
                                     .w = p->w,
                                     .tied = p->signs.tied,
                                     .scale = {scale[0], scale[1]}},
        &vanishes);
}

enum dalcs_status dalcs_euler_operating_point(struct dalcs_euler *e, bool transient_follows) {
    e->failure.at_operating_point = true;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        dalcs_component_sample_operating(c, transient_follows, c->u);
        const bool refines = c->osnsp.asks.refines;
        c->osnsp.asks.refines = true; /* one answer, to the digits that the file has */
        const enum dalcs_status status = dalcs_euler_solve(e, k, 0.0, c->u, c->y);
        c->osnsp.asks.refines = refines;
        DALCS_TRY(status);
        memcpy(c->u, c->y, (size_t)c->system->n_x * sizeof(double));
    }
    if (e->listener.on_operating_point != NULL) {
        DALCS_TRY(e->listener.on_operating_point(e->circuit, e));
    }
    for (int k = 0; k < e->n_components; k++) {
        DALCS_TRY(dalcs_euler_tell_open(e, k));
    }
    e->failure.at_operating_point = false;
    return DALCS_OK;
}

enum dalcs_status dalcs_euler_start(struct dalcs_euler *e, double *const *initial) {
    e->failure.looks_behind = true;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        size_t n_x = (size_t)c->system->n_x;
        size_t n_columns = (size_t)dalcs_system_n_columns(c->system);
        dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->u);
        if (initial != NULL) {
            memcpy(c->u, initial[k], n_x * sizeof(double));
            memset(c->y_before, 0, n_columns * sizeof(double));
            memcpy(c->y_before, c->u, n_x * sizeof(double));
        } else {
            memcpy(c->y_before, c->y, n_columns * sizeof(double));
        }
        if (e->listener.observer != NULL) {
            e->listener.observer->start(e->listener.observer->user, k, c->u);
        }
        if (initial != NULL || dalcs_component_jumps_at_start(c)) {
            DALCS_TRY(dalcs_euler_settle_after(e, k, c->y_before, c->u, c->y));
        }
    }
    for (int k = 0; initial != NULL && k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        c->was_open = dalcs_osnsp_is_open(&c->osnsp);
        if (c->is_static) {
            DALCS_TRY(dalcs_euler_tell_open(e, k));
        }
    }
    e->failure.looks_behind = false;
    return DALCS_OK;
}

/* What is open at one instant only, as where diodes commutate, is left out. */
static enum dalcs_status tell_what_stays_open(struct dalcs_euler *e) {
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        bool open = !c->is_static && dalcs_osnsp_is_open(&c->osnsp);
        if (open && c->was_open) {
            DALCS_TRY(dalcs_euler_tell_open(e, k));
        }
        c->was_open = open;
    }
    return DALCS_OK;
}

/* After a step: how large states and answers have been. */
static void note_scale(struct dalcs_component *c) {
    for (int x = 0; x < c->system->n_x; x++) {
        double size = fabs(c->y[x]);
        c->largest[x] = size > c->largest[x] ? size : c->largest[x];
    }
    c->scale[0] = fmax(c->scale[0], c->osnsp.certificate.volt);
    c->scale[1] = fmax(c->scale[1], c->osnsp.certificate.ampere);
}

/* The switches of component k do not agree with its answer. If they would not in vanishing steps from the same state either,
 * a step in one of their positions is none of the circuit. */
static enum dalcs_status check_limit(struct dalcs_euler *e, int k, double sigma) {
    struct dalcs_component *c = &e->component[k];
    const size_t bytes = (size_t)c->osnsp.n_words * sizeof(uint64_t);
    struct dalcs_restless found;
    memcpy(c->saved_mode, c->osnsp.mode, bytes);
    const struct dalcs_restless_step vanishing = {
        .sigma = ldexp(sigma, MICRO), .u = c->u, .moving = c->probe_u};
    DALCS_TRY(dalcs_restless_find(&c->positions, false, &vanishing, c->probe_y, &found));
    memcpy(c->osnsp.mode, c->saved_mode, bytes);
    if (found.pair >= 0) {
        note_failure(e, k, sigma, c->u);
        c->failure.restless = found;
        return DALCS_INFEASIBLE;
    }
    return dalcs_osnsp_solve(&c->osnsp, sigma, c->u, c->y);
}

static enum dalcs_status solve_step(struct dalcs_euler *e, int k, double sigma) {
    struct dalcs_component *c = &e->component[k];
    sigma = c->system->n_x > 0 ? sigma : 0.0;
    DALCS_TRY(dalcs_euler_solve(e, k, sigma, c->u, c->y));
    return c->positions.settled ? DALCS_OK : check_limit(e, k, sigma);
}

enum dalcs_status dalcs_euler_step(struct dalcs_euler *e) {
    e->t_before = e->t;
    double h = dalcs_grid_advance(&e->grid, &e->at_jump);
    e->t = e->grid.t;
    e->h = h;
    double sigma = 1.0 / h;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        if (c->is_static) {
            continue;
        }
        double *swap = c->y_before;
        c->y_before = c->y;
        c->y = swap;
        size_t n_x = (size_t)c->system->n_x;
        dalcs_component_sample(c, e->t, DALCS_LEFT, c->u);
        DALCS_TRY(solve_step(e, k, sigma));
        note_scale(c);
        if (dalcs_component_overgrows(c, c->y)) {
            e->failure.system = k;
            e->failure.time = e->t;
            return DALCS_NOT_CONVERGED;
        }
        if (e->listener.observer != NULL) {
            e->listener.observer->scale(e->listener.observer->user, k, &c->osnsp.certificate);
        }
        if (e->listener.detects_jumps && c->commands.moved && n_x > 0) {
            size_t mode_bytes = (size_t)c->osnsp.n_words * sizeof(uint64_t);
            memcpy(c->saved_mode, c->osnsp.mode, mode_bytes);
            double length;
            enum dalcs_status status =
                dalcs_euler_look_after(e, k, c->y_before, c->u, c->probe_y, &length);
            if (status < DALCS_OK) {
                return status; /* without a micro-step there is no jump to report, no more */
            }
            memcpy(c->osnsp.mode, c->saved_mode, mode_bytes);
        }
        if (e->listener.observer != NULL) {
            e->listener.observer->step(e->listener.observer->user, k, c->u, c->y, c->u + n_x, h);
        }
        memcpy(c->u, c->y, n_x * sizeof(double));
    }
    e->steps++;
    return e->listener.on_open != NULL ? tell_what_stays_open(e) : DALCS_OK;
}

enum dalcs_status dalcs_euler_cross(struct dalcs_euler *e) {
    e->failure.looks_behind = true;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        dalcs_component_sample(c, e->t, DALCS_RIGHT, c->probe_u);
        bool changes = false;
        for (int i = 0; i < c->varying.n; i++) {
            int input = c->system->n_x + c->varying.input[i];
            changes = changes || c->probe_u[input] != c->u[input];
        }
        if (changes) {
            dalcs_component_sample(c, e->t, DALCS_RIGHT, c->u);
            memcpy(c->probe_y, c->y, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
            DALCS_TRY(dalcs_euler_settle_after(e, k, c->probe_y, c->u, c->y));
        }
    }
    e->failure.looks_behind = false;
    return DALCS_OK;
}
