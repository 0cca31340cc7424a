/* smooth_poles.h - where a smooth function has no value between two places at which it has one: a quotient whose divisor
 * passes 0, a negative power of 0, the tangent of a right angle. Values on both sides say nothing of it. */
#ifndef DALCS_SMOOTH_POLES_H
#define DALCS_SMOOTH_POLES_H

#include "system.h"

/* Has any function of the system poles? */
bool dalcs_smooth_may_have_poles(const struct dalcs_system *system);

/* What is 0 at a pole that argument j of a source makes, one that is read: the argument itself, or a cosine. */
double dalcs_smooth_zero(const struct dalcs_smooth_input *of, int j, const double *x);

/* Does that change its sign between two places? 0 itself is none: there the function is asked, and has no value. */
bool dalcs_smooth_turns(const struct dalcs_smooth_input *of, int j, const double *before,
                        const double *after);

/* The source that has a pole where argument j of source k is 0, between arguments x[n_smooth][2] before and after, being
 * `at` there; -1: none. A quotient of two that are 0 together has none: within `tolerance` of `most`, which both are
 * around there. */
struct dalcs_smooth_places {
    const double (*before)[2], (*after)[2], (*at)[2], (*most)[2];
    double tolerance;
};

int dalcs_smooth_pole(const struct dalcs_system *system, int k, int j,
                      const struct dalcs_smooth_places *p);

#endif
