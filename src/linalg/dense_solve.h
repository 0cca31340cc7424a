/* dense_solve.h - small dense systems in doubles, several right-hand sides at once. */
#ifndef DALCS_DENSE_SOLVE_H
#define DALCS_DENSE_SOLVE_H

#include "quads.h"

/* Of a row of n unknowns and n_rhs right-hand sides, in whole quads. */
static inline int dalcs_dense_row(int n, int n_rhs) {
    return dalcs_quads_of(n + n_rhs);
}

/* a[n][dalcs_dense_row(n, n_rhs)]: a matrix, to the right of it its right-hand sides, which become the solutions. What
 * is behind them has to be numbers. Returns the smallest pivot by size; 0: the matrix is singular. */
double dalcs_dense_solve(int n, int n_rhs, double *a);

#endif
