/* power_of_step.h - does a quantity vanish with a step, stay or grow as the step gets shorter? */
#ifndef DALCS_POWER_OF_STEP_H
#define DALCS_POWER_OF_STEP_H

#include <math.h>

/* The power of a step's length with which a quantity goes that is `whole` in a step and `half` in one half as long: 1
 * where it is a change that goes on with time, 0 where it jumps, -1 where it has no limit, as the derivative of an impulse.
 * The whole number that is nearest, so there is no threshold. Of what vanishes in the shorter step: INFINITY. */
static inline double dalcs_power_of_step(double whole, double half) {
    return half == 0.0 ? INFINITY : rint(log2(fabs(whole / half)));
}

#endif
