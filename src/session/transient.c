/* transient.c - .tran: the start, then the loop over time of either method.
 *
 * Implicit Euler walks its grid and rows follow. The Radau methods go where something happens, and
 * rows are evaluated when they are due. dalcs_transient_run at the end is the table of contents. */
#include "measures.h"

#include "audit_run.h"
#include "steady.h"

#include "cycle.h"
#include "energy.h"
#include "extremes.h"
#include "filling.h"
#include "gates.h"
#include "losses_run.h"

#include <math.h>
#include <stdlib.h>

/* Unknowns solved for between calls of the sink's progress, a fraction of a second of work, but no
 * more steps than that. */
enum { PROGRESS_UNKNOWNS = 1 << 18, PROGRESS_STEPS = 4096 };

/* Where more are cut short by a longest step than this, a note says so. */
enum { MANY_STEPS = 1000 };

/* A file has an end, too, where a circuit rings all the time a thousand times as fast as its clock. */
static const struct dalcs_filling_limit FILLING_LIMIT = {100000, 4};

/* Where .tran has no tstep. */
static const double ROWS_WITHOUT_A_STEP = 1000.0;

static double row_distance(const struct dalcs_circuit *c) {
    const struct dalcs_transient *t = &c->transient;
    return c->options.initial_interval > 0.0 ? c->options.initial_interval
           : t->step > 0.0                   ? t->step
                                             : t->stop / ROWS_WITHOUT_A_STEP;
}

static struct dalcs_schedule choose_schedule(const struct dalcs_run *r) {
    const struct dalcs_transient *t = &r->s->circuit.transient;
    struct dalcs_schedule schedule = {.start = t->start, .step = t->step, .stop = t->stop};
    double ratio = t->step / r->h;
    if (r->options->at != NULL) {
        schedule.kind = DALCS_AT_TIMES;
        schedule.at = r->options->at;
        schedule.n_at = r->options->n_at;
    } else if (r->method != DALCS_METHOD_EULER) {
        schedule.kind = DALCS_ON_GRID;
        schedule.step = row_distance(&r->s->circuit);
    } else if (ratio >= 1.0 - 1e-9 && fabs(ratio - rint(ratio)) <= 1e-9 * ratio) {
        schedule.kind = DALCS_ON_GRID;
    } else {
        schedule.kind = DALCS_EVERY_STEP; /* the print grid does not fall on steps */
    }
    return schedule;
}

/* Rows further apart than half a period do not show a sine, nor do averages over them. `since` when there are no
 * others; INFINITY: never. */
static void warn_of_coarse_rows(struct dalcs_run *r, const struct dalcs_schedule *schedule,
                                double since) {
    const struct dalcs_circuit *c = &r->s->circuit;
    bool may_be_coarse = schedule->kind == DALCS_ON_GRID && isfinite(since);
    for (int i = 0; i < c->n_devices && may_be_coarse; i++) {
        const struct dalcs_device *d = &c->device[i];
        const struct dalcs_stimulus *s = d->stimulus >= 0 ? &c->stimulus[d->stimulus] : NULL;
        if (s != NULL && s->kind == DALCS_STIMULUS_SIN && s->u.sine.amplitude != 0.0 &&
            schedule->step * s->u.sine.frequency > 0.5) {
            dalcs_diag_add(&r->s->diag, DALCS_WARNING, &d->where, "a smaller tstep in .tran",
                           "rows are %g s apart%s and a period of '%s' is %g s: they do not show "
                           "it, nor what is computed from them",
                           schedule->step, since > schedule->start ? " there" : "", d->name,
                           1.0 / s->u.sine.frequency);
            return;
        }
    }
}

/* From x(0-), or from the operating point (NULL). */
static enum dalcs_status start_at(struct dalcs_euler *e, struct dalcs_radau *radau,
                                  double *const *initial) {
    return radau != NULL ? dalcs_radau_start(radau, initial) : dalcs_euler_start(e, initial);
}

static bool sources_jump(const struct dalcs_circuit *circuit, double t) {
    bool jumps = false;
    for (int i = 0; i < circuit->n_stimuli && !jumps; i++) {
        jumps = dalcs_stimulus_jumps_at(&circuit->stimulus[i], t);
    }
    return jumps;
}

/* A hysteresis goes on from the operating point. */
static void take_over_switches(struct dalcs_euler *e, const struct dalcs_euler *held) {
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        const struct dalcs_osnsp *before = &held->component[k].osnsp;
        for (int i = 0; i < c->n_switches; i++) {
            int d = c->switch_pair[i];
            dalcs_osnsp_command(&c->osnsp, d, dalcs_osnsp_is_on(before, d));
        }
    }
}

/* The operating point of `clamped`, in which .ic are held; its states start the transient. */
static enum dalcs_status start_from(struct dalcs_run *r, struct dalcs_euler *e,
                                    struct dalcs_radau *radau,
                                    const struct dalcs_network *clamped) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler held;
    DALCS_TRY(dalcs_euler_setup(&held, &s->circuit, clamped, &r->osnsp, 1.0, 1.0));
    r->undetermined.clamped = clamped;
    held.open_user = &r->undetermined;
    held.on_open = dalcs_undetermined_at;
    held.on_operating_point = dalcs_held_coils_rest;
    double **initial = dalcs_alloc((size_t)held.n_components, sizeof(*initial));
    enum dalcs_status status =
        initial == NULL ? DALCS_E_NOMEM : dalcs_euler_operating_point(&held, true);
    status = dalcs_explain_failure(r, &held, status);
    dalcs_run_add_work(r, &held);
    if (status == DALCS_OK) {
        for (int k = 0; k < held.n_components; k++) {
            initial[k] = held.component[k].u; /* the same x: clamps add algebraic unknowns only */
        }
        take_over_switches(e, &held);
        status = start_at(e, radau, initial);
    }
    free(initial);
    dalcs_euler_finish(&held);
    return status;
}

/* By a network of its own. */
static enum dalcs_status start_from_clamps(struct dalcs_run *r, struct dalcs_euler *e,
                                           struct dalcs_radau *radau) {
    struct dalcs_session *s = r->s;
    struct dalcs_network clamped;
    DALCS_TRY(dalcs_network_build(&clamped, &s->circuit,
                                  &(struct dalcs_network_options){.clamp_initial_conditions = true},
                                  &s->diag));
    enum dalcs_status status = start_from(r, e, radau, &clamped);
    dalcs_network_finish(&clamped);
    return status;
}

/* With logic at rest, if it has one: a change of an output may move what others read. NULL: it has none. */
static enum dalcs_status operating_point(struct dalcs_euler *e, struct dalcs_logic_run *logic) {
    bool changed = logic != NULL;
    for (int round = 0; changed && round <= logic->network.n; round++) {
        DALCS_TRY(dalcs_euler_operating_point(e, true));
        DALCS_TRY(dalcs_logic_run_rest(logic, &changed));
    }
    return changed || logic == NULL ? dalcs_euler_operating_point(e, true) : DALCS_OK;
}

enum dalcs_status dalcs_transient_start(struct dalcs_run *r, struct dalcs_euler *e,
                                        struct dalcs_radau *radau, struct dalcs_logic_run *logic) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (r->orbit != NULL) {
        return dalcs_steady_start(r->orbit, e, radau);
    }
    if (logic != NULL) {
        bool changed;
        DALCS_TRY(dalcs_logic_run_rest(logic, &changed));
    }
    if (c->transient.use_initial_conditions) {
        return start_at(e, radau, r->s->network.initial);
    }
    if (r->s->network.held != NULL) {
        return start_from(r, e, radau, r->s->network.held);
    }
    if (c->n_initial_conditions > 0) {
        return start_from_clamps(r, e, radau);
    }
    DALCS_TRY(operating_point(e, logic));
    if (logic != NULL && sources_jump(c, 0.0)) {
        DALCS_TRY(dalcs_recorder_before_start(&r->s->recorder, e));
        if (r->losses != NULL) {
            dalcs_losses_run_before_start(r->losses);
        }
    }
    return start_at(e, radau, NULL);
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

static enum dalcs_status step_to_the_end(struct dalcs_run *r, struct dalcs_euler *e,
                                         struct dalcs_measures *measures) {
    struct dalcs_recorder *recorder = &r->s->recorder;
    const long interval = progress_interval(&r->s->network);
    while (!dalcs_grid_at_end(&e->grid)) {
        DALCS_TRY(dalcs_euler_step(e));
        DALCS_TRY(dalcs_recorder_step(recorder, e));
        dalcs_measures_step(measures, e);
        if (e->at_jump && !dalcs_grid_at_end(&e->grid)) {
            DALCS_TRY(dalcs_euler_cross(e));
            DALCS_TRY(dalcs_recorder_cross(recorder, e));
            dalcs_measures_cross(measures, e);
        }
        if (e->steps % interval == 0) {
            DALCS_TRY(dalcs_run_progress(r, e->t, e->grid.stop));
        }
    }
    return DALCS_OK;
}

/* What is nearer before the first row than this part of its time may be at it. */
static const double before_start = 1e-9;

struct transient {
    struct dalcs_run *run;
    struct dalcs_recorder *recorder;
    struct dalcs_radau *radau;
    struct dalcs_measures *measures;
    struct dalcs_audit_run *audit;
    struct dalcs_logic_run *logic;
    struct dalcs_rows rows;
    struct dalcs_gate_samples samples;
    struct dalcs_filling filling;
    double t;
    double next_row;  /* s, that is due */
    double next_edge; /* s, of any source: rows are wanted there */
    long interval;    /* steps and rows between calls of progress */
    long to_go;       /* of them, until the next */
};

/* Of any source; before the first row nobody asks. */
static double edge_after(const struct transient *c, double t) {
    const struct dalcs_circuit *circuit = &c->run->s->circuit;
    double edge = dalcs_logic_run_next(c->logic);
    t = dalcs_larger(t, c->recorder->schedule.start * (1.0 - before_start));
    for (int i = 0; i < circuit->n_stimuli && dalcs_recorder_wants_sides(c->recorder, INFINITY);
         i++) {
        edge = fmin(edge, dalcs_stimulus_next_edge(&circuit->stimulus[i], t));
    }
    return edge;
}

/* After so many steps and rows more. */
static enum dalcs_status tell_progress(struct transient *c, long n) {
    c->to_go -= n;
    if (c->to_go > 0) {
        return DALCS_OK;
    }
    c->to_go = c->interval;
    return dalcs_run_progress(c->run, c->t, c->radau->options.stop);
}

static enum dalcs_status row(struct transient *c, enum dalcs_side side, bool is_due) {
    int n_done;
    DALCS_TRY(dalcs_rows_fill(&c->rows, &c->t, 1, side, &n_done));
    if (side == DALCS_RIGHT) {
        dalcs_rows_join(&c->rows, c->recorder->row); /* the row on the left was the last one */
    }
    DALCS_TRY(dalcs_recorder_row(c->recorder, &c->rows, c->t, is_due));
    dalcs_audit_run_rows(c->audit, c->t, side, 1);
    c->next_row = dalcs_recorder_due(c->recorder);
    return DALCS_OK;
}

/* The rows while nothing else happens: until shortly before `until`; ends: when something does. */
static enum dalcs_status rows(struct transient *c, double until, bool ends) {
    double time[DALCS_MOST_ROWS];
    double near = c->radau->resolution;
    int most = c->rows.one_by_one ? 1 : DALCS_MOST_ROWS;
    int n_due;
    DALCS_TRY(dalcs_filling_enter(&c->filling, c->t, until, ends));
    for (int n; (n = dalcs_filling_list(&c->filling, c->recorder, near, time, most, &n_due)) > 0;) {
        DALCS_TRY(dalcs_rows_fill(&c->rows, time, n, DALCS_LEFT, &n));
        c->t = time[n - 1];
        DALCS_TRY(dalcs_recorder_rows(c->recorder, &c->rows, time, n, n_due));
        dalcs_audit_run_rows(c->audit, c->t, DALCS_LEFT, n);
        c->next_row = dalcs_recorder_due(c->recorder);
        DALCS_TRY(tell_progress(c, n));
    }
    return DALCS_OK;
}

/* May the next row be in this segment, periods later? */
static bool cycles(const struct transient *c) {
    const struct dalcs_radau *radau = c->radau;
    return radau->cycling != NULL && radau->cycling->memory.cycles &&
           !dalcs_filling_is_on(&c->filling, c->t);
}

/* Over periods of which nobody asks anything. */
static enum dalcs_status leap(struct transient *c) {
    const struct dalcs_leap *leap;
    double until = dalcs_smaller(dalcs_smaller(c->next_row, c->next_edge), c->measures->begin);
    bool may;
    DALCS_TRY(dalcs_audit_run_leap(c->audit, until, &may));
    if (!may) {
        return DALCS_OK;
    }
    until = dalcs_audit_run_until(c->audit, until);
    dalcs_audit_run_start_leap(c->audit);
    DALCS_TRY(dalcs_cycle_leap(c->radau, until, c->to_go, &leap));
    if (leap == NULL) {
        return DALCS_OK;
    }
    dalcs_audit_run_end_leap(c->audit);
    c->t = c->radau->cycling->segment.t;
    dalcs_measures_skip(c->measures, c->t);
    DALCS_TRY(dalcs_recorder_leap(c->recorder, leap));
    return tell_progress(c, leap->n_steps);
}

static void tell_cut(void *user, int part, double t) {
    dalcs_audit_run_cut(user, part, t);
}

static bool has_gates(const struct transient *c) {
    return c->logic->circuit != NULL;
}

static enum dalcs_status decide(struct dalcs_run *r, struct dalcs_logic_run *logic, double t) {
    const enum dalcs_status status = dalcs_logic_run_at(logic, t);
    return status == DALCS_NOT_CONVERGED ? dalcs_refuse_gates(r, logic, t) : status;
}

/* Gates at t, to which all has come: the audit decides them again, and what they write begins there. */
static enum dalcs_status pass_gates(struct transient *c, double t) {
    if (!has_gates(c)) {
        return DALCS_OK;
    }
    DALCS_TRY(decide(c->run, c->logic, t));
    dalcs_measures_renew(c->measures, t);
    return dalcs_audit_run_gates(c->audit, t);
}

/* What samples may take, before anything happens at t. */
static enum dalcs_status sample(struct transient *c, double t) {
    DALCS_TRY(dalcs_gate_samples_read(&c->samples, c->logic, t));
    return dalcs_audit_run_sample(c->audit, t);
}

/* To the next time at which there is something to do, with the rows up to there. */
static enum dalcs_status advance(struct transient *c) {
    struct dalcs_radau *radau = c->radau;
    double near = radau->resolution;
    double stop = radau->options.stop;
    bool happens;
    if (cycles(c)) {
        DALCS_TRY(leap(c));
    }
    double end = dalcs_radau_next_stop(radau, &happens);
    double t = dalcs_smaller(dalcs_smaller(end, stop),
                             dalcs_smaller(c->next_edge, c->measures->next_edge));
    bool comes = c->next_row + near < t;
    if (comes || dalcs_filling_is_on(&c->filling, t)) {
        bool stops = (happens && end <= t + near) || c->next_edge <= t + near || t >= stop - near;
        DALCS_TRY(rows(c, t, stops));
        if (comes && cycles(c)) {
            return DALCS_OK;
        }
    }
    t = dalcs_smaller(t, c->next_row);
    bool ends = end <= t + near;
    bool edge = c->next_edge <= t + near;
    if (ends) {
        t = end;
    } else if (edge) {
        t = c->next_edge;
    }
    c->t = t;
    if (has_gates(c)) {
        dalcs_measures_end_at(c->measures, t);
    }
    DALCS_TRY(dalcs_measures_reach(c->measures, radau, dalcs_smaller(t, stop), near));
    bool sides = dalcs_recorder_wants_sides(c->recorder, t);
    bool is_due = c->next_row <= t + near;
    bool written = is_due || (sides && (edge || (ends && happens)));
    if (written) {
        DALCS_TRY(row(c, DALCS_LEFT, is_due));
        dalcs_filling_row(&c->filling, t, edge || (ends && happens));
    }
    bool passes = ends || (edge && has_gates(c));
    if (passes || t >= stop - near) {
        dalcs_audit_run_leave(c->audit, t >= stop - near ? stop : t);
    }
    if (t >= stop - near) {
        c->t = stop;
        return DALCS_OK;
    }
    if (passes) {
        DALCS_TRY(sample(c, t));
        radau->base->t = t;
        DALCS_TRY(dalcs_radau_pass(radau, t));
        DALCS_TRY(pass_gates(c, t));
        dalcs_audit_run_enter(c->audit);
        radau->base->t = t;
        DALCS_TRY(dalcs_recorder_events(c->recorder, radau->base));
    }
    bool jumps = edge && sources_jump(&c->run->s->circuit, c->t);
    if (edge || has_gates(c)) {
        c->next_edge = edge_after(c, t);
    }
    if (sides && ((ends && happens) || jumps)) {
        DALCS_TRY(row(c, DALCS_RIGHT, false));
    }
    return DALCS_OK;
}

static void note_end_of_filling(struct dalcs_run *r, const struct dalcs_filling *filling) {
    if (isfinite(filling->ended)) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL,
                       "--fill with a larger bound, or none, or a later tstart",
                       "%zu rows, and %zu for each that there is anyway, were added up to t = %.9g "
                       "s: from there on there are no more",
                       FILLING_LIMIT.most, FILLING_LIMIT.for_each, filling->ended);
        warn_of_coarse_rows(r, &r->s->recorder.schedule, filling->ended);
    }
}

static enum dalcs_status run_to_the_end(struct dalcs_run *r, struct dalcs_radau *radau,
                                        struct dalcs_measures *measures,
                                        struct dalcs_audit_run *audit,
                                        struct dalcs_logic_run *logic) {
    struct transient c = {.run = r,
                          .recorder = &r->s->recorder,
                          .radau = radau,
                          .measures = measures,
                          .audit = audit,
                          .logic = logic};
    logic->cut_user = audit;
    logic->on_cut = tell_cut;
    c.next_row = dalcs_recorder_due(c.recorder);
    c.next_edge = edge_after(&c, 0.0);
    c.interval = c.to_go = progress_interval(&r->s->network);
    DALCS_TRY(dalcs_rows_setup(&c.rows, radau, NULL, r->s->network.n_outputs));
    enum dalcs_status status =
        dalcs_filling_setup(&c.filling, c.recorder, &c.rows, r->fill, r->lines, &FILLING_LIMIT);
    status = status == DALCS_OK ? dalcs_gate_samples_setup(&c.samples, logic) : status;
    dalcs_audit_run_begin(audit);
    status = status == DALCS_OK ? dalcs_audit_run_gates(audit, 0.0) : status;
    while (c.t < radau->options.stop && status == DALCS_OK) {
        status = advance(&c);
        status = status == DALCS_OK ? tell_progress(&c, 1) : status;
    }
    if (status != DALCS_OK) {
        dalcs_radau_break_off(radau, c.t);
    }
    note_end_of_filling(r, &c.filling);
    dalcs_filling_finish(&c.filling);
    dalcs_rows_finish(&c.rows);
    dalcs_gate_samples_finish(&c.samples);
    return status;
}

/* Which method each component goes with, and why. */
static enum dalcs_status report_methods(struct dalcs_run *r, const struct dalcs_radau *radau) {
    const size_t n = (size_t)r->s->network.n_systems;
    struct dalcs_component_method *component =
        dalcs_arena_alloc(&r->s->arena, n, sizeof(*component));
    if (component == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *family_name =
        dalcs_method_name(r->method == DALCS_METHOD_AUTO ? DALCS_METHOD_RADAU : r->method);
    for (size_t k = 0; k < n; k++) {
        component[k] = (struct dalcs_component_method){.method = "euler", .stages = 1};
        if (radau != NULL) {
            const struct dalcs_radau_part *part = &radau->part[k];
            bool steps = part->kind == DALCS_PART_STEPPED;
            component[k].method = steps ? family_name : "algebraic";
            component[k].stages = steps ? part->stages.method->n_stages : 1;
            component[k].because = part->because;
        }
    }
    r->s->report.component = component;
    r->s->report.n_components = n;
    return DALCS_OK;
}

static enum dalcs_status walk(struct dalcs_run *r, struct dalcs_euler *e, struct dalcs_radau *radau,
                              struct dalcs_measures *measures, struct dalcs_audit_run *audit,
                              struct dalcs_logic_run *logic) {
    struct dalcs_session *s = r->s;
    DALCS_TRY(report_methods(r, radau));
    DALCS_TRY(dalcs_transient_start(r, e, radau, logic));
    DALCS_TRY(decide(r, logic, 0.0));
    if (radau != NULL) {
        DALCS_TRY(dalcs_radau_evaluate(radau, 0.0, DALCS_RIGHT));
    }
    DALCS_TRY(dalcs_undetermined_several(&r->undetermined, e, s->circuit.transient.stop));
    dalcs_recorder_states(&s->network, e, s->start);
    DALCS_TRY(dalcs_run_begin_plot(r, r->orbit != NULL && !r->leaves_orbit ? DALCS_PERIODIC
                                                                           : DALCS_TRANSIENT));
    DALCS_TRY(dalcs_recorder_start(&s->recorder, e));
    DALCS_TRY(dalcs_measures_start(measures, r, e, radau));
    enum dalcs_status status = radau != NULL ? run_to_the_end(r, radau, measures, audit, logic)
                                             : step_to_the_end(r, e, measures);
    if (status == DALCS_OK && radau != NULL) {
        status = dalcs_radau_evaluate(radau, radau->options.stop, DALCS_LEFT);
    }
    dalcs_recorder_states(&s->network, e, s->final);
    if (r->orbit_end != NULL) {
        dalcs_steady_read(e, r->orbit_end);
    }
    DALCS_TRY(status);
    if (dalcs_audit_run_fails(audit)) {
        return DALCS_NOT_CONVERGED; /* the rows stay what they are: partial */
    }
    return r->sink->end(r->sink->user);
}

/* SPICE needs a tmax to be accurate, and people write one. */
static void note_held_back(struct dalcs_run *r, const struct dalcs_radau *radau) {
    long held_back = 0;
    for (int k = 0; k < radau->n_parts; k++) {
        held_back += radau->part[k].length.held_back;
    }
    if (r->max_step > 0.0 && r->fixed_step == 0.0 && held_back > MANY_STEPS &&
        2 * held_back > radau->steps) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, "leave tmax out of .tran",
                       "the longest step that is allowed, %g s, cut %ld of %ld steps short: the "
                       "tolerance does not need it",
                       r->max_step, held_back, radau->steps);
    }
}

/* A wrong sign below this, or so many tolerances, is what a guard may be let be by. */
static const double noted_sign = 1e-4;
static const double noted_sign_over_tolerance = 100.0;

static void warn_of_wrong_sign(struct dalcs_run *r, const struct dalcs_radau *radau) {
    if (radau->wrong_sign > noted_sign &&
        radau->wrong_sign > noted_sign_over_tolerance * radau->options.tolerance) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, "compare with another --tol",
                       "a diode has had the wrong sign, up to %.2g of the largest current or "
                       "voltage, at t = %.9g s: what follows may be wrong",
                       radau->wrong_sign, radau->wrong_time);
    }
}

static void add_radau_work(struct dalcs_run *r, const struct dalcs_radau *radau) {
    struct dalcs_report *report = &r->s->report;
    report->work.steps += radau->steps;
    report->work.rejected += radau->rejected;
    report->work.restarts += radau->restarts;
    report->work.euler_steps += radau->euler_steps;
    report->work.periodic_steps += radau->periodic_steps;
    report->work.leapt_steps += radau->leapt_steps;
    for (int k = 0; k < radau->n_parts; k++) {
        report->work.factorizations += radau->part[k].stages.factorizations;
        report->work.cache_hits += radau->part[k].stages.cache_hits;
    }
    note_held_back(r, radau);
    report->certificate.wrong_sign = radau->wrong_sign;
    warn_of_wrong_sign(r, radau);
    if (radau->worst_residual > report->certificate.worst) {
        report->certificate.worst = radau->worst_residual;
        report->certificate.time = radau->worst_time;
        report->certificate.where = "stages";
    }
    if (radau->euler_steps > 0) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, NULL,
                       "where events crowded, radau fell back to implicit Euler for %ld step%s",
                       radau->euler_steps, radau->euler_steps == 1 ? "" : "s");
    }
}

/* ---- The ledger of energies ---------------------------------------------------------------- */

/* The ledger into the report. Where it does not add up, an equation was not what its devices are, or a
 * step went where it should not. */
static enum dalcs_status close_ledger(struct dalcs_run *r, struct dalcs_energy *energy,
                                      struct dalcs_euler *e, struct dalcs_radau *radau) {
    enum dalcs_status status = dalcs_energy_close(energy, e, radau);
    if (status > DALCS_OK) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, NULL,
                       "the energies are not known: a part of the circuit without states has no "
                       "answer to one of its sources alone");
        return DALCS_OK;
    }
    DALCS_TRY(status);
    struct dalcs_report *report = &r->s->report;
    if (!isfinite(energy->sum.turnover)) { /* an unstable circuit, beyond what doubles hold */
        return DALCS_OK;
    }
    report->energy.present = true;
    report->energy.sources = energy->sum.account[DALCS_POWER_SOURCES];
    report->energy.resistors = energy->sum.account[DALCS_POWER_RESISTORS];
    report->energy.diodes = energy->sum.account[DALCS_POWER_DIODES];
    report->energy.jumps = energy->sum.jumps;
    report->energy.stored_change = energy->sum.stored_change;
    report->energy.method = energy->sum.method;
    report->energy.balance = dalcs_energy_balance(energy);
    double unexplained = dalcs_energy_unexplained(energy, radau);
    if (unexplained == 0.0) {
        return DALCS_OK;
    }
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, NULL,
                   "internal error: the energy balance is off by %.3g J of %.3g J; please report "
                   "this netlist",
                   unexplained, energy->sum.turnover);
    return DALCS_E_INTERNAL;
}

struct dalcs_radau_options dalcs_transient_options(const struct dalcs_run *r, double stop) {
    return (struct dalcs_radau_options){.tolerance = r->tolerance,
                                        .abstol = r->abstol,
                                        .vntol = r->vntol,
                                        .family = r->family,
                                        .stages = r->stages,
                                        .fixed_step = r->fixed_step,
                                        .max_step = r->max_step,
                                        .stop = stop};
}

enum dalcs_status dalcs_transient_run(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    const double stop = s->circuit.transient.stop;
    bool is_euler = r->method == DALCS_METHOD_EULER;
    struct dalcs_euler e;
    struct dalcs_radau radau = {0};
    struct dalcs_energy energy = {0};
    struct dalcs_measures measures = {0};
    struct dalcs_losses_run losses = {0};
    struct dalcs_audit_run audit = {0};
    struct dalcs_logic_run logic = {0};
    struct dalcs_schedule schedule = choose_schedule(r);
    warn_of_coarse_rows(r, &schedule, isinf(r->fill) ? schedule.start : INFINITY);
    dalcs_recorder_finish(&s->recorder); /* of a .pss before */
    DALCS_TRY(dalcs_recorder_setup(&s->recorder, &s->network, r->sink, &schedule,
                                   r->options->record, r->options->max_events));
    s->recorder.n_shown = s->circuit.n_shown;
    DALCS_TRY(dalcs_tangents_watch(r));
    DALCS_TRY(dalcs_euler_setup(&e, &s->circuit, &s->network, &r->osnsp, r->h, stop));
    e.detect_jumps = r->options->record || dalcs_run_keeps_ledger(r) || dalcs_run_wants_losses(r);
    e.jump_user = r;
    e.on_jump = dalcs_note_jump;
    e.open_user = &r->undetermined;
    e.on_open = dalcs_undetermined_at;
    s->report.step = is_euler ? r->h : r->fixed_step;
    s->report.stop = stop;
    enum dalcs_status status = DALCS_OK;
    if (!is_euler) {
        const struct dalcs_radau_options options = dalcs_transient_options(r, stop);
        status = dalcs_radau_setup(&radau, &e, &options, &r->osnsp);
    }
    status = status == DALCS_OK && !is_euler ? dalcs_logic_run_setup(&logic, &s->circuit, &radau)
                                             : status;
    if (status == DALCS_OK && dalcs_run_wants_losses(r)) {
        status =
            dalcs_losses_run_start(&losses, r, &e, is_euler, is_euler ? 0.0 : radau.resolution);
    }
    if (status == DALCS_OK && dalcs_run_keeps_ledger(r)) {
        status = dalcs_energy_setup(&energy, &e, is_euler ? NULL : &radau);
    }
    if (status == DALCS_OK) {
        status = is_euler ? DALCS_OK : dalcs_audit_run_start(&audit, r, &e, &radau);
    }
    if (status == DALCS_OK) {
        status = walk(r, &e, is_euler ? NULL : &radau, &measures, &audit, &logic);
        enum dalcs_status reported = dalcs_measures_report(&measures, r, status);
        status = status == DALCS_OK ? reported : status;
    }
    if (status == DALCS_OK && losses.wanted) {
        status = dalcs_losses_run_report(&losses, r);
    }
    if (status == DALCS_OK && dalcs_run_keeps_ledger(r)) {
        status = close_ledger(r, &energy, &e, is_euler ? NULL : &radau);
    }
    if (status == DALCS_OK) {
        dalcs_tangents_judge(r);
    }
    const bool is_wrong = dalcs_audit_run_fails(&audit);
    const enum dalcs_status audited = dalcs_audit_run_report(&audit);
    status = status == DALCS_OK ? audited : status;
    if (!is_wrong) {
        status = dalcs_explain_failure(r, &e, status);
    }
    dalcs_run_add_work(r, &e);
    add_radau_work(r, &radau);
    dalcs_audit_run_finish(&audit);
    dalcs_logic_run_finish(&logic);
    dalcs_measures_finish(&measures);
    dalcs_losses_run_finish(&losses);
    r->losses = NULL;
    dalcs_energy_finish(&energy);
    dalcs_radau_finish(&radau);
    dalcs_euler_finish(&e);
    return status;
}
