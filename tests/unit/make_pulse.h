/* make_pulse.h - a PULSE stimulus in one line. */
#ifndef DALCS_MAKE_PULSE_H
#define DALCS_MAKE_PULSE_H

#include "stimulus.h"

static inline struct dalcs_stimulus make_pulse(double low, double high, double delay, double rise,
                                               double fall, double width, double period) {
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_PULSE};
    s.u.pulse.low = low;
    s.u.pulse.high = high;
    s.u.pulse.delay = delay;
    s.u.pulse.rise = rise;
    s.u.pulse.fall = fall;
    s.u.pulse.width = width;
    s.u.pulse.period = period;
    return s;
}

#endif
