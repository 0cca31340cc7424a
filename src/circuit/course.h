/* course.h - a sum of stimuli from some time on, up to its next edge.
 *
 * It is value + slope tau + what bends, and its second derivative is bounded by sums over the sources' terms
 * (stimulus.h). So from any time on there is a time before which it cannot reach a threshold, and going from one
 * such time to the next no crossing is passed over, however steep or close to another one. */
#ifndef DALCS_COURSE_H
#define DALCS_COURSE_H

#include "stimulus.h"

#include <float.h>

enum { DALCS_COURSE_ORDERS = 4 };

/* On one side of a time: the limit of the value, and derivatives. */
struct dalcs_course {
    double value, derivative[DALCS_COURSE_ORDERS];
    double rounding, rounded[DALCS_COURSE_ORDERS]; /* what rounding may have left of each */
    double bend;                                   /* at least |second derivative|, up to `reach` */
    double straight, rise;                         /* the straight part of value and slope */
    double swing;                                  /* |value - straight - rise tau| up to `reach` */
    double reach;                                  /* s */
    bool before;                                   /* the left side */
};

double dalcs_sum_value(const struct dalcs_stimulus_sum *sum, double t, enum dalcs_side side);
double dalcs_sum_next_edge(const struct dalcs_stimulus_sum *sum, double t);

/* The terms of all parts, one behind the other, times their factors, go to `term`, which has room for them; before a
 * time they are those just before it. */
void dalcs_course_look(const struct dalcs_stimulus_sum *sum, double t, enum dalcs_side side,
                       struct dalcs_stimulus_term *term, struct dalcs_course *course);

/* Is it above (1) or below (-1) a threshold just beyond the time? 0: it rests there. */
int dalcs_course_side(const struct dalcs_course *course, double threshold);

/* Times looked at in one search; a sum that never crosses must not cost its whole future. */
enum { DALCS_COURSE_LOOKS = 256 };

/* One look, at *t, along a course that bends, of which value, derivative[0], bend, straight, rise, swing and reach are
 * known: true: it has passed the threshold, between `start` and *t, which becomes where; false: *t becomes a time before
 * which it cannot, `edge` at most. */
bool dalcs_course_advance(const struct dalcs_course *course, double sign, double threshold,
                          double rounding, double start, double edge, double *t);

/* From *t on, where it is on one side of a threshold (`sign` 1: above), to its next edge: goes to where it passes the
 * threshold and returns true; or to the edge, or as far as a number of looks bring it. */
bool dalcs_course_passes(const struct dalcs_stimulus_sum *sum, int sign, double threshold,
                         double edge, double *t);

#endif
