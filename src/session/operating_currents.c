/* operating_currents.c - exponential diodes: their tangents are taken at the currents that they carry.
 *
 * A tangent at I0 is above V = N Vt log(1 + I/IS) + RS I everywhere else. At the mean of the current over the charge that
 * passes, I0 = (integral of i^2) / (integral of i), the energy that the line takes is that of the curve to first
 * order. That current is found by running the circuit: with the tangents of the pass before, first without a forward voltage, so
 * that all conduct which may, until nothing changes. With I0 off by a part d the voltage is off by N Vt (d - log(1 + d)), in second order of d: a
 * pass needs the root of the run's tolerance only, and one whose voltages changed by that root is the last, for the
 * next would change them by its square. Mostly there are two. */
#include "session_internal.h"

#include <math.h>
#include <string.h>

enum { MOST_PASSES = 8, MOST_NAMED = 4 };

/* A, of a diode that nothing passes, and where the first pass fails: a source across ideal diodes, say. */
static const double USUAL = 1;

/* Forward and backward, over all of the run and over the part that counts. */
struct charge {
    double of_all[2], of_part[2];               /* C */
    double square_of_all[2], square_of_part[2]; /* A^2 s */
};

struct collector {
    const struct dalcs_sink *to;         /* asked whether to go on */
    const struct dalcs_session *session; /* likewise */
    int n;
    struct charge *charge;  /* [n] */
    double *last;           /* [n] */
    double last_time, from; /* s */
    bool is_transient, has_row;
};

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
    struct collector *c = user;
    const double dt = c->is_transient ? time - c->last_time : 1;
    for (int k = 0; k < c->n; k++) {
        const double before = c->is_transient ? c->last[k] : value[k];
        struct charge *charge = &c->charge[k];
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
    const struct collector *c = user;
    if (atomic_load(&c->session->is_cancelled)) {
        return DALCS_E_CANCELLED;
    }
    return c->to->progress != NULL ? c->to->progress(c->to->user, time, stop) : DALCS_OK;
}

/* A; 0: nothing passes. What passes must be more than the run's errors in all that does, and so must what passes in
 * the part that counts. */
static double mean_of(const struct charge *c, int side, double tolerance) {
    const double least = tolerance * (c->of_all[0] + c->of_all[1]);
    if (c->of_part[side] > least) {
        return c->square_of_part[side] / c->of_part[side];
    }
    return c->of_all[side] > least ? c->square_of_all[side] / c->of_all[side] : 0;
}

static const struct dalcs_exponential *exponential_of(const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    const struct dalcs_exponential *e =
        d->kind == DALCS_DIODE ? &c->diode_model[d->model].exponential : NULL;
    return e != NULL && e->voltage > 0 ? e : NULL;
}

/* A model of its own for each exponential diode, at the current that the netlist's models are taken at. */
static enum dalcs_status part_models(struct dalcs_circuit *c, int n) {
    struct dalcs_diode_model *all =
        dalcs_arena_alloc(&c->arena, (size_t)(c->n_diode_models + n), sizeof *all);
    if (all == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(all, c->diode_model, (size_t)c->n_diode_models * sizeof *all);
    for (int k = 0; k < c->n_devices; k++) {
        if (exponential_of(c, k) != NULL) {
            all[c->n_diode_models] = c->diode_model[c->device[k].model];
            c->device[k].model = c->n_diode_models++;
        }
    }
    c->diode_model = all;
    c->has_own_tangents = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_operating_currents_keep(struct dalcs_circuit *to,
                                                const struct dalcs_circuit *from, bool *any) {
    int n = 0;
    for (int k = 0; k < to->n_devices; k++) {
        n += exponential_of(to, k) != NULL ? 1 : 0;
    }
    *any = n > 0 && from->n_devices == to->n_devices;
    if (!*any) {
        return DALCS_OK;
    }
    DALCS_TRY(part_models(to, n));
    for (int k = 0; k < to->n_devices; k++) {
        const struct dalcs_exponential *was =
            exponential_of(to, k) != NULL ? exponential_of(from, k) : NULL;
        if (was != NULL) {
            dalcs_exponential_take(&to->diode_model[to->device[k].model], was->at, was->back_at);
        }
    }
    return DALCS_OK;
}

/* Which of the analyses shows what the diodes carry. */
static enum dalcs_analysis telling_analysis(const struct dalcs_circuit *c) {
    bool sweeps_sources = c->n_dc > 0;
    for (int k = 0; k < c->n_dc; k++) {
        sweeps_sources =
            sweeps_sources && c->dc[k].device >= 0 && c->device[c->dc[k].device].stimulus >= 0;
    }
    return c->transient.present ? DALCS_TRANSIENT
           : sweeps_sources     ? DALCS_DC_SWEEP
                                : DALCS_OPERATING_POINT;
}

/* The diodes' currents are what rows show. Behind them are the measured signals where there are gates, which may sample
 * some of them. */
static enum dalcs_status list_signals(struct dalcs_arena *arena, struct dalcs_circuit *c, int n) {
    const struct dalcs_signal *all = c->signal;
    const int *measured = c->measured;
    const int n_measured = c->n_gates > 0 || c->n_delayed > 0 ? c->n_measured : 0;
    struct dalcs_signal *signal =
        dalcs_arena_alloc(arena, (size_t)(n + n_measured), sizeof *signal);
    int *place = dalcs_arena_alloc(arena, (size_t)n_measured, sizeof *place);
    if (signal == NULL || place == NULL) {
        return DALCS_E_NOMEM;
    }
    c->n_signals = 0;
    for (int k = 0; k < c->n_devices; k++) {
        if (exponential_of(c, k) != NULL) {
            signal[c->n_signals++] = (struct dalcs_signal){
                .name = c->device[k].name, .kind = DALCS_SIGNAL_CURRENT, .device = k};
        }
    }
    c->n_shown = c->n_signals;
    for (int k = 0; k < n_measured; k++) {
        place[k] = c->n_signals;
        signal[c->n_signals++] = all[measured[k]];
    }
    c->signal = signal;
    c->measured = place;
    return DALCS_OK;
}

/* A session of the same circuit that records only the currents of diodes. */
static enum dalcs_status make_shadow(struct dalcs_session *s, int n, struct dalcs_session *shadow) {
    struct dalcs_circuit *c = &shadow->circuit;
    *c = s->circuit;
    c->arena = (struct dalcs_arena){0};
    shadow->name = s->name;
    DALCS_TRY(list_signals(&shadow->arena, c, n));
    c->losses = NULL;
    c->n_computed = c->n_measured = c->n_measures = c->n_fouriers = c->n_prints = c->n_steps = 0;
    c->operating_point = true;
    c->options.compress = c->options.fill = 0;
    c->transient.step = 0; /* no more rows than are asked for */
    c->transient.start = 0;
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

/* Runs the circuit once and puts the diodes' currents into *c. */
static enum dalcs_status pass(struct dalcs_session *s, const struct dalcs_run_options *given,
                              double tolerance, struct collector *c) {
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
    const struct dalcs_transient *t = &s->circuit.transient;
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

/* Without a forward voltage, and with the breakdown that the card says. */
static void idealise(struct dalcs_diode_model *m) {
    m->exponential.at = m->exponential.back_at = 0;
    m->vfwd = 0;
    m->ron = m->rrev = m->exponential.series;
    m->vrev = m->exponential.breakdown;
}

/* What a voltage that is `volts` times the logarithm of a current changes by, in second order, where its line is taken
 * at the second of these currents rather than at the first. */
static double turned(double volts, double old, double at) {
    const double change = at / old - 1;
    return volts * (change - log1p(change));
}

/* One diode's tangents at what was found; how much its voltage changes by it, over itself. */
static double retake(struct dalcs_diode_model *m, const struct charge *charge, double tolerance) {
    const struct dalcs_exponential old = m->exponential;
    double at = mean_of(charge, 0, tolerance);
    double back_at = mean_of(charge, 1, tolerance);
    if (old.at == 0) {
        dalcs_exponential_take(m, at > 0 ? at : USUAL, back_at > 0 ? back_at : USUAL);
        return at > 0 || back_at > 0 ? 1 : 0;
    }
    double most = 0;
    if (at > 0) {
        most = turned(old.voltage, old.at, at) / dalcs_exponential_voltage(&old, at);
    } else if (old.at < USUAL && old.at > old.saturation) {
        /* It has carried something, and this line blocks: half way to where the curve begins. */
        at = sqrt(old.at * old.saturation);
        most = 1;
    }
    if (back_at > 0 && old.back_voltage > 0) {
        most = fmax(most, turned(old.back_voltage, old.back_at, back_at) / old.breakdown);
    }
    dalcs_exponential_take(m, at > 0 ? at : old.at, back_at > 0 ? back_at : old.back_at);
    return most;
}

static double retake_all(struct dalcs_circuit *c, const struct collector *found, double tolerance) {
    double most = 0;
    int k = 0;
    for (int d = 0; d < c->n_devices; d++) {
        if (exponential_of(c, d) != NULL) {
            most = fmax(
                most, retake(&c->diode_model[c->device[d].model], &found->charge[k++], tolerance));
        }
    }
    return most;
}

/* "d1 at 9.86 mA (Vfwd = 0.61 V, Ron = 2.62 ohm), ..." */
static void note(struct dalcs_session *s, int n, int n_passes) {
    const struct dalcs_circuit *c = &s->circuit;
    const char *list = "";
    const struct dalcs_device *first = NULL;
    int n_named = 0;
    for (int d = 0; d < c->n_devices && n_named < MOST_NAMED && list != NULL; d++) {
        if (exponential_of(c, d) == NULL) {
            continue;
        }
        const struct dalcs_diode_model *m = &c->diode_model[c->device[d].model];
        first = first != NULL ? first : &c->device[d];
        list = dalcs_arena_printf(&s->arena, "%s%s'%s' at %.4g A (Vfwd = %.4g V, Ron = %.4g ohm)",
                                  list, n_named++ > 0 ? ", " : "", c->device[d].name,
                                  m->exponential.at, m->vfwd, m->ron);
    }
    if (list != NULL && first != NULL) {
        dalcs_diag_add(&s->diag, DALCS_NOTE, &first->where,
                       ".options diodecurrent=amperes takes one current for all, without another "
                       "run",
                       "the tangents of exponential diodes are taken at the currents that they "
                       "carry, found in %d run%s: %s%s",
                       n_passes, n_passes == 1 ? "" : "s", list, n > n_named ? ", ..." : "");
    }
}

static enum dalcs_status rebuild_network(struct dalcs_session *s) {
    const struct dalcs_network_options options = {
        .silent = true, .with_readout = dalcs_circuit_is_audited(&s->circuit)};
    dalcs_network_finish(&s->network);
    const enum dalcs_status status =
        dalcs_network_build(&s->network, &s->circuit, &options, &s->diag);
    s->has_network = status == DALCS_OK;
    return status;
}

/* All of them without forward voltages, or at the usual current. */
static void take_all(struct dalcs_circuit *c, bool ideal) {
    for (int k = 0; k < c->n_devices; k++) {
        if (exponential_of(c, k) != NULL && ideal) {
            idealise(&c->diode_model[c->device[k].model]);
        } else if (exponential_of(c, k) != NULL) {
            dalcs_exponential_take(&c->diode_model[c->device[k].model], USUAL, USUAL);
        }
    }
}

/* Whatever else is wrong with the circuit, the run itself says it. */
static bool is_fatal(enum dalcs_status status) {
    return status == DALCS_E_CANCELLED || status == DALCS_E_NOMEM;
}

/* Passes until no voltage changes by more than the root of the run's tolerance. */
static enum dalcs_status settle(struct dalcs_session *s, const struct dalcs_run_options *options,
                                struct collector *c, int *n_passes) {
    const double coarse =
        fmin(sqrt(dalcs_run_tolerance(options, &s->circuit)), DALCS_TOLERANCE_MAX);
    double change = 1;
    enum dalcs_status status = DALCS_OK;
    for (*n_passes = 0; *n_passes < MOST_PASSES && change > coarse && status == DALCS_OK;) {
        status = pass(s, options, coarse, c);
        ++*n_passes;
        if (status != DALCS_OK && *n_passes == 1) {
            take_all(&s->circuit, false);
            status = is_fatal(status) ? status : DALCS_OK;
        } else if (status == DALCS_OK) {
            change = retake_all(&s->circuit, c, coarse);
        }
    }
    return status;
}

enum dalcs_status dalcs_operating_currents(struct dalcs_session *s,
                                           const struct dalcs_run_options *options,
                                           const struct dalcs_sink *sink) {
    struct dalcs_circuit *c = &s->circuit;
    int n = 0;
    for (int k = 0; k < c->n_devices && c->n_diode_models > 0; k++) {
        n += exponential_of(c, k) != NULL ? 1 : 0;
    }
    if (n == 0 || c->options.has_diode_current) {
        return DALCS_OK;
    }
    if (!c->has_own_tangents) {
        DALCS_TRY(part_models(c, n));
    }
    take_all(c, true);
    struct dalcs_arena arena = {0};
    struct collector collector = {.to = sink,
                                  .session = s,
                                  .n = n,
                                  .charge =
                                      dalcs_arena_alloc(&arena, (size_t)n, sizeof(struct charge)),
                                  .last = dalcs_arena_alloc(&arena, (size_t)n, sizeof(double))};
    int n_passes = 0;
    enum dalcs_status status = collector.charge != NULL && collector.last != NULL
                                   ? settle(s, options, &collector, &n_passes)
                                   : DALCS_E_NOMEM;
    dalcs_arena_finish(&arena);
    if (!is_fatal(status)) {
        status = rebuild_network(s);
    }
    if (status == DALCS_OK && n_passes > 0) {
        note(s, n, n_passes);
    }
    return status;
}
