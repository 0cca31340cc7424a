/* current_error.h - errors of currents that are small differences of large voltages, and the other way round. */
#ifndef DALCS_CURRENT_ERROR_H
#define DALCS_CURRENT_ERROR_H

#include "radau.h"

/* The largest error of a branch current without memory, and with a map of a voltage that resistors make of coils'
 * currents, in the step that was solved last, over what is
 * allowed: the tolerance times its scale at these units (V, A), and `besides`, V and A. 0 if it is far less
 * than that. *of_unit: the largest that is not allowed, over its unit. */
double dalcs_current_error(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                           struct dalcs_stage_entry *entry, const double unit[2],
                           const double besides[2], double *of_unit);

#endif
