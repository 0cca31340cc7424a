/* extended.h - small dense systems in extended precision.
 *
 * The stages of a step come from solutions of several systems that cancel to a few hundredths; what a
 * double loses there would show as noise in currents through small resistances. Circuit matrices are
 * mostly zeros, which elimination skips, so this costs little more than LAPACK would. */
#ifndef DALCS_EXTENDED_H
#define DALCS_EXTENDED_H

/* Solves A X = B by elimination with row exchanges, for n_rhs columns: row i is a[i * (n + n_rhs)]
 * with A first and B behind; X takes the place of B. im may be NULL: a real system. Returns the
 * smallest pivot in magnitude, the caller having balanced A; with 0, X means nothing. */
long double dalcs_extended_solve(int n, int n_rhs, long double *re, long double *im);

/* Solves rows [first, n) of a[n][width] for columns [first, n), as far as there are pivots of at least
 * `least`, and takes them out of all rows: row_of[c] says y_c = its last columns - its other columns * y,
 * or is -1 where column c stays. Columns that are gone are 0. */
void dalcs_extended_eliminate(int first, int n, int width, long double least, long double *a,
                              int *row_of);

#endif
