/* smooth_tangents.h - what Newton's method needs of one smooth source. Private to src/dalcs. */
#ifndef DALCS_SMOOTH_TANGENTS_H
#define DALCS_SMOOTH_TANGENTS_H

#include "smooth_newton.h"

double dalcs_smooth_line(const struct dalcs_smooth_input *of, int j);

/* A root has an infinite slope at 0. Its finite substitute is the square root of the largest number: where sources
 * alone set the argument, 0 times it is 0. */
void dalcs_smooth_finite_gradient(const struct dalcs_smooth_input *of, const double *x,
                                  double *gradient);

/* What of a function, or of its slope, counts; where none does it may have none. */
static inline double dalcs_smooth_share(double share, double value) {
    return share == 0.0 ? 0.0 : share * value;
}

/* As dalcs_smooth_rest(), of a function of which a share counts; and the slopes of that. */
double dalcs_smooth_rest_of_share(const struct dalcs_smooth_input *of, double share,
                                  const double *x);
void dalcs_smooth_gradient_of_rest(const struct dalcs_smooth_input *of, double share,
                                   const double *x, double *gradient);

/* The exponent of a root with the sign of its argument, or 0: it is another function. */
double dalcs_smooth_root_exponent(const struct dalcs_smooth_input *of);

/* Where such a root of which a share counts meets the line that its argument x and its value g x + phi move along as phi
 * changes, x by `slope` times that; x itself where there is no such place, or another function. */
double dalcs_smooth_root_point(const struct dalcs_smooth_input *of, double share, double x,
                               double phi, double slope);

/* Does it have a value at x? */
void dalcs_smooth_take_rest(const struct dalcs_smooth_input *of, const double *x, double *phi);

#endif
