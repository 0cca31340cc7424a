/* logic_queue.h - what gates have decided and is seen later. */
#ifndef DALCS_LOGIC_QUEUE_H
#define DALCS_LOGIC_QUEUE_H

#include "logic_run.h"

/* user is the logic. A gate with a delay has decided at user->now: that is seen later. */
void dalcs_logic_queue(void *user, int gate, const struct dalcs_logic_state *next);

/* Pulses that begin at t. */
void dalcs_logic_start_pulses(struct dalcs_logic_run *l, double t);

/* What is due by t is seen. Has anything come due? */
bool dalcs_logic_release(struct dalcs_logic_run *l, double t);

#endif
