/* restart.h - mode and state just after an instant, by two micro-steps of implicit Euler; and steps of it. */
#ifndef DALCS_RESTART_H
#define DALCS_RESTART_H

#include "radau_state.h"

/* Two micro-steps from part->segment.t decide mode and state; a jump is reported. `longer` makes
 * them 2^(5 longer) times as long; mode_only leaves the state as it is. *is_off: it jumps by no
 * more than the error that the state of an event has, or so it seems, and was left where it is, for a
 * projecting step to decide; in large parts on factors, whose rounding such a step would not survive, and
 * for NULL it was moved. */
enum dalcs_status dalcs_radau_restart(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      int longer, bool mode_only, bool *is_off) DALCS_MUST_CHECK;

/* s; of one of them. */
double dalcs_radau_micro_length(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                                int longer);

/* One step of implicit Euler of length h as the present segment. */
enum dalcs_status dalcs_radau_euler_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double h) DALCS_MUST_CHECK;

/* One problem of such a step, of length h to part->segment.t + tau, from state[n_x] into y[n_columns], with the switches where
 * they then stand; part->guards.slides is set where nothing fits. */
enum dalcs_status dalcs_radau_implicit_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                            double h, double tau, const double *state,
                                            double *y) DALCS_MUST_CHECK;

/* The last such answer, in part->work.y1, becomes the present segment. */
void dalcs_radau_accept_implicit(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 double h);

/* part->segment.out, made by implicit Euler in a step of length h, becomes the present segment. */
void dalcs_radau_accept_euler(const struct dalcs_radau *r, struct dalcs_radau_part *part, double h);

#endif
