/* logic_outputs.h - what the outputs of gates and samples show, in the stimuli of the circuit. */
#ifndef DALCS_LOGIC_OUTPUTS_H
#define DALCS_LOGIC_OUTPUTS_H

#include "logic_run.h"

/* Gate k at rest. *changed: it showed something else. */
enum dalcs_status dalcs_logic_output_start(struct dalcs_logic_run *l, int k,
                                           bool *changed) DALCS_MUST_CHECK;

/* What gate k has decided, from t on. */
enum dalcs_status dalcs_logic_output_show(struct dalcs_logic_run *l, int k,
                                          double t) DALCS_MUST_CHECK;

#endif
