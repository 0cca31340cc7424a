/* transition.h - which mode followed the last time from the same guess.
 *
 * In a converter the same switch opens again and again, and the same diode takes over. What micro-steps
 * found out once is tried first the next time, and has to pass like any other guess. */
#ifndef DALCS_TRANSITION_H
#define DALCS_TRANSITION_H

#include "radau.h"

enum dalcs_status dalcs_transition_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* At a fresh point: if something changed sides, takes the mode that followed from the present one;
 * false: none is known. */
bool dalcs_transition_guess(struct dalcs_radau_part *part, bool flipped);

/* The guess did not pass: back to the mode before it. */
void dalcs_transition_refuse(struct dalcs_radau_part *part);

/* The present mode is what followed; worth remembering if it took micro-steps to find. */
void dalcs_transition_learn(struct dalcs_radau_part *part, bool found_by_restart);

#endif
