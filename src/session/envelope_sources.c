/* envelope_sources.c - slow sources beside the clock, period by period. */
#include "envelope.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

static double delay_of(const struct dalcs_stimulus *s) {
    return s->kind == DALCS_STIMULUS_SIN     ? s->u.sine.delay
           : s->kind == DALCS_STIMULUS_PULSE ? s->u.pulse.delay
           : s->kind == DALCS_STIMULUS_PWL   ? s->u.pwl.repeat_from
                                             : 0.0;
}

static bool is_level(const struct dalcs_stimulus *s) {
    bool is = s->kind == DALCS_STIMULUS_DC || s->kind == DALCS_STIMULUS_FORMULA;
    if (s->kind == DALCS_STIMULUS_PULSE) {
        is = s->u.pulse.low == s->u.pulse.high;
    } else if (s->kind == DALCS_STIMULUS_SIN) {
        is = s->u.sine.amplitude == 0.0;
    }
    return is;
}

static enum dalcs_status refuse(struct dalcs_run *r, int stimulus) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL,
                   "write it as PWL, which may be as long as the run",
                   "'%s' neither repeats nor is a PWL: .env knows of no other slow sources",
                   dalcs_steady_source_name(&r->s->circuit, stimulus));
    return DALCS_E_OPTION;
}

enum dalcs_status dalcs_envelope_sources_setup(struct dalcs_envelope_sources *s,
                                               struct dalcs_run *r) {
    struct dalcs_circuit *c = &r->s->circuit;
    *s = (struct dalcs_envelope_sources){.run = r};
    s->index = dalcs_arena_alloc(&s->arena, (size_t)c->n_stimuli + 1, sizeof(*s->index));
    s->whole = dalcs_arena_alloc(&s->arena, (size_t)c->n_stimuli + 1, sizeof(*s->whole));
    if (s->index == NULL || s->whole == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_stimuli; i++) {
        struct dalcs_stimulus *of = &c->stimulus[i];
        if (is_level(of)) {
            continue;
        }
        if (dalcs_steady_repeats(of)) {
            s->delay = fmax(s->delay, delay_of(of));
            continue;
        }
        if (of->kind != DALCS_STIMULUS_PWL) {
            return refuse(r, i);
        }
        s->index[s->n] = i;
        s->whole[s->n++] = *of;
        *of = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true};
    }
    return DALCS_OK;
}

void dalcs_envelope_sources_finish(struct dalcs_envelope_sources *s) {
    dalcs_arena_finish(&s->arena);
}

static enum dalcs_status take_part(struct dalcs_envelope_sources *s, int k, long n) {
    struct dalcs_arena *arena = &s->run->s->arena;
    const struct dalcs_stimulus *whole = &s->whole[k];
    struct dalcs_stimulus *part = &s->run->s->circuit.stimulus[s->index[k]];
    const double from = (double)n * s->period;
    const double to = (double)(n + 1) * s->period;
    if (part->kind != DALCS_STIMULUS_PWL || part->u.pwl.t == whole->u.pwl.t) {
        *part = *whole;
        part->u.pwl.t = dalcs_arena_alloc(arena, (size_t)whole->u.pwl.n + 2, sizeof(double));
        part->u.pwl.v = dalcs_arena_alloc(arena, (size_t)whole->u.pwl.n + 2, sizeof(double));
        if (part->u.pwl.t == NULL || part->u.pwl.v == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    double *t = (double *)part->u.pwl.t;
    double *v = (double *)part->u.pwl.v;
    int m = 0;
    t[m] = 0.0;
    v[m++] = dalcs_stimulus_value(whole, from, DALCS_RIGHT);
    for (int i = 0; i < whole->u.pwl.n; i++) {
        if (whole->u.pwl.t[i] > from && whole->u.pwl.t[i] < to) {
            t[m] = whole->u.pwl.t[i] - from;
            v[m++] = whole->u.pwl.v[i];
        }
    }
    t[m] = s->period;
    v[m++] = dalcs_stimulus_value(whole, to, DALCS_LEFT);
    part->u.pwl.n = m;
    return DALCS_OK;
}

enum dalcs_status dalcs_envelope_sources_take(struct dalcs_envelope_sources *s, long n) {
    for (int k = 0; k < s->n; k++) {
        DALCS_TRY(take_part(s, k, n));
    }
    return DALCS_OK;
}

long dalcs_envelope_sources_next_corner(const struct dalcs_envelope_sources *s, long n) {
    double next = INFINITY;
    for (int k = 0; k < s->n; k++) {
        for (int i = 0; i < s->whole[k].u.pwl.n; i++) {
            const double at = floor(s->whole[k].u.pwl.t[i] / s->period);
            next = at >= (double)n ? fmin(next, at) : next;
        }
    }
    return next < 9e15 ? (long)next : LONG_MAX;
}
