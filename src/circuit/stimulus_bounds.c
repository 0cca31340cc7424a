/* stimulus_bounds.c - between what values a source stays. */
#include "stimulus.h"

#include <math.h>

bool dalcs_stimulus_bounds(const struct dalcs_stimulus *s, double *low, double *high) {
    if (s->is_written) {
        return false;
    }
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        *low = *high = s->dc;
        return true;
    case DALCS_STIMULUS_PULSE:
        *low = fmin(s->u.pulse.low, s->u.pulse.high);
        *high = fmax(s->u.pulse.low, s->u.pulse.high);
        return true;
    case DALCS_STIMULUS_SIN: /* a sine that grows has none */
        *low = s->u.sine.offset - fabs(s->u.sine.amplitude);
        *high = s->u.sine.offset + fabs(s->u.sine.amplitude);
        return s->u.sine.damping >= 0;
    case DALCS_STIMULUS_EXP:
        *low = fmin(s->u.exponential.low, s->u.exponential.high);
        *high = fmax(s->u.exponential.low, s->u.exponential.high);
        return true;
    case DALCS_STIMULUS_PWL:
        *low = *high = s->u.pwl.v[0];
        for (int k = 1; k < s->u.pwl.n; k++) {
            *low = fmin(*low, s->u.pwl.v[k]);
            *high = fmax(*high, s->u.pwl.v[k]);
        }
        return true;
    default:
        return false;
    }
}
