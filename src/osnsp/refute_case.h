/* refute_case.h - one case of a problem: which pairs are on which side. Private to src/osnsp. */
#ifndef DALCS_REFUTE_CASE_H
#define DALCS_REFUTE_CASE_H

#include "farkas.h"
#include "nonnegative.h"

struct dalcs_refutation {
    const struct dalcs_osnsp *p;
    struct dalcs_claim claim;
    struct dalcs_arena work;
    int n_rows, n_columns;
    double *v, *clean;                /* [n_rows] weights */
    const double *proof;              /* those of the two that were tried last */
    double *sum;                      /* [3 n_columns] work of farkas.c */
    double *dense;                    /* [n_columns][n_rows] scaled */
    double *row_scale, *column_scale; /* [n_rows], [n_columns] */
    double *right;                    /* [n_rows] work: scaled */
    struct dalcs_nonnegative least;
    int *lambda, *slack; /* [n_pairs] columns of the least squares, -1 */
    long n_cases, most_cases;
};

enum dalcs_status dalcs_refutation_make_dense(struct dalcs_refutation *r) DALCS_MUST_CHECK;

/* Is the present case contradictory? */
bool dalcs_refutation_closes(struct dalcs_refutation *r);

#endif
