/* guards_internal.h - what the files about guards have in common. Private to src/locate. */
#ifndef DALCS_GUARDS_INTERNAL_H
#define DALCS_GUARDS_INTERNAL_H

#include "guards.h"

/* Is a pair on the side that it was on in the segment before, with the same value? */
bool dalcs_guard_goes_on(const struct dalcs_radau_part *part, int pair, double value);

/* A guard that starts a little below 0 and is above after next to no time: the flank of a source, when it
 * begins, may take over from a current within 1e-16 s. Or after less than times can be told apart: the
 * last digit of a time makes volts of a current that has nowhere to go but a leak. */
bool dalcs_guard_is_over_soon(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                              const double *value, int stride, double scale);

#endif
