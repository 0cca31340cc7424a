/* steady_run.c - .pss: the period, the search, then one period as the .tran that it is. */
#include "steady.h"

#include "sensitivity.h"
#include "stroboscope.h"

#include "quantity.h"

#include <math.h>
#include <stdlib.h>

/* Rows in a period, where nobody asks for another distance. */
static const double rows_in_a_period = 1000.0;

/* What comes back after one more period may be off by so much, over the scale of a state: no more than what the search
 * has called good. */
static const double most_defect = 1e-10;

/* That a message names. */
enum { MOST_STATES = 8 };

static enum dalcs_status refuse(struct dalcs_run *r, const char *hint, const char *text) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, hint, "%s", text);
    return DALCS_E_OPTION;
}

/* ---- Failures in words --------------------------------------------------------------------------- */

static const char *unit_of(const struct dalcs_steady *st, int state) {
    int k = 0;
    while (state >= st->layout.first[k + 1]) {
        k++;
    }
    return st->run->s->network.system[k].column_is_current[state - st->layout.first[k]] ? "A" : "V";
}

/* "v(c2) rises by 3.33 mV and v(c1) falls by 3.33 mV": the states that move most, of the last pass. */
static const char *moves_text(struct dalcs_steady *st) {
    struct dalcs_arena *arena = &st->run->s->arena;
    const char *text = "";
    double most = INFINITY;
    for (int told = 0; told < 2 && text != NULL; told++) {
        int state = -1;
        double next = 0.0;
        for (int x = 0; x < st->layout.n_x; x++) {
            double moves = fabs(st->step[x]) / (st->scale[x] > 0.0 ? st->scale[x] : 1.0);
            bool is_next = moves > next && (moves < most || (moves == most && told > 0));
            state = is_next ? x : state;
            next = is_next ? moves : next;
        }
        if (state < 0 || (told > 0 && next < 1e-3 * most)) {
            break;
        }
        char by[DALCS_QUANTITY_SIZE];
        text = dalcs_arena_printf(
            arena, "%s%s%s %s by %s", text, told > 0 ? " and " : "", dalcs_steady_name(st, state),
            st->step[state] > 0.0 ? "rises" : "falls",
            dalcs_quantity_write(by, fabs(st->step[state]), unit_of(st, state), 6));
        st->step[state] = 0.0;
        most = told == 0 ? next : most;
    }
    return text == NULL ? "" : text;
}

static enum dalcs_status tell_failure(struct dalcs_steady *st, bool endless) {
    struct dalcs_session *s = st->run->s;
    for (int x = 0; x < st->layout.n_x; x++) {
        st->step[x] = st->then.x[x] - st->at.x[x];
    }
    if (endless) {
        for (int x = 0; x < st->layout.n_x; x++) {
            st->step[x] = st->drift[x];
        }
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL,
            "a source fills what nothing empties: give it a way out, or limit what commands it",
            "there is no periodic steady state: each period %s, whatever they are", moves_text(st));
        return DALCS_NOT_CONVERGED;
    }
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL,
                   "look at it with .tran; a switch that follows the circuit may have a clock of "
                   "its own",
                   "no periodic steady state was found in %ld periods; in the last one %s",
                   st->n.periods, moves_text(st));
    return DALCS_NOT_CONVERGED;
}

static const char *states_text(struct dalcs_steady *st) {
    struct dalcs_arena *arena = &st->run->s->arena;
    const char *text = "";
    for (int x = 0; x < st->layout.n_x && text != NULL; x++) {
        char value[DALCS_QUANTITY_SIZE];
        if (x == MOST_STATES) {
            return dalcs_arena_printf(arena, "%s, ...", text);
        }
        text = dalcs_arena_printf(arena, "%s%s%s = %s", text, x > 0 ? ", " : "",
                                  dalcs_steady_name(st, x),
                                  dalcs_quantity_write(value, st->at.x[x], unit_of(st, x), 9));
    }
    return text == NULL ? "" : text;
}

/* Of a circuit without a clock. */
static enum dalcs_status find_oscillation(struct dalcs_steady *st, double guess) {
    struct dalcs_session *s = st->run->s;
    bool found;
    bool rests;
    DALCS_TRY(dalcs_steady_oscillation(st, guess, &found, &rests));
    if (rests && st->layout.n_x == 0) {
        return refuse(st->run, ".op has what there is",
                      "no source repeats, and nothing in the circuit has a memory");
    }
    if (rests) {
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL,
            ".op has that state; if the circuit is to oscillate, start it with IC= and uic",
            "there is no oscillation: no source repeats, and the circuit comes to rest, "
            "at %s",
            states_text(st));
        return DALCS_NOT_CONVERGED;
    }
    if (!found && st->is_free_of_events) {
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL,
            "what is linear rings at any amplitude, or moves on and on; look at it with "
            ".tran",
            "there is no oscillation of its own: no source repeats, and nothing switches "
            "again and again");
        return DALCS_NOT_CONVERGED;
    }
    if (!found) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL,
                       "look at it with .tran; a guess of the period, .pss 10u, may help",
                       "no source repeats, and no oscillation was found");
        return DALCS_NOT_CONVERGED;
    }
    return DALCS_OK;
}

/* ---- The period ---------------------------------------------------------------------------------- */

/* Is the run that has just ended, in st->then, where it began? */
enum dalcs_status dalcs_steady_find_defect(struct dalcs_steady *st) {
    struct dalcs_session *s = st->run->s;
    dalcs_steady_find_residual(st);
    s->report.steady.defect = st->residual;
    if (!(st->residual <= most_defect)) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, "a smaller --tol",
                       "after one more period the states are off by %.3g", st->residual);
        return DALCS_NOT_CONVERGED;
    }
    return DALCS_OK;
}

/* One period is short: every segment of it is audited, unless none is to be. is_silent: nobody asks for its losses. */
static enum dalcs_status run_period(struct dalcs_steady *st, bool is_silent) {
    struct dalcs_run *r = st->run;
    const struct dalcs_run_options *options = r->options;
    struct dalcs_run_options all = *options;
    all.audit = options->audit == DALCS_AUDIT_OFF ? DALCS_AUDIT_OFF : DALCS_AUDIT_FULL;
    r->options = &all;
    r->orbit = &st->at;
    r->orbit_end = &st->then;
    struct dalcs_losses_card *losses = r->s->circuit.losses;
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
    const bool is_beside = r->s->near != NULL && r->s->near->asked != DALCS_NEAR_ORBIT;
    return status == DALCS_OK && !is_beside ? dalcs_steady_find_defect(st) : status;
}

/* ---- A period as a .tran --------------------------------------------------------------------------- */

static void take_period(struct dalcs_run *r, double period, bool uic) {
    struct dalcs_circuit *c = &r->s->circuit;
    const double step = c->periodic.step > 0.0 ? c->periodic.step : period / rows_in_a_period;
    c->transient = (struct dalcs_transient){.present = true,
                                            .step = step,
                                            .stop = period,
                                            .use_initial_conditions = uic,
                                            .where = c->transient.where};
    r->h = period / rows_in_a_period;
    r->max_step = r->options->step;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

/* Does the largest multiplier say that each second period differs? */
static bool is_subharmonic(const struct dalcs_report *report) {
    const struct dalcs_floquet *m = report->steady.multiplier;
    return dalcs_steady_is_unstable(report) && m[0].im == 0.0 && m[0].re < 0.0;
}

/* st: set up from here on, to be finished by the caller. */
static enum dalcs_status find_orbit(struct dalcs_run *r, bool leaves, struct dalcs_steady *st) {
    const struct dalcs_circuit *c = &r->s->circuit;
    double period = r->options->period > 0.0 ? r->options->period : c->periodic.period;
    bool found = false;
    bool endless;
    bool is_fixed = r->method != DALCS_METHOD_AUTO && r->options->step > 0.0;
    if (r->method == DALCS_METHOD_EULER || r->fixed_step > 0.0 || is_fixed) {
        return refuse(r, "leave the method, or the step, to the program",
                      "a steady state needs steps whose error is controlled");
    }
    bool is_free;
    DALCS_TRY(dalcs_steady_find_period(r, period, leaves, &period, &is_free));
    const double n_periods = fmax(1.0, c->periodic.n_periods);
    const double one = period;
    period = is_free ? period : n_periods * period;
    if (c->periodic.oscillates && !is_free) {
        return refuse(r, "leave osc out: the period follows from the sources",
                      "osc is of circuits that oscillate by themselves, and here a source repeats");
    }
    const bool uic = c->transient.use_initial_conditions || c->periodic.use_initial_conditions;
    take_period(r, period, uic);
    DALCS_TRY(dalcs_steady_setup(st, r, period));
    if (r->s->near != NULL && r->s->near->asked != DALCS_NEAR_ORBIT) {
        DALCS_TRY(dalcs_steady_at_near(st, is_free, r->s->near));
        take_period(r, st->period, uic);
        return DALCS_OK;
    }
    if (r->s->near != NULL) {
        DALCS_TRY(dalcs_steady_from_near(st, is_free, r->s->near));
        take_period(r, st->period, uic);
    } else if (is_free) {
        DALCS_TRY(find_oscillation(st, period));
        st->period *= n_periods;
        DALCS_TRY(n_periods > 1.0 ? dalcs_steady_pass(st, 1, DALCS_STEADY_M) : DALCS_OK);
        take_period(r, st->period, uic);
    } else {
        endless = false;
        DALCS_TRY(n_periods == 1.0 ? dalcs_steady_anchor_try(st, leaves, &found) : DALCS_OK);
        DALCS_TRY(found ? DALCS_OK : dalcs_steady_search(st, &found, &endless));
        if (!found) {
            return tell_failure(st, endless);
        }
        DALCS_TRY(n_periods > 1.0 ? dalcs_steady_replace(st, one, (int)n_periods) : DALCS_OK);
    }
    DALCS_TRY(is_free ? DALCS_OK : dalcs_steady_anchor_keep(st, leaves));
    if (r->s->anchor.is_sought ||
        r->s->report.steady.present) { /* nobody asks, or its .pss has told */
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_steady_next_step(st)); /* how far it may be off, and what is conserved */
    DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_MEANS));
    DALCS_TRY(dalcs_steady_report(st));
    return period == one && r->s->near == NULL && is_subharmonic(&r->s->report)
               ? dalcs_steady_look_for_double(st)
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
    const struct dalcs_steady_near *near = r->s->near;
    const bool is_run =
        near == NULL || near->asked == DALCS_NEAR_ORBIT ||
        (near->asked == DALCS_NEAR_MEASURE && dalcs_steady_near_measures(&r->s->circuit));
    enum dalcs_status status = find_orbit(r, false, &st);
    status =
        status == DALCS_OK && !r->s->anchor.is_sought && is_run ? run_period(&st, false) : status;
    dalcs_steady_put_back(r, &kept, true);
    free(kept.stimulus);
    if (status == DALCS_OK && r->s->circuit.sensitivity.present && r->s->near == NULL) {
        status = dalcs_sensitivities_run(&st);
    }
    dalcs_steady_finish(&st);
    return status;
}

static enum dalcs_status look_at(struct dalcs_run *r,
                                 enum dalcs_status (*look)(struct dalcs_steady *st),
                                 struct dalcs_steady *st) {
    const struct dalcs_circuit *c = &r->s->circuit;
    double period = r->options->period > 0.0 ? r->options->period : c->periodic.period;
    bool is_free;
    DALCS_TRY(dalcs_steady_find_period(r, period, false, &period, &is_free));
    if (is_free) {
        return refuse(r, "give the circuit a clock",
                      "samples are taken once in each period, and no source repeats");
    }
    take_period(r, period,
                c->transient.use_initial_conditions || c->periodic.use_initial_conditions);
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

/* A period whose rows nobody has asked for is checked as any other. */
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
    const bool is_checked = r->s->report.steady.present;
    DALCS_TRY(dalcs_steady_keep(r, &kept));
    enum dalcs_status status = find_orbit(r, false, &st);
    if (status == DALCS_OK && !r->s->anchor.is_sought) {
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
    if (status == DALCS_OK && !r->s->anchor.is_sought) {
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
