/* steady_run.c - .pss: the period, the search, then one period as the .tran that it is. */
#include "steady_step.h"

#include "sensitivity.h"
#include "stroboscope.h"

#include "quantity.h"

#include <math.h>
#include <stdlib.h>

/* Rows in a period, unless the netlist gives their distance. */
static const double rows_in_a_period = 1000.0;

/* What comes back after one more period may be off by so much, over the scale of a state: no more than what the search
 * has called good. */
static const double most_defect = 1e-10;

/* ---- The period ---------------------------------------------------------------------------------- */

bool dalcs_steady_returns(struct dalcs_steady *st) {
    dalcs_steady_find_residual(st);
    return st->pass.residual <= most_defect;
}

/* Is the run that has just ended, in st->then, where it began? */
enum dalcs_status dalcs_steady_find_defect(struct dalcs_steady *st) {
    struct dalcs_session *s = st->run->s;
    const bool returns = dalcs_steady_returns(st);
    s->results.report.steady.defect = st->pass.residual;
    if (!returns) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, "a smaller --tol",
                       "after one more period the states are off by %.3g", st->pass.residual);
        return DALCS_NOT_CONVERGED;
    }
    return DALCS_OK;
}

/* One period is short: every segment of it is audited, unless the audit is off. is_silent: without losses. */
static enum dalcs_status run_period(struct dalcs_steady *st, bool is_silent) {
    struct dalcs_run *r = st->run;
    const struct dalcs_run_options *options = r->options;
    struct dalcs_run_options all = *options;
    all.audit = options->audit == DALCS_AUDIT_OFF ? DALCS_AUDIT_OFF : DALCS_AUDIT_FULL;
    r->options = &all;
    r->orbit = &st->at;
    r->orbit_end = &st->then;
    struct dalcs_losses_card *losses = r->s->circuit.results.losses;
    const struct dalcs_losses_card of_tran =
        losses != NULL ? *losses : (struct dalcs_losses_card){0};
    if (losses != NULL) { /* the window is all of it */
        losses->from = 0.0;
        losses->to = INFINITY;
        losses->present = losses->present && !is_silent;
    }
    enum dalcs_status status = dalcs_transient_run_thinned(r);
    if (losses != NULL) {
        *losses = of_tran;
    }
    r->orbit = NULL;
    r->orbit_end = NULL;
    r->options = options;
    const bool is_beside =
        r->s->steady.near != NULL && r->s->steady.near->asked != DALCS_NEAR_ORBIT;
    return status == DALCS_OK && !is_beside ? dalcs_steady_find_defect(st) : status;
}

/* ---- A period as a .tran --------------------------------------------------------------------------- */

static void take_period(struct dalcs_run *r, double period, bool uic) {
    struct dalcs_circuit *c = &r->s->circuit;
    const double step =
        c->analyses.periodic.step > 0.0 ? c->analyses.periodic.step : period / rows_in_a_period;
    c->analyses.transient = (struct dalcs_transient){.present = true,
                                                     .step = step,
                                                     .stop = period,
                                                     .use_initial_conditions = uic,
                                                     .where = c->analyses.transient.where};
    r->h = period / rows_in_a_period;
    r->radau.max_step = r->options->step;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

/* The period may be a multiple of that of the sources: of gates, and of an orbit nearby. */
static enum dalcs_status take_repeats(struct dalcs_steady *st, bool uic) {
    struct dalcs_run *r = st->run;
    int n = 1;
    if (r->s->steady.near != NULL) {
        n = (int)rint(r->s->steady.near->period / st->period);
    } else if (r->s->circuit.control.n_gates > 0) {
        DALCS_TRY(dalcs_steady_find_repeats(st, &n));
        dalcs_steady_note_repeats(st, n);
    }
    st->period *= n > 1 ? n : 1;
    take_period(r, st->period, uic);
    return DALCS_OK;
}

/* From where any run starts, unless events crowd. */
static enum dalcs_status search_within(struct dalcs_steady *st, bool *found, bool *endless) {
    dalcs_steady_limit_crowd(st, true);
    const enum dalcs_status status = dalcs_steady_search(st, DALCS_STEADY_PERIODS, found, endless);
    const bool is_over = status >= DALCS_OK && !*found && dalcs_steady_is_crowded(st, NULL);
    dalcs_steady_limit_crowd(st, false);
    return is_over ? dalcs_steady_tell_crowd(st) : status;
}

/* From the orbit of a step before, if that leads to one; else from where any run starts. */
static enum dalcs_status search(struct dalcs_steady *st, bool is_free, bool leaves,
                                double n_periods) {
    const double guess = st->period;
    bool found = false;
    bool endless = false;
    struct dalcs_steady_attractor attractor = {.kind = DALCS_STEADY_UNKNOWN};
    DALCS_TRY(n_periods == 1.0 ? dalcs_steady_anchor_try(st, leaves, is_free, &found) : DALCS_OK);
    if (is_free) {
        DALCS_TRY(found ? DALCS_OK : dalcs_steady_find_oscillation(st, guess));
        st->period *= n_periods;
        return n_periods > 1.0 ? dalcs_steady_pass(st, 1, DALCS_STEADY_M) : DALCS_OK;
    }
    DALCS_TRY(found ? DALCS_OK : dalcs_steady_search_early(st, &found, &endless));
    DALCS_TRY(found || endless ? DALCS_OK : search_within(st, &found, &endless));
    if (!found && !endless) {
        DALCS_TRY(dalcs_steady_look_ahead(st, &found, &attractor));
        if (found) {
            return DALCS_OK;
        }
    }
    DALCS_TRY(found ? DALCS_OK : dalcs_steady_search_from_rest(st, &attractor, &found));
    if (!found) {
        return dalcs_steady_tell_failure(st, endless, &attractor);
    }
    return n_periods > 1.0 ? dalcs_steady_replace(st, st->period / n_periods, (int)n_periods)
                           : DALCS_OK;
}

/* st: set up from here on, to be finished by the caller. */
static enum dalcs_status find_orbit(struct dalcs_run *r, bool leaves, struct dalcs_steady *st) {
    const struct dalcs_circuit *c = &r->s->circuit;
    double period = r->options->period > 0.0 ? r->options->period : c->analyses.periodic.period;
    bool is_fixed = r->method != DALCS_METHOD_AUTO && r->options->step > 0.0;
    if (r->method == DALCS_METHOD_EULER || r->radau.fixed_step > 0.0 || is_fixed) {
        return dalcs_steady_refuse(r, "leave the method, or the step, to the program",
                                   "a steady state needs steps whose error is controlled");
    }
    bool is_free;
    DALCS_TRY(dalcs_steady_find_period(r, period, leaves, &period, &is_free));
    const double n_periods = fmax(1.0, c->analyses.periodic.n_periods);
    period *= is_free ? 1.0 : n_periods;
    if (c->analyses.periodic.oscillates && !is_free) {
        return dalcs_steady_refuse(
            r, "leave osc out: the period follows from the sources",
            "osc is for circuits that oscillate by themselves, and here a source repeats");
    }
    const bool uic =
        c->analyses.transient.use_initial_conditions || c->analyses.periodic.use_initial_conditions;
    take_period(r, period, uic);
    DALCS_TRY(dalcs_steady_setup(st, r, period));
    if (!leaves && r->s->steady.near == NULL && dalcs_steady_recall(st)) {
        take_period(r, st->period, uic);
        return DALCS_OK;
    }
    DALCS_TRY(is_free ? DALCS_OK : take_repeats(st, uic));
    if (r->s->steady.near != NULL && r->s->steady.near->asked != DALCS_NEAR_ORBIT) {
        DALCS_TRY(dalcs_steady_at_near(st, is_free, r->s->steady.near));
        take_period(r, st->period, uic);
        return DALCS_OK;
    }
    if (r->s->steady.near != NULL) {
        DALCS_TRY(dalcs_steady_from_near(st, is_free, r->s->steady.near));
        take_period(r, st->period, uic);
    } else {
        DALCS_TRY(search(st, is_free, leaves, n_periods));
        take_period(r, st->period, uic);
    }
    DALCS_TRY(is_free && n_periods > 1.0 ? DALCS_OK : dalcs_steady_anchor_keep(st, leaves));
    DALCS_TRY(leaves || r->s->steady.near != NULL ? DALCS_OK : dalcs_steady_remember(st));
    if (r->s->steady.anchor.is_sought ||
        r->s->results.report.steady.present) { /* no .pss, or it has reported */
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_steady_next_step(st)); /* how far it may be off, and what is conserved */
    DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_MEANS));
    DALCS_TRY(dalcs_steady_report(st));
    return n_periods == 1.0 && r->s->steady.near == NULL &&
                   dalcs_steady_is_unstable(&r->s->results.report)
               ? dalcs_steady_look_beside(st)
               : DALCS_OK;
}

enum dalcs_status dalcs_steady_prepare(struct dalcs_session *session) {
    const struct dalcs_network_options options = {.silent = true, .with_readout = true};
    if (session->network.readout != NULL || session->circuit.n_devices == 0) {
        return DALCS_OK;
    }
    dalcs_network_finish(&session->network);
    enum dalcs_status status =
        dalcs_network_build(&session->network, &session->circuit, &options, &session->diag);
    session->has_network = status == DALCS_OK;
    return status;
}

enum dalcs_status dalcs_steady_run(struct dalcs_run *r) {
    struct dalcs_steady st = {0};
    struct dalcs_steady_kept kept;
    DALCS_TRY(dalcs_steady_keep(r, &kept));
    const struct dalcs_steady_near *near = r->s->steady.near;
    const bool is_run =
        near == NULL || near->asked == DALCS_NEAR_ORBIT ||
        (near->asked == DALCS_NEAR_MEASURE && dalcs_steady_near_measures(&r->s->circuit));
    enum dalcs_status status = find_orbit(r, false, &st);
    status = status == DALCS_OK && !r->s->steady.anchor.is_sought && is_run ? run_period(&st, false)
                                                                            : status;
    dalcs_steady_put_back(r, &kept, true);
    free(kept.stimulus);
    if (status == DALCS_OK && r->s->circuit.analyses.sensitivity.present &&
        r->s->steady.near == NULL) {
        status = dalcs_sensitivities_run(&st);
    }
    dalcs_steady_finish(&st);
    return status;
}

static enum dalcs_status look_at(struct dalcs_run *r,
                                 enum dalcs_status (*look)(struct dalcs_steady *st),
                                 struct dalcs_steady *st) {
    const struct dalcs_circuit *c = &r->s->circuit;
    double period = r->options->period > 0.0 ? r->options->period : c->analyses.periodic.period;
    bool is_free;
    DALCS_TRY(dalcs_steady_find_period(r, period, false, &period, &is_free));
    if (is_free) {
        return dalcs_steady_refuse(r, "give the circuit a clock",
                                   "samples are taken once in each period, and no source repeats");
    }
    take_period(r, period,
                c->analyses.transient.use_initial_conditions ||
                    c->analyses.periodic.use_initial_conditions);
    DALCS_TRY(dalcs_steady_setup(st, r, period));
    return look(st);
}

enum dalcs_status dalcs_steady_look(struct dalcs_run *r,
                                    enum dalcs_status (*look)(struct dalcs_steady *st)) {
    struct dalcs_steady st = {0};
    struct dalcs_steady_kept kept;
    DALCS_TRY(dalcs_steady_keep(r, &kept));
    const enum dalcs_status status = look_at(r, look, &st);
    dalcs_steady_put_back(r, &kept, true);
    free(kept.stimulus);
    dalcs_steady_finish(&st);
    return status;
}

static enum dalcs_status no_plot(void *user, const struct dalcs_plot *plot) {
    (void)user;
    (void)plot;
    return DALCS_OK;
}

static enum dalcs_status no_row(void *user, double time, const double *value) {
    (void)user;
    (void)time;
    (void)value;
    return DALCS_OK;
}

static enum dalcs_status no_end(void *user) {
    (void)user;
    return DALCS_OK;
}

/* A period without rows is checked as any other. */
static enum dalcs_status check_period(struct dalcs_steady *st) {
    struct dalcs_run *r = st->run;
    const struct dalcs_sink *sink = r->sink;
    const struct dalcs_sink silent = {.user = sink->user,
                                      .begin = no_plot,
                                      .row = no_row,
                                      .end = no_end,
                                      .progress = sink->progress};
    r->sink = &silent;
    const enum dalcs_status status = run_period(st, true);
    r->sink = sink;
    return status;
}

enum dalcs_status dalcs_periodic_ac_run(struct dalcs_run *r) {
    struct dalcs_steady st = {0};
    struct dalcs_steady_kept kept;
    const bool is_checked = r->s->results.report.steady.present;
    DALCS_TRY(dalcs_steady_keep(r, &kept));
    enum dalcs_status status = find_orbit(r, false, &st);
    if (status == DALCS_OK && !r->s->steady.anchor.is_sought) {
        status = is_checked ? DALCS_OK : check_period(&st);
        status = status == DALCS_OK ? dalcs_periodic_ac_walk(&st) : status;
    }
    dalcs_steady_put_back(r, &kept, true);
    free(kept.stimulus);
    dalcs_steady_finish(&st);
    return status;
}

enum dalcs_status dalcs_steady_leave(struct dalcs_run *r) {
    struct dalcs_steady st = {0};
    struct dalcs_steady_kept kept;
    DALCS_TRY(dalcs_steady_keep(r, &kept));
    enum dalcs_status status = find_orbit(r, true, &st);
    dalcs_steady_put_back(r, &kept, false);
    if (status == DALCS_OK && !r->s->steady.anchor.is_sought) {
        r->orbit = &st.at;
        r->leaves_orbit = true;
        status = dalcs_transient_run_thinned(r);
        r->orbit = NULL;
        r->leaves_orbit = false;
    }
    dalcs_steady_put_back(r, &kept, true);
    free(kept.stimulus);
    dalcs_steady_finish(&st);
    return status;
}
