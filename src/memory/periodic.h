/* periodic.h - what comes back with the sources' period, or with that of the switches' commands, is computed once.
 *
 * Between two events a circuit is linear, and what it does from an event on follows from its mode, its
 * states and what the sources do. If all are what they were one period of the sources ago, everything
 * since then happens again, period after period: a rectifier in its steady state. Its segments are kept
 * from one such event on, and once the circuit has come back to it, they are taken as they are, later by
 * whole periods.
 *
 * Of a component under sines with a common period, which may command switches, or one whose commanded switches
 * follow PULSEs with one, and passive: there what the states miss by coming back cannot grow. It is held to a part of the tolerance, over
 * all periods to come. */
#ifndef DALCS_PERIODIC_H
#define DALCS_PERIODIC_H

#include "radau_state.h"

/* part->memory.periodic; NULL where nothing can come back: then the functions below are not called. */
enum dalcs_status dalcs_periodic_setup(const struct dalcs_radau *r,
                                       struct dalcs_radau_part *part) DALCS_MUST_CHECK;

void dalcs_periodic_finish(struct dalcs_radau_part *part);

/* No search for a command ends within a period from part->segment.t on, unless it finds one: each period has the same ends. */
void dalcs_periodic_look_ahead(struct dalcs_radau_part *part);

/* At part->segment.t pairs have changed sides, or been commanded to. */
void dalcs_periodic_event(const struct dalcs_radau *r, struct dalcs_radau_part *part);

/* The present segment has been looked for, and found. */
enum dalcs_status dalcs_periodic_note(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* Is the segment known that follows the present one? If it was until now, and what ends the run is in it,
 * part->segment.out is the part's own again. */
bool dalcs_periodic_repeats(const struct dalcs_radau *r, struct dalcs_radau_part *part);

/* After dalcs_periodic_repeats(), where the present segment ended: the known one is the present one. part->x is its state only
 * where the energies are needed. */
void dalcs_periodic_take(struct dalcs_radau *r, struct dalcs_radau_part *part);

#endif
