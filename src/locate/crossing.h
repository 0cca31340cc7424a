/* crossing.h - when a polynomial given at the nodes of a step first falls below zero.
 *
 * In Bernstein's basis a polynomial stays between its least and largest coefficient on the interval
 * (Farouki 2012), so a step that hides two crossings between its nodes cannot pass for one that has
 * none. */
#ifndef DALCS_CROSSING_H
#define DALCS_CROSSING_H

#include "collocation.h"

/* value[k * stride + i] is quantity i of n at node k: none falls below bound[i] on [0, 1]. Whole quads
 * (quads.h) are read and written. */
void dalcs_crossing_bounds(const struct dalcs_collocation *c, int n, const double *value,
                           int stride, double *bound);

struct dalcs_crossing {
    bool falls;   /* below -depth somewhere on [0, end] */
    double theta; /* the last zero before that; 0 when it is never positive before */
    bool at_once; /* it is never positive before */
    double peak;  /* no value before the fall is larger */
};

/* value[k * stride] is the quantity at node k. Looks at theta in [0, end], end <= 1. Falls that stay
 * above -depth (>= 0) do not count. Looks near `guess` first: 0 where nothing is known. */
struct dalcs_crossing dalcs_crossing_find(const struct dalcs_collocation *c, const double *value,
                                          int stride, double end, double depth, double guess);

/* Where a polynomial in Bernstein's basis that is above 0 at first falls below it, in (0, end); INFINITY unless its
 * coefficients tell that it does so once and is below -depth at `end`. */
double dalcs_crossing_only(const struct dalcs_collocation *c, const double *coefficient, double end,
                           double depth);

#endif
