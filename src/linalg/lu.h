/* lu.h - sparse LU of one square matrix: the seam to KLU.
 *
 * KLU (Davis and Palamadai Natarajan 2010) permutes a circuit matrix to block triangular form
 * and factors each block. Its factors are copied into two plain triangles by rows, which a solve
 * runs through in half the time of klu_solve; KLU's own objects are freed. Pivots are never
 * reused for other values unchecked, because one that was safe in one mode may vanish in the
 * next. Complex numbers are pairs (re, im) one behind the other. */
#ifndef DALCS_LU_H
#define DALCS_LU_H

#include "memory.h"

#include <suitesparse/klu.h>

#include <stdbool.h>

/* Room at the end of `work` for unknowns that a caller borders the matrix with. */
enum { DALCS_LU_SPARE = 16 };

/* P A Q = L U + F: F couples a diagonal block to the later ones, which are solved first. */
struct dalcs_lu {
    int n;
    bool is_complex; /* then the reals below are pairs */
    int n_blocks;
    int *block;             /* [n_blocks + 1] first row of each block */
    int *from, *to;         /* [n] row i takes b[from[i]]; unknown i goes to b[to[i]] */
    int *lower_p, *lower_j; /* rows of L without its unit diagonal, and of F */
    double *lower_x;
    int *upper_p, *upper_j; /* rows of U without its diagonal */
    double *upper_x;
    double *pivot_inverse; /* [n] */
    double *work;          /* [n + DALCS_LU_SPARE] */
    void *storage;         /* of all of these */
};

/* A square matrix by columns. */
struct dalcs_columns {
    int n;
    int *p, *i;
    double *x; /* real and imaginary parts in turn, where it is complex */
    bool is_complex;
};

/* KLU's settings and counters; one for each thread of work. */
void dalcs_lu_common_init(klu_common *common);

/* Are the next matrices to be analysed ones with a full diagonal? Then no block triangular form is
 * sought, for it might match rows to other columns than theirs, which the ordering for little fill
 * relies on. */
void dalcs_lu_keep_diagonal(klu_common *common, bool keep);

/* Pivots of at least a tenth of the largest entry in their column. With KLU's own 1e-3, which keep more to the
 * diagonal, elements may grow a thousandfold. */
void dalcs_lu_pivot_carefully(klu_common *common);

/* Factors a matrix. DALCS_SINGULAR when KLU meets
 * a zero pivot, or when its cheap estimate of the reciprocal condition is below rcond_min and a pivot
 * may be what rounding left of its column: the caller balances rows and columns, so that this means
 * something. On any failure *lu is zeroed: nothing to free.
 *
 * row_of_column may be NULL. Otherwise it has for each column the row that a matrix much like this
 * one was found to match to it, -1 where there is none, and gets the rows found for this one. The
 * search for a full diagonal, which is quadratic in a long chain of capacitors, then finds all but a
 * few rows at once; for that, entries change places within their columns. */
enum dalcs_status dalcs_lu_factor(struct dalcs_lu *lu, klu_common *common,
                                  const struct dalcs_columns *a, int *row_of_column,
                                  double rcond_min) DALCS_MUST_CHECK;

/* A matrix of up to so many rows is as well factored without an analysis. */
enum { DALCS_LU_SMALL = 16 };

/* The same of such a matrix, by plain elimination. DALCS_SINGULAR where a pivot is 0 or, over another one, less
 * than `apart`: then it may be singular, or need an order that follows its pattern; dalcs_lu_factor decides that. */
enum dalcs_status dalcs_lu_factor_small(struct dalcs_lu *lu, const struct dalcs_columns *a,
                                        double apart) DALCS_MUST_CHECK;

/* The analysis of the pattern alone, for all values, real or complex. DALCS_SINGULAR when no
 * values can make the matrix regular. Free it with klu_free_symbolic. */
enum dalcs_status dalcs_lu_analyze(klu_symbolic **symbolic, klu_common *common,
                                   const struct dalcs_columns *a) DALCS_MUST_CHECK;

/* dalcs_lu_factor with the analysis at hand. `common` must not serve both real and complex ones.
 * kept may be NULL. Otherwise, and if *kept has KLU's factors of other values of the same
 * pattern (with columns listed in the same order), their pivots are tried first, which costs a
 * quarter, and given up if the elements grow; *kept gets the factors for a next time, to be
 * freed by dalcs_lu_drop. */
enum dalcs_status dalcs_lu_factor_analyzed(struct dalcs_lu *lu, klu_common *common,
                                           klu_symbolic *symbolic, klu_numeric **kept,
                                           const struct dalcs_columns *a,
                                           double rcond_min) DALCS_MUST_CHECK;

void dalcs_lu_drop(klu_numeric **kept, bool is_complex, klu_common *common);

/* Overwrites b[n] with the solution; real factors only. */
void dalcs_lu_solve(const struct dalcs_lu *lu, double *b);

/* The same without its permutations: on entry work[i] holds b[from[i]], afterwards unknown
 * to[i]. */
void dalcs_lu_solve_ordered(const struct dalcs_lu *lu);

/* The same for complex factors. */
void dalcs_lu_solve_ordered_complex(const struct dalcs_lu *lu);

/* Bytes held, roughly; for the bound on a cache. */
size_t dalcs_lu_bytes(const struct dalcs_lu *lu);

void dalcs_lu_finish(struct dalcs_lu *lu);

#endif
