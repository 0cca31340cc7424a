/* nonnegative.h - least squares with some unknowns that may not be negative (Lawson and Hanson, Solving Least Squares
 * Problems, 1974, ch. 23), on dense columns.
 *
 * What is left of the right-hand side is, where it is not 0, a vector of Farkas: perpendicular to every free column,
 * at an obtuse angle to every other one, and at an acute angle to the right-hand side. */
#ifndef DALCS_NONNEGATIVE_H
#define DALCS_NONNEGATIVE_H

#include "memory.h"

struct dalcs_nonnegative {
    int m, n;
    double *a;     /* [n][m] columns */
    bool *is_free; /* [n] */
    double *b;     /* [m] */
    double *q;     /* [n] the answer */
    double *rest;  /* [m] b less what the columns make of it */

    /* Work. */
    double *basis, *r; /* [m][m] orthonormal; [m][m] upper triangle, by columns */
    double *size, *z;  /* [n] norms of columns; [m] */
    int k, *active;    /* [m] columns behind the basis */
    bool *is_active, *is_barred;
};

/* Room for a problem, in the arena; all 0. */
enum dalcs_status dalcs_nonnegative_setup(struct dalcs_nonnegative *p, struct dalcs_arena *arena,
                                          int m, int n) DALCS_MUST_CHECK;

/* Minimises |a q - b| over q >= 0 where it is not free; the first n columns count. */
void dalcs_nonnegative_solve(struct dalcs_nonnegative *p, int n);

#endif
