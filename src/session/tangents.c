/* tangents.c - currents that are not those which an idealised element is right for, told of after the run.
 *
 * An exponential diode is right at the current that its tangent is taken at. Which current it carries cannot be known
 * before the run, and a diode for milliamperes at the tangent of 1 A has a fifth of a volt too much. A MOSFET's channel
 * carries no more than its saturation current, the switch in its place does. */
#include "quantity.h"
#include "session_internal.h"

#include <math.h>

/* A tangent that is off by this part of the voltage gets a note. */
static const double notable = 0.1;

static const struct dalcs_exponential *exponential_of(const struct dalcs_circuit *c, int output) {
    const struct dalcs_signal *signal = &c->results.signal[output];
    if (signal->kind != DALCS_SIGNAL_CURRENT || c->device[signal->device].kind != DALCS_DIODE) {
        return NULL;
    }
    const struct dalcs_diode_model *m = &c->models.of_diode[c->device[signal->device].model];
    return m->exponential.voltage > 0.0 ? &m->exponential : NULL;
}

static const struct dalcs_saturation *saturation_of(const struct dalcs_circuit *c, int output) {
    const struct dalcs_signal *signal = &c->results.signal[output];
    for (int k = 0; k < c->models.n_saturations && signal->kind == DALCS_SIGNAL_CURRENT; k++) {
        if (c->models.saturation[k].device == signal->device) {
            return &c->models.saturation[k];
        }
    }
    return NULL;
}

enum dalcs_status dalcs_currents_watch(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    struct dalcs_recorder *recorder = &r->s->results.recorder;
    if (c->models.n_diodes == 0 && c->models.n_saturations == 0) {
        return DALCS_OK;
    }
    int n = 0;
    for (int i = 0; i < c->results.n_shown; i++) {
        n += exponential_of(c, i) != NULL || saturation_of(c, i) != NULL ? 1 : 0;
    }
    if (n == 0) {
        return DALCS_OK;
    }
    recorder->watched = dalcs_arena_alloc(&r->s->arena, (size_t)n, sizeof(*recorder->watched));
    if (recorder->watched == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->results.n_shown; i++) {
        const struct dalcs_saturation *s = saturation_of(c, i);
        if (exponential_of(c, i) != NULL || s != NULL) {
            recorder->watched[recorder->n_watched++] = (struct dalcs_watched){
                .output = i, .sign = s != NULL && s->current < 0.0 ? -1.0 : 1.0};
        }
    }
    return DALCS_OK;
}

/* The switch in its place carries any current. */
static void judge_saturations(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const struct dalcs_recorder *recorder = &r->s->results.recorder;
    for (int k = 0; k < recorder->n_watched; k++) {
        const struct dalcs_watched *w = &recorder->watched[k];
        const struct dalcs_saturation *s = saturation_of(c, w->output);
        if (s != NULL && w->largest > fabs(s->current)) {
            dalcs_diag_add(
                &r->s->diag, DALCS_WARNING, &s->where,
                "drive its gate further, or take a transistor that carries more",
                "'%s' carries %.4g A at %.4g s, more than the %.4g A at which its channel "
                "saturates with v(gs) = %g V",
                s->name, w->sign * w->largest, w->at, s->current, s->level);
        }
    }
}

static void judge_tangents(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const struct dalcs_recorder *recorder = &r->s->results.recorder;
    int worst = -1;
    double most = notable;
    double over = 0.0; /* V */
    for (int k = 0; k < recorder->n_watched; k++) {
        if (exponential_of(c, recorder->watched[k].output) == NULL) {
            continue;
        }
        int device = c->results.signal[recorder->watched[k].output].device;
        const struct dalcs_diode_model *m = &c->models.of_diode[c->device[device].model];
        double i = recorder->watched[k].largest;
        double v = dalcs_exponential_voltage(&m->exponential, i);
        double off = m->vfwd + m->ron * i - v;
        if (i > 0.0 && fabs(off) > most * v) {
            worst = k;
            most = fabs(off) / v;
            over = off;
        }
    }
    if (worst < 0) {
        return;
    }
    char text[DALCS_QUANTITY_SIZE];
    const struct dalcs_device *d =
        &c->device[c->results.signal[recorder->watched[worst].output].device];
    dalcs_diag_add(&r->s->diag, DALCS_NOTE, &d->where,
                   dalcs_arena_printf(&r->s->arena, ".options diodecurrent=%.2g takes it there",
                                      recorder->watched[worst].largest),
                   "'%s' carries %.3g A at most, where its tangent at %.3g A is %s %s the "
                   "exponential diode",
                   d->name, recorder->watched[worst].largest,
                   c->models.of_diode[d->model].exponential.at,
                   dalcs_quantity_write(text, fabs(over), "V", 3), over > 0.0 ? "above" : "below");
}

void dalcs_currents_judge(struct dalcs_run *r) {
    judge_tangents(r);
    judge_saturations(r);
}
