/* shadow_run.c - a run without output, which sums the charge that each diode carries. */
#include "shadow_run.h"

#include "session_internal.h"

#include <math.h>
#include <string.h>

/* i from a to b in a straight line, where it is above 0. */
static void integrate(double a, double b, double dt, double *charge, double *square) {
    if (a <= 0 && b <= 0) {
        return;
    }
    if (a < 0 || b < 0) {
        dt *= fmax(a, b) / fabs(b - a);
        a = fmax(a, 0);
        b = fmax(b, 0);
    }
    *charge += dt * (a + b) / 2;
    *square += dt * (a * a + a * b + b * b) / 3;
}

static enum dalcs_status take_row(void *user, double time, const double *value) {
    struct dalcs_charge_collector *c = user;
    const double dt = c->is_transient ? time - c->last_time : 1;
    for (int k = 0; k < c->n; k++) {
        const double before = c->is_transient ? c->last[k] : value[k];
        struct dalcs_charge *charge = &c->charge[k];
        for (int side = 0; side < 2 && (c->has_row || !c->is_transient); side++) {
            const double sign = side == 0 ? 1 : -1;
            integrate(sign * before, sign * value[k], dt, &charge->of_all[side],
                      &charge->square_of_all[side]);
            if (!c->is_transient || c->last_time >= c->from) {
                integrate(sign * before, sign * value[k], dt, &charge->of_part[side],
                          &charge->square_of_part[side]);
            }
        }
        c->last[k] = value[k];
    }
    c->last_time = time;
    c->has_row = true;
    return DALCS_OK;
}

static enum dalcs_status ask(void *user, double time, double stop) {
    const struct dalcs_charge_collector *c = user;
    if (atomic_load(&c->session->is_cancelled)) {
        return DALCS_E_CANCELLED;
    }
    return c->to->progress != NULL ? c->to->progress(c->to->user, time, stop) : DALCS_OK;
}

double dalcs_charge_mean(const struct dalcs_charge *c, int side, double tolerance) {
    const double least = tolerance * (c->of_all[0] + c->of_all[1]);
    if (c->of_part[side] > least) {
        return c->square_of_part[side] / c->of_part[side];
    }
    return c->of_all[side] > least ? c->square_of_all[side] / c->of_all[side] : 0;
}

/* Which of the analyses shows what the diodes carry. */
static enum dalcs_analysis telling_analysis(const struct dalcs_circuit *c) {
    bool sweeps_sources = c->analyses.n_dc > 0;
    for (int k = 0; k < c->analyses.n_dc; k++) {
        sweeps_sources = sweeps_sources && c->analyses.dc[k].device >= 0 &&
                         c->device[c->analyses.dc[k].device].stimulus >= 0;
    }
    return c->analyses.transient.present ? DALCS_TRANSIENT
           : sweeps_sources              ? DALCS_DC_SWEEP
                                         : DALCS_OPERATING_POINT;
}

/* The diodes' currents are what rows show. Behind them are the measured signals where there are gates, which may sample
 * some of them. */
static enum dalcs_status list_signals(struct dalcs_arena *arena, struct dalcs_circuit *c, int n) {
    const struct dalcs_signal *all = c->results.signal;
    const int *measured = c->results.measured;
    const int n_measured =
        c->control.n_gates > 0 || c->control.n_delayed > 0 ? c->results.n_measured : 0;
    struct dalcs_signal *signal =
        dalcs_arena_alloc(arena, (size_t)(n + n_measured), sizeof *signal);
    int *place = dalcs_arena_alloc(arena, (size_t)n_measured, sizeof *place);
    if (signal == NULL || place == NULL) {
        return DALCS_E_NOMEM;
    }
    c->results.n_signals = 0;
    for (int k = 0; k < c->n_devices; k++) {
        if (dalcs_exponential_of(c, k) != NULL) {
            signal[c->results.n_signals++] = (struct dalcs_signal){
                .name = c->device[k].name, .kind = DALCS_SIGNAL_CURRENT, .device = k};
        }
    }
    c->results.n_shown = c->results.n_signals;
    for (int k = 0; k < n_measured; k++) {
        place[k] = c->results.n_signals;
        signal[c->results.n_signals++] = all[measured[k]];
    }
    c->results.signal = signal;
    c->results.measured = place;
    return DALCS_OK;
}

/* A session of the same circuit that records only the currents of diodes. */
static enum dalcs_status make_shadow(struct dalcs_session *s, int n, struct dalcs_session *shadow) {
    struct dalcs_circuit *c = &shadow->circuit;
    *c = s->circuit;
    c->arena = (struct dalcs_arena){0};
    shadow->name = s->name;
    shadow->is_cancelled_with = &s->is_cancelled;
    DALCS_TRY(list_signals(&shadow->arena, c, n));
    c->results.losses = NULL;
    c->results.n_computed = c->results.n_measured = c->results.n_measures = c->results.n_fouriers =
        c->results.n_prints = c->analyses.n_steps = 0;
    c->analyses.operating_point = true;
    c->options.compress = c->options.fill = 0;
    c->analyses.transient.step = 0; /* no more rows than are asked for */
    c->analyses.transient.start = 0;
    const struct dalcs_network_options options = {.silent = true,
                                                  .with_readout = dalcs_circuit_is_audited(c)};
    const enum dalcs_status status =
        dalcs_network_build(&shadow->network, c, &options, &shadow->diag);
    shadow->has_network = status == DALCS_OK;
    return status;
}

static void finish_shadow(struct dalcs_session *shadow) {
    dalcs_session_forget_run(shadow);
    if (shadow->has_network) {
        dalcs_network_finish(&shadow->network);
    }
    dalcs_diag_finish(&shadow->diag);
    dalcs_arena_finish(&shadow->circuit.arena);
    dalcs_arena_finish(&shadow->arena);
}

enum dalcs_status dalcs_shadow_run(struct dalcs_session *s, const struct dalcs_run_options *given,
                                   double tolerance, struct dalcs_charge_collector *c) {
    const enum dalcs_analysis analysis = telling_analysis(&s->circuit);
    struct dalcs_session shadow = {0};
    enum dalcs_status status = make_shadow(s, c->n, &shadow);
    struct dalcs_run_options options = *given;
    options.tolerance = tolerance;
    options.fill = options.compress = 0;
    options.at = NULL;
    options.record = options.energy = false;
    options.audit = DALCS_AUDIT_OFF;
    options.dump_path = NULL;
    const struct dalcs_transient *t = &s->circuit.analyses.transient;
    c->is_transient = analysis == DALCS_TRANSIENT;
    c->from = t->start > 0 ? t->start : t->stop / 2;
    c->has_row = false;
    memset(c->charge, 0, (size_t)c->n * sizeof *c->charge);
    const struct dalcs_sink sink = {.user = c, .row = take_row, .progress = ask};
    if (status == DALCS_OK) {
        status = dalcs_session_run_analysis(&shadow, &options, &sink, analysis);
    }
    finish_shadow(&shadow);
    return status;
}
