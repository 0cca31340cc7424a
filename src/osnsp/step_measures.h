/* step_measures.h - norms of rows, and the conductances of a system. */
#ifndef DALCS_STEP_MEASURES_H
#define DALCS_STEP_MEASURES_H

#include "step_form.h"

/* The norm of every row of the system over voltages and over currents, in form->checks, the least and the most
 * conductance, and how far a voltage counts as a current. */
void dalcs_step_form_measure(struct dalcs_step_form *form, const struct dalcs_system *system);

#endif
