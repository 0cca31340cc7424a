/* gates.h - what is refused of logic, in words. */
#ifndef DALCS_SESSION_GATES_H
#define DALCS_SESSION_GATES_H

#include "logic_run.h"
#include "session_internal.h"

/* A loop of gates at t that does not settle. */
enum dalcs_status dalcs_refuse_gates(struct dalcs_run *r, const struct dalcs_logic_run *logic,
                                     double t) DALCS_MUST_CHECK;

/* Analyses and methods that have no events. */
enum dalcs_status dalcs_check_gates(struct dalcs_run *r,
                                    enum dalcs_analysis analysis) DALCS_MUST_CHECK;

#endif
