/* steady_step.h - Newton's step for the fixed point of the Poincare map, and a point of the search. Private to this folder. */
#ifndef DALCS_STEADY_STEP_H
#define DALCS_STEADY_STEP_H

#include "steady.h"

/* A residual that is good enough where a further step makes it no smaller. */
static const double dalcs_steady_good = 1e-10;

/* ---- steady_newton.c --------------------------------------------------------------------------- */

/* st->step of Newton's method from the last pass, and st->distance. Where M has a multiplier of 1 whose quantity is
 * conserved, it keeps that quantity; where that grows, or nothing periodic has as much of
 * it, st->is_stuck. */
enum dalcs_status dalcs_steady_newton(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* Where st->is_stuck: does all go on alike along st->drift? Not where one that drifts drives another one, ever faster. */
bool dalcs_steady_has_drift(const struct dalcs_steady *st);

/* What a state of a system is multiplied by, so that energies are alike: the square root of what it stores; of one that
 * stores nothing, and of all beside gates, 1 over its scale. */
double dalcs_steady_unit(const struct dalcs_steady *st, int system, int x);

/* unit /= scales that balance rows and columns of M [n][n] in these units (dgebal), of which entries that are rounding have
 * no part. work: [n + n^2]. */
enum dalcs_status dalcs_steady_balance(int n, const double *M, double *unit,
                                       double *work) DALCS_MUST_CHECK;

/* ---- steady_free.c ----------------------------------------------------------------------------- */

/* The same where st->is_free: st->step, and *by (s) of the period. */
enum dalcs_status dalcs_steady_newton_free(struct dalcs_steady *st, double *by) DALCS_MUST_CHECK;

/* ---- steady_step.c ----------------------------------------------------------------------------- */

/* st->step of Newton's method from the last pass, and st->longer. */
enum dalcs_status dalcs_steady_next_step(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* Is the last pass, which is with M, that of an orbit from which st->at is off by `distance` over the scales, and
 * st->period by that part of itself where it is free? A bound, but for terms of second order. */
bool dalcs_steady_comes_back(const struct dalcs_steady *st, double distance);

/* st->at = from + factor step, with switches and gates as the last pass has left them. */
void dalcs_steady_go_by(struct dalcs_steady *st, const double *from, const double *step,
                        double factor);

/* st->at and st->period by st->step and st->longer. */
void dalcs_steady_take_step(struct dalcs_steady *st);

/* Is every switch with hysteresis, and every gate, in its old state again behind the last pass? */
bool dalcs_steady_switches_return(const struct dalcs_steady *st);

void dalcs_steady_copy_point(const struct dalcs_steady *st, struct dalcs_orbit_point *to,
                             const struct dalcs_orbit_point *from);

#endif
