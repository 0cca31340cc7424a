/* redundant_rows.h - of rows that follow from each other, those to leave out.
 *
 * A dependency says that a sum of rows with weights is 0. So the residual of the row that is left out is what rounding
 * leaves in the others, over its own weight: with the largest one left out it is within rounding of its own terms, as
 * theirs are. An island of ohms and gigohms would otherwise have the rounding of amperes in the KCL of nanoamperes. */
#ifndef DALCS_REDUNDANT_ROWS_H
#define DALCS_REDUNDANT_ROWS_H

#include "null_space.h"

/* Sums of rows with these weights are 0. */
struct dalcs_dependencies {
    int n, n_rows;
    double *weight; /* [n][n_rows]; 0 where rounding hides how many depend */
    double *size;   /* [n_rows] what the terms of a row add up to */
    int *chosen;    /* [n] the rows to leave out */
    double *scaled; /* [n][n_rows] work */
    int *largest;   /* [n] work: the row of the largest of these */
};

enum dalcs_status dalcs_dependencies_setup(struct dalcs_dependencies *d, struct dalcs_arena *arena,
                                           int n, int n_rows) DALCS_MUST_CHECK;

/* d->chosen becomes as many of the first n_candidates rows as there are dependencies, with d->size the largest that they have.
 * False: a dependency is of other rows alone, or nothing is known of them. */
bool dalcs_dependencies_choose(const struct dalcs_dependencies *d, int n_candidates);

/* space->redundant becomes these, where they are, with d->size what columns of size[n_columns] make of t, the matrix of the
 * space. d: set up for space->n_redundant dependencies, which it becomes. */
enum dalcs_status dalcs_redundant_rows_choose(struct dalcs_null_space *space,
                                              const struct dalcs_triplets *t, const double *size,
                                              int n_candidates,
                                              struct dalcs_dependencies *d) DALCS_MUST_CHECK;

#endif
