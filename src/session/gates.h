/* gates.h - what is refused of logic, in words; and what samples read. */
#ifndef DALCS_SESSION_GATES_H
#define DALCS_SESSION_GATES_H

#include "logic_run.h"
#include "rows.h"
#include "session_internal.h"

/* A loop of gates at t that does not settle. */
enum dalcs_status dalcs_refuse_gates(struct dalcs_run *r, const struct dalcs_logic_run *logic,
                                     double t) DALCS_MUST_CHECK;

/* The operating point of an engine, with gates at rest in it: a change of an output may move what others read. logic is
 * that of the engine, which may have none; NULL likewise. */
enum dalcs_status dalcs_gates_operating_point(struct dalcs_euler *e, struct dalcs_logic_run *logic,
                                              bool sources_at_start) DALCS_MUST_CHECK;

/* Reports gates that have found no state of rest. */
void dalcs_warn_of_restless_gates(struct dalcs_run *r, struct dalcs_logic_run *logic);

/* What samples may take at the end of a step of implicit Euler. */
void dalcs_gates_read_euler(const struct dalcs_network *network, struct dalcs_logic_run *logic);

/* The rows of what samples take. Does nothing where there are none. */
struct dalcs_gate_samples {
    bool are_there;
    struct dalcs_rows rows; /* of logic->sample */
};

enum dalcs_status dalcs_gate_samples_setup(struct dalcs_gate_samples *s,
                                           const struct dalcs_logic_run *logic) DALCS_MUST_CHECK;

/* At t, before anything happens there. */
enum dalcs_status dalcs_gate_samples_read(struct dalcs_gate_samples *s,
                                          struct dalcs_logic_run *logic, double t) DALCS_MUST_CHECK;

void dalcs_gate_samples_finish(struct dalcs_gate_samples *s);

/* An output as implicit Euler has it. */
double dalcs_gates_read_output(const struct dalcs_euler *e, const struct dalcs_output *output);

#endif
