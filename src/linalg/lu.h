/* lu.h - sparse LU of one square matrix: the seam to KLU.
 *
 * KLU (Davis and Palamadai Natarajan 2010) permutes a circuit matrix to block triangular form and
 * factors each block; a factor is never reused for other values, because a pivot that was safe in
 * one mode may vanish in the next. */
#ifndef DALCS_LU_H
#define DALCS_LU_H

#include "memory.h"

#include <suitesparse/klu.h>

struct dalcs_lu {
    int n;
    klu_symbolic *symbolic;
    klu_numeric *numeric;
};

/* KLU's settings and counters; one for each thread of work. */
void dalcs_lu_common_init(klu_common *common);

/* Factors the matrix of order n whose columns are (p[n+1], i[], x[]). DALCS_SINGULAR when KLU meets
 * a zero pivot or when its cheap estimate of the reciprocal condition is below rcond_min: the
 * caller balances rows and columns, so that the estimate means something. On any failure *lu is
 * zeroed: nothing to free. */
enum dalcs_status dalcs_lu_factor(struct dalcs_lu *lu, klu_common *common, int n, int *p, int *i,
                                  double *x, double rcond_min) DALCS_MUST_CHECK;

/* Overwrites b[n * n_rhs] with the solution(s). */
void dalcs_lu_solve(const struct dalcs_lu *lu, klu_common *common, int n_rhs, double *b);

/* Bytes held, roughly; for the bound on a cache. */
size_t dalcs_lu_bytes(const struct dalcs_lu *lu);

void dalcs_lu_finish(struct dalcs_lu *lu, klu_common *common);

#endif
