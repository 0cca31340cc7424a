/* control_course.h - a control that is a sum of sources, from some time on up to its next edge.
 *
 * It is value + slope tau + what bends, and its second derivative is bounded by sums over the sources' terms
 * (stimulus.h). So from any time on there is a time before which it cannot reach its threshold, and going from one
 * such time to the next no crossing is passed over, however steep or close to another one. */
#ifndef DALCS_CONTROL_COURSE_H
#define DALCS_CONTROL_COURSE_H

#include "circuit.h"
#include "system.h"

struct dalcs_control {
    const struct dalcs_circuit *circuit;
    const struct dalcs_system *system;
    struct dalcs_stimulus_term *term; /* work: those of one source */
};

/* The source of an input; NULL: the constant 1. */
static inline const struct dalcs_stimulus *dalcs_control_stimulus(const struct dalcs_control *c,
                                                                  int input) {
    int index = c->system->stimulus[input];
    return index < 0 ? NULL : &c->circuit->stimulus[index];
}

/* Of the sources that control any switch by themselves, room for the terms of one; 1 at least. */
int dalcs_control_most_terms(const struct dalcs_control *control);

double dalcs_control_value(const struct dalcs_control *control, int pair, double t,
                           enum dalcs_side side);

/* The first edge after t. */
double dalcs_control_next_edge(const struct dalcs_control *control, int pair, double t);

/* Is it a straight line from t to its next edge? */
bool dalcs_control_is_straight(const struct dalcs_control *control, int pair, double t);

/* Along a curve from *t to its next edge: goes on to where it is below the threshold, if it comes down (`sign` 1) or
 * goes up (-1) to it, and returns true; to the edge, or after a number of looks as far as it has come, if it does
 * not. What is below by no more than rounding has not crossed. */
bool dalcs_control_follow(const struct dalcs_control *control, int pair, double sign,
                          double threshold, double edge, double *t);

#endif
