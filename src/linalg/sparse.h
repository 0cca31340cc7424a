/* sparse.h - sparse matrices: triplets to collect, compressed rows to use.
 *
 * One type per representation. Indices are int (KLU's choice); sizes are checked once, where a
 * matrix is compressed. */
#ifndef DALCS_SPARSE_H
#define DALCS_SPARSE_H

#include "memory.h"

/* Entries in any order; duplicates add up when compressed. Zero-initialise. */
struct dalcs_triplets {
    size_t n, capacity;

    struct dalcs_triplet {
        int row, column;
        double value;
    } * entry;
};

enum dalcs_status dalcs_triplets_add(struct dalcs_triplets *t, int row, int column,
                                     double value) DALCS_MUST_CHECK;

void dalcs_triplets_finish(struct dalcs_triplets *t);

/* Compressed rows, columns ascending within a row. All is in the block that starts at x. */
struct dalcs_csr {
    int n_rows, n_columns;
    int *p;    /* [n_rows + 1] */
    int *j;    /* [p[n_rows]] */
    double *x; /* [p[n_rows]] */
};

/* Sums duplicates, rounded once; what cancels is dropped. On failure *a is zeroed. */
enum dalcs_status dalcs_csr_compress(struct dalcs_csr *a, int n_rows, int n_columns,
                                     const struct dalcs_triplets *t) DALCS_MUST_CHECK;

/* The same of numbers that are rounded: what cancels but for that is dropped, too. */
enum dalcs_status dalcs_csr_compress_rounded(struct dalcs_csr *a, int n_rows, int n_columns,
                                             const struct dalcs_triplets *t) DALCS_MUST_CHECK;

void dalcs_csr_finish(struct dalcs_csr *a);

/* Row i of a, times v[n_columns]. */
static inline double dalcs_csr_row_dot(const struct dalcs_csr *a, int i, const double *v) {
    double sum = 0.0;
    for (int k = a->p[i]; k < a->p[i + 1]; k++) {
        sum += a->x[k] * v[a->j[k]];
    }
    return sum;
}

/* ends[2] = the columns (p, m) when row i is exactly v[p] - v[m]; else ends[0] = -1. */
void dalcs_csr_row_difference(const struct dalcs_csr *a, int i, int *ends);

/* y[n_rows] = a v[n_columns] */
void dalcs_csr_multiply(const struct dalcs_csr *a, const double *v, double *y);

#endif
