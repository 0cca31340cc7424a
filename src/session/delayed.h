/* delayed.h - which analyses transmission lines and delay() have. */
#ifndef DALCS_DELAYED_H
#define DALCS_DELAYED_H

#include "pipeline.h"

/* An error for those that have no histories: responses, steady states, sweeps of operating points, fixed steps. */
enum dalcs_status dalcs_delayed_check(const struct dalcs_run *r,
                                      enum dalcs_analysis analysis) DALCS_MUST_CHECK;

/* Before an operating point: what delayed sources read is in the equations themselves (network.h, at_rest). */
void dalcs_delayed_rest(const struct dalcs_circuit *circuit);

#endif
