/* rounding.h - what rounding leaves of a value, over its size.
 *
 * One operation rounds by half of DBL_EPSILON at most, and n of them in a row by n times as much (N. Higham, Accuracy and
 * Stability of Numerical Algorithms, 2002, lemma 3.1). */
#ifndef DALCS_ROUNDING_H
#define DALCS_ROUNDING_H

#include <float.h>

/* Of a time, or of a value of a formula: up to eight operations, as an edge's delay + n period + rise has. */
static const double dalcs_rounded = 4.0 * DBL_EPSILON;

/* Of a sum of products, over the sum of their sizes: a row of up to sixteen terms, of two operations each. */
static const double dalcs_sum_rounded = 16.0 * DBL_EPSILON;

/* Of a certified answer, over the scale of each equation: 900 units in the last place. Elimination of n unknowns leaves a small
 * multiple of n of them (Higham, theorem 9.3): 14 for each of 64 unknowns, the most that a dense map has. The default of
 * the certificate's tolerance; what a solution leaves where it should leave 0 is rounding up to this. */
static const double dalcs_answer_rounded = 2e-13;

#endif
