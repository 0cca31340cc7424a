/* part.h - everything that theory says of one system: conditions, verdicts, a summary. */
#ifndef DALCS_PART_H
#define DALCS_PART_H

#include "power.h"
#include "system.h"

/* Fills *part; what it holds is in `result` and in system's names. power may be NULL: then nobody is
 * named who gives energy. jumps[n_inputs] says which inputs ever jump; NULL: any may. h in s is the
 * step of the conditions on one step. */
enum dalcs_status dalcs_part_check(struct dalcs_checked_part *part, struct dalcs_arena *result,
                                   const struct dalcs_system *system,
                                   const struct dalcs_power *power, const bool *jumps,
                                   double h) DALCS_MUST_CHECK;

#endif
