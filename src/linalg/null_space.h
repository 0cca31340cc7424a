/* null_space.h - which rows of a sparse matrix follow from others, and what it maps to 0.
 *
 * Gaussian elimination in extended precision, the row of fewest entries first (H. M. Markowitz,
 * Management Science 3, 1957). Each entry carries a bound of its rounding (J. H. Wilkinson, Rounding
 * Errors in Algebraic Processes, 1963), and what may be rounding alone is 0: so the rank is decided
 * entry by entry, whatever the scales, and exactly where entries are 1 and -1, as in the loops and
 * islands of a circuit. */
#ifndef DALCS_NULL_SPACE_H
#define DALCS_NULL_SPACE_H

#include "sparse.h"

struct dalcs_null_space {
    int n_rows, n_columns;
    int n_redundant, *redundant; /* rows that follow from the others, ascending */
    int n_free, *free_column;    /* columns that the others follow from */

    /* the other rows, in the order of elimination */
    int rank;
    int *begin;            /* [rank + 1] */
    int *column;           /* the pivot's first */
    double *value, *bound; /* entries, and of their rounding */
    double *error;         /* [n_columns] how far off the entries of the last vector may be */

    struct dalcs_arena arena; /* of the arrays */
};

/* Of the matrix [n_rows][n_columns] that t collects. On failure there is nothing to finish. */
enum dalcs_status dalcs_null_space_find(struct dalcs_null_space *s, int n_rows, int n_columns,
                                        const struct dalcs_triplets *t) DALCS_MUST_CHECK;

/* vector[n_columns]: the one with 1 in free_column[k] and 0 in the other free ones. Of the others, what may be rounding alone
 * is 0. */
void dalcs_null_space_vector(const struct dalcs_null_space *s, int k, double *vector);

void dalcs_null_space_finish(struct dalcs_null_space *s);

#endif
