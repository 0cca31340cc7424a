/* transient_walk.c - the loop over time of the Radau methods: from one time at which something happens to the next,
 * with the rows between evaluated when they are due. */
#include "transient.h"

#include "audit_run.h"
#include "cosimulation.h"
#include "cycle.h"
#include "edges_ahead.h"
#include "extremes.h"
#include "filling.h"
#include "gates.h"
#include "measures.h"

#include <math.h>

/* A file has an end, too, where a circuit rings all the time a thousand times as fast as its clock. */
static const struct dalcs_filling_limit FILLING_LIMIT = {100000, 4};

/* Unknowns solved for between calls of the sink's progress, a fraction of a second of work, but no
 * more steps than that. */
enum { PROGRESS_UNKNOWNS = 1 << 18, PROGRESS_STEPS = 4096 };

/* Steps between calls of the sink's progress. */
long dalcs_transient_progress_interval(const struct dalcs_network *n) {
    long n_unknowns = 1;
    for (int k = 0; k < n->n_systems; k++) {
        n_unknowns += dalcs_system_n_columns(&n->system[k]);
    }
    long n_steps = PROGRESS_UNKNOWNS / n_unknowns;
    return n_steps < 1 ? 1 : n_steps < PROGRESS_STEPS ? n_steps : PROGRESS_STEPS;
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
    struct dalcs_cosimulation *cosimulation;
    struct dalcs_rows rows;
    struct dalcs_gate_samples samples;
    struct dalcs_filling filling;
    struct dalcs_edges_ahead edges; /* of all sources */
    double t;
    double next_row;  /* s, that is due */
    double next_edge; /* s, of any source: rows are wanted there */
    long interval;    /* steps and rows between calls of progress */
    long to_go;       /* of them, until the next */
};

/* Of any source; it is not called before the first row. */
static double edge_after(struct transient *c, double t) {
    double edge = dalcs_logic_run_next(c->logic);
    t = dalcs_larger(t, c->recorder->schedule.start * (1.0 - before_start));
    return dalcs_recorder_wants_sides(c->recorder, INFINITY)
               ? fmin(edge, dalcs_edges_ahead_after(&c->edges, t))
               : edge;
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
    dalcs_audit_run_rows(c->audit, c->recorder, &c->t, side, 1);
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
        dalcs_audit_run_rows(c->audit, c->recorder, time, DALCS_LEFT, n);
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

/* Over periods without rows and measurements. */
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
    DALCS_TRY(dalcs_event_log_leap(&c->recorder->log, leap));
    dalcs_audit_run_tell(c->audit, c->t);
    return tell_progress(c, leap->n_steps);
}

static void tell_cut(void *user, int part, double t) {
    dalcs_audit_run_cut(user, part, t);
}

static bool has_gates(const struct transient *c) {
    return c->logic->circuit != NULL;
}

enum dalcs_status dalcs_transient_decide(struct dalcs_run *r, struct dalcs_logic_run *logic,
                                         double t) {
    const enum dalcs_status status = dalcs_logic_run_at(logic, t);
    return status == DALCS_NOT_CONVERGED ? dalcs_refuse_gates(r, logic, t) : status;
}

/* Gates at t, to which all has come: the audit decides them again, and what they write begins there. */
static enum dalcs_status pass_gates(struct transient *c, double t) {
    if (!has_gates(c)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_transient_decide(c->run, c->logic, t));
    dalcs_measures_renew(c->measures, t);
    return dalcs_audit_run_gates(c->audit, c->logic, t);
}

/* What samples may take, before anything happens at t. */
static enum dalcs_status sample(struct transient *c, double t) {
    DALCS_TRY(dalcs_gate_samples_read(&c->samples, c->logic, t));
    return dalcs_audit_run_sample(c->audit, t);
}

/* A program outside reads what is just before t, if it is to be asked now; *edge: it gives sources other values. */
static enum dalcs_status exchange(struct transient *c, double t, bool *edge) {
    int n_done;
    if (!dalcs_cosimulation_is_due(c->cosimulation, t, c->radau->resolution)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_rows_fill(&c->rows, &t, 1, DALCS_LEFT, &n_done));
    DALCS_TRY(dalcs_cosimulation_ask(c->cosimulation, t, &c->rows, NULL));
    *edge = *edge || dalcs_cosimulation_has_changed(c->cosimulation);
    return DALCS_OK;
}

/* What happens at one time. */
struct stop {
    double t;
    bool ends;    /* a step or another part of a component does */
    bool happens; /* and is an event, or the like */
    bool edge;    /* of a source or a gate */
    bool is_last;
};

/* The next time at which there is something to do; *again: rows went over several periods, look once more. */
static enum dalcs_status next_stop(struct transient *c, struct stop *next, bool *again) {
    struct dalcs_radau *radau = c->radau;
    const double near = radau->resolution;
    const double stop = radau->options.stop;
    *again = false;
    if (cycles(c)) {
        DALCS_TRY(leap(c));
    }
    double end = dalcs_radau_next_stop(radau, &next->happens);
    double t = dalcs_smaller(dalcs_smaller(end, stop),
                             dalcs_smaller(c->next_edge, c->measures->next_edge));
    t = dalcs_smaller(t, c->cosimulation->inputs.next);
    bool comes = c->next_row + near < t;
    if (comes || dalcs_filling_is_on(&c->filling, t)) {
        bool stops =
            (next->happens && end <= t + near) || c->next_edge <= t + near || t >= stop - near;
        DALCS_TRY(rows(c, t, stops));
        if (comes && cycles(c)) {
            *again = true;
            return DALCS_OK;
        }
    }
    t = dalcs_smaller(t, c->next_row);
    next->ends = end <= t + near;
    next->edge = c->next_edge <= t + near;
    next->t = next->ends ? end : next->edge ? c->next_edge : t;
    next->is_last = next->t >= stop - near;
    return DALCS_OK;
}

/* Components and gates go on behind it. */
static enum dalcs_status pass(struct transient *c, double t) {
    struct dalcs_radau *radau = c->radau;
    DALCS_TRY(sample(c, t));
    radau->base->t = t;
    DALCS_TRY(dalcs_radau_pass(radau, t));
    DALCS_TRY(pass_gates(c, t));
    dalcs_audit_run_enter(c->audit);
    radau->base->t = t;
    DALCS_TRY(dalcs_event_log_note(&c->recorder->log, radau->base, true));
    dalcs_audit_run_told(c->audit, t);
    return DALCS_OK;
}

/* To the next time at which there is something to do, with the rows up to there. */
static enum dalcs_status advance(struct transient *c) {
    const double near = c->radau->resolution;
    const double stop = c->radau->options.stop;
    struct stop next;
    bool again;
    DALCS_TRY(next_stop(c, &next, &again));
    if (again) {
        return DALCS_OK;
    }
    const double t = next.t;
    const bool event = next.ends && next.happens;
    c->t = t;
    DALCS_TRY(exchange(c, t, &next.edge));
    const bool passes = next.ends || (next.edge && has_gates(c));
    if ((passes || next.is_last) && has_gates(c)) {
        dalcs_measures_end_at(c->measures, t);
    }
    DALCS_TRY(dalcs_measures_reach(c->measures, c->radau, dalcs_smaller(t, stop), near));
    bool sides = dalcs_recorder_wants_sides(c->recorder, t);
    bool is_due = c->next_row <= t + near;
    if (is_due || (sides && (next.edge || event))) {
        DALCS_TRY(row(c, DALCS_LEFT, is_due));
        dalcs_filling_row(&c->filling, t, next.edge || event);
    }
    if (passes || next.is_last) {
        dalcs_audit_run_leave(c->audit, next.is_last ? stop : t);
    }
    if (next.is_last) {
        c->t = stop;
        return dalcs_gate_samples_read(&c->samples, c->logic, stop);
    }
    if (passes) {
        DALCS_TRY(pass(c, t));
    }
    bool jumps = next.edge && dalcs_sources_jump(&c->run->s->circuit, c->t);
    if (next.edge || has_gates(c)) {
        c->next_edge = edge_after(c, t);
    }
    return sides && (event || jumps) ? row(c, DALCS_RIGHT, false) : DALCS_OK;
}

static void note_end_of_filling(struct dalcs_run *r, const struct dalcs_filling *filling) {
    if (isfinite(filling->ended)) {
        dalcs_diag_add(
            &r->s->diag, DALCS_NOTE, NULL,
            "--fill with a larger bound or none, or a later tstart, leaves more for the rest",
            "%zu added rows, and %zu for each row of .tran, are the limit: it is reached at "
            "t = %.9g s, and no rows are added after that",
            FILLING_LIMIT.most, FILLING_LIMIT.for_each, filling->ended);
        dalcs_transient_warn_of_coarse_rows(r, &r->s->results.recorder.schedule, filling->ended);
    }
}

enum dalcs_status dalcs_transient_walk(struct dalcs_run *r, struct dalcs_radau *radau,
                                       struct dalcs_measures *measures,
                                       struct dalcs_audit_run *audit,
                                       struct dalcs_logic_run *logic) {
    struct transient c = {.run = r,
                          .recorder = &r->s->results.recorder,
                          .radau = radau,
                          .measures = measures,
                          .audit = audit,
                          .logic = logic,
                          .cosimulation = r->transient.cosimulation};
    logic->cut.user = audit;
    logic->cut.tell = tell_cut;
    c.next_row = dalcs_recorder_due(c.recorder);
    DALCS_TRY(dalcs_edges_ahead_of_all(&c.edges, r->s->circuit.stimulus, r->s->circuit.n_stimuli));
    c.next_edge = edge_after(&c, 0.0);
    c.interval = c.to_go = dalcs_transient_progress_interval(&r->s->network);
    enum dalcs_status status = dalcs_rows_setup(&c.rows, radau, NULL, r->s->network.n_outputs);
    if (status != DALCS_OK) {
        dalcs_edges_ahead_finish(&c.edges);
        return status;
    }
    status = dalcs_filling_setup(&c.filling, c.recorder, &c.rows, r->rows.fill, r->rows.lines,
                                 &FILLING_LIMIT);
    status = status == DALCS_OK ? dalcs_gate_samples_setup(&c.samples, logic) : status;
    dalcs_audit_run_begin(audit);
    dalcs_audit_run_told(audit, 0.0);
    status = status == DALCS_OK ? dalcs_audit_run_gates(audit, logic, 0.0) : status;
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
    dalcs_edges_ahead_finish(&c.edges);
    return status;
}
