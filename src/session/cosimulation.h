/* cosimulation.h - external sources: what a program outside reads and gives in the course of a .tran. */
#ifndef DALCS_COSIMULATION_H
#define DALCS_COSIMULATION_H

#include "session_internal.h"

#include "logic_run.h"

struct dalcs_rows;

/* Zero-initialise; finish frees. */
struct dalcs_cosimulation {
    struct dalcs_run *run; /* NULL: the circuit has no external source */
    struct dalcs_logic_inputs inputs;
    struct dalcs_exchange exchange;
    const char **input; /* heap; so are the next two */
    double *value, *given;
};

/* DALCS_E_OPTION and a message where an analysis has external sources and no exchange gives them values. */
enum dalcs_status dalcs_cosimulation_check(const struct dalcs_run *r,
                                           enum dalcs_analysis analysis) DALCS_MUST_CHECK;

/* Calls the exchange at 0, before the operating point. */
enum dalcs_status dalcs_cosimulation_start(struct dalcs_cosimulation *c, struct dalcs_run *r,
                                           struct dalcs_logic_run *logic) DALCS_MUST_CHECK;

/* Does a source get another value than it has? */
bool dalcs_cosimulation_has_changed(const struct dalcs_cosimulation *c);

/* Is the program to be asked at t? Times nearer than `near` are one. */
static inline bool dalcs_cosimulation_is_due(const struct dalcs_cosimulation *c, double t,
                                             double near) {
    return c->run != NULL && c->inputs.next <= t + near;
}

/* All signals just before t, from the rows of one of the Radau methods, which are there, or from the engine of implicit
 * Euler (rows: NULL); what is given for them waits for the logic of the run. */
enum dalcs_status dalcs_cosimulation_ask(struct dalcs_cosimulation *c, double t,
                                         const struct dalcs_rows *rows,
                                         const struct dalcs_euler *e) DALCS_MUST_CHECK;

void dalcs_cosimulation_finish(struct dalcs_cosimulation *c);

#endif
