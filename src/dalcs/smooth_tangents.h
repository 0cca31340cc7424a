/* smooth_tangents.h - what Newton's method asks of one smooth source. Private to src/dalcs. */
#ifndef DALCS_SMOOTH_TANGENTS_H
#define DALCS_SMOOTH_TANGENTS_H

#include "smooth_newton.h"

double dalcs_smooth_line(const struct dalcs_smooth_input *of, int j);

/* A root at 0 is vertical, and where sources alone decide its argument nobody asks for its slope: 0 times the square
 * root of the largest number is 0. */
void dalcs_smooth_finite_gradient(const struct dalcs_smooth_input *of, const double *x,
                                  double *gradient);

void dalcs_smooth_gradient_of_rest(const struct dalcs_smooth_input *of, const double *x,
                                   double *gradient);

/* Where it has a value at x. */
void dalcs_smooth_take_rest(const struct dalcs_smooth_input *of, const double *x, double *phi);

#endif
