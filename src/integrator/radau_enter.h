/* radau_enter.h - what begins where a segment does: pieces of sources, positions of switches, decisions of gates. */
#ifndef DALCS_RADAU_ENTER_H
#define DALCS_RADAU_ENTER_H

#include "radau_state.h"

/* Times closer than the resolution are one: what sources do just behind the instant they do at it. A carrier that meets
 * its reference at t = 0 crosses it at 1e-21 s by rounding. Returns whether any has an edge; *jumps: whether its value jumps. */
bool dalcs_radau_enter_edges(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             bool *jumps);

/* Switches that sources control stand as commanded. */
void dalcs_radau_obey_commands(struct dalcs_radau_part *part);

/* Asks the decider, if there is one. */
enum dalcs_status dalcs_radau_decide(struct dalcs_radau *r, double t) DALCS_MUST_CHECK;

#endif
