/* stage_store.h - steps that a run has made, for the next run of the same circuit.
 *
 * The search for a steady state is a sequence of runs over one period. Lengths of steps are powers of 2 of one length, and events
 * are looked for within a step. So the runs need the same few matrices, wherever their events are. A dense map depends on
 * the equations, the method, the constant inputs and the functions of time. Where these are alike the next run
 * has the maps of the last one. */
#ifndef DALCS_STAGE_STORE_H
#define DALCS_STAGE_STORE_H

#include "stages.h"

struct dalcs_stage_store {
    int n;                         /* parts of a run */
    struct dalcs_stage_left *left; /* [n] */
};

/* For runs of n parts. The equations of their systems do not change while it is used. */
enum dalcs_status dalcs_stage_store_setup(struct dalcs_stage_store *store, int n) DALCS_MUST_CHECK;

void dalcs_stage_store_finish(struct dalcs_stage_store *store);

/* What is there for this part of a run, before its first step. */
void dalcs_stage_store_take(struct dalcs_stage_store *store, int part, struct dalcs_stages *stages);

/* Behind its last step, in the place of dalcs_stages_finish(). */
void dalcs_stage_store_put(struct dalcs_stage_store *store, int part, struct dalcs_stages *stages);

#endif
