/* current_error.h - errors of currents that are small differences of large voltages, and of voltages that are such of currents. */
#ifndef DALCS_CURRENT_ERROR_H
#define DALCS_CURRENT_ERROR_H

#include "radau_state.h"

/* Errors over what is allowed: the tolerance times a scale at these units (V, A), and `besides`, V and A. */
struct dalcs_lever_error {
    double
        of_currents; /* the largest of a branch current without memory; 0 if far less than allowed */
    double of_voltages; /* of a voltage that resistors make of coils' currents; likewise */
};

/* Those of the step that was solved last. */
void dalcs_current_error(struct dalcs_radau_part *part, struct dalcs_stage_entry *entry,
                         const double unit[2], const double besides[2],
                         struct dalcs_lever_error *error);

#endif
