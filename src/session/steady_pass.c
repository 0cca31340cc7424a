/* steady_pass.c - a run of some periods from a given point. */
#include "steady.h"

#include "orbit_log.h"
#include "radau.h"
#include "steady_means.h"
#include "steady_watch.h"
#include "transient.h"
#include "variation.h"

#include <math.h>
#include <string.h>

/* A state is measured by its own largest value on the way, but that of one that hardly moves beside others
 * of its unit is rounding of theirs. */
static const double least_scale = 1e-5;

enum dalcs_status dalcs_steady_start(const struct dalcs_orbit_point *point, struct dalcs_euler *e,
                                     struct dalcs_radau *radau) {
    struct dalcs_arena arena = {0};
    double **initial = dalcs_arena_alloc(&arena, (size_t)e->n_components, sizeof(*initial));
    if (initial == NULL) {
        return DALCS_E_NOMEM;
    }
    double *x = point->x;
    const bool *closed = point->closed;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        initial[k] = x;
        x += c->system->n_x;
        for (int i = 0; i < c->n_switches; i++) {
            dalcs_osnsp_command(&c->osnsp, c->switch_pair[i], closed[c->switch_pair[i]]);
        }
        closed += c->system->n_pairs;
    }
    enum dalcs_status status = dalcs_radau_start(radau, initial);
    dalcs_arena_finish(&arena);
    return status;
}

void dalcs_steady_read(const struct dalcs_euler *e, struct dalcs_orbit_point *point) {
    double *x = point->x;
    bool *closed = point->closed;
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_component *c = &e->component[k];
        memcpy(x, c->y, (size_t)c->system->n_x * sizeof(double));
        for (int i = 0; i < c->n_switches; i++) {
            closed[c->switch_pair[i]] = dalcs_osnsp_is_on(&c->osnsp, c->switch_pair[i]);
        }
        x += c->system->n_x;
        closed += c->system->n_pairs;
    }
}

static enum dalcs_status go(struct dalcs_radau *radau, const struct dalcs_run *r,
                            struct dalcs_steady_means *means,
                            const struct dalcs_steady_watch *watch) {
    const long interval = dalcs_transient_progress_interval(&r->s->network);
    double t = 0.0;
    long n = 0;
    DALCS_TRY(dalcs_run_progress(r, t, radau->options.stop)); /* passes are short, and many */
    while (t < radau->options.stop && (watch == NULL || !dalcs_steady_watch_is_full(watch))) {
        bool happens;
        t = fmin(dalcs_radau_next_stop(radau, &happens), radau->options.stop);
        radau->base->t = t;
        DALCS_TRY(means != NULL ? dalcs_steady_means_reach(means, t) : DALCS_OK);
        if (means != NULL && t >= radau->options.stop) {
            DALCS_TRY(dalcs_radau_evaluate(radau, t, DALCS_LEFT));
        }
        DALCS_TRY(dalcs_radau_pass(radau, t));
        if (++n % interval == 0) {
            DALCS_TRY(dalcs_run_progress(r, t, radau->options.stop));
        }
    }
    return DALCS_OK;
}

static void read_point(struct dalcs_steady *st, const struct dalcs_radau *radau) {
    const struct dalcs_steady_layout *l = &st->layout;
    double largest[2] = {0.0, 0.0};
    for (int k = 0; k < radau->n_parts; k++) {
        for (int unit = 0; unit < 2 && radau->part[k].kind == DALCS_PART_STEPPED; unit++) {
            largest[unit] = fmax(largest[unit], radau->part[k].scales.unit[unit]);
        }
    }
    for (int k = 0; k < radau->n_parts; k++) {
        const struct dalcs_radau_part *part = &radau->part[k];
        const struct dalcs_system *s = part->component->system;
        for (int x = 0; x < s->n_x; x++) {
            st->then.x[l->first[k] + x] = part->x[x];
            st->scale[l->first[k] + x] = fmax(
                fmax(part->scales.column[x], fmax(fabs(part->segment.in[x]), fabs(part->x[x]))),
                least_scale * largest[s->column_is_current[x]]);
        }
        for (int d = 0; d < s->n_pairs; d++) {
            st->then.closed[l->first_pair[k] + d] = s->pair[d].kind == DALCS_PAIR_SWITCH &&
                                                    dalcs_osnsp_is_on(&part->component->osnsp, d);
        }
    }
}

static void read_signature(struct dalcs_steady *st, const struct dalcs_variation *variation) {
    st->signature = 0;
    for (int k = 0; k < variation->n_parts; k++) {
        st->signature = st->signature * 31 + variation->part[k].signature;
    }
}

/* Of the part whose first event comes first. */
static void read_phase(struct dalcs_steady *st, const struct dalcs_variation *variation) {
    const struct dalcs_variation_part *first = NULL;
    int index = 0;
    memset(st->phase, 0, (size_t)st->layout.n_x * sizeof(double));
    for (int k = 0; k < variation->n_parts; k++) {
        const struct dalcs_variation_part *v = &variation->part[k];
        if (v->n_x > 0 && isfinite(v->moved) && (first == NULL || v->moved < first->moved)) {
            first = v;
            index = k;
        }
    }
    if (first != NULL) {
        memcpy(st->phase + st->layout.first[index], first->moves,
               (size_t)first->n_x * sizeof(double));
    }
}

static void read_M(struct dalcs_steady *st, const struct dalcs_variation *variation) {
    st->is_exact = true;
    for (int k = 0; k < variation->n_parts; k++) {
        const struct dalcs_variation_part *v = &variation->part[k];
        memcpy(st->M + st->layout.first_of_M[k], v->v,
               (size_t)v->n_x * (size_t)v->n_x * sizeof(double));
        memcpy(st->first + st->layout.first[k], v->first, (size_t)v->n_x * sizeof(double));
        memcpy(st->last + st->layout.first[k], v->last, (size_t)v->n_x * sizeof(double));
        st->is_exact = st->is_exact && v->is_exact;
    }
}

/* All periods once the run has started. */
static enum dalcs_status go_with_means(struct dalcs_steady *st, struct dalcs_radau *radau) {
    const struct dalcs_session *s = st->run->s;
    struct dalcs_steady_means means;
    DALCS_TRY(dalcs_steady_means_setup(&means, &s->circuit, &s->network, radau));
    enum dalcs_status status = go(radau, st->run, &means, NULL);
    const double duration = radau->options.stop;
    for (int k = 0; k < s->network.n_outputs; k++) {
        st->found.average[k] = means.sum[k] / duration;
        st->found.rms[k] = sqrt(means.square[k] / duration);
    }
    dalcs_steady_means_finish(&means);
    dalcs_recorder_states(&s->network, radau->base, st->found.state);
    return status;
}

static enum dalcs_status start(struct dalcs_steady *st, struct dalcs_euler *e,
                               struct dalcs_radau *radau) {
    return st->has_point ? dalcs_steady_start(&st->at, e, radau)
                         : dalcs_transient_start(st->run, e, radau, NULL);
}

static enum dalcs_status run_periods(struct dalcs_steady *st, struct dalcs_euler *e,
                                     struct dalcs_radau *radau, enum dalcs_steady_asked asked) {
    const bool with_M = asked == DALCS_STEADY_M;
    const bool with_modes = st->run->s->near != NULL && !with_M; /* they tell two runs apart */
    struct dalcs_variation variation = {0};
    struct dalcs_observer observer;
    if (with_M || with_modes) {
        DALCS_TRY(dalcs_variation_setup(&variation, radau, !with_M));
        observer = dalcs_variation_observer(&variation);
        e->observer = &observer;
    }
    enum dalcs_status status = start(st, e, radau);
    if (status == DALCS_OK) {
        status =
            asked == DALCS_STEADY_MEANS ? go_with_means(st, radau) : go(radau, st->run, NULL, NULL);
    }
    if (status == DALCS_OK) {
        read_point(st, radau);
    }
    if (status == DALCS_OK && (with_M || with_modes)) {
        read_signature(st, &variation);
        status = variation.status;
    }
    if (status == DALCS_OK && with_M) {
        read_M(st, &variation);
        read_phase(st, &variation);
    }
    e->observer = NULL;
    dalcs_variation_finish(&variation);
    return status;
}

static enum dalcs_status run_watched(struct dalcs_steady *st, struct dalcs_euler *e,
                                     struct dalcs_radau *radau, struct dalcs_steady_watch *watch) {
    struct dalcs_observer observer;
    if (watch != NULL) {
        observer = dalcs_steady_watch_observer(watch);
        e->observer = &observer;
    }
    enum dalcs_status status = start(st, e, radau);
    status = status == DALCS_OK ? go(radau, st->run, NULL, watch) : status;
    e->observer = NULL;
    if (status == DALCS_OK) {
        read_point(st, radau);
    }
    return status == DALCS_OK && watch != NULL ? watch->status : status;
}

enum dalcs_status dalcs_steady_pass_watched(struct dalcs_steady *st, double duration,
                                            struct dalcs_steady_watch *watch, bool *recurs,
                                            int *from, int *to) {
    struct dalcs_run *r = st->run;
    struct dalcs_euler e;
    struct dalcs_radau radau = {0};
    const struct dalcs_radau_options options = dalcs_transient_options(r, duration);
    DALCS_TRY(dalcs_euler_setup(&e, &r->s->circuit, &r->s->network, &r->osnsp, 1e-3 * duration,
                                duration));
    enum dalcs_status status = dalcs_radau_setup(&radau, &e, &options, &r->osnsp);
    if (status == DALCS_OK) {
        status = run_watched(st, &e, &radau, watch);
        r->s->report.work.steps += radau.steps;
    }
    if (status == DALCS_OK && watch != NULL) {
        *recurs = dalcs_steady_watch_recurs(watch, &radau, from, to);
    }
    status = dalcs_explain_failure(r, &e, status);
    dalcs_radau_finish(&radau);
    dalcs_euler_finish(&e);
    return status;
}

void dalcs_steady_find_residual(struct dalcs_steady *st) {
    st->residual = 0.0;
    for (int x = 0; x < st->layout.n_x; x++) {
        double off = fabs(st->then.x[x] - st->at.x[x]);
        st->residual = off > 0.0 ? fmax(st->residual, off / st->scale[x]) : st->residual;
    }
}

enum dalcs_status dalcs_steady_pass(struct dalcs_steady *st, long n,
                                    enum dalcs_steady_asked asked) {
    struct dalcs_run *r = st->run;
    const double stop = (double)n * st->period;
    struct dalcs_euler e;
    struct dalcs_radau radau = {0};
    const struct dalcs_radau_options options = dalcs_transient_options(r, stop);
    DALCS_TRY(dalcs_euler_setup(&e, &r->s->circuit, &r->s->network, &r->osnsp, r->h, stop));
    enum dalcs_status status = dalcs_radau_setup(&radau, &e, &options, &r->osnsp);
    if (status == DALCS_OK) {
        status = run_periods(st, &e, &radau, asked);
        st->n.periods += n;
        r->s->report.work.steps += radau.steps;
    }
    status = asked == DALCS_STEADY_M ? status : dalcs_explain_failure(r, &e, status);
    dalcs_radau_finish(&radau);
    dalcs_euler_finish(&e);
    if (status == DALCS_OK && st->has_point) {
        dalcs_steady_find_residual(st);
    }
    return status;
}

enum dalcs_status dalcs_steady_log(struct dalcs_steady *st, struct dalcs_euler *e,
                                   struct dalcs_radau *radau, struct dalcs_orbit_log *log) {
    struct dalcs_observer observer = dalcs_orbit_log_observer(log);
    e->observer = &observer;
    enum dalcs_status status = dalcs_steady_start(&st->at, e, radau);
    status = status == DALCS_OK ? go(radau, st->run, NULL, NULL) : status;
    status = status == DALCS_OK ? log->status : status;
    e->observer = NULL;
    if (status == DALCS_OK) {
        read_point(st, radau);
    }
    return status == DALCS_OK ? dalcs_orbit_log_close(log, st->period) : status;
}

void dalcs_steady_take(struct dalcs_steady *st) {
    struct dalcs_orbit_point point = st->at;
    st->at = st->then;
    st->then = point;
    st->has_point = true;
}

/* ---- Set up -------------------------------------------------------------------------------------- */

static bool make_point(struct dalcs_arena *arena, const struct dalcs_steady_layout *l,
                       struct dalcs_orbit_point *point) {
    point->x = dalcs_arena_alloc(arena, (size_t)l->n_x + 1, sizeof(double));
    point->closed = dalcs_arena_alloc(arena, (size_t)l->n_pairs + 1, sizeof(bool));
    return point->x != NULL && point->closed != NULL;
}

enum dalcs_status dalcs_steady_setup(struct dalcs_steady *st, struct dalcs_run *r, double period) {
    const struct dalcs_network *network = &r->s->network;
    const size_t n = (size_t)network->n_systems + 1;
    *st = (struct dalcs_steady){.run = r, .period = period};
    struct dalcs_steady_layout *l = &st->layout;
    l->n_systems = network->n_systems;
    l->first = dalcs_arena_alloc(&st->arena, n, sizeof(*l->first));
    l->first_pair = dalcs_arena_alloc(&st->arena, n, sizeof(*l->first_pair));
    l->first_of_M = dalcs_arena_alloc(&st->arena, n, sizeof(*l->first_of_M));
    bool complete = l->first != NULL && l->first_pair != NULL && l->first_of_M != NULL;
    for (int k = 0; k < l->n_systems && complete; k++) {
        const struct dalcs_system *s = &network->system[k];
        l->first[k + 1] = l->first[k] + s->n_x;
        l->first_pair[k + 1] = l->first_pair[k] + s->n_pairs;
        l->first_of_M[k + 1] = l->first_of_M[k] + (size_t)s->n_x * (size_t)s->n_x;
        l->n_x = l->first[k + 1];
        l->n_pairs = l->first_pair[k + 1];
    }
    if (complete) {
        const size_t n_x = (size_t)l->n_x + 1;
        st->M = dalcs_arena_alloc(&st->arena, l->first_of_M[l->n_systems] + 1, sizeof(double));
        st->scale = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->step = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->drift = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->first = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->last = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->phase = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->found.state =
            dalcs_arena_alloc(&r->s->arena, (size_t)network->n_states + 1, sizeof(double));
        st->found.average =
            dalcs_arena_alloc(&st->arena, (size_t)network->n_outputs + 1, sizeof(double));
        st->found.rms =
            dalcs_arena_alloc(&st->arena, (size_t)network->n_outputs + 1, sizeof(double));
        st->conserved = dalcs_arena_alloc(&st->arena, n_x, sizeof(*st->conserved));
        complete = make_point(&st->arena, l, &st->at) && make_point(&st->arena, l, &st->then) &&
                   st->M != NULL && st->phase != NULL && st->first != NULL && st->last != NULL &&
                   st->scale != NULL && st->step != NULL && st->drift != NULL &&
                   st->found.state != NULL && st->found.average != NULL && st->found.rms != NULL &&
                   st->conserved != NULL;
    }
    if (!complete) {
        dalcs_steady_finish(st);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_steady_finish(struct dalcs_steady *st) {
    dalcs_arena_finish(&st->arena);
    *st = (struct dalcs_steady){0};
}
