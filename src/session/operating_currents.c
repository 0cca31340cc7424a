/* operating_currents.c - exponential diodes: their tangents are taken at the currents that they carry.
 *
 * A tangent at I0 is above V = N Vt log(1 + I/IS) + RS I everywhere else. At the mean of the current over the charge that
 * passes, I0 = (integral of i^2) / (integral of i), the energy that the line takes is that of the curve to first
 * order. That current is found by running the circuit: with the tangents of the pass before, first without a forward voltage, so
 * that all conduct which may, until nothing changes. With I0 off by a part d the voltage is off by N Vt (d - log(1 + d)), in second order of d: a
 * pass needs the root of the run's tolerance only, and one whose voltages changed by that root is the last, for the
 * next would change them by its square. Mostly there are two. */
#include "shadow_run.h"

#include "session_internal.h"

#include <math.h>
#include <string.h>

enum { MOST_PASSES = 8, MOST_NAMED = 4 };

/* A, of a diode that nothing passes, and where the first pass fails: a source across ideal diodes, say. */
static const double USUAL = 1;

const struct dalcs_exponential *dalcs_exponential_of(const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    const struct dalcs_exponential *e =
        d->kind == DALCS_DIODE ? &c->models.of_diode[d->model].exponential : NULL;
    return e != NULL && e->voltage > 0 ? e : NULL;
}

/* A model of its own for each exponential diode, at the current that the netlist's models are taken at. */
static enum dalcs_status part_models(struct dalcs_circuit *c, int n) {
    struct dalcs_diode_model *all =
        dalcs_arena_alloc(&c->arena, (size_t)(c->models.n_diodes + n), sizeof *all);
    if (all == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(all, c->models.of_diode, (size_t)c->models.n_diodes * sizeof *all);
    for (int k = 0; k < c->n_devices; k++) {
        if (dalcs_exponential_of(c, k) != NULL) {
            all[c->models.n_diodes] = c->models.of_diode[c->device[k].model];
            c->device[k].model = c->models.n_diodes++;
        }
    }
    c->models.of_diode = all;
    c->models.has_own_tangents = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_operating_currents_keep(struct dalcs_circuit *to,
                                                struct dalcs_network *network,
                                                const struct dalcs_circuit *from,
                                                struct dalcs_diag *diag) {
    int n = 0;
    for (int k = 0; k < to->n_devices; k++) {
        n += dalcs_exponential_of(to, k) != NULL ? 1 : 0;
    }
    if (n == 0 || from->n_devices != to->n_devices) {
        return DALCS_OK;
    }
    DALCS_TRY(part_models(to, n));
    for (int k = 0; k < to->n_devices; k++) {
        const struct dalcs_exponential *was =
            dalcs_exponential_of(to, k) != NULL ? dalcs_exponential_of(from, k) : NULL;
        if (was != NULL) {
            dalcs_exponential_take(&to->models.of_diode[to->device[k].model], was->at,
                                   was->back_at);
        }
    }
    const struct dalcs_network_options again = {.silent = true, .with_readout = true};
    dalcs_network_finish(network);
    return dalcs_network_build(network, to, &again, diag);
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
static double retake(struct dalcs_diode_model *m, const struct dalcs_charge *charge,
                     double tolerance) {
    const struct dalcs_exponential old = m->exponential;
    double at = dalcs_charge_mean(charge, 0, tolerance);
    double back_at = dalcs_charge_mean(charge, 1, tolerance);
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

static double retake_all(struct dalcs_circuit *c, const struct dalcs_charge_collector *found,
                         double tolerance) {
    double most = 0;
    int k = 0;
    for (int d = 0; d < c->n_devices; d++) {
        if (dalcs_exponential_of(c, d) != NULL) {
            most = fmax(most, retake(&c->models.of_diode[c->device[d].model], &found->charge[k++],
                                     tolerance));
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
        if (dalcs_exponential_of(c, d) == NULL) {
            continue;
        }
        const struct dalcs_diode_model *m = &c->models.of_diode[c->device[d].model];
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
        if (dalcs_exponential_of(c, k) != NULL && ideal) {
            idealise(&c->models.of_diode[c->device[k].model]);
        } else if (dalcs_exponential_of(c, k) != NULL) {
            dalcs_exponential_take(&c->models.of_diode[c->device[k].model], USUAL, USUAL);
        }
    }
}

/* Whatever else is wrong with the circuit, the run itself says it. */
static bool is_fatal(enum dalcs_status status) {
    return status == DALCS_E_CANCELLED || status == DALCS_E_NOMEM;
}

/* Passes until no voltage changes by more than the root of the run's tolerance. */
static enum dalcs_status settle(struct dalcs_session *s, const struct dalcs_run_options *options,
                                struct dalcs_charge_collector *c, int *n_passes) {
    const double coarse =
        fmin(sqrt(dalcs_run_tolerance(options, &s->circuit)), DALCS_TOLERANCE_MAX);
    double change = 1;
    enum dalcs_status status = DALCS_OK;
    for (*n_passes = 0; *n_passes < MOST_PASSES && change > coarse && status == DALCS_OK;) {
        status = dalcs_shadow_run(s, options, coarse, c);
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
    for (int k = 0; k < c->n_devices && c->models.n_diodes > 0; k++) {
        n += dalcs_exponential_of(c, k) != NULL ? 1 : 0;
    }
    if (n == 0 || c->options.has_diode_current) {
        return DALCS_OK;
    }
    if (!c->models.has_own_tangents) {
        DALCS_TRY(part_models(c, n));
    }
    take_all(c, true);
    struct dalcs_arena arena = {0};
    struct dalcs_charge_collector collector = {
        .to = sink,
        .session = s,
        .n = n,
        .charge = dalcs_arena_alloc(&arena, (size_t)n, sizeof(struct dalcs_charge)),
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
