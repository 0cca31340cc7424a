/* micro_steps.h - pairs of micro-steps of implicit Euler from part->segment.t, and the states that follow from them. */
#ifndef DALCS_MICRO_STEPS_H
#define DALCS_MICRO_STEPS_H

#include "radau_state.h"

/* Steps that are told from each other by their length differ by so many rungs of the ladder: a thousandth, of lengths whose
 * factors other steps have. */
enum { DALCS_FAR_SHORTER = 10 };

/* Steps of implicit Euler without a certificate get longer so many times: a step so short may have none, as its states are
 * rounded. */
enum { DALCS_LONGER_TRIES = 4 };

/* Notes a failure at part->segment.t with the problem of sigma and u[n_x + n_inputs]; returns status. */
enum dalcs_status dalcs_micro_fail(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   double sigma, const double *u,
                                   enum dalcs_status status) DALCS_MUST_CHECK;

/* Switches whose control reads the circuit. all: those with hysteresis move, too; in micro-steps they stand as they
 * are, see dalcs_search_change_mode(). */
void dalcs_micro_positions(struct dalcs_radau_part *part, bool all);

/* part->work.y1 and y2 by two micro-steps of length h (s), in each of which sources go on by tau (s). */
enum dalcs_status dalcs_micro_pair(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   double tau) DALCS_MUST_CHECK;

/* The same with tau = h. */
enum dalcs_status dalcs_micro_steps(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    double h) DALCS_MUST_CHECK;

/* The same, where they saw a state jump with the sources: with the positions of all switches, from the mode before, that
 * agree with what has jumped behind them, if there are any. */
enum dalcs_status dalcs_micro_leap(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   const uint64_t *before) DALCS_MUST_CHECK;

/* The states just after part->segment.t from y1 and y2, into after[n_x]. Does any jump, and *noticeable: by more than
 * the error that the state of an event has? A fast transient moves in both micro-steps and is left to be stepped
 * through. It may hide a jump, or the mode that it is in: *closer is how short micro-steps that show it are, over
 * these. */
bool dalcs_micro_extrapolate(const struct dalcs_radau_part *part, double *after, bool *noticeable,
                             double *closer);

/* The impulses of the micro-steps of length h (s) into r->base->charge and flux. */
void dalcs_micro_impulses(struct dalcs_radau *r, const struct dalcs_radau_part *part, double h);

/* Over the largest of its unit: a state that moves by more has jumped by more than the error that the state of an event
 * has. */
double dalcs_micro_noticeable(const struct dalcs_radau_part *part);

/* V, A: the largest so far, and of the states, into largest[2]. */
void dalcs_micro_largest(const struct dalcs_radau_part *part, double *largest);

/* V, A: and of what sources and thresholds drive, in the inputs of the last micro-step. */
void dalcs_micro_raise_to_drives(const struct dalcs_radau_part *part, double *largest);

/* V, A: no less than |y[0..n-1]|. */
void dalcs_micro_raise(const struct dalcs_system *s, const double *y, int n, double *largest);

/* V or A (of = 0, 1): a state that changes by less has not: rounding of the largest of its unit, or what rounding of
 * the other unit drives. */
double dalcs_micro_rounding(const struct dalcs_radau_part *part, int of, const double *largest);

#endif
