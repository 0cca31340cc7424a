/* algebraic_poles.h - what a part without memory has no value at between two times that it is asked for. */
#ifndef DALCS_ALGEBRAIC_POLES_H
#define DALCS_ALGEBRAIC_POLES_H

#include "radau_state.h"

/* Before such a part is solved at t. False: nothing can be between that and the last time. */
bool dalcs_algebraic_poles_expect(const struct dalcs_radau_part *part, double t);

/* After that, on a side of t: whether a function has a pole since `from`, the time before. Then it is DALCS_NOT_CONVERGED,
 * *t is where, and the component's functions tell which. */
enum dalcs_status dalcs_algebraic_poles_check(const struct dalcs_radau *r,
                                              struct dalcs_radau_part *part, double from, double *t,
                                              enum dalcs_side side) DALCS_MUST_CHECK;

#endif
