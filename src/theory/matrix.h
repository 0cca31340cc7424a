/* matrix.h - dense matrices by columns, in an arena, and their factorisations by LAPACK.
 *
 * Every function that makes a matrix takes its memory from the arena given; nothing is freed alone.
 * Dimensions may be 0. */
#ifndef DALCS_MATRIX_H
#define DALCS_MATRIX_H

#include "memory.h"

#include <stdbool.h>
#include <stddef.h>

struct dalcs_matrix {
    int rows, columns;
    double *a; /* element (i, j) is a[i + j rows] */
};

static inline double *dalcs_at(const struct dalcs_matrix *m, int i, int j) {
    return &m->a[(size_t)i + (size_t)j * (size_t)m->rows];
}

/* Zeroed. */
enum dalcs_status dalcs_matrix_new(struct dalcs_matrix *m, struct dalcs_arena *arena, int rows,
                                   int columns) DALCS_MUST_CHECK;

enum dalcs_status dalcs_matrix_copy(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                    const struct dalcs_matrix *from) DALCS_MUST_CHECK;

enum dalcs_status dalcs_matrix_transpose(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                         const struct dalcs_matrix *from) DALCS_MUST_CHECK;

/* m = left right, a matrix of its own. */
enum dalcs_status dalcs_matrix_product(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                       const struct dalcs_matrix *left,
                                       const struct dalcs_matrix *right) DALCS_MUST_CHECK;

/* m += factor other, of the same shape. */
void dalcs_matrix_add(struct dalcs_matrix *m, double factor, const struct dalcs_matrix *other);

/* The rows row[n_rows] and columns column[n_columns] of a matrix; NULL: all of them. */
enum dalcs_status dalcs_matrix_part(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                    const struct dalcs_matrix *from, int n_rows, const int *row,
                                    int n_columns, const int *column) DALCS_MUST_CHECK;

/* Largest magnitude of an element; 0 of an empty matrix. */
double dalcs_matrix_largest(const struct dalcs_matrix *m);

/* x takes the place of b: matrix x = b. DALCS_SINGULAR when a pivot is exactly 0. */
enum dalcs_status dalcs_matrix_solve(const struct dalcs_matrix *matrix, struct dalcs_matrix *b,
                                     struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Eigenvalues of a symmetric matrix, ascending, of which the lower triangle is read;
 * vector may be NULL: else its columns are the eigenvectors. value[rows]. */
enum dalcs_status dalcs_matrix_symmetric_eigen(const struct dalcs_matrix *matrix, double *value,
                                               struct dalcs_matrix *vector,
                                               struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Is a symmetric matrix + shift I positive definite (Cholesky)? */
enum dalcs_status dalcs_matrix_is_positive(const struct dalcs_matrix *matrix, double shift,
                                           bool *is, struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The smallest and largest eigenvalue of M + M'. Both 0 of an empty matrix. */
enum dalcs_status dalcs_matrix_symmetric_part(const struct dalcs_matrix *matrix, double *smallest,
                                              double *largest,
                                              struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Eigenvalues re[rows] + i im[rows]; right eigenvectors as LAPACK's dgeev packs them, or NULL. */
enum dalcs_status dalcs_matrix_eigen(const struct dalcs_matrix *matrix, double *re, double *im,
                                     struct dalcs_matrix *vector,
                                     struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Singular values, descending, value[min(rows, columns)]; right may be NULL: else its rows are the
 * right singular vectors, [columns][columns]. */
enum dalcs_status dalcs_matrix_singular_values(const struct dalcs_matrix *matrix, double *value,
                                               struct dalcs_matrix *right,
                                               struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Rank where singular values below 1e-10 of the largest count as 0. null may be NULL: else its
 * columns span the null space. */
enum dalcs_status dalcs_matrix_rank(const struct dalcs_matrix *matrix, int *rank,
                                    struct dalcs_matrix *null,
                                    struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
