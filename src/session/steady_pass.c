/* steady_pass.c - a run of some periods from a given point. */
#include "steady.h"

#include "gates.h"
#include "orbit_log.h"
#include "radau.h"
#include "steady_means.h"
#include "steady_watch.h"
#include "transient.h"
#include "variation.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A state is measured by its own largest value on the way, but that of one that hardly moves beside others
 * of its unit is rounding of theirs. */
static const double least_scale = 1e-5;

/* The state of a pass. */
struct pass {
    struct dalcs_run *run;
    const struct dalcs_steady *of; /* a search that it is part of; NULL: none */
    struct dalcs_euler *euler;
    struct dalcs_radau *radau;
    struct dalcs_logic_run logic;
    struct dalcs_gate_samples samples;
    struct dalcs_steady_means *means; /* NULL: not asked for */
    struct dalcs_steady_watch *watch; /* likewise */
    const struct dalcs_logic_memory
        *ramps; /* segments end where ramps of outputs do; NULL: they need not */
    double t;   /* s, now */
};

/* All that happens at t; what does so at the end of a period belongs to the next one. */
static enum dalcs_status pass_time(struct pass *p, double t) {
    struct dalcs_radau *radau = p->radau;
    const bool is_last = t >= radau->options.stop;
    radau->base->t = t;
    DALCS_TRY(p->means != NULL ? dalcs_steady_means_reach(p->means, t) : DALCS_OK);
    if (p->means != NULL && is_last) {
        DALCS_TRY(dalcs_radau_evaluate(radau, t, DALCS_LEFT));
    }
    DALCS_TRY(dalcs_gate_samples_read(&p->samples, &p->logic, t));
    if (p->ramps != NULL && radau->part[0].kind == DALCS_PART_STEPPED &&
        radau->part[0].segment.t < t && radau->part[0].segment.t_end > t) {
        dalcs_radau_cut(&radau->part[0], t);
    }
    DALCS_TRY(dalcs_radau_pass(radau, t));
    return is_last || p->logic.circuit == NULL ? DALCS_OK
                                               : dalcs_transient_decide(p->run, &p->logic, t);
}

/* Of outputs that nothing reads but rows, too. */
static double next_ramp_end(const struct pass *p) {
    double next = INFINITY;
    for (int k = 0; p->ramps != NULL && k < p->ramps->n_pins; k++) {
        const struct dalcs_stimulus *s = &p->logic.circuit->stimulus[p->ramps->pin[k].stimulus];
        const double end = s->u.pwl.t[s->u.pwl.n - 1];
        next = end > p->t + p->radau->resolution ? fmin(next, end) : next;
    }
    return next;
}

/* The next time at which something happens; with gates what is as near to the end as times are told apart is the end. */
static double next_time(struct pass *p) {
    bool happens;
    const double stop = p->radau->options.stop;
    const double next = dalcs_radau_next_stop(p->radau, &happens);
    const double due = fmin(dalcs_logic_run_next(&p->logic), next_ramp_end(p));
    return due < next ? (due < stop - p->radau->resolution ? due : fmin(next, stop))
                      : fmin(next, stop);
}

static enum dalcs_status go(struct pass *p) {
    const struct dalcs_run *r = p->run;
    const double stop = p->radau->options.stop;
    const long interval = dalcs_transient_progress_interval(&r->s->network);
    double t = 0.0;
    long n = 0;
    DALCS_TRY(dalcs_run_progress(r, t, stop)); /* passes are short, and many */
    while (t < stop && (p->watch == NULL || !dalcs_steady_watch_is_full(p->watch))) {
        t = next_time(p);
        DALCS_TRY(pass_time(p, t));
        p->t = t;
        if (p->of != NULL && dalcs_steady_is_crowded(p->of, p->radau)) {
            return DALCS_NOT_CONVERGED;
        }
        if (++n % interval == 0) {
            DALCS_TRY(dalcs_run_progress(r, t, stop));
        }
    }
    return DALCS_OK;
}

/* The scales of numbers of gates: the largest voltage of the circuit, the length of the run. */
static void scale_numbers(struct dalcs_steady *st, const struct dalcs_radau *radau, double volts) {
    const struct dalcs_steady_layout *l = &st->layout;
    for (int k = 0; k < l->memory.n_numbers; k++) {
        int gate;
        const enum dalcs_logic_number kind = dalcs_logic_number_kind(&l->memory, k, &gate);
        const bool is_time = kind == DALCS_NUMBER_PULSE || kind == DALCS_NUMBER_DUE;
        st->scale[l->n_states + k] = is_time ? radau->options.stop : volts;
    }
}

/* What has died away so far that its energy is below the normal numbers is 0: sums of it lose their digits, and no one-step
 * problem that starts from there has a certificate. */
static double beyond_underflow(double x) {
    return x * x < DBL_MIN ? 0.0 : x;
}

static enum dalcs_status read_point(struct dalcs_steady *st, const struct pass *pass) {
    const struct dalcs_radau *radau = pass->radau;
    const struct dalcs_steady_layout *l = &st->layout;
    double largest[2] = {0.0, 0.0};
    for (int k = 0; k < radau->n_parts; k++) {
        for (int unit = 0; unit < 2 && radau->part[k].kind == DALCS_PART_STEPPED; unit++) {
            largest[unit] = fmax(largest[unit], radau->part[k].scales.unit[unit]);
        }
    }
    for (int k = 0; k < radau->n_parts; k++) {
        const struct dalcs_radau_part *part = &radau->part[k];
        const struct dalcs_system *s = part->component->system;
        for (int x = 0; x < s->n_x; x++) {
            st->then.x[l->first[k] + x] = beyond_underflow(part->x[x]);
            st->scale[l->first[k] + x] = fmax(
                fmax(part->scales.column[x], fmax(fabs(part->segment.in[x]), fabs(part->x[x]))),
                least_scale * largest[s->column_is_current[x]]);
        }
        for (int d = 0; d < s->n_pairs; d++) {
            st->then.closed[l->first_pair[k] + d] = s->pair[d].kind == DALCS_PAIR_SWITCH &&
                                                    dalcs_osnsp_is_on(&part->component->osnsp, d);
        }
    }
    scale_numbers(st, radau, largest[0]);
    return dalcs_steady_read_gates(&pass->logic, radau->options.stop, &st->then);
}

/* All periods once the run has started. */
static enum dalcs_status go_with_means(struct dalcs_steady *st, struct pass *p) {
    const struct dalcs_session *s = st->run->s;
    const struct dalcs_steady_means *means = p->means;
    const double duration = p->radau->options.stop;
    DALCS_TRY(dalcs_steady_means_setup(p->means, &s->circuit, &s->network, p->radau));
    enum dalcs_status status = go(p);
    dalcs_steady_means_close(p->means);
    for (int k = 0; k < s->network.n_outputs; k++) {
        st->found.average[k] = dalcs_steady_means_average(means, k, duration);
        st->found.rms[k] = dalcs_steady_means_rms(means, k, duration);
    }
    dalcs_recorder_states(&s->network, p->euler, st->found.state);
    return status;
}

static enum dalcs_status start(struct dalcs_steady *st, struct pass *p) {
    DALCS_TRY(st->has_point ? dalcs_steady_start(&st->at, p->euler, p->radau, &p->logic)
                            : dalcs_transient_start(st->run, p->euler, p->radau, &p->logic, false));
    DALCS_TRY(dalcs_radau_begin(p->radau));
    return p->logic.circuit != NULL ? dalcs_transient_decide(st->run, &p->logic, 0.0) : DALCS_OK;
}

static enum dalcs_status run_periods(struct dalcs_steady *st, struct pass *p,
                                     enum dalcs_steady_asked asked) {
    const bool with_M = asked == DALCS_STEADY_M;
    const bool with_modes = st->run->s->steady.near != NULL && !with_M; /* to compare two runs */
    struct dalcs_variation variation = {0};
    struct dalcs_observer observer;
    if (with_M || with_modes) {
        DALCS_TRY(
            dalcs_variation_setup(&variation, p->radau, &p->logic, &st->layout.memory, !with_M));
        observer = dalcs_variation_observer(&variation);
        p->euler->listener.observer = &observer;
    }
    struct dalcs_steady_means means = {0};
    const struct dalcs_session *s = st->run->s;
    enum dalcs_status status = DALCS_OK;
    if (asked == DALCS_STEADY_MEANS) {
        p->means = &means;
        status = dalcs_steady_means_listen(&means, &s->circuit, &s->network, p->euler,
                                           p->radau->resolution);
    }
    status = status == DALCS_OK ? start(st, p) : status;
    if (status == DALCS_OK) {
        status = asked == DALCS_STEADY_MEANS ? go_with_means(st, p) : go(p);
    }
    p->means = NULL;
    p->euler->listener.on_jump = NULL;
    dalcs_steady_means_finish(&means);
    if (status == DALCS_OK) {
        status = read_point(st, p);
    }
    if (status == DALCS_OK && (with_M || with_modes)) {
        dalcs_steady_read_signature(st, &variation);
        status = variation.status;
    }
    if (status == DALCS_OK && with_M) {
        dalcs_steady_read_M(st, &variation);
        dalcs_steady_read_phase(st, &variation);
    }
    p->euler->listener.observer = NULL;
    p->logic.observer = NULL;
    dalcs_variation_finish(&variation);
    return status;
}

static enum dalcs_status run_watched(struct dalcs_steady *st, struct pass *p) {
    struct dalcs_observer observer;
    if (p->watch != NULL) {
        observer = dalcs_steady_watch_observer(p->watch, p->radau);
        p->euler->listener.observer = &observer;
        dalcs_steady_watch_gates(p->watch, &p->logic);
    }
    enum dalcs_status status = start(st, p);
    status = status == DALCS_OK ? go(p) : status;
    p->euler->listener.observer = NULL;
    p->logic.observer = NULL;
    if (status == DALCS_OK) {
        status = read_point(st, p);
    }
    return status == DALCS_OK && p->watch != NULL ? p->watch->status : status;
}

/* Behind the set up of the engine, which the caller owns. */
static enum dalcs_status pass_setup(struct pass *p, struct dalcs_run *r, struct dalcs_euler *e,
                                    struct dalcs_radau *radau) {
    *p = (struct pass){.run = r, .euler = e, .radau = radau};
    DALCS_TRY(dalcs_logic_run_setup(&p->logic, &r->s->circuit, e, radau));
    return dalcs_gate_samples_setup(&p->samples, &p->logic);
}

static void pass_finish(struct pass *p) {
    dalcs_gate_samples_finish(&p->samples);
    dalcs_logic_run_finish(&p->logic);
}

static enum dalcs_status engine_setup(struct dalcs_run *r, struct dalcs_euler *e,
                                      struct dalcs_radau *radau, double h, double stop) {
    const struct dalcs_radau_options options = dalcs_transient_options(r, stop);
    DALCS_TRY(dalcs_euler_setup(e, &r->s->circuit, &r->s->network, &r->osnsp, h, stop));
    const enum dalcs_status status = dalcs_radau_setup(radau, e, &options, &r->osnsp);
    if (status != DALCS_OK) {
        dalcs_euler_finish(e);
    }
    return status;
}

enum dalcs_status dalcs_steady_pass_watched(struct dalcs_steady *st, double duration,
                                            struct dalcs_steady_watch *watch, bool *recurs,
                                            int *from, int *to) {
    struct dalcs_run *r = st->run;
    struct dalcs_euler e;
    struct dalcs_radau radau = {0};
    struct pass p;
    DALCS_TRY(engine_setup(r, &e, &radau, 1e-3 * duration, duration));
    enum dalcs_status status = pass_setup(&p, r, &e, &radau);
    p.watch = watch;
    if (status == DALCS_OK) {
        status = run_watched(st, &p);
        r->s->results.report.work.steps += radau.steps;
    }
    if (status == DALCS_OK && watch != NULL) {
        *recurs = dalcs_steady_watch_recurs(watch, &radau, from, to);
    }
    status = dalcs_explain_failure(r, &e, status);
    pass_finish(&p);
    dalcs_radau_finish(&radau);
    dalcs_euler_finish(&e);
    return status;
}

enum dalcs_status dalcs_steady_pass(struct dalcs_steady *st, long n,
                                    enum dalcs_steady_asked asked) {
    struct dalcs_run *r = st->run;
    struct dalcs_euler e;
    struct dalcs_radau radau = {0};
    struct pass p;
    const struct dalcs_diag_mark mark = dalcs_diag_mark(&r->s->diag);
    DALCS_TRY(engine_setup(r, &e, &radau, r->h, (double)n * st->period));
    enum dalcs_status status = pass_setup(&p, r, &e, &radau);
    p.of = st;
    if (status == DALCS_OK) {
        status = run_periods(st, &p, asked);
        st->n.periods += n;
        r->s->results.report.work.steps += radau.steps;
        dalcs_steady_count_crowd(st, &radau);
    }
    if (asked == DALCS_STEADY_M && status == DALCS_E_NETLIST) {
        /* Gates that do not settle where a step has led: a run that fails. A run from the start comes there or not. */
        dalcs_diag_forget(&r->s->diag, &mark);
        status = DALCS_NOT_CONVERGED;
    }
    status = asked == DALCS_STEADY_M ? status : dalcs_explain_failure(r, &e, status);
    pass_finish(&p);
    dalcs_radau_finish(&radau);
    dalcs_euler_finish(&e);
    if (status == DALCS_OK && st->has_point) {
        dalcs_steady_find_residual(st);
    }
    return status;
}

static enum dalcs_status run_logged(struct dalcs_steady *st, struct pass *p,
                                    struct dalcs_orbit_log *log) {
    struct dalcs_observer observer = dalcs_orbit_log_observer(log);
    p->euler->listener.observer = &observer;
    p->ramps = p->logic.circuit != NULL ? &st->layout.memory : NULL;
    DALCS_TRY(dalcs_orbit_log_watch(log, &p->logic, &st->layout.memory));
    enum dalcs_status status = start(st, p);
    status = status == DALCS_OK ? go(p) : status;
    status = status == DALCS_OK ? log->status : status;
    p->euler->listener.observer = NULL;
    status = status == DALCS_OK ? read_point(st, p) : status;
    return status == DALCS_OK ? dalcs_orbit_log_close(log, st->period) : status;
}

enum dalcs_status dalcs_steady_log(struct dalcs_steady *st, struct dalcs_euler *e,
                                   struct dalcs_radau *radau, struct dalcs_orbit_log *log) {
    struct pass p;
    enum dalcs_status status = pass_setup(&p, st->run, e, radau);
    status = status == DALCS_OK ? run_logged(st, &p, log) : status;
    pass_finish(&p);
    return status;
}
