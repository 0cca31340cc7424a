/* audit_gates.h - gates, flip-flops and samples, decided a second time: from what comparators say and what outputs show. */
#ifndef DALCS_AUDIT_GATES_H
#define DALCS_AUDIT_GATES_H

#include "audit.h"
#include "logic_run.h"

struct dalcs_audit_gates {
    const struct dalcs_circuit *circuit;
    struct dalcs_radau *radau;
    const struct dalcs_readout *readout;
    const struct dalcs_logic_run *logic; /* that has decided last; of it, which bits came back */
    struct dalcs_logic_place *place;     /* [n_comparators] */
    bool
        *says; /* [n_gates], behind these [n_comparators]: at the last instant that was looked at */
    int n_restless;          /* gates that are looked at anyhow; before the first look all are */
    int *source;             /* places there, of what gates read */
    struct audit_gate *gate; /* [n_gates]; NULL: there are none */
    int *node_system;        /* [n_nodes] -1: none; NULL: there are no samples */
};

/* Does nothing where the circuit has no gates. */
enum dalcs_status dalcs_audit_gates_start(struct dalcs_audit_gates *a,
                                          const struct dalcs_circuit *circuit,
                                          struct dalcs_radau *radau,
                                          const struct dalcs_readout *readout) DALCS_MUST_CHECK;
void dalcs_audit_gates_finish(struct dalcs_audit_gates *a);

/* The run goes on from another one, with what gates remember of that; they have not decided yet. That a period ends with
 * what it began with is looked at elsewhere. */
enum dalcs_status dalcs_audit_gates_go_on(struct dalcs_audit_gates *a,
                                          const struct dalcs_logic_run *logic) DALCS_MUST_CHECK;

/* Nothing has happened at t yet: what samples may take. */
enum dalcs_status dalcs_audit_gates_sample(struct dalcs_audit_gates *a, double t) DALCS_MUST_CHECK;

/* All gates have decided at t, where something may have happened; findings go to audit. */
enum dalcs_status dalcs_audit_gates_look(struct dalcs_audit_gates *a, struct dalcs_audit *audit,
                                         const struct dalcs_logic_run *logic,
                                         double t) DALCS_MUST_CHECK;

#endif
