/* periodic_ac.c - .ac behind .pss: small sinusoids around the periodic orbit. */
#include "periodic_ac.h"
#include "pi.h"

#include "radau.h"

#include <math.h>
#include <string.h>

/* Of the run whose log is taken: how events move follows from what is on both sides of them, which is as good as this. The
 * orbit of a looser run is off by what that run is. */
static const double tolerance_of_log = 1e-10;

/* ---- One frequency ------------------------------------------------------------------------------- */

static double probe(const struct dalcs_periodic_ac *a, const struct dalcs_probe *probe, int which) {
    if (probe->system < 0) {
        return 0.0;
    }
    const struct dalcs_periodic_ac_part *part = &a->part[probe->system];
    return dalcs_probe_value(probe, part->y[which], part->s[which]);
}

static enum dalcs_status refuse_frequency(const struct dalcs_periodic_ac *a, double frequency) {
    struct dalcs_run *r = a->run;
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, &r->s->circuit.analyses.ac.where,
                   "a quantity that no period changes, such as the charge of a floating node, has "
                   "an unbounded response there: add a path for it, or begin at another frequency",
                   "at %.9g Hz the response is not unique", frequency);
    return DALCS_SINGULAR;
}

/* Once more, as the audit sees it: what is written is what was found unseen. */
static enum dalcs_status audit_part(struct dalcs_periodic_ac *a, struct dalcs_periodic_ac_part *p,
                                    double frequency) {
    const double w = dalcs_two_pi * frequency;
    dalcs_audit_periodic_begin(&a->audit, (int)(p - a->part), &p->response, w, a->sideband);
    p->response.last_look++; /* diodes that rest are looked for at as many frequencies */
    DALCS_TRY(dalcs_periodic_response_at(&p->response, w, a->sideband));
    return dalcs_audit_periodic_end(&a->audit, &p->response, frequency);
}

static enum dalcs_status solve_part(struct dalcs_periodic_ac *a, struct dalcs_periodic_ac_part *p,
                                    double frequency) {
    if (p->rests) {
        return DALCS_OK;
    }
    const enum dalcs_status status =
        dalcs_periodic_response_at(&p->response, dalcs_two_pi * frequency, a->sideband);
    if (status == DALCS_SINGULAR) {
        return refuse_frequency(a, frequency);
    }
    DALCS_TRY(status);
    for (int m = 0; m < p->response.n_read; m++) {
        const int column = p->response.read[m];
        p->y[0][column] = creal(p->response.y[column]);
        p->y[1][column] = cimag(p->response.y[column]);
    }
    return a->is_audited && p != &a->by_current ? audit_part(a, p, frequency) : DALCS_OK;
}

static enum dalcs_status solve(struct dalcs_periodic_ac *a, double frequency) {
    for (int k = 0; k < a->n_parts; k++) {
        DALCS_TRY(solve_part(a, &a->part[k], frequency));
    }
    return a->loop.is_loaded ? solve_part(a, &a->by_current, frequency) : DALCS_OK;
}

static enum dalcs_status gain_at(void *user, double frequency, double complex *gain) {
    struct dalcs_periodic_ac *a = user;
    DALCS_TRY(solve(a, frequency));
    *gain = dalcs_periodic_loop_gain(a);
    return DALCS_OK;
}

static enum dalcs_status put_row(struct dalcs_periodic_ac *a, int k) {
    const double frequency = dalcs_sweep_value(a->sweep, k);
    struct dalcs_run *r = a->run;
    const struct dalcs_network *network = &r->s->network;
    const size_t n_shown = (size_t)r->s->circuit.results.n_shown;
    a->is_audited = dalcs_audit_periodic_asks(&a->audit, k);
    DALCS_TRY(solve(a, frequency));
    for (int i = 0; i < network->n_outputs; i++) {
        const struct dalcs_output *out = &network->output[i];
        for (int which = 0; which < 2; which++) {
            a->row[2 * i + which] = probe(a, &out->plus, which) - probe(a, &out->minus, which);
        }
    }
    DALCS_TRY(a->is_audited ? dalcs_audit_periodic_row(&a->audit, frequency, a->row) : DALCS_OK);
    a->is_audited = false;
    dalcs_measures_complex_row(&a->measures, frequency, a->row);
    memcpy(a->shown, a->row, 2 * n_shown * sizeof *a->shown);
    if (a->loop.device >= 0) {
        const double complex gain = dalcs_periodic_loop_gain(a);
        a->shown[2 * n_shown] = creal(gain);
        a->shown[2 * n_shown + 1] = cimag(gain);
        DALCS_TRY(dalcs_margins_reach(&a->margins, frequency, gain));
    }
    return r->sink->row(r->sink->user, frequency, a->shown);
}

/* ---- All of them --------------------------------------------------------------------------------- */

/* The gain of the loop is a signal behind the others. */
static enum dalcs_status announce(struct dalcs_periodic_ac *a) {
    struct dalcs_run *r = a->run;
    struct dalcs_arena *arena = &r->s->arena;
    const size_t n_shown = (size_t)r->s->circuit.results.n_shown;
    const size_t n = n_shown + (a->loop.device >= 0 ? 1 : 0);
    a->name = dalcs_arena_alloc(arena, n_shown + 1, sizeof *a->name);
    a->unit = dalcs_arena_alloc(arena, n_shown + 1, sizeof *a->unit);
    if (a->name == NULL || a->unit == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_shown; k++) {
        a->name[k] = r->signals.name[k];
        a->unit[k] = r->signals.unit[k];
    }
    a->unit[n_shown] = DALCS_UNIT_NONE;
    if (a->loop.device >= 0) {
        a->name[n_shown] =
            dalcs_arena_printf(arena, "loop(%s)", r->s->circuit.device[a->loop.device].name);
        DALCS_TRY(a->name[n_shown] != NULL ? DALCS_OK : DALCS_E_NOMEM);
    }
    return dalcs_run_announce(r, &(struct dalcs_plot){.analysis = DALCS_AC,
                                                      .scale = "frequency",
                                                      .scale_unit = DALCS_UNIT_HERTZ,
                                                      .n_signals = n,
                                                      .name = a->name,
                                                      .unit = a->unit,
                                                      .is_complex = true});
}

static enum dalcs_status walk(struct dalcs_periodic_ac *a) {
    struct dalcs_run *r = a->run;
    const struct dalcs_sweep *f = a->sweep;
    DALCS_TRY(announce(a));
    DALCS_TRY(dalcs_measures_start_rows(&a->measures, r, DALCS_MEASURED_AC, dalcs_sweep_value(f, 0),
                                        dalcs_sweep_value(f, f->n - 1)));
    a->margins = (struct dalcs_margins){.user = a, .at = gain_at};
    for (int k = 0; k < f->n; k++) {
        DALCS_TRY(put_row(a, k));
        DALCS_TRY(dalcs_run_progress(r, k + 1, f->n));
    }
    dalcs_periodic_ac_tell(a);
    DALCS_TRY(dalcs_measures_report(&a->measures, r, DALCS_OK));
    DALCS_TRY(dalcs_periodic_loop_report(a));
    return r->sink->end(r->sink->user);
}

/* ---- From the orbit to the rows ------------------------------------------------------------------- */

static enum dalcs_status start_audit(struct dalcs_periodic_ac *a, double tolerance) {
    a->answer = dalcs_arena_alloc(&a->arena, (size_t)a->n_parts + 1, sizeof *a->answer);
    if (a->answer == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < a->n_parts; k++) {
        a->answer[k] = (struct dalcs_response_columns){{a->part[k].y[0], a->part[k].y[1]}};
    }
    const struct dalcs_audit_periodic_asked asked = {.run = a->run,
                                                     .euler = &a->euler,
                                                     .log = &a->log,
                                                     .orbit_tolerance = tolerance,
                                                     .of = a->answer,
                                                     .n = a->sweep->n};
    return dalcs_audit_periodic_start(&a->audit, &asked);
}

static void report(struct dalcs_periodic_ac *a) {
    struct dalcs_session *s = a->run->s;
    s->results.report.response.present = true;
    s->results.report.response.period = a->st->period;
    s->results.report.response.sideband = a->sideband;
    s->results.report.response.exact = a->log.is_exact && a->st->pass.is_exact;
    for (int k = 0; k < a->n_parts; k++) {
        s->results.report.response.tail =
            fmax(s->results.report.response.tail, a->part[k].flow.worst);
    }
    if (!s->results.report.response.exact) {
        dalcs_diag_add(
            &s->diag, DALCS_WARNING, &s->circuit.analyses.ac.where, NULL,
            "the response is not exact: the mode is not known all the time, an event only "
            "touches its threshold, or commands at one time move apart");
    }
    if (s->results.report.steady.present && dalcs_steady_is_unstable(&s->results.report)) {
        dalcs_diag_add(&s->diag, DALCS_WARNING, &s->circuit.analyses.ac.where, NULL,
                       "the orbit is unstable: this is the response around it, which no run and no "
                       "analyser would show");
    }
}

static double complex source_of(const void *user, int stimulus) {
    const struct dalcs_periodic_ac *a = user;
    return dalcs_periodic_loop_source(a, a->loop.device, stimulus);
}

/* *is_off: the period of the log does not come back, and that of a run with its tolerance may. */
static enum dalcs_status look_around(struct dalcs_periodic_ac *a, bool *is_off) {
    struct dalcs_run *r = a->run;
    struct dalcs_radau_options options = dalcs_transient_options(r, a->st->period);
    options.tolerance = fmin(options.tolerance, tolerance_of_log);
    a->sideband =
        r->options->sideband != 0 ? r->options->sideband : r->s->circuit.analyses.orbit_ac.sideband;
    DALCS_TRY(dalcs_periodic_frequencies_choose(a));
    DALCS_TRY(dalcs_periodic_loop_find(a));
    DALCS_TRY(dalcs_radau_setup(&a->radau, &a->euler, &options, &r->osnsp));
    const struct dalcs_orbit_sources sources = {a, source_of};
    DALCS_TRY(dalcs_orbit_log_setup(&a->log, &a->radau, &sources));
    a->log.is_recorded = dalcs_audit_periodic_is_asked(r);
    DALCS_TRY(dalcs_explain_failure(r, &a->euler,
                                    dalcs_steady_log(a->st, &a->euler, &a->radau, &a->log)));
    *is_off = r->tolerance > options.tolerance && !dalcs_steady_returns(a->st);
    if (*is_off) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_steady_find_defect(a->st));
    DALCS_TRY(dalcs_periodic_ac_setup(a));
    DALCS_TRY(start_audit(a, options.tolerance));
    report(a);
    return walk(a);
}

static void part_finish(struct dalcs_periodic_ac_part *p) {
    dalcs_periodic_response_finish(&p->response);
    dalcs_periodic_flow_finish(&p->flow);
}

static enum dalcs_status walk_around(struct dalcs_steady *st, bool *is_off) {
    struct dalcs_run *r = st->run;
    struct dalcs_periodic_ac a = {.st = st, .run = r};
    DALCS_TRY(
        dalcs_euler_setup(&a.euler, &r->s->circuit, &r->s->network, &r->osnsp, r->h, st->period));
    const enum dalcs_status status = look_around(&a, is_off);
    for (int k = 0; k < a.n_parts; k++) {
        part_finish(&a.part[k]);
    }
    part_finish(&a.by_current);
    dalcs_margins_finish(&a.margins);
    dalcs_audit_periodic_finish(&a.audit);
    dalcs_measures_finish(&a.measures);
    dalcs_orbit_log_finish(&a.log);
    dalcs_radau_finish(&a.radau);
    dalcs_euler_finish(&a.euler);
    dalcs_arena_finish(&a.arena);
    return status;
}

enum dalcs_status dalcs_periodic_ac_walk(struct dalcs_steady *st) {
    struct dalcs_run *r = st->run;
    const double tolerance = r->tolerance;
    bool is_off = false;
    bool found;
    enum dalcs_status status = walk_around(st, &is_off);
    if (status == DALCS_OK && is_off) {
        r->tolerance = tolerance_of_log;
        status = dalcs_steady_burst(st, &found);
        status = status == DALCS_OK ? walk_around(st, &is_off) : status;
        r->tolerance = tolerance;
    }
    return status;
}
