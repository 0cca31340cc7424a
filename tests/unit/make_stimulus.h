/* make_stimulus.h - sources by their values. */
#ifndef MAKE_STIMULUS_H
#define MAKE_STIMULUS_H

#include "make_pulse.h"
#include "run_tests.h"
#include "stimulus.h"

#include <stdbool.h>

static const double PI = 3.14159265358979323846;

static inline struct dalcs_stimulus make_sine(double offset, double amplitude, double frequency,
                                              double delay, double damping, double phase) {
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_SIN};
    s.u.sine.offset = offset;
    s.u.sine.amplitude = amplitude;
    s.u.sine.frequency = frequency;
    s.u.sine.delay = delay;
    s.u.sine.damping = damping;
    s.u.sine.phase = phase;
    return s;
}

static inline struct dalcs_stimulus make_exponential(double low, double high, double rise_delay,
                                                     double rise_tau, double fall_delay,
                                                     double fall_tau) {
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_EXP};
    s.u.exponential.low = low;
    s.u.exponential.high = high;
    s.u.exponential.rise_delay = rise_delay;
    s.u.exponential.rise_tau = rise_tau;
    s.u.exponential.fall_delay = fall_delay;
    s.u.exponential.fall_tau = fall_tau;
    return s;
}

static inline struct dalcs_stimulus make_pwl(const double *t, const double *v, int n) {
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_PWL};
    s.u.pwl.n = n;
    s.u.pwl.t = t;
    s.u.pwl.v = v;
    return s;
}

static inline void check_limits(const struct dalcs_stimulus *s, double t, double left,
                                double right) {
    ck_assert_msg(dalcs_stimulus_value(s, t, DALCS_LEFT) == left, "left of %.17g: %.17g", t,
                  dalcs_stimulus_value(s, t, DALCS_LEFT));
    ck_assert_msg(dalcs_stimulus_value(s, t, DALCS_RIGHT) == right, "right of %.17g: %.17g", t,
                  dalcs_stimulus_value(s, t, DALCS_RIGHT));
    ck_assert(dalcs_stimulus_jumps_at(s, t) == (left != right));
}

#endif
