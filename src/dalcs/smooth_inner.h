/* smooth_inner.h - functions that only functions read: x/sqrt(1 + x*x) is a quotient of a root of a product.
 *
 * A linear system of the values of all lets the product be below -1 on the way, where the root has no value. What only
 * functions read acts on the circuit through these alone: its value can be that of its argument at once, and then theirs.
 * Newton's method then has the function as it is written, of what is read in the circuit. */
#ifndef DALCS_SMOOTH_INNER_H
#define DALCS_SMOOTH_INNER_H

#include "system.h"

/* Argument j of function `of` rises by so much with the value of function k, which comes before it. */
struct dalcs_smooth_link {
    int k, of, j;
    double factor;
};

struct dalcs_smooth_inner {
    int *
        column; /* [n_smooth] of the value, -1: not of one that functions alone read; NULL: there is none */
    int n_links; /* by k */
    struct dalcs_smooth_link *link;
    double *next; /* [n] phi that goes with the arguments that were read */
};

/* For n values of the system's functions, point by point. */
enum dalcs_status dalcs_smooth_inner_setup(struct dalcs_smooth_inner *inner,
                                           const struct dalcs_system *system, int n,
                                           struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
