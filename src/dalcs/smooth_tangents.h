/* smooth_tangents.h - what Newton's method needs of one smooth source. Private to src/dalcs. */
#ifndef DALCS_SMOOTH_TANGENTS_H
#define DALCS_SMOOTH_TANGENTS_H

#include "smooth_newton.h"

double dalcs_smooth_line(const struct dalcs_smooth_input *of, int j);

/* A root has an infinite slope at 0. Its finite substitute is the square root of the largest number: where sources
 * alone set the argument, 0 times it is 0. */
void dalcs_smooth_finite_gradient(const struct dalcs_smooth_input *of, const double *x,
                                  double *gradient);

void dalcs_smooth_gradient_of_rest(const struct dalcs_smooth_input *of, const double *x,
                                   double *gradient);

/* Does it have a value at x? */
void dalcs_smooth_take_rest(const struct dalcs_smooth_input *of, const double *x, double *phi);

#endif
