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
    bool is = s->kind == DALCS_STIMULUS_DC || s->kind == DALCS_STIMULUS_FORMULA || s->is_written;
    if (s->kind == DALCS_STIMULUS_PULSE) {
        is = s->u.pulse.low == s->u.pulse.high;
    } else if (s->kind == DALCS_STIMULUS_SIN) {
        is = s->u.sine.amplitude == 0.0;
    }
    return is;
}

/* Of pulses that are written out as straight lines: four of each. */
static const double most_pulses = 1e4;

/* An exponential has died away after so many time constants, to the last bit: ln(2^53). */
static const double time_constants = 36.8;

static enum dalcs_status refuse(struct dalcs_run *r, int stimulus) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL,
                   "write it as PWL, which may be as long as the run",
                   "'%s' neither repeats nor comes to an end: .env accepts no other slow sources",
                   dalcs_steady_source_name(&r->s->circuit, stimulus));
    return DALCS_E_OPTION;
}

/* s, when what is curved is so no longer; INFINITY: never. Of straight lines 0. */
static double curved_until(const struct dalcs_stimulus *s) {
    double until = 0.0;
    if (s->kind == DALCS_STIMULUS_EXP) {
        const bool falls = isfinite(s->u.exponential.fall_delay);
        const double rise =
            s->u.exponential.rise_delay + time_constants * s->u.exponential.rise_tau;
        const double fall =
            falls ? s->u.exponential.fall_delay + time_constants * s->u.exponential.fall_tau : 0.0;
        until = fmax(rise, fall);
    } else if (s->kind == DALCS_STIMULUS_SIN && s->u.sine.n_cycles > 0.0) {
        until = s->u.sine.delay + s->u.sine.n_cycles / s->u.sine.frequency;
    } else if (s->kind == DALCS_STIMULUS_SIN) {
        until = s->u.sine.damping > 0.0 ? s->u.sine.delay + time_constants / s->u.sine.damping
                                        : (double)INFINITY;
    }
    return until;
}

/* A pulse that would not come again before the end. */
static bool is_once(const struct dalcs_run *r, const struct dalcs_stimulus *s) {
    return s->kind == DALCS_STIMULUS_PULSE &&
           s->u.pulse.period >= r->s->circuit.analyses.transient.stop;
}

/* One pulse or some of them. */
static enum dalcs_status write_lines(struct dalcs_envelope_sources *s, struct dalcs_stimulus *of) {
    const bool is_one = is_once(s->run, of);
    const size_t n_pulses = is_one ? 1 : (size_t)of->u.pulse.n_periods;
    double *t = dalcs_arena_alloc(&s->arena, 4 * n_pulses + 1, sizeof *t);
    double *v = dalcs_arena_alloc(&s->arena, 4 * n_pulses + 1, sizeof *v);
    int n = 0;
    if (t == NULL || v == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_pulses; k++) {
        const double from = of->u.pulse.delay + (is_one ? 0.0 : (double)k * of->u.pulse.period);
        const double high = from + of->u.pulse.rise;
        const double falls = high + of->u.pulse.width;
        t[n] = from;
        v[n++] = of->u.pulse.low;
        t[n] = high;
        v[n++] = of->u.pulse.high;
        if (isfinite(falls)) {
            t[n] = falls;
            v[n++] = of->u.pulse.high;
            t[n] = falls + of->u.pulse.fall;
            v[n++] = of->u.pulse.low;
        }
    }
    *of = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_PWL, .u.pwl = {.n = n, .t = t, .v = v}};
    return DALCS_OK;
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
        if (dalcs_steady_repeats(of) && !is_once(r, of)) {
            s->delay = fmax(s->delay, delay_of(of));
            continue;
        }
        const bool is_pulse = of->kind == DALCS_STIMULUS_PULSE;
        if (isinf(curved_until(of)) || (is_pulse && of->u.pulse.n_periods > most_pulses)) {
            return refuse(r, i);
        }
        DALCS_TRY(is_pulse ? write_lines(s, of) : DALCS_OK);
        s->index[s->n] = i;
        s->whole[s->n++] = *of;
        *of = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true};
    }
    return DALCS_OK;
}

void dalcs_envelope_sources_finish(struct dalcs_envelope_sources *s) {
    dalcs_arena_finish(&s->arena);
}

/* A curve from then on, counted from there; what is over is a level. */
static void take_curve(struct dalcs_stimulus *part, const struct dalcs_stimulus *whole,
                       double from) {
    *part = *whole;
    if (from >= curved_until(whole)) {
        *part = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC,
                                        .dc = dalcs_stimulus_value(whole, from, DALCS_RIGHT),
                                        .has_dc = true};
    } else if (whole->kind == DALCS_STIMULUS_EXP) {
        part->u.exponential.rise_delay -= from;
        part->u.exponential.fall_delay -= from;
    } else {
        part->u.sine.delay -= from;
    }
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
        if (s->whole[k].kind == DALCS_STIMULUS_PWL) {
            DALCS_TRY(take_part(s, k, n));
        } else {
            take_curve(&s->run->s->circuit.stimulus[s->index[k]], &s->whole[k],
                       (double)n * s->period);
        }
    }
    return DALCS_OK;
}

long dalcs_envelope_sources_next_corner(const struct dalcs_envelope_sources *s, long n) {
    double next = INFINITY;
    for (int k = 0; k < s->n; k++) {
        const bool is_curve = s->whole[k].kind != DALCS_STIMULUS_PWL;
        if (is_curve && (double)n * s->period < curved_until(&s->whole[k])) {
            return n;
        }
        for (int i = 0; !is_curve && i < s->whole[k].u.pwl.n; i++) {
            const double at = floor(s->whole[k].u.pwl.t[i] / s->period);
            next = at >= (double)n ? fmin(next, at) : next;
        }
    }
    return next < 9e15 ? (long)next : LONG_MAX;
}
