/* transient.c - .tran: from the rows that are asked for to the reports.
 *
 * Implicit Euler walks its grid and rows follow (below). The Radau methods go where something happens
 * (transient_walk.c). dalcs_transient_run at the end is the table of contents. */
#include "transient.h"

#include "audit_run.h"
#include "cosimulation.h"
#include "energy.h"
#include "gates.h"
#include "losses_run.h"
#include "measures.h"
#include "steady.h"

#include <math.h>

/* Where .tran has no tstep. */
static const double ROWS_WITHOUT_A_STEP = 1000.0;

static double row_distance(const struct dalcs_circuit *c) {
    const struct dalcs_transient *t = &c->analyses.transient;
    return c->options.initial_interval > 0.0 ? c->options.initial_interval
           : t->step > 0.0                   ? t->step
                                             : t->stop / ROWS_WITHOUT_A_STEP;
}

static struct dalcs_schedule choose_schedule(const struct dalcs_run *r) {
    const struct dalcs_transient *t = &r->s->circuit.analyses.transient;
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

struct dalcs_radau_options dalcs_transient_options(const struct dalcs_run *r, double stop) {
    return (struct dalcs_radau_options){.tolerance = r->tolerance,
                                        .abstol = r->radau.abstol,
                                        .vntol = r->radau.vntol,
                                        .family = r->radau.family,
                                        .stages = r->radau.stages,
                                        .fixed_step = r->radau.fixed_step,
                                        .max_step = r->radau.max_step,
                                        .stop = stop,
                                        .store = r->store};
}

/* What a run with either method is made of. */
struct parts {
    bool is_euler;
    struct dalcs_euler euler;
    struct dalcs_radau radau;
    struct dalcs_energy energy;
    struct dalcs_measures measures;
    struct dalcs_losses_run losses;
    struct dalcs_impulses impulses;
    struct dalcs_audit_run audit;
    struct dalcs_logic_run logic;
    struct dalcs_cosimulation cosimulation;
};

/* s, the next time at which stimuli that are written may change. */
static double next_written(const struct parts *p) {
    return fmin(dalcs_logic_run_next(&p->logic), p->cosimulation.inputs.next);
}

/* What is just after a time at which sources jump, or gates decide. */
static enum dalcs_status cross(struct dalcs_run *r, struct parts *p) {
    struct dalcs_euler *e = &p->euler;
    const bool has_gates = p->logic.circuit != NULL;
    if (has_gates) {
        dalcs_gates_read_euler(&r->s->network, &p->logic);
    }
    for (int k = 0; has_gates && e->at_jump && k < e->n_components; k++) {
        dalcs_component_command_behind(&e->component[k], e->t);
    }
    if (has_gates && e->at_jump) { /* what both command acts together */
        DALCS_TRY(dalcs_transient_decide(r, &p->logic, e->t));
    }
    DALCS_TRY(e->at_jump ? dalcs_euler_cross(e) : DALCS_OK);
    if (has_gates) {
        DALCS_TRY(dalcs_transient_decide(r, &p->logic, e->t));
        dalcs_grid_disturb(&e->grid, next_written(p));
    }
    if (e->at_jump || (has_gates && dalcs_sources_jump(&r->s->circuit, e->t))) {
        DALCS_TRY(dalcs_recorder_cross(&r->s->results.recorder, e));
        dalcs_measures_cross(&p->measures, e);
    }
    return DALCS_OK;
}

static enum dalcs_status step_to_the_end(struct dalcs_run *r, struct parts *p) {
    struct dalcs_recorder *recorder = &r->s->results.recorder;
    struct dalcs_euler *e = &p->euler;
    const long interval = dalcs_transient_progress_interval(&r->s->network);
    if (p->logic.circuit != NULL) {
        dalcs_grid_disturb(&e->grid, next_written(p));
    }
    while (!dalcs_grid_at_end(&e->grid)) {
        DALCS_TRY(dalcs_euler_step(e));
        DALCS_TRY(dalcs_recorder_step(recorder, e));
        dalcs_measures_step(&p->measures, e);
        if (dalcs_cosimulation_is_due(&p->cosimulation, e->t, e->grid.resolution)) {
            DALCS_TRY(dalcs_cosimulation_ask(&p->cosimulation, e->t, NULL, e));
        }
        if ((e->at_jump || p->logic.circuit != NULL) && !dalcs_grid_at_end(&e->grid)) {
            DALCS_TRY(cross(r, p));
        }
        if (e->steps % interval == 0) {
            DALCS_TRY(dalcs_run_progress(r, e->t, e->grid.stop));
        }
    }
    return DALCS_OK;
}

static struct dalcs_radau *radau_of(struct parts *p) {
    return p->is_euler ? NULL : &p->radau;
}

/* Before anything is allocated but the recorder. */
static enum dalcs_status set_up_rows(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    struct dalcs_schedule schedule = choose_schedule(r);
    dalcs_transient_warn_of_coarse_rows(r, &schedule,
                                        isinf(r->rows.fill) ? schedule.start : INFINITY);
    dalcs_recorder_finish(&s->results.recorder); /* of a .pss before */
    DALCS_TRY(dalcs_recorder_setup(&s->results.recorder, &s->network, r->sink, &schedule,
                                   r->options->record, r->options->max_events));
    s->results.recorder.n_shown = s->circuit.results.n_shown;
    return dalcs_currents_watch(r);
}

static enum dalcs_status set_up_euler(struct dalcs_run *r, struct parts *p) {
    struct dalcs_session *s = r->s;
    const double stop = s->circuit.analyses.transient.stop;
    struct dalcs_euler *e = &p->euler;
    DALCS_TRY(dalcs_euler_setup(e, &s->circuit, &s->network, &r->osnsp, r->h, stop));
    e->listener.detects_jumps = r->options->record || dalcs_run_keeps_ledger(r) ||
                                dalcs_run_wants_losses(r) || s->circuit.results.n_measured > 0;
    e->listener.jump_user = r;
    e->listener.on_jump = dalcs_note_jump;
    e->listener.open_user = &r->nonunique.undetermined;
    e->listener.on_open = dalcs_undetermined_at;
    s->results.report.step = p->is_euler ? r->h : r->radau.fixed_step;
    s->results.report.stop = stop;
    return DALCS_OK;
}

static enum dalcs_status set_up_others(struct dalcs_run *r, struct parts *p) {
    struct dalcs_session *s = r->s;
    if (!p->is_euler) {
        const struct dalcs_radau_options options =
            dalcs_transient_options(r, s->circuit.analyses.transient.stop);
        DALCS_TRY(dalcs_radau_setup(&p->radau, &p->euler, &options, &r->osnsp));
    }
    DALCS_TRY(dalcs_logic_run_setup(&p->logic, &s->circuit, &p->euler, radau_of(p)));
    DALCS_TRY(dalcs_cosimulation_start(&p->cosimulation, r, &p->logic));
    r->transient.cosimulation = &p->cosimulation;
    if (dalcs_run_wants_losses(r)) {
        DALCS_TRY(dalcs_losses_run_start(&p->losses, r, &p->euler, p->is_euler,
                                         p->is_euler ? 0.0 : p->radau.resolution));
    }
    if (r->s->circuit.results.n_measured > 0) {
        DALCS_TRY(dalcs_impulses_setup(&p->impulses, &r->s->circuit, &r->s->network,
                                       p->is_euler ? 0.0 : p->radau.resolution));
        r->transient.impulses = &p->impulses;
        p->losses.sum.impulses = &p->impulses;
    }
    if (dalcs_run_keeps_ledger(r)) {
        DALCS_TRY(dalcs_energy_setup(&p->energy, &p->euler, radau_of(p)));
    }
    return p->is_euler ? DALCS_OK : dalcs_audit_run_start(&p->audit, r, &p->euler, &p->radau);
}

static enum dalcs_status walk(struct dalcs_run *r, struct parts *p) {
    struct dalcs_euler *e = &p->euler;
    struct dalcs_radau *radau = radau_of(p);
    struct dalcs_session *s = r->s;
    DALCS_TRY(dalcs_transient_report_methods(r, radau));
    DALCS_TRY(dalcs_transient_start(r, e, radau, &p->logic, true));
    if (r->orbit != NULL && !p->is_euler) {
        DALCS_TRY(dalcs_audit_gates_go_on(&p->audit.gates, &p->logic));
    }
    DALCS_TRY(dalcs_measures_prepare(&p->measures, r, radau));
    DALCS_TRY(radau != NULL ? dalcs_radau_begin(radau) : DALCS_OK);
    DALCS_TRY(dalcs_transient_decide(r, &p->logic, 0.0));
    if (radau != NULL) {
        DALCS_TRY(dalcs_radau_evaluate(radau, 0.0, DALCS_RIGHT));
    }
    DALCS_TRY(dalcs_undetermined_several(&r->nonunique.undetermined, e,
                                         s->circuit.analyses.transient.stop));
    dalcs_recorder_states(&s->network, e, s->results.start);
    DALCS_TRY(dalcs_run_begin_plot(r, r->orbit != NULL && !r->leaves_orbit ? DALCS_PERIODIC
                                                                           : DALCS_TRANSIENT));
    DALCS_TRY(dalcs_recorder_start(&s->results.recorder, e));
    DALCS_TRY(dalcs_measures_start(&p->measures, r, e, radau, &p->audit));
    enum dalcs_status status =
        radau != NULL ? dalcs_transient_walk(r, radau, &p->measures, &p->audit, &p->logic)
                      : step_to_the_end(r, p);
    if (status == DALCS_OK && radau != NULL) {
        status = dalcs_radau_evaluate(radau, radau->options.stop, DALCS_LEFT);
    }
    dalcs_recorder_states(&s->network, e, s->results.final);
    DALCS_TRY(status);
    if (r->orbit_end != NULL) {
        DALCS_TRY(
            dalcs_steady_read(e, &p->logic, s->circuit.analyses.transient.stop, r->orbit_end));
    }
    if (dalcs_audit_run_fails(&p->audit)) {
        return DALCS_REFUTED; /* the rows stay what they are: partial */
    }
    return r->sink->end(r->sink->user);
}

static enum dalcs_status walk_and_report(struct dalcs_run *r, struct parts *p) {
    DALCS_TRY(set_up_others(r, p));
    const enum dalcs_status walked = walk(r, p);
    const enum dalcs_status reported = dalcs_measures_report(&p->measures, r, walked);
    DALCS_TRY(walked);
    DALCS_TRY(reported);
    if (p->losses.wanted) {
        DALCS_TRY(dalcs_losses_run_report(&p->losses, r));
    }
    if (dalcs_run_keeps_ledger(r)) {
        DALCS_TRY(dalcs_transient_close_ledger(r, &p->energy, &p->euler, radau_of(p)));
    }
    dalcs_currents_judge(r);
    return DALCS_OK;
}

static void finish(struct dalcs_run *r, struct parts *p) {
    dalcs_audit_run_finish(&p->audit);
    dalcs_logic_run_finish(&p->logic);
    dalcs_cosimulation_finish(&p->cosimulation);
    r->transient.cosimulation = NULL;
    dalcs_measures_finish(&p->measures);
    dalcs_losses_run_finish(&p->losses);
    r->transient.losses = NULL;
    dalcs_impulses_finish(&p->impulses);
    r->transient.impulses = NULL;
    dalcs_energy_finish(&p->energy);
    dalcs_radau_finish(&p->radau);
    dalcs_euler_finish(&p->euler);
}

enum dalcs_status dalcs_transient_run(struct dalcs_run *r) {
    struct parts p = {.is_euler = r->method == DALCS_METHOD_EULER};
    DALCS_TRY(set_up_rows(r));
    DALCS_TRY(set_up_euler(r, &p));
    enum dalcs_status status = walk_and_report(r, &p);
    p.audit.ends_at_pole = dalcs_failed_at_pole(&p.euler, status);
    const bool is_wrong = dalcs_audit_run_fails(&p.audit);
    const enum dalcs_status audited = dalcs_audit_run_report(&p.audit);
    status = status == DALCS_OK ? audited : status;
    if (!is_wrong) {
        status = dalcs_explain_failure(r, &p.euler, status);
    }
    dalcs_run_add_work(r, &p.euler);
    dalcs_transient_add_radau_work(r, &p.radau);
    finish(r, &p);
    return status;
}
