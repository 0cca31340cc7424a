/* redundant_rows.h - of rows that follow from each other, those to leave out.
 *
 * A dependency says that a sum of rows with weights is 0. So the residual of the row that is left out is what rounding
 * leaves in the others, over its own weight: with the largest one left out it is within rounding of its own terms, as
 * theirs are. An island of ohms and gigohms would otherwise have the rounding of amperes in the KCL of nanoamperes. */
#ifndef DALCS_REDUNDANT_ROWS_H
#define DALCS_REDUNDANT_ROWS_H

#include "null_space.h"

/* space->redundant becomes as many of the first n_candidates rows whose terms, each column times size[n_columns], are the
 * largest that the dependencies have. t: the matrix of the space. Nothing changes where rounding hides how many depend, or
 * where one is of other rows alone. */
enum dalcs_status dalcs_redundant_rows_choose(struct dalcs_null_space *space,
                                              const struct dalcs_triplets *t, const double *size,
                                              int n_candidates) DALCS_MUST_CHECK;

#endif
