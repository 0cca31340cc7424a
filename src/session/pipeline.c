/* pipeline.c - running: DALCS -> one OSNSP per step -> certified rows.
 *
 * dalcs_session_run at the end is the table of contents. */
#include "pipeline.h"

#include "audit_points.h"
#include "computed.h"
#include "cosimulation.h"
#include "delayed.h"
#include "orbit_analyses.h"

#include "stroboscope.h"

#include "thinning.h"

#include <math.h>
#include <time.h>

/* The counts of one engine run into the report. */
void dalcs_run_add_work(struct dalcs_run *r, const struct dalcs_euler *e) {
    struct dalcs_report *report = &r->s->results.report;
    report->work.steps += e->steps;
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_osnsp_counters *c = &e->component[k].osnsp.counters;
        report->work.osnsp += c->solved;
        report->work.pivots += c->pivots;
        report->work.factorizations += c->factorizations;
        report->work.cache_hits += c->cache_hits;
        report->work.singular += c->singular;
        dalcs_run_warn_of_switches(r, &e->component[k], e->steps);
    }
    if (e->worst.certificate.worst >= report->certificate.worst) {
        const char *where = dalcs_explain_row(r->s, e, e->worst.system, e->worst.certificate.where);
        report->certificate.worst = e->worst.certificate.worst;
        report->certificate.time = e->worst.time;
        report->certificate.where = where == NULL ? "" : where;
    }
}

enum dalcs_status dalcs_transient_run_thinned(struct dalcs_run *r) {
    struct dalcs_thinning thinning;
    if (!(r->rows.compress > 0.0)) {
        return dalcs_transient_run(r);
    }
    const struct dalcs_sink *sink = r->sink;
    DALCS_TRY(dalcs_thinning_setup(&thinning, sink, (size_t)r->s->circuit.results.n_shown,
                                   r->rows.compress));
    r->sink = &thinning.sink;
    enum dalcs_status status = dalcs_transient_run(r);
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
            report->size.corners += s->pair[d].is_formula ? 1 : 0;
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
    s->results.start = dalcs_alloc((size_t)n->n_states, sizeof(double));
    s->results.final = dalcs_alloc((size_t)n->n_states, sizeof(double));
    if (name == NULL || s->results.start == NULL || s->results.final == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n->n_states; i++) {
        name[i] = n->state[i].element;
    }
    s->results.report = (struct dalcs_report){.netlist = s->name,
                                              .title = s->circuit.title,
                                              .method = dalcs_method_name(0),
                                              .certificate = {.where = ""},
                                              .n_states = (size_t)n->n_states,
                                              .state_name = name,
                                              .start = s->results.start,
                                              .final = s->results.final};
    report_size(&s->results.report, n);
    s->results.has_report = true;
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

static enum dalcs_status run_analysis(struct dalcs_run *r, enum dalcs_analysis analysis) {
    const struct dalcs_circuit *circuit = &r->s->circuit;
    DALCS_TRY(dalcs_cosimulation_check(r, analysis));
    DALCS_TRY(dalcs_delayed_check(r, analysis));
    switch (analysis) {
    case DALCS_OPERATING_POINT:
        return circuit->analyses.operating_point ? dalcs_operating_point_run(r) : DALCS_OK;
    case DALCS_DC_SWEEP:
        return circuit->analyses.n_dc > 0 ? dalcs_dc_sweep_run(r) : DALCS_OK;
    case DALCS_AC:
        if (circuit->analyses.ac.n == 0 && !r->options->bode) {
            return DALCS_OK;
        }
        return circuit->analyses.periodic.present || r->options->bode ? dalcs_periodic_ac_run(r)
                                                                      : dalcs_small_signal_run(r);
    case DALCS_TRANSFER:
        return circuit->analyses.transfer.present ? dalcs_transfer_function_run(r) : DALCS_OK;
    case DALCS_PERIODIC:
        if (r->s->steady.stroboscope != NULL) {
            return dalcs_stroboscope_run(r);
        }
        return circuit->analyses.periodic.present || r->options->steady ? dalcs_steady_run(r)
                                                                        : DALCS_OK;
    default:
        if (r->options->envelope) {
            DALCS_TRY(dalcs_envelope_ask(r));
        }
        if (!circuit->analyses.transient.present) {
            return DALCS_OK;
        }
        if (circuit->analyses.envelope.present) {
            return dalcs_envelope_run(r);
        }
        if (circuit->analyses.transient.starts_steady) {
            return dalcs_steady_leave(r);
        }
        return dalcs_transient_run_thinned(r);
    }
}

enum dalcs_status dalcs_run_analyses(struct dalcs_session *session,
                                     const struct dalcs_run_options *options,
                                     const struct dalcs_sink *sink, const struct dalcs_plot *step,
                                     const enum dalcs_analysis *analysis, size_t n) {
    dalcs_session_forget_run(session);
    DALCS_TRY(dalcs_periodic_loop_prepare(session, options));
    struct dalcs_run r = {.s = session, .options = options, .sink = sink, .step = step};
    double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    double wall = seconds(CLOCK_MONOTONIC);
    DALCS_TRY(prepare_report(&r));
    dalcs_undetermined_init(&r.nonunique.undetermined, &session->circuit, &r,
                            dalcs_nonunique_found);
    enum dalcs_status status = dalcs_run_choose(&r);
    if (status == DALCS_OK) {
        status = dalcs_run_name_signals(&r, session->source.has_netlist);
    }
    for (size_t k = 0; k < n && status == DALCS_OK; k++) {
        status =
            atomic_load(&session->is_cancelled) ? DALCS_E_CANCELLED : run_analysis(&r, analysis[k]);
    }
    dalcs_audit_add_points(&r);
    dalcs_steady_forget(&r);
    dalcs_names_finish(&r.interrupting);
    dalcs_undetermined_finish(&r.nonunique.undetermined);
    dalcs_nonunique_count_rest(&r);
    struct dalcs_report *report = &session->results.report;
    report->n_nonunique = session->results.n_nonunique;
    report->nonunique = session->results.nonunique;
    report->n_events = session->results.recorder.log.n_events;
    report->n_events_dropped = session->results.recorder.log.n_events_dropped;
    report->event = session->results.recorder.log.event;
    report->n_jumps = session->results.recorder.log.n_jumps;
    report->n_jumps_dropped = session->results.recorder.log.n_jumps_dropped;
    report->jump = session->results.recorder.log.jump;
    report->work.cpu_s = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    report->work.wall_s = seconds(CLOCK_MONOTONIC) - wall;
    return status;
}

const enum dalcs_analysis dalcs_analyses_in_order[DALCS_N_IN_ORDER] = {
    DALCS_OPERATING_POINT, DALCS_DC_SWEEP, DALCS_TRANSFER,
    DALCS_PERIODIC,        DALCS_AC,       DALCS_TRANSIENT};

enum dalcs_status dalcs_run_asked(struct dalcs_session *session,
                                  const struct dalcs_run_options *options,
                                  const struct dalcs_sink *sink) {
    const enum dalcs_analysis alone = options->steady ? DALCS_PERIODIC
                                      : options->bode ? DALCS_AC
                                                      : DALCS_TRANSIENT;
    return options->steady || options->bode || options->envelope
               ? dalcs_run_analyses(session, options, sink, NULL, &alone, 1)
               : dalcs_run_analyses(session, options, sink, NULL, dalcs_analyses_in_order,
                                    DALCS_N_IN_ORDER);
}

static struct dalcs_sink completed(const struct dalcs_sink *sink) {
    return (struct dalcs_sink){
        .user = sink->user,
        .begin = sink->begin != NULL ? sink->begin : ignore_begin,
        .row = sink->row != NULL ? sink->row : ignore_row,
        .end = sink->end != NULL ? sink->end : ignore_end,
        .progress = sink->progress != NULL ? sink->progress : ignore_progress,
        .rows = sink->rows,
    };
}

enum dalcs_status dalcs_session_run_analysis(struct dalcs_session *session,
                                             const struct dalcs_run_options *options,
                                             const struct dalcs_sink *sink,
                                             enum dalcs_analysis analysis) {
    const struct dalcs_sink complete = completed(sink);
    return dalcs_run_analyses(session, options, &complete, NULL, &analysis, 1);
}

/* .step as a bifurcation diagram. */
static enum dalcs_status run_stroboscope(struct dalcs_session *session,
                                         const struct dalcs_run_options *options,
                                         const struct dalcs_sink *sink) {
    struct dalcs_stroboscope stroboscope = {0};
    if (session->source.steps.n == 0 || !options->steady) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL,
                       "write a card such as: .step param load 1 10 0.1",
                       "samples need one value after the other, and the netlist has no .step");
        return DALCS_E_OPTION;
    }
    session->steady.stroboscope = &stroboscope;
    const enum dalcs_status status = dalcs_stepped_run(session, options, sink);
    session->steady.stroboscope = NULL;
    dalcs_stroboscope_finish(&stroboscope);
    return status;
}

/* Of a circuit with the values that were set; the sink has all callbacks but perhaps rows. */
static enum dalcs_status run_circuit(struct dalcs_session *session,
                                     const struct dalcs_run_options *options,
                                     const struct dalcs_sink *sink) {
    const bool is_alone = options->steady || options->bode || options->envelope;
    if (is_alone) {
        session->circuit.analyses.periodic.present =
            session->circuit.analyses.periodic.present ||
            !options->envelope; /* as if there were a .pss */
        DALCS_TRY(dalcs_steady_prepare(session));
    }
    DALCS_TRY(dalcs_steps_find(session));
    if (options->samples > 0) {
        return run_stroboscope(session, options, sink);
    }
    if (session->source.steps.n > 0) {
        return dalcs_stepped_run(session, options, sink);
    }
    if (options->only_step > 1) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL,
                       "this is one run, without .step and .mc: there is no run %zu of them",
                       options->only_step);
        return DALCS_E_OPTION;
    }
    DALCS_TRY(dalcs_operating_currents(session, options, sink));
    DALCS_TRY(dalcs_run_asked(session, options, sink));
    return session->circuit.analyses.worst_case.present
               ? dalcs_worst_case_run(session, options, sink)
               : DALCS_OK;
}

static enum dalcs_status run_all(struct dalcs_session *session,
                                 const struct dalcs_run_options *options,
                                 const struct dalcs_sink *sink) {
    DALCS_TRY(dalcs_session_apply_values(session));
    const struct dalcs_sink complete = completed(sink);
    if (session->circuit.results.n_computed == 0) {
        return run_circuit(session, options, &complete);
    }
    struct dalcs_computing computing;
    dalcs_computing_init(&computing, session, &complete);
    return run_circuit(session, options, &computing.sink);
}

enum dalcs_status dalcs_session_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) {
    struct dalcs_run_options own;
    session->results.ended = dalcs_run_options_take(session, options, &own);
    session->results.ended =
        session->results.ended == DALCS_OK ? run_all(session, &own, sink) : session->results.ended;
    atomic_store(&session->is_cancelled, false);
    return session->results.ended;
}

void dalcs_session_cancel(struct dalcs_session *session) {
    atomic_store(&session->is_cancelled, true);
}

enum dalcs_status dalcs_run_progress(const struct dalcs_run *r, double time, double stop) {
    return atomic_load(&r->s->is_cancelled) ? DALCS_E_CANCELLED
                                            : r->sink->progress(r->sink->user, time, stop);
}
