/* steady_settle.c - what sources are in a steady state: as from a multiple of T on that is behind all delays. */
#include "steady.h"

#include <math.h>

/* PWL: the block from where t = 0 is in it on, and what is before that behind it; its ends are jumps if they differ. */
static enum dalcs_status turn_block(struct dalcs_run *r, struct dalcs_stimulus *s, double period) {
    const int n = s->u.pwl.n;
    const double from = s->u.pwl.repeat_from;
    const double last = s->u.pwl.t[n - 1];
    double start =
        fmod(from, last - from); /* t = from is a multiple of the block and this behind t = 0 */
    start = start > 0.0 ? last - start : from;
    double *t = dalcs_arena_alloc(&r->s->arena, (size_t)(2 * n + 4), sizeof(double));
    double *v = dalcs_arena_alloc(&r->s->arena, (size_t)(2 * n + 4), sizeof(double));
    if (t == NULL || v == NULL) {
        return DALCS_E_NOMEM;
    }
    const double stretch = period / (last - from);
    const double bound[2][2] = {{start, last}, {from, start}};
    int m = 0;
    for (int half = 0; half < 2; half++) {
        const double *b = bound[half];
        const double shift = half == 0 ? -start : last - start - from;
        if (!(b[1] > b[0])) {
            continue;
        }
        t[m] = stretch * (b[0] + shift);
        v[m++] = dalcs_stimulus_value(s, b[0] == from ? last : b[0], DALCS_RIGHT);
        for (int i = 0; i < n; i++) {
            if (s->u.pwl.t[i] > b[0] && s->u.pwl.t[i] < b[1]) {
                t[m] = stretch * (s->u.pwl.t[i] + shift);
                v[m++] = s->u.pwl.v[i];
            }
        }
        t[m] = half == 1 || start == from ? period : stretch * (b[1] + shift);
        v[m++] = dalcs_stimulus_value(s, b[1], DALCS_LEFT);
    }
    s->u.pwl.n = m;
    s->u.pwl.t = t;
    s->u.pwl.v = v;
    s->u.pwl.repeat_from = 0.0;
    return DALCS_OK;
}

/* An n-th of T in the place of a period that is so but for the digits that it was typed with: edges that are meant to
 * meet do so only if no more than their own rounding is between them (stimulus.c). */
static double fitted(double own, double T) {
    return T / rint(T / own);
}

static void settle_sine(struct dalcs_stimulus *s, double T) {
    const double own = 1.0 / s->u.sine.frequency;
    const double period = fitted(own, T);
    s->u.sine.frequency = period != own ? 1.0 / period : s->u.sine.frequency;
    if (s->u.sine.delay != 0.0) {
        s->u.sine.phase -= 360.0 * fmod(s->u.sine.delay / period, 1.0);
        s->u.sine.delay = 0.0;
    }
}

static void settle_pulse(struct dalcs_stimulus *s, double T) {
    s->u.pulse.period = fitted(s->u.pulse.period, T);
    const double rest = fmod(s->u.pulse.delay, s->u.pulse.period);
    s->u.pulse.delay = rest > 0.0 ? rest - s->u.pulse.period : rest;
}

enum dalcs_status dalcs_steady_settle(struct dalcs_run *r, struct dalcs_stimulus *s,
                                      const char *name, double T) {
    if (s->kind == DALCS_STIMULUS_SIN) {
        settle_sine(s, T);
    } else if (s->kind == DALCS_STIMULUS_PULSE) {
        settle_pulse(s, T);
    } else if (s->kind == DALCS_STIMULUS_PWL) {
        const double own = s->u.pwl.t[s->u.pwl.n - 1] - s->u.pwl.repeat_from;
        if (s->u.pwl.repeat_from != 0.0 || fitted(own, T) != own) {
            return turn_block(r, s, fitted(own, T));
        }
    } else if (s->kind == DALCS_STIMULUS_TONES && s->u.tones.delay > 0.0) {
        dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, "leave its delay out",
                       "the delay of '%s' is not supported yet in a steady state", name);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}
