/* session.c - the whole flow behind dalcs.h: netlist -> circuit -> DALCS -> OSNSPs -> rows.
 *
 * dalcs_session_run is the table of contents of the library. */
#include "dalcs.h"

#include "circuit.h"
#include "euler.h"
#include "netlist.h"
#include "network.h"
#include "number.h"
#include "recorder.h"
#include "system_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Steps between calls of the sink's progress. */
enum { PROGRESS_INTERVAL = 4096 };

struct dalcs_session {
    char *name;
    struct dalcs_diag diag;
    struct dalcs_circuit circuit;
    bool has_circuit;
    struct dalcs_network network;
    bool has_network;
    struct dalcs_recorder recorder; /* owns the report's events and jumps */
    struct dalcs_report report;
    bool has_report;
    double *start, *final;
    struct dalcs_arena arena; /* names of the report and of the plots */
};

enum dalcs_status dalcs_session_create(struct dalcs_session **session) {
    *session = dalcs_alloc(1, sizeof(**session));
    return *session == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

static void forget_run(struct dalcs_session *s) {
    if (s->recorder.network != NULL) {
        dalcs_recorder_finish(&s->recorder);
    }
    free(s->start);
    free(s->final);
    s->start = NULL;
    s->final = NULL;
    s->report = (struct dalcs_report){0};
    s->has_report = false;
}

void dalcs_session_destroy(struct dalcs_session *session) {
    if (session == NULL) {
        return;
    }
    forget_run(session);
    if (session->has_network) {
        dalcs_network_finish(&session->network);
    }
    if (session->has_circuit) {
        dalcs_circuit_finish(&session->circuit);
    }
    dalcs_diag_finish(&session->diag);
    dalcs_arena_finish(&session->arena);
    free(session);
}

/* ---- Reading ------------------------------------------------------------------------------- */

static enum dalcs_status read_netlist(struct dalcs_session *s, const char *path, const char *text,
                                      size_t length) {
    if (s->name != NULL) {
        return DALCS_E_OPTION; /* a session reads one netlist */
    }
    s->name = dalcs_arena_copy(&s->arena, path, strlen(path));
    if (s->name == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_netlist netlist = {0};
    enum dalcs_status status =
        text == NULL ? dalcs_netlist_read_file(&netlist, path, &s->diag)
                     : dalcs_netlist_read_text(&netlist, path, text, length, &s->diag);
    if (status == DALCS_OK) {
        status = dalcs_circuit_build(&s->circuit, &netlist, &s->diag);
        s->has_circuit = status == DALCS_OK;
    }
    dalcs_netlist_finish(&netlist);
    if (status == DALCS_OK) {
        status = dalcs_network_build(&s->network, &s->circuit,
                                     &(struct dalcs_network_options){0}, &s->diag);
        s->has_network = status == DALCS_OK;
    }
    return status;
}

enum dalcs_status dalcs_session_read_file(struct dalcs_session *session, const char *path) {
    return read_netlist(session, path, NULL, 0);
}

enum dalcs_status dalcs_session_read_text(struct dalcs_session *session, const char *name,
                                          const char *text, size_t length) {
    return read_netlist(session, name, text, length);
}

size_t dalcs_session_n_messages(const struct dalcs_session *session) {
    return session->diag.n;
}

const char *dalcs_session_message(const struct dalcs_session *session, size_t index,
                                  enum dalcs_level *level) {
    static const enum dalcs_level level_of[] = {[DALCS_NOTE] = DALCS_LEVEL_NOTE,
                                                [DALCS_WARNING] = DALCS_LEVEL_WARNING,
                                                [DALCS_ERROR] = DALCS_LEVEL_ERROR};
    if (index >= session->diag.n) {
        return NULL;
    }
    if (level != NULL) {
        *level = level_of[session->diag.item[index].severity];
    }
    return session->diag.item[index].text;
}

struct dalcs_request dalcs_session_request(const struct dalcs_session *session) {
    const struct dalcs_transient *t = &session->circuit.transient;
    return (struct dalcs_request){.operating_point = session->circuit.operating_point,
                                  .transient = t->present,
                                  .step = t->step,
                                  .stop = t->stop,
                                  .start = t->start,
                                  .max_step = t->max_step};
}

/* ---- Running ------------------------------------------------------------------------------- */

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

struct run {
    struct dalcs_session *s;
    const struct dalcs_run_options *options;
    const struct dalcs_sink *sink;
    struct dalcs_osnsp_options osnsp;
    double h;
    const char **name;
    enum dalcs_unit *unit;
};

static void option_error(struct dalcs_session *s, const char *text) {
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL, "%s", text);
}

static enum dalcs_status check_options(struct run *r) {
    struct dalcs_session *s = r->s;
    const struct dalcs_run_options *o = r->options;
    if (o->method != NULL && strcmp(o->method, "euler") != 0) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, "the methods are: euler",
                       "unknown method '%s'", o->method);
        return DALCS_E_OPTION;
    }
    const char *wanted = s->circuit.options.method;
    if (o->method == NULL && wanted != NULL && strcmp(wanted, "euler") != 0) {
        dalcs_diag_add(&s->diag, DALCS_NOTE, NULL, NULL,
                       "method=%s has no meaning here: using implicit Euler", wanted);
    }
    if (!(o->step >= 0.0) || !isfinite(o->step)) {
        option_error(s, "the step must be positive");
        return DALCS_E_OPTION;
    }
    for (size_t k = 0; k < o->n_at; k++) {
        if (!(o->at[k] >= (k > 0 ? o->at[k - 1] : 0.0)) || !isfinite(o->at[k])) {
            option_error(s, "output times must be ascending and not negative");
            return DALCS_E_OPTION;
        }
    }
    if (!(o->certificate_tolerance > 0.0) || o->max_outer < 1 || o->max_pivots < 1) {
        option_error(s, "tolerances and iteration limits must be positive");
        return DALCS_E_OPTION;
    }
    r->osnsp = (struct dalcs_osnsp_options){.certificate_tolerance = o->certificate_tolerance,
                                            .proximal_weight = {o->proximal_weight[0],
                                                                o->proximal_weight[1],
                                                                o->proximal_weight[2]},
                                            .rcond_min = o->rcond_min,
                                            .max_outer = o->max_outer,
                                            .max_pivots = o->max_pivots,
                                            .cache_bytes = o->cache_bytes,
                                            .dense_limit = o->dense_limit};
    const struct dalcs_transient *t = &s->circuit.transient;
    r->h = o->step > 0.0                    ? o->step
           : s->circuit.options.step > 0.0  ? s->circuit.options.step
           : t->max_step > 0.0              ? t->max_step
           : t->step > 0.0                  ? t->step
                                            : t->stop / 1000.0;
    if (t->present && t->stop / r->h > 1e15) {
        option_error(s, "the step is too small for the stop time: times would not be distinct");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status name_signals(struct run *r) {
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

static enum dalcs_status begin_plot(struct run *r, enum dalcs_analysis analysis) {
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

/* "KCL at out", "branch v1", "complementarity of d1" */
static const char *describe_row(struct dalcs_session *s, int system, int where) {
    if (where < 0) {
        return "";
    }
    const struct dalcs_system *d = &s->network.system[system];
    int n_equations = dalcs_system_n_equations(d);
    if (where >= n_equations) {
        return dalcs_arena_printf(&s->arena, "complementarity of %s",
                                  d->pair[where - n_equations].element);
    }
    static const char *const what[] = {[DALCS_LABEL_STATE] = "branch",
                                       [DALCS_LABEL_NODE] = "KCL at",
                                       [DALCS_LABEL_BRANCH] = "branch",
                                       [DALCS_LABEL_REFERENCE] = "reference"};
    return dalcs_arena_printf(&s->arena, "%s %s", what[d->row[where].kind],
                              d->row[where].element);
}

/* The counts of one engine run into the report. */
static void add_work(struct run *r, const struct dalcs_euler *e) {
    struct dalcs_report *report = &r->s->report;
    report->work.steps += e->steps;
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_osnsp_counters *c = &e->component[k].osnsp.counters;
        report->work.osnsp += c->solved;
        report->work.pivots += c->pivots;
        report->work.factorizations += c->factorizations;
        report->work.cache_hits += c->cache_hits;
        report->work.singular += c->singular;
        if (e->component[k].delayed_commands > 0) {
            dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, NULL,
                           "in %ld steps a switch and the voltage that controls it did not agree; "
                           "its last command stood until the next step",
                           e->component[k].delayed_commands);
        }
    }
    if (e->worst.worst >= report->certificate.worst) {
        const char *where = describe_row(r->s, e->worst_system, e->worst.where);
        report->certificate.worst = e->worst.worst;
        report->certificate.time = e->worst_time;
        report->certificate.where = where == NULL ? "" : where;
    }
}

/* A list "v1, d1" of names, in the session's arena. */
static const char *join_names(struct dalcs_session *s, int n, const char *const *name) {
    const char *list = "";
    for (int k = 0; k < n && list != NULL; k++) {
        list = k == 0    ? name[0]
               : k == 12 ? dalcs_arena_printf(&s->arena, "%s and %d more", list, n - k)
               : k > 12  ? list
                         : dalcs_arena_printf(&s->arena, "%s, %s", list, name[k]);
    }
    return list == NULL ? "" : list;
}

static const struct dalcs_location *place_of(const struct dalcs_circuit *c, const char *element) {
    for (int i = 0; i < c->n_devices; i++) {
        if (strcmp(c->device[i].name, element) == 0) {
            return &c->device[i].where;
        }
    }
    return NULL;
}

static void explain_infeasible(struct run *r, const struct dalcs_euler *e, const char *when) {
    struct dalcs_session *s = r->s;
    const struct dalcs_witness *w = &e->component[e->failed_system].osnsp.witness;
    static const char *const kind[] = {[DALCS_WITNESS_LOOP] = "loop",
                                       [DALCS_WITNESS_CUTSET] = "cutset",
                                       [DALCS_WITNESS_MODE] = "mode"};
    static const char *const why[] = {
        [DALCS_WITNESS_LOOP] = "the sources drive current around it with nothing to limit the "
                               "current",
        [DALCS_WITNESS_CUTSET] = "the sources force a current that nothing in it lets pass",
        [DALCS_WITNESS_MODE] = "no combination of conducting and blocking satisfies the circuit, "
                               "which its controlled sources or negative resistors keep from being "
                               "passive"};
    const struct dalcs_location *where =
        w->n_elements > 0 ? place_of(&s->circuit, w->element[0]) : NULL;
    dalcs_diag_add(&s->diag, DALCS_ERROR, where, NULL, "%s no solution exists: %s %s: %s", when,
                   kind[w->kind], join_names(s, w->n_elements, w->element), why[w->kind]);
    const char **element =
        dalcs_arena_alloc(&s->arena, (size_t)w->n_elements, sizeof(*element));
    if (element != NULL) {
        memcpy(element, w->element, (size_t)w->n_elements * sizeof(*element));
        s->report.infeasible.present = true;
        s->report.infeasible.time = e->failed_time;
        s->report.infeasible.kind = kind[w->kind];
        s->report.infeasible.n_elements = (size_t)w->n_elements;
        s->report.infeasible.element = element;
    }
}

static void dump_problem(struct run *r, const struct dalcs_euler *e) {
    const struct dalcs_component *c = &e->component[e->failed_system];
    if (r->options->dump_path == NULL) {
        return;
    }
    enum dalcs_status status =
        dalcs_system_file_write(r->options->dump_path, c->system,
                                &(struct dalcs_system_step){.sigma = c->failed_sigma,
                                                            .u = c->failed_u,
                                                            .mode = c->osnsp.mode});
    dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, NULL,
                   status == DALCS_OK ? "the one-step problem was written to %s"
                                      : "the one-step problem could not be written to %s",
                   r->options->dump_path);
}

/* A numerical failure, in words; other statuses explain themselves elsewhere. */
static void explain_failure(struct run *r, const struct dalcs_euler *e, enum dalcs_status status) {
    struct dalcs_session *s = r->s;
    if (status <= DALCS_OK || e->failed_system < 0) {
        return;
    }
    const char *when = e->at_operating_point
                           ? "at the operating point"
                           : dalcs_arena_printf(&s->arena, "at t = %.9g s (step %ld, h = %.6g s)",
                                                e->failed_time, e->steps + 1, e->failed_h);
    when = when == NULL ? "" : when;
    if (status == DALCS_INFEASIBLE) {
        explain_infeasible(r, e, when);
    } else {
        const struct dalcs_certificate *c = &e->component[e->failed_system].osnsp.certificate;
        const char *row = describe_row(s, e->failed_system, c->where);
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL,
                       "%s no certified solution was found: the best residual is %.3g of its scale, "
                       "%s",
                       when, c->worst, row == NULL ? "" : row);
    }
    dump_problem(r, e);
}

static enum dalcs_status run_operating_point(struct run *r) {
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
    explain_failure(r, &e, status);
    add_work(r, &e);
    dalcs_euler_finish(&e);
    return status;
}

static struct dalcs_schedule choose_schedule(const struct run *r) {
    const struct dalcs_transient *t = &r->s->circuit.transient;
    struct dalcs_schedule schedule = {.start = t->start, .step = t->step};
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
static enum dalcs_status start_from_clamps(struct run *r, struct dalcs_euler *e) {
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
    explain_failure(r, &held, status);
    add_work(r, &held);
    if (status == DALCS_OK) {
        for (int k = 0; k < held.n_components; k++) {
            initial[k] = held.component[k].u; /* the same x: clamps add algebraic unknowns only */
        }
        status = dalcs_euler_start(e, initial);
        explain_failure(r, e, status);
    }
    free(initial);
    dalcs_euler_finish(&held);
    dalcs_network_finish(&clamped);
    return status;
}

static enum dalcs_status start_transient(struct run *r, struct dalcs_euler *e) {
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

static enum dalcs_status step_to_the_end(struct run *r, struct dalcs_euler *e) {
    struct dalcs_recorder *recorder = &r->s->recorder;
    while (!dalcs_grid_at_end(&e->grid)) {
        DALCS_TRY(dalcs_euler_step(e));
        DALCS_TRY(dalcs_recorder_step(recorder, e));
        if (e->at_jump && !dalcs_grid_at_end(&e->grid)) {
            DALCS_TRY(dalcs_euler_cross(e));
            DALCS_TRY(dalcs_recorder_cross(recorder, e));
        }
        if (e->steps % PROGRESS_INTERVAL == 0 && r->sink->progress != NULL) {
            DALCS_TRY(r->sink->progress(r->sink->user, e->t, e->grid.stop));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status run_transient(struct run *r) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler e;
    struct dalcs_schedule schedule = choose_schedule(r);
    DALCS_TRY(dalcs_recorder_setup(&s->recorder, &s->network, &s->circuit, r->sink, &schedule,
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
    explain_failure(r, &e, status);
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

static enum dalcs_status prepare_report(struct run *r) {
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

enum dalcs_status dalcs_session_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) {
    if (!session->has_network) {
        return DALCS_E_NETLIST;
    }
    forget_run(session);
    struct run r = {.s = session, .options = options, .sink = sink};
    double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    double wall = seconds(CLOCK_MONOTONIC);
    DALCS_TRY(check_options(&r));
    DALCS_TRY(prepare_report(&r));
    enum dalcs_status status = name_signals(&r);
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

const struct dalcs_report *dalcs_session_report(const struct dalcs_session *session) {
    return session->has_report ? &session->report : NULL;
}

enum dalcs_status dalcs_parse_number(const char *text, double *value) {
    struct dalcs_number number;
    if (dalcs_number_parse(text, &number) != DALCS_NUMBER_OK) {
        return DALCS_E_OPTION;
    }
    *value = number.value;
    return DALCS_OK;
}
