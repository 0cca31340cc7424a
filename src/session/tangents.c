/* tangents.c - exponential diodes that carry another current than the one their tangent is taken at.
 *
 * Which current that is cannot be known before the run, and a diode for milliamperes at the tangent of 1 A
 * has a fifth of a volt too much. After the run it is known. */
#include "session_internal.h"

#include <math.h>

/* A tangent is off by this part of the voltage: enough to say so. */
static const double notable = 0.1;

static const struct dalcs_exponential *exponential_of(const struct dalcs_circuit *c, int output) {
    const struct dalcs_signal *signal = &c->signal[output];
    if (signal->kind != DALCS_SIGNAL_CURRENT || c->device[signal->device].kind != DALCS_DIODE) {
        return NULL;
    }
    const struct dalcs_diode_model *m = &c->diode_model[c->device[signal->device].model];
    return m->exponential.voltage > 0.0 ? &m->exponential : NULL;
}

enum dalcs_status dalcs_tangents_watch(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    struct dalcs_recorder *recorder = &r->s->recorder;
    int n = 0;
    for (int i = 0; i < c->n_shown && c->n_diode_models > 0; i++) {
        n += exponential_of(c, i) != NULL ? 1 : 0;
    }
    if (n == 0) {
        return DALCS_OK;
    }
    int *watched = dalcs_arena_alloc(&r->s->arena, (size_t)n, sizeof(*watched));
    recorder->largest = dalcs_arena_alloc(&r->s->arena, (size_t)n, sizeof(*recorder->largest));
    if (watched == NULL || recorder->largest == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_shown; i++) {
        if (exponential_of(c, i) != NULL) {
            watched[recorder->n_watched++] = i;
        }
    }
    recorder->watched = watched;
    return DALCS_OK;
}

void dalcs_tangents_judge(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const struct dalcs_recorder *recorder = &r->s->recorder;
    int worst = -1;
    double most = notable;
    double over = 0.0; /* V */
    for (int k = 0; k < recorder->n_watched; k++) {
        int device = c->signal[recorder->watched[k]].device;
        const struct dalcs_diode_model *m = &c->diode_model[c->device[device].model];
        double i = recorder->largest[k];
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
    const struct dalcs_device *d = &c->device[c->signal[recorder->watched[worst]].device];
    dalcs_diag_add(&r->s->diag, DALCS_NOTE, &d->where,
                   dalcs_arena_printf(&r->s->arena, ".options diodecurrent=%.2g takes it there",
                                      recorder->largest[worst]),
                   "'%s' carries %.3g A at most, where its tangent at %.3g A is %.3g mV %s the "
                   "exponential diode",
                   d->name, recorder->largest[worst], c->diode_model[d->model].exponential.at,
                   1e3 * fabs(over), over > 0.0 ? "above" : "below");
}
