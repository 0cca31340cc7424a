/* source_check.c - what is said of sources when all cards are read, for it needs .tran: periods, pulses, a start from 0.
 *
 * The frequency that a SIN may leave out is 1/tstop, as in SPICE. */

#include "element_cards.h"

#include <math.h>

/* Edges are told apart to 1e-15 of the time; leave room for a few points in between. */
static void check_period(struct dalcs_builder *builder, const struct dalcs_token *name,
                         double period) {
    const double stop = builder->circuit->analyses.transient.stop;
    if (builder->circuit->analyses.transient.present && period < stop * 1e-13) {
        dalcs_builder_error(builder, name, NULL,
                            "a period of %g s is below the resolution of times up to %g s", period,
                            stop);
    }
}

static void check_pulse(struct dalcs_builder *builder, const struct dalcs_token *name,
                        const struct dalcs_stimulus *s) {
    const double length = s->u.pulse.rise + s->u.pulse.width + s->u.pulse.fall;
    const double period = s->u.pulse.period;
    const double flanks = s->u.pulse.rise + s->u.pulse.fall;
    if (length > period * (1 + 1e-12) && fabs(flanks - period) <= 1e-12 * period) {
        /* how a triangle is written: elsewhere a width may not be 0 */
        dalcs_builder_note(builder, name, NULL,
                           "the flanks fill the period of %g s: each pulse is cut by the next one, "
                           "%g s before its end",
                           period, length - period);
    } else if (length > period * (1 + 1e-12)) {
        dalcs_builder_warn(builder, name, NULL,
                           "the pulse lasts %g s, longer than its period of %g s: each is cut by "
                           "the next",
                           length, period);
    }
    check_period(builder, name, period);
}

void dalcs_stimulus_check(struct dalcs_builder *builder, const struct dalcs_token *name,
                          struct dalcs_stimulus *s) {
    const struct dalcs_transient *transient = &builder->circuit->analyses.transient;
    if (s->kind == DALCS_STIMULUS_SIN && s->u.sine.frequency == 0 && transient->present) {
        s->u.sine.frequency = 1 / transient->stop;
        dalcs_builder_note(builder, name, NULL, "SIN without a frequency: it is 1/tstop = %g Hz",
                           s->u.sine.frequency);
    }
    if (s->kind == DALCS_STIMULUS_PULSE) {
        check_pulse(builder, name, s);
    }
    if (s->kind == DALCS_STIMULUS_PWL && s->u.pwl.repeats) {
        check_period(builder, name, s->u.pwl.t[s->u.pwl.n - 1] - s->u.pwl.repeat_from);
    }
}

/* Seconds in which sources rise with LTspice's `startup` on .tran. */
static const double STARTUP_TIME = 20e-6;

/* A source of a number rises from 0 in a straight line; its operating point for .op stays. */
static bool raise(struct dalcs_circuit *circuit, struct dalcs_stimulus *s) {
    double *t = dalcs_arena_alloc(&circuit->arena, 2, sizeof *t);
    double *v = dalcs_arena_alloc(&circuit->arena, 2, sizeof *v);
    if (t == NULL || v == NULL) {
        return false;
    }
    t[1] = STARTUP_TIME;
    v[1] = s->dc;
    s->kind = DALCS_STIMULUS_PWL;
    s->u.pwl.n = 2;
    s->u.pwl.t = t;
    s->u.pwl.v = v;
    s->u.pwl.repeats = false;
    s->u.pwl.repeat_from = 0;
    return true;
}

/* LTspice turns all independent sources on in that time, after an operating point without them. One that
 * has a function starts as it is, which is the same where that is 0 at first. */
static void start_up(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    int n_risen = 0;
    const char *first = NULL;
    for (int k = 0; k < circuit->n_devices; k++) {
        const struct dalcs_device *device = &circuit->device[k];
        if (device->stimulus < 0 || dalcs_names_is_inner(device->name)) {
            continue;
        }
        struct dalcs_stimulus *s = &circuit->stimulus[device->stimulus];
        if (s->kind == DALCS_STIMULUS_DC) {
            n_risen++;
            builder->out_of_memory = !raise(circuit, s) || builder->out_of_memory;
        } else if (first == NULL && dalcs_stimulus_value(s, 0, DALCS_LEFT) != 0) {
            first = device->name;
        }
    }
    dalcs_builder_note(builder, builder->analyses.startup, NULL,
                       "%d source%s of a constant value rise%s from 0 in the first 20 us, as in "
                       "LTspice; those with a function start as they are",
                       n_risen, n_risen == 1 ? "" : "s", n_risen == 1 ? "s" : "");
    if (first != NULL) {
        dalcs_builder_warn(
            builder, builder->analyses.startup, NULL,
            "source '%s' has a function that does not start at 0: LTspice would ramp it up too",
            first);
    }
}

void dalcs_source_check(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    if (builder->analyses.startup != NULL) {
        start_up(builder);
    }
    for (int k = 0; k < circuit->n_devices; k++) {
        const struct dalcs_device *device = &circuit->device[k];
        if (device->stimulus >= 0) {
            dalcs_stimulus_check(builder, builder->elements.device_token[k],
                                 &circuit->stimulus[device->stimulus]);
        }
        if (device->stimulus >= 0 && circuit->stimulus[device->stimulus].is_ac_alone &&
            circuit->analyses.transient.present && circuit->analyses.ac.n == 0) {
            dalcs_builder_warn(
                builder, builder->elements.device_token[k],
                "SIN(0 12 60) is a sine of 12 and 60 Hz",
                "source '%s' has an AC value alone, which .tran does not use: it is 0",
                device->name);
        }
    }
}
