/* euler_internal.h - what the files behind euler.h share. */
#ifndef DALCS_EULER_INTERNAL_H
#define DALCS_EULER_INTERNAL_H

#include "euler.h"

/* The problem of component k for sigma and u[n_x + n_inputs], into y[n_columns]; switches follow their control.
 * A failure is noted in e. */
enum dalcs_status dalcs_euler_solve(struct dalcs_euler *e, int k, double sigma, const double *u,
                                    double *y) DALCS_MUST_CHECK;

/* What is just after a discontinuity of component k at e->t, from u = (x-, s), where before[n_columns] is what was just
 * before: a jump is found, reported and left in e->after; y[n_columns] becomes the values after it. */
enum dalcs_status dalcs_euler_settle_after(struct dalcs_euler *e, int k, const double *before,
                                           const double *u, double *y) DALCS_MUST_CHECK;

/* The state just after it alone, in e->after; y holds the impulsive currents of a micro-step of *length (s). */
enum dalcs_status dalcs_euler_look_after(struct dalcs_euler *e, int k, const double *before,
                                         const double *u, double *y,
                                         double *length) DALCS_MUST_CHECK;

#endif
