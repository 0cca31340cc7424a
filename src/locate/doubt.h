/* doubt.h - how far a guard may be off.
 *
 * A guard that has just crossed starts at 0 up to an error, and what is within it is no event. The error of
 * the largest voltage or current is a bound for all, but a loose one for a leak beside a current that works.
 * Its own is what the errors of all that it is made of come to: of states and sources by the map of the
 * step, where there is one, else of its neighbours by Kirchhoff's law. */
#ifndef DALCS_DOUBT_H
#define DALCS_DOUBT_H

#include "extremes.h"
#include "magnitudes.h"
#include "rounding.h"
#include "step_error.h"

/* What rounding leaves of a zero, over its unit's scale: of one on dense maps what it leaves of an answer. */
static inline double dalcs_doubt_noise(const struct dalcs_radau_part *part) {
    return dalcs_answer_rounded * part->segment.rounding;
}

/* The entry of a pair's lambda in its own w: ohms, or the slope of a kink; 0: it is ideal. */
double dalcs_pair_slope(const struct dalcs_system *s, int pair);

/* Finds the capacitors of a part that may step on factors: part->charging_row. */
enum dalcs_status dalcs_doubt_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* V or A, what rounding leaves of a guard that is 0. Factors leave more than a map, of what meets at the guard's
 * nodes: what a thousand amperes elsewhere would leave is a current here. scale: of its unit. */
double dalcs_doubt_noise_about(const struct dalcs_radau_part *part, int guard, double scale,
                               const double *unit);

/* The band of errors, over the unit's scale: no guard is in doubt beyond it, and no error up to it in a pair that has just
 * changed sides is an event. */
static inline double dalcs_doubt_band(const struct dalcs_radau_part *part) {
    return dalcs_beyond * dalcs_larger(part->inner_tolerance, dalcs_doubt_noise(part));
}

/* V or A that a guard may be off by in the present step, of part->segment.entry; scale: of its unit. */
double dalcs_doubt_about(const struct dalcs_radau_part *part, int guard, double scale,
                         const double *unit);

/* A that a pair may begin with, below 0, which has just closed: errors of voltages across milliohms, which die away
 * within nanoseconds, may be more than the band. */
double dalcs_doubt_of_closed(const struct dalcs_radau_part *part, int pair, double scale);

#endif
