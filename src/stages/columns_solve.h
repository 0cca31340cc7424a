/* columns_solve.h - systems of a step on sparse factors, for four right-hand sides. Private to src/stages. */
#ifndef DALCS_COLUMNS_SOLVE_H
#define DALCS_COLUMNS_SOLVE_H

#include "stage_columns.h"
#include "stage_factors.h"

/* rhs[n_rows] by rows of M to solved, in the order of the system's unknowns, balanced; complex ones are re, im one behind the
 * other. */
void dalcs_columns_solve(const struct dalcs_stage_factors *f, int system, const dalcs_four *rhs,
                         dalcs_four *solved);

/* rhs += the transposed of that times `solved`, of which nothing is left. */
void dalcs_columns_solve_back(const struct dalcs_stage_factors *f, int system, dalcs_four *solved,
                              dalcs_four *rhs);

#endif
