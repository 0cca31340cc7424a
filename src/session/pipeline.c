/* pipeline.c - running: DALCS -> one OSNSP per step -> certified rows.
 *
 * dalcs_session_run at the end is the table of contents. */
#include "session_internal.h"

#include "thinning.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

/* Unknowns solved for between calls of the sink's progress, a fraction of a second of work, but no
 * more steps than that. */
enum { PROGRESS_UNKNOWNS = 1 << 18, PROGRESS_STEPS = 4096 };

static enum dalcs_status name_signals(struct dalcs_run *r) {
    const struct dalcs_network *n = &r->s->network;
    r->name = dalcs_arena_alloc(&r->s->arena, (size_t)n->n_outputs, sizeof(*r->name));
    r->unit = dalcs_arena_alloc(&r->s->arena, (size_t)n->n_outputs, sizeof(*r->unit));
    if (r->name == NULL || r->unit == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n->n_outputs; i++) {
        r->name[i] = n->output[i].name;
        r->unit[i] = n->output[i].is_current ? DALCS_AMPERE : DALCS_VOLT;
    }
    return DALCS_OK;
}

static enum dalcs_status begin_plot(struct dalcs_run *r, enum dalcs_analysis analysis) {
    struct dalcs_plot *plot = dalcs_arena_alloc(&r->s->arena, 1, sizeof(*plot));
    if (plot == NULL) {
        return DALCS_E_NOMEM;
    }
    *plot = (struct dalcs_plot){.analysis = analysis,
                                .title = r->s->circuit.title,
                                .n_signals = (size_t)r->s->network.n_outputs,
                                .name = r->name,
                                .unit = r->unit};
    return r->sink->begin(r->sink->user, plot);
}

/* Switches that no command agreed with what followed from it. */
static void warn_of_switches(struct dalcs_run *r, const struct dalcs_component *c, long steps) {
    if (c->delayed_commands == 0) {
        return;
    }
    if (steps == 0 || c->is_static) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, NULL,
                       "a switch and the voltage that controls it do not agree, open or closed; "
                       "the values are those of its last command");
    } else {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, NULL,
                       "in %ld one-step problem%s a switch and the voltage that controls it did "
                       "not agree; its last command stood until the next one",
                       c->delayed_commands, c->delayed_commands == 1 ? "" : "s");
    }
}

/* The counts of one engine run into the report. */
static void add_work(struct dalcs_run *r, const struct dalcs_euler *e) {
    struct dalcs_report *report = &r->s->report;
    report->work.steps += e->steps;
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_osnsp_counters *c = &e->component[k].osnsp.counters;
        report->work.osnsp += c->solved;
        report->work.pivots += c->pivots;
        report->work.factorizations += c->factorizations;
        report->work.cache_hits += c->cache_hits;
        report->work.singular += c->singular;
        warn_of_switches(r, &e->component[k], e->steps);
    }
    if (e->worst.worst >= report->certificate.worst) {
        const char *where = dalcs_explain_row(r->s, e, e->worst_system, e->worst.where);
        report->certificate.worst = e->worst.worst;
        report->certificate.time = e->worst_time;
        report->certificate.where = where == NULL ? "" : where;
    }
}

static enum dalcs_status run_operating_point(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler e;
    DALCS_TRY(dalcs_euler_setup(&e, &s->circuit, &s->network, &r->osnsp, 1.0, 1.0));
    enum dalcs_status status = dalcs_euler_operating_point(&e, s->circuit.transient.present);
    if (status == DALCS_OK) {
        status = begin_plot(r, DALCS_OPERATING_POINT);
    }
    double *row = dalcs_alloc((size_t)s->network.n_outputs, sizeof(*row));
    if (status == DALCS_OK && row == NULL) {
        status = DALCS_E_NOMEM;
    }
    if (status == DALCS_OK) {
        dalcs_recorder_evaluate(&s->network, &e, row);
        status = r->sink->row(r->sink->user, 0.0, row);
    }
    if (status == DALCS_OK) {
        status = r->sink->end(r->sink->user);
    }
    if (status == DALCS_OK && !s->circuit.transient.present) {
        dalcs_recorder_states(&s->network, &e, s->start);
        dalcs_recorder_states(&s->network, &e, s->final);
    }
    free(row);
    dalcs_explain_failure(r, &e, status);
    add_work(r, &e);
    dalcs_euler_finish(&e);
    return status;
}

static struct dalcs_schedule choose_schedule(const struct dalcs_run *r) {
    const struct dalcs_transient *t = &r->s->circuit.transient;
    struct dalcs_schedule schedule = {.start = t->start, .step = t->step, .stop = t->stop};
    double ratio = t->step / r->h;
    if (r->options->at != NULL) {
        schedule.kind = DALCS_AT_TIMES;
        schedule.at = r->options->at;
        schedule.n_at = r->options->n_at;
    } else if (ratio >= 1.0 - 1e-9 && fabs(ratio - rint(ratio)) <= 1e-9 * ratio) {
        schedule.kind = DALCS_ON_GRID;
    } else {
        schedule.kind = DALCS_EVERY_STEP; /* the print grid does not fall on steps */
    }
    return schedule;
}

/* The operating point with .ic held, by a network of its own; its states start the transient. */
static enum dalcs_status start_from_clamps(struct dalcs_run *r, struct dalcs_euler *e) {
    struct dalcs_session *s = r->s;
    struct dalcs_network clamped;
    struct dalcs_euler held;
    DALCS_TRY(dalcs_network_build(&clamped, &s->circuit,
                                  &(struct dalcs_network_options){.clamp_initial_conditions = true},
                                  &s->diag));
    enum dalcs_status status = dalcs_euler_setup(&held, &s->circuit, &clamped, &r->osnsp, 1.0, 1.0);
    if (status != DALCS_OK) {
        dalcs_network_finish(&clamped);
        return status;
    }
    double **initial = dalcs_alloc((size_t)held.n_components, sizeof(*initial));
    status = initial == NULL ? DALCS_E_NOMEM : dalcs_euler_operating_point(&held, true);
    dalcs_explain_failure(r, &held, status);
    add_work(r, &held);
    if (status == DALCS_OK) {
        for (int k = 0; k < held.n_components; k++) {
            initial[k] = held.component[k].u; /* the same x: clamps add algebraic unknowns only */
        }
        status = dalcs_euler_start(e, initial);
    }
    free(initial);
    dalcs_euler_finish(&held);
    dalcs_network_finish(&clamped);
    return status;
}

static enum dalcs_status start_transient(struct dalcs_run *r, struct dalcs_euler *e) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (c->transient.use_initial_conditions) {
        return dalcs_euler_start(e, r->s->network.initial);
    }
    if (c->n_initial_conditions > 0) {
        return start_from_clamps(r, e);
    }
    DALCS_TRY(dalcs_euler_operating_point(e, true));
    return dalcs_euler_start(e, NULL);
}

/* Steps between calls of the sink's progress. */
static long progress_interval(const struct dalcs_network *n) {
    long n_unknowns = 1;
    for (int k = 0; k < n->n_systems; k++) {
        n_unknowns += dalcs_system_n_columns(&n->system[k]);
    }
    long n_steps = PROGRESS_UNKNOWNS / n_unknowns;
    return n_steps < 1 ? 1 : n_steps < PROGRESS_STEPS ? n_steps : PROGRESS_STEPS;
}

static enum dalcs_status step_to_the_end(struct dalcs_run *r, struct dalcs_euler *e) {
    struct dalcs_recorder *recorder = &r->s->recorder;
    const long interval = progress_interval(&r->s->network);
    while (!dalcs_grid_at_end(&e->grid)) {
        DALCS_TRY(dalcs_euler_step(e));
        DALCS_TRY(dalcs_recorder_step(recorder, e));
        if (e->at_jump && !dalcs_grid_at_end(&e->grid)) {
            DALCS_TRY(dalcs_euler_cross(e));
            DALCS_TRY(dalcs_recorder_cross(recorder, e));
        }
        if (e->steps % interval == 0) {
            DALCS_TRY(r->sink->progress(r->sink->user, e->t, e->grid.stop));
        }
    }
    return DALCS_OK;
}

/* All components go with implicit Euler. */
static enum dalcs_status report_euler(struct dalcs_run *r) {
    const size_t n = (size_t)r->s->network.n_systems;
    struct dalcs_component_method *component =
        dalcs_arena_alloc(&r->s->arena, n, sizeof(*component));
    if (component == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        component[k] = (struct dalcs_component_method){.method = "euler", .stages = 1};
    }
    r->s->report.component = component;
    r->s->report.n_components = n;
    return DALCS_OK;
}

static enum dalcs_status run_transient(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler e;
    struct dalcs_schedule schedule = choose_schedule(r);
    DALCS_TRY(report_euler(r));
    DALCS_TRY(dalcs_recorder_setup(&s->recorder, &s->network, r->sink, &schedule,
                                   r->options->record, r->options->max_events));
    DALCS_TRY(dalcs_euler_setup(&e, &s->circuit, &s->network, &r->osnsp, r->h,
                                s->circuit.transient.stop));
    e.detect_jumps = r->options->record;
    e.jump_user = &s->recorder;
    e.on_jump = dalcs_recorder_jump;
    s->report.step = r->h;
    s->report.stop = s->circuit.transient.stop;
    enum dalcs_status status = start_transient(r, &e);
    if (status == DALCS_OK) {
        dalcs_recorder_states(&s->network, &e, s->start);
        status = begin_plot(r, DALCS_TRANSIENT);
    }
    if (status == DALCS_OK) {
        status = dalcs_recorder_start(&s->recorder, &e);
    }
    if (status == DALCS_OK) {
        status = step_to_the_end(r, &e);
        dalcs_recorder_states(&s->network, &e, s->final);
    }
    if (status == DALCS_OK) {
        status = r->sink->end(r->sink->user);
    }
    dalcs_explain_failure(r, &e, status);
    add_work(r, &e);
    dalcs_euler_finish(&e);
    return status;
}

/* The method that was chosen. */
static enum dalcs_status run_method(struct dalcs_run *r) {
    if (r->method != DALCS_METHOD_EULER) {
        return run_transient(r); /* until there is a run_transient_radau(r) */
    }
    return run_transient(r);
}

/* The same with fewer rows. */
static enum dalcs_status run_thinned(struct dalcs_run *r) {
    struct dalcs_thinning thinning;
    const struct dalcs_sink *sink = r->sink;
    DALCS_TRY(dalcs_thinning_setup(&thinning, sink, (size_t)r->s->network.n_outputs, r->compress));
    r->sink = &thinning.sink;
    enum dalcs_status status = run_method(r);
    enum dalcs_status flushed = dalcs_thinning_flush(&thinning); /* of a run that stopped early */
    r->sink = sink;
    dalcs_thinning_finish(&thinning);
    return status == DALCS_OK ? flushed : status;
}

static void report_size(struct dalcs_report *report, const struct dalcs_network *n) {
    report->size.nodes = n->n_nodes;
    report->size.components = n->n_systems;
    for (int k = 0; k < n->n_systems; k++) {
        const struct dalcs_system *s = &n->system[k];
        report->size.x += s->n_x;
        report->size.z += s->n_z;
        for (int d = 0; d < s->n_pairs; d++) {
            bool is_switch = s->pair[d].kind == DALCS_PAIR_SWITCH;
            report->size.switches += is_switch ? 1 : 0;
            report->size.z += is_switch ? 1 : 0; /* a switch's current is algebraic */
            report->size.lambda += is_switch ? 0 : 1;
        }
    }
}

static double seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static enum dalcs_status prepare_report(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    const struct dalcs_network *n = &s->network;
    const char **name = dalcs_arena_alloc(&s->arena, (size_t)n->n_states, sizeof(*name));
    s->start = dalcs_alloc((size_t)n->n_states, sizeof(double));
    s->final = dalcs_alloc((size_t)n->n_states, sizeof(double));
    if (name == NULL || s->start == NULL || s->final == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n->n_states; i++) {
        name[i] = n->state[i].element;
    }
    s->report = (struct dalcs_report){.netlist = s->name,
                                      .title = s->circuit.title,
                                      .method = dalcs_method_name(0),
                                      .certificate = {.where = ""},
                                      .n_states = (size_t)n->n_states,
                                      .state_name = name,
                                      .start = s->start,
                                      .final = s->final};
    report_size(&s->report, n);
    s->has_report = true;
    return DALCS_OK;
}

static enum dalcs_status ignore_begin(void *user, const struct dalcs_plot *plot) {
    (void)user;
    (void)plot;
    return DALCS_OK;
}

static enum dalcs_status ignore_row(void *user, double time, const double *value) {
    (void)user;
    (void)time;
    (void)value;
    return DALCS_OK;
}

static enum dalcs_status ignore_end(void *user) {
    (void)user;
    return DALCS_OK;
}

static enum dalcs_status ignore_progress(void *user, double time, double stop) {
    (void)user;
    (void)time;
    (void)stop;
    return DALCS_OK;
}

enum dalcs_status dalcs_session_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) {
    if (!session->has_network) {
        return DALCS_E_NETLIST;
    }
    dalcs_session_forget_run(session);
    const struct dalcs_sink complete = {
        .user = sink->user,
        .begin = sink->begin != NULL ? sink->begin : ignore_begin,
        .row = sink->row != NULL ? sink->row : ignore_row,
        .end = sink->end != NULL ? sink->end : ignore_end,
        .progress = sink->progress != NULL ? sink->progress : ignore_progress,
    };
    struct dalcs_run r = {.s = session, .options = options, .sink = &complete};
    double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    double wall = seconds(CLOCK_MONOTONIC);
    DALCS_TRY(prepare_report(&r));
    enum dalcs_status status = dalcs_run_choose(&r);
    if (status == DALCS_OK) {
        status = name_signals(&r);
    }
    if (status == DALCS_OK && session->circuit.operating_point) {
        status = run_operating_point(&r);
    }
    if (status == DALCS_OK && session->circuit.transient.present) {
        status = r.compress > 0.0 ? run_thinned(&r) : run_method(&r);
    }
    struct dalcs_report *report = &session->report;
    report->n_events = session->recorder.n_events;
    report->n_events_dropped = session->recorder.n_events_dropped;
    report->event = session->recorder.event;
    report->n_jumps = session->recorder.n_jumps;
    report->n_jumps_dropped = session->recorder.n_jumps_dropped;
    report->jump = session->recorder.jump;
    report->work.cpu_s = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    report->work.wall_s = seconds(CLOCK_MONOTONIC) - wall;
    return status;
}
