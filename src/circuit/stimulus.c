/* stimulus.c - values, edges and jumps of DC, SIN, PULSE, PWL and EXP sources, and of sums of tones. */
#include "stimulus_kinds.h"

#include "formula_stimulus.h"
#include "history.h"
#include "pi.h"

#include <math.h>

/* ---- SIN ----------------------------------------------------------------------------------- */

/* The nearest whole number: a sum with no bits left for a fraction, several times faster than a call
 * of floor. */
static double nearest_whole(double x) {
    return fabs(x) < 0x1p51 ? (x + 0x1.8p52) - 0x1.8p52 : x;
}

double dalcs_sine_of_cycles(double x) {
    double r = x - nearest_whole(x); /* -1/2 .. 1/2 */
    if (r > 0.25) {
        r = 0.5 - r;
    } else if (r < -0.25) {
        r = -0.5 - r;
    }
    return sin(2 * dalcs_pi * r);
}

double dalcs_sine_cycles_at(double frequency, double since, double phase) {
    const double cycles = frequency * since;
    const double lost = fma(frequency, since, -cycles);
    return (cycles - nearest_whole(cycles)) + (phase + lost);
}

double dalcs_sine_cycles(const struct dalcs_stimulus *s, double since) {
    return dalcs_sine_cycles_at(s->u.sine.frequency, since, s->u.sine.phase / 360);
}

double dalcs_sine_length(const struct dalcs_stimulus *s) {
    return s->u.sine.n_cycles > 0 ? s->u.sine.n_cycles / s->u.sine.frequency : (double)INFINITY;
}

double dalcs_sine_value(const struct dalcs_stimulus *s, double t) {
    const double since = fmin(t - s->u.sine.delay, dalcs_sine_length(s));
    if (since <= 0) {
        return s->u.sine.offset + s->u.sine.amplitude * dalcs_sine_of_cycles(s->u.sine.phase / 360);
    }
    double value = s->u.sine.amplitude * dalcs_sine_of_cycles(dalcs_sine_cycles(s, since));
    if (s->u.sine.damping != 0) {
        value *= exp(-s->u.sine.damping * since);
    }
    return s->u.sine.offset + value;
}

/* ---- EXP ----------------------------------------------------------------------------------- */

/* 1 - exp(-(t - delay) / tau) after the delay, 0 before. */
static double approach(double t, double delay, double tau, enum dalcs_side side) {
    const double near = dalcs_stimulus_tolerance(t, 0);
    const bool is_jump = tau <= near;
    if (t < delay - near) {
        return 0;
    }
    if (t <= delay + near) {
        return is_jump && side == DALCS_RIGHT ? 1 : 0;
    }
    return is_jump ? 1 : -expm1(-(t - delay) / tau);
}

static double exponential_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    const double rise = approach(t, s->u.exponential.rise_delay, s->u.exponential.rise_tau, side);
    const double fall = approach(t, s->u.exponential.fall_delay, s->u.exponential.fall_tau, side);
    return s->u.exponential.low + (s->u.exponential.high - s->u.exponential.low) * (rise - fall);
}

/* ---- Tones --------------------------------------------------------------------------------- */

bool dalcs_tones_have_begun(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    const double near = s->u.tones.delay > 0 ? dalcs_stimulus_tolerance(t, s->u.tones.delay) : 0;
    return s->u.tones.delay <= 0 || t > s->u.tones.delay + near ||
           (side == DALCS_RIGHT && t >= s->u.tones.delay - near);
}

static double tones_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    if (!dalcs_tones_have_begun(s, t, side)) {
        return 0;
    }
    double sum = s->u.tones.offset;
    for (int k = 0; k < s->u.tones.n; k++) {
        const struct dalcs_tone *tone = &s->u.tones.tone[k];
        sum += tone->amplitude * dalcs_sine_of_cycles(dalcs_sine_cycles_at(
                                     tone->frequency, t - s->u.tones.delay, tone->phase));
    }
    return sum;
}

/* ---- The interface ------------------------------------------------------------------------- */

double dalcs_stimulus_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        return s->dc;
    case DALCS_STIMULUS_SIN:
        return dalcs_sine_value(s, t);
    case DALCS_STIMULUS_PULSE:
        return dalcs_pulse_value(s, t, side);
    case DALCS_STIMULUS_PWL:
        return dalcs_pwl_value(s, t, side);
    case DALCS_STIMULUS_EXP:
        return exponential_value(s, t, side);
    case DALCS_STIMULUS_TONES:
        return tones_value(s, t, side);
    case DALCS_STIMULUS_DELAYED:
        return dalcs_history_value(s->u.history, t, side);
    case DALCS_STIMULUS_FORMULA:
        return dalcs_formula_stimulus_value(s, t, side);
    }
    return 0;
}

static double if_after(double edge, double t, double near) {
    return edge > t + near ? edge : INFINITY;
}

double dalcs_stimulus_next_edge(const struct dalcs_stimulus *s, double t) {
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        return INFINITY;
    case DALCS_STIMULUS_SIN:
        return fmin(
            if_after(s->u.sine.delay, t, dalcs_stimulus_tolerance(t, 0)),
            if_after(s->u.sine.delay + dalcs_sine_length(s), t, dalcs_stimulus_tolerance(t, 0)));
    case DALCS_STIMULUS_PULSE:
        return dalcs_pulse_next_edge(s, t);
    case DALCS_STIMULUS_PWL:
        return dalcs_pwl_next_edge(s, t);
    case DALCS_STIMULUS_EXP:
        return fmin(if_after(s->u.exponential.rise_delay, t, dalcs_stimulus_tolerance(t, 0)),
                    if_after(s->u.exponential.fall_delay, t, dalcs_stimulus_tolerance(t, 0)));
    case DALCS_STIMULUS_TONES:
        return if_after(s->u.tones.delay, t, dalcs_stimulus_tolerance(t, 0));
    case DALCS_STIMULUS_DELAYED:
        return dalcs_history_next_edge(s->u.history, t);
    case DALCS_STIMULUS_FORMULA:
        return dalcs_formula_stimulus_next_edge(s, t);
    }
    return INFINITY;
}

bool dalcs_stimulus_jumps_at(const struct dalcs_stimulus *s, double t) {
    if (s->kind == DALCS_STIMULUS_DELAYED) {
        return dalcs_history_jumps_at(s->u.history, t);
    }
    if (s->kind == DALCS_STIMULUS_PWL && !s->u.pwl.repeats &&
        t - dalcs_stimulus_tolerance(t, 0) > s->u.pwl.t[s->u.pwl.n - 1]) {
        return false; /* as what gates write mostly is: it is past */
    }
    return dalcs_stimulus_value(s, t, DALCS_LEFT) != dalcs_stimulus_value(s, t, DALCS_RIGHT);
}

double dalcs_stimulus_operating_value(const struct dalcs_stimulus *s, bool transient_follows) {
    if (s->has_dc && !transient_follows) {
        return s->dc;
    }
    if (s->kind == DALCS_STIMULUS_FORMULA) {
        return dalcs_formula_stimulus_operating_value(s, transient_follows);
    }
    return dalcs_stimulus_value(s, 0, DALCS_LEFT);
}
