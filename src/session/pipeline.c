/* pipeline.c - running: DALCS -> one OSNSP per step -> certified rows.
 *
 * dalcs_session_run at the end is the table of contents. */
#include "session_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stdio.h>
#include <time.h>
#include "radau.h"

/* Unknowns solved for between calls of the sink's progress, a fraction of a second of work, but no
 * more steps than that. */
enum { PROGRESS_UNKNOWNS = 1 << 18, PROGRESS_STEPS = 4096 };

/* The grid tells times apart to a few 1e-15 of the stop time; leave room for edges between. */
static const double MOST_STEPS = 1e13;

struct dalcs_run_options dalcs_run_options_default(void) {
    return (struct dalcs_run_options){.certificate_tolerance = 2e-13,
                                      .proximal_weight = {1e-8, 1e-7, 1e-6},
                                      .rcond_min = 1e-14,
                                      .max_outer = 40,
                                      .max_pivots = 200,
                                      .cache_bytes = (size_t)256 << 20,
                                      .dense_limit = 64,
                                      .max_events = 1000000};
}

static const char *const METHODS[] = {"auto", "radau", "euler"};

enum { N_METHODS = sizeof METHODS / sizeof METHODS[0] };

const char *dalcs_method_name(size_t index) {
    return index < N_METHODS ? METHODS[index] : NULL;
}

static bool is_method(const char *name) {
    bool found = false;
    for (size_t k = 0; k < N_METHODS && !found; k++) {
        found = strcmp(METHODS[k], name) == 0;
    }
    return found;
}

static enum dalcs_status option_error(struct dalcs_session *s, const char *text) {
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL, "%s", text);
    return DALCS_E_OPTION;
}

static enum dalcs_status check_method(struct dalcs_session *s, const struct dalcs_run_options *o) {
    if (o->method != NULL && !is_method(o->method)) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, "the methods are: euler", "unknown method '%s'",
                       o->method);
        return DALCS_E_OPTION;
    }
    const struct dalcs_circuit_options *netlist = &s->circuit.options;
    if (o->method == NULL && netlist->method != NULL && !is_method(netlist->method)) {
        dalcs_diag_add(&s->diag, DALCS_NOTE, &netlist->method_where, NULL,
                       "method=%s has no meaning here: using implicit Euler", netlist->method);
    }
    if (netlist->tolerance_where.line > 0) {
        dalcs_diag_add(&s->diag, DALCS_NOTE, &netlist->tolerance_where,
                       "choose the step with --step or .options step=",
                       "reltol, abstol and vntol have no effect with the fixed step of euler");
    }
    return DALCS_OK;
}

static enum dalcs_status check_output_times(struct dalcs_session *s,
                                            const struct dalcs_run_options *o) {
    const struct dalcs_transient *t = &s->circuit.transient;
    for (size_t k = 0; o->at != NULL && k < o->n_at; k++) {
        if (!(o->at[k] >= (k > 0 ? o->at[k - 1] : 0.0)) || !isfinite(o->at[k])) {
            return option_error(s, "output times must be ascending and not negative");
        }
        if (t->present && o->at[k] > t->stop) {
            return option_error(s, "output times must not come after the stop time");
        }
    }
    return DALCS_OK;
}

static enum dalcs_status check_tolerances(struct dalcs_session *s,
                                          const struct dalcs_run_options *o) {
    bool positive = o->certificate_tolerance > 0.0 && o->max_outer > 0 && o->max_pivots > 0;
    for (int k = 0; k < 3; k++) {
        positive = positive && o->proximal_weight[k] > 0.0 && o->proximal_weight[k] < 1.0;
    }
    if (!positive || !(o->certificate_tolerance < 1.0) || !(o->rcond_min >= 0.0) ||
        !(o->rcond_min < 1.0) || o->dense_limit < 0) {
        return option_error(s, "tolerances and limits must be positive, tolerances less than 1");
    }
    return DALCS_OK;
}

/* Does the next step depend on the one before? */
static bool has_memory(const struct dalcs_network *n) {
    bool found = false;
    for (int k = 0; k < n->n_systems && !found; k++) {
        found = n->system[k].n_x > 0;
        for (int d = 0; d < n->system[k].n_pairs && !found; d++) {
            const struct dalcs_pair *p = &n->system[k].pair[d];
            found = p->kind == DALCS_PAIR_SWITCH && p->turn_on != p->turn_off;
        }
    }
    return found;
}

static enum dalcs_status choose_step(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    const struct dalcs_transient *t = &s->circuit.transient;
    const double given = r->options->step;
    if (!(given >= 0.0) || !isfinite(given)) {
        return option_error(s, "the step must be positive");
    }
    if (!t->present) {
        return DALCS_OK;
    }
    if (given > t->stop) {
        return option_error(s, "the step is longer than the run");
    }
    if (given > 0.0) {
        r->h = given;
    } else if (s->circuit.options.step > 0.0) {
        r->h = s->circuit.options.step;
    } else if (t->max_step > 0.0 && (t->step == 0.0 || has_memory(&s->network))) {
        r->h = t->max_step;
    } else { /* without memory only the times that are printed matter */
        r->h = t->step > 0.0 ? t->step : t->stop / 1000.0;
    }
    if (t->stop / r->h > MOST_STEPS) {
        return option_error(s,
                            "the step is too small for the stop time: times would not be distinct");
    }
    return DALCS_OK;
}

static enum dalcs_status check_options(struct dalcs_run *r) {
    DALCS_TRY(check_method(r->s, r->options));
    DALCS_TRY(check_output_times(r->s, r->options));
    DALCS_TRY(check_tolerances(r->s, r->options));
    r->osnsp = dalcs_osnsp_options_of(r->options);
    return choose_step(r);
}

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
static enum dalcs_status start_radau(struct dalcs_run *r, struct dalcs_radau *radau);

static enum dalcs_status start_from_clamps(struct dalcs_run *r, struct dalcs_euler *e, struct dalcs_radau *radau) {
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
        status = radau != NULL ? dalcs_radau_start(radau, initial) : dalcs_euler_start(e, initial);
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
        return start_from_clamps(r, e, NULL);
    }
    DALCS_TRY(dalcs_euler_operating_point(e, true));
    return dalcs_euler_start(e, NULL);
}

static enum dalcs_status start_radau(struct dalcs_run *r, struct dalcs_radau *radau) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (c->transient.use_initial_conditions) {
        return dalcs_radau_start(radau, r->s->network.initial);
    }
    if (c->n_initial_conditions > 0) {
        return start_from_clamps(r, radau->base, radau);
    }
    DALCS_TRY(dalcs_euler_operating_point(radau->base, true));
    return dalcs_radau_start(radau, NULL);
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

static enum dalcs_status run_transient(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler e;
    struct dalcs_schedule schedule = choose_schedule(r);
    DALCS_TRY(dalcs_recorder_setup(&s->recorder, &s->network, r->sink, &schedule,
                                   r->options->record, r->options->max_events));
    DALCS_TRY(dalcs_euler_setup(&e, &s->circuit, &s->network, &r->osnsp, r->h,
                                s->circuit.transient.stop));
    e.detect_jumps = r->options->record;
    e.jump_user = &s->recorder;
    e.on_jump = dalcs_recorder_jump;
    s->report.step = r->h;
    s->report.stop = s->circuit.transient.stop;
    bool is_radau = !getenv("DALCS_EULER") && !(r->options->method && !strcmp(r->options->method,"euler"));
    struct dalcs_radau radau = {0};
    if (is_radau) {
        struct dalcs_radau_options o = {.tolerance = getenv("DALCS_TOL") ? atof(getenv("DALCS_TOL")) : 1e-6,
            .stages = getenv("DALCS_STAGES") ? atoi(getenv("DALCS_STAGES")) : 0, .max_step = s->circuit.transient.max_step, .stop = s->circuit.transient.stop};
        DALCS_TRY(dalcs_radau_setup(&radau, &e, &o, &r->osnsp));
        if (s->recorder.schedule.kind == DALCS_EVERY_STEP) { s->recorder.schedule.kind = DALCS_ON_GRID; }
    }
    enum dalcs_status status = is_radau ? start_radau(r, &radau) : start_transient(r, &e);
    if (status == DALCS_OK && is_radau) {
        status = dalcs_radau_evaluate(&radau, 0.0, DALCS_RIGHT);
    }
    if (status == DALCS_OK) {
        dalcs_recorder_states(&s->network, &e, s->start);
        status = begin_plot(r, DALCS_TRANSIENT);
    }
    if (status == DALCS_OK) {
        status = dalcs_recorder_start(&s->recorder, &e);
    }
    if (status == DALCS_OK) {
        status = is_radau ? dalcs_transient_run(r, &radau) : step_to_the_end(r, &e);
        if (is_radau) {
            e.steps = radau.steps; s->report.work.rejected=radau.rejected; s->report.work.restarts=radau.restarts; s->report.work.euler_steps=radau.euler_steps;
            if (getenv("DALCS_V")) { long f=0; for(int k=0;k<radau.n_parts;k++) f+=radau.part[k].stages.factorizations;
              fprintf(stderr,"steps %ld rejected %ld restarts %ld euler %ld maps %ld\n",radau.steps,radau.rejected,radau.restarts,radau.euler_steps,f);}
            if (status == DALCS_OK) status = dalcs_radau_evaluate(&radau, s->circuit.transient.stop, DALCS_LEFT);
            dalcs_radau_finish(&radau);
        }
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
                                      .method = "euler",
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
    enum dalcs_status status = check_options(&r);
    if (status == DALCS_OK) {
        status = name_signals(&r);
    }
    if (status == DALCS_OK && session->circuit.operating_point) {
        status = run_operating_point(&r);
    }
    if (status == DALCS_OK && session->circuit.transient.present) {
        status = run_transient(&r);
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
