/* least_norm.h - the inner product in which one of the answers that a mode leaves open is chosen.
 *
 * Answers differ by vectors that the mode maps to 0. The chosen one has the least norm of the diodes, lambda of closed and w
 * of open ones, which is the limit of equal small on-resistances and leaks; among these the least norm of the switches;
 * and among these that of the unknowns. So a diode in series with an open switch has no reverse voltage, whichever way the
 * voltage of both goes. In one norm of both kinds it would have half of it one way and none the other, and where that
 * changes, no guard of the circuit is 0.
 *
 * Each norm is one of parts: what a vector has in the pairs of one kind. Vectors with parts other than 0 are made
 * orthogonal to each other and come first; the others have no parts then (Gram and Schmidt, in the form that subtracts at once,
 * the largest first: G. H. Golub, C. F. Van Loan, Matrix Computations, section 5.2.8). Vectors without a part in common
 * stay as they are, so that no rounding of one gets into another. */
#ifndef DALCS_LEAST_NORM_H
#define DALCS_LEAST_NORM_H

#include <float.h>
#include <stddef.h>

struct dalcs_least_norm {
    int n; /* vectors */
    int n_columns, n_parts;
    double *vector; /* [n][n_columns] */
    double *part;   /* [n][n_parts] */
    double *
        size; /* [n] of what rounding in the parts is of: the norm of the sums of their terms' sizes */
};

/* What rounding leaves of parts, over their size. */
static inline double dalcs_least_norm_rounding(int n_columns) {
    return n_columns * DBL_EPSILON;
}

/* Vector k and its parts. */
static inline double *dalcs_least_norm_vector(const struct dalcs_least_norm *o, int k) {
    return o->vector + (size_t)k * (size_t)o->n_columns;
}

static inline double *dalcs_least_norm_part(const struct dalcs_least_norm *o, int k) {
    return o->part + (size_t)k * (size_t)o->n_parts;
}

/* Returns how many are seen. */
int dalcs_least_norm_separate(const struct dalcs_least_norm *o);

#endif
