/* sweep.c - the values of a sweep. */
#include "sweep.h"

#include <math.h>

/* A value this close behind the last one, in steps, is the last one. */
static const double NEAR = 1e-9;

static double base_of(enum dalcs_spacing spacing) {
    return spacing == DALCS_OCTAVES ? 2.0 : 10.0;
}

int dalcs_sweep_count(enum dalcs_spacing spacing, double start, double stop, double step) {
    double steps;
    if (spacing == DALCS_LINEAR) {
        if (start == stop) {
            return 1;
        }
        steps = (stop - start) / step;
    } else {
        steps = step * log(stop / start) / log(base_of(spacing));
    }
    if (!(steps >= -NEAR) || !isfinite(steps)) {
        return 0;
    }
    steps = floor(steps * (1.0 + NEAR) + NEAR);
    return steps >= DALCS_SWEEP_MOST ? -1 : (int)steps + 1;
}

double dalcs_sweep_value(const struct dalcs_sweep *sweep, int k) {
    if (sweep->spacing == DALCS_LISTED) {
        return sweep->list[k];
    }
    double value = sweep->spacing == DALCS_LINEAR
                       ? sweep->start + k * sweep->step
                       : sweep->start * pow(base_of(sweep->spacing), k / sweep->step);
    /* 3 * 0.1 is not 0.3: a value beside the last one is the last one. */
    double width = sweep->spacing == DALCS_LINEAR ? fabs(sweep->step) : fabs(sweep->stop);
    return fabs(value - sweep->stop) <= NEAR * width ? sweep->stop : value;
}
