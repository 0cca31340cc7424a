/* stage_matrix.h - the sparse matrix of a mode for any eigenvalue, balanced.
 *
 * The scales are powers of 2 that bring the largest entries of rows and columns near 1, at the real
 * eigenvalue; in the same way as the dense map does it. */
#ifndef DALCS_STAGE_MATRIX_H
#define DALCS_STAGE_MATRIX_H

#include "stage_plan.h"
#include "stage_singular.h"

/* S = base + mu/h P by columns. */
struct dalcs_stage_matrix {
    int n;
    int n_pairs;       /* present; they come last */
    int *row, *column; /* [n] of M; row n_rows + k: choice k */
    int *p, *i;
    double *base, *P;
    double *row_scale, *column_scale; /* [n] */
    double *values;                   /* room for complex ones */
};

/* The rows and columns of pair[n_pairs] are present, the others left out; choices are in the place of
 * the rows that follow from others. */
enum dalcs_status dalcs_stage_matrix_build(struct dalcs_stage_matrix *m,
                                           const struct dalcs_stage_plan *plan, int n_pairs,
                                           const int *pair,
                                           const struct dalcs_stage_singular *choice,
                                           double h) DALCS_MUST_CHECK;

/* Puts S into m->values at mu/h = re + i im, in pairs when it is complex. */
void dalcs_stage_matrix_at(struct dalcs_stage_matrix *m, double re, double im, bool is_complex);

/* The scale of a row or column whose largest entry is in 2^e [1/2, 1): 2^-e, or 1 if it is empty. */
double dalcs_stage_matrix_scale(double largest);

void dalcs_stage_matrix_finish(struct dalcs_stage_matrix *m);

#endif
