/* tied.h - diodes with neither current nor voltage, which may change sides without anything else.
 *
 * Numbers of pairs; unit[2]: V, A, the largest of each. */
#ifndef DALCS_TIED_H
#define DALCS_TIED_H

#include "radau_state.h"

/* V or A that rounding makes of a pair that is 0. */
double dalcs_tied_nothing(const struct dalcs_radau_part *part, int pair, const double *unit);

/* Is there a diode with neither current nor voltage during the whole step? It may change sides without
 * anything else, and where that leaves a choice (sources in parallel, floating nodes) only the OSNSP
 * knows which is of least norm. A closed one that had no current before the event either is none of them
 * where the mode determines all: nothing happened to it. Nor is an open
 * one whose voltage is 0 to the last bit, as before anything has been charged, once the circuit is known to
 * leave no choice. Large components, where that is expensive, are asked only at their start and at edges, not
 * after every event. */
bool dalcs_tied_stay(const struct dalcs_radau_part *part, bool is_determined, const double *unit);

/* Does a guard that starts from nothing go up from node to node, or with sign -1 down, if by no more than rounding
 * makes of it beside others? Its own digits tell, for they are those of a power of time. */
bool dalcs_tied_leaves(const struct dalcs_radau_part *part, int pair, double sign);

/* Is this pair such a diode? Where a formula's jump rests, the side that is written for equality is no tie. */
bool dalcs_tied_is(const struct dalcs_radau_part *part, int pair, const double *unit);

/* Opens the closed diodes among them but those in which a current begins, and closes the open ones whose voltage
 * begins to rise. False: there are none. */
bool dalcs_tied_turn(struct dalcs_radau_part *part, const double *unit);

/* Closes all open ones where there may be many answers: they may have a part of a current. False: there are none. */
bool dalcs_tied_share(struct dalcs_radau_part *part, const double *unit);

/* Opens those that are closed now and were not `before`, and have no current halfway to `end`, in steps, nor begin to.
 * False: there is none. */
bool dalcs_tied_open_idle(struct dalcs_radau_part *part, const uint64_t *before, double end,
                          const double *unit);

/* Has a pair been 0 for all of the segment before, on the side where it is? */
bool dalcs_tied_was_at_rest(const struct dalcs_radau_part *part, int pair, const double *unit);

#endif
