/* matrix.c - dense matrices; the seam to LAPACKE. */
#include "matrix.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double rank_tolerance = 1e-10;

enum dalcs_status dalcs_matrix_new(struct dalcs_matrix *m, struct dalcs_arena *arena, int rows,
                                   int columns) {
    *m = (struct dalcs_matrix){rows, columns, NULL};
    m->a = dalcs_arena_alloc(arena, (size_t)rows * (size_t)columns + 1, sizeof(double));
    return m->a == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

static size_t size_of(const struct dalcs_matrix *m) {
    return (size_t)m->rows * (size_t)m->columns;
}

enum dalcs_status dalcs_matrix_copy(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                    const struct dalcs_matrix *from) {
    DALCS_TRY(dalcs_matrix_new(m, arena, from->rows, from->columns));
    memcpy(m->a, from->a, size_of(from) * sizeof(double));
    return DALCS_OK;
}

enum dalcs_status dalcs_matrix_transpose(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                         const struct dalcs_matrix *from) {
    DALCS_TRY(dalcs_matrix_new(m, arena, from->columns, from->rows));
    for (int j = 0; j < from->columns; j++) {
        for (int i = 0; i < from->rows; i++) {
            *dalcs_at(m, j, i) = *dalcs_at(from, i, j);
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_matrix_product(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                       const struct dalcs_matrix *left,
                                       const struct dalcs_matrix *right) {
    DALCS_TRY(dalcs_matrix_new(m, arena, left->rows, right->columns));
    for (int j = 0; j < right->columns; j++) {
        double *to = dalcs_at(m, 0, j);
        for (int k = 0; k < right->rows; k++) {
            const double factor = *dalcs_at(right, k, j);
            const double *from = dalcs_at(left, 0, k);
            for (int i = 0; factor != 0.0 && i < left->rows; i++) {
                to[i] += factor * from[i];
            }
        }
    }
    return DALCS_OK;
}

void dalcs_matrix_add(struct dalcs_matrix *m, double factor, const struct dalcs_matrix *other) {
    for (size_t i = 0; i < size_of(m); i++) {
        m->a[i] += factor * other->a[i];
    }
}

enum dalcs_status dalcs_matrix_part(struct dalcs_matrix *m, struct dalcs_arena *arena,
                                    const struct dalcs_matrix *from, int n_rows, const int *row,
                                    int n_columns, const int *column) {
    int rows = row == NULL ? from->rows : n_rows;
    int columns = column == NULL ? from->columns : n_columns;
    DALCS_TRY(dalcs_matrix_new(m, arena, rows, columns));
    for (int j = 0; j < columns; j++) {
        for (int i = 0; i < rows; i++) {
            *dalcs_at(m, i, j) =
                *dalcs_at(from, row == NULL ? i : row[i], column == NULL ? j : column[j]);
        }
    }
    return DALCS_OK;
}

double dalcs_matrix_largest(const struct dalcs_matrix *m) {
    double largest = 0.0;
    for (size_t i = 0; i < size_of(m); i++) {
        largest = fmax(largest, fabs(m->a[i]));
    }
    return largest;
}

/* LAPACKE's own allocations may fail, and its input may hold what overflowed. */
static enum dalcs_status status_of(lapack_int info) {
    if (info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR) {
        return DALCS_E_NOMEM;
    }
    return info == 0 ? DALCS_OK : DALCS_SINGULAR;
}

static int leading(int n) {
    return n > 0 ? n : 1;
}

enum dalcs_status dalcs_matrix_solve(const struct dalcs_matrix *matrix, struct dalcs_matrix *b,
                                     struct dalcs_arena *arena) {
    if (matrix->rows == 0 || b->columns == 0) {
        return DALCS_OK;
    }
    struct dalcs_matrix lu;
    DALCS_TRY(dalcs_matrix_copy(&lu, arena, matrix));
    lapack_int *pivot = dalcs_arena_alloc(arena, (size_t)matrix->rows, sizeof(*pivot));
    if (pivot == NULL) {
        return DALCS_E_NOMEM;
    }
    return status_of(
        LAPACKE_dgesv(LAPACK_COL_MAJOR, lu.rows, b->columns, lu.a, lu.rows, pivot, b->a, b->rows));
}

enum dalcs_status dalcs_matrix_symmetric_eigen(const struct dalcs_matrix *matrix, double *value,
                                               struct dalcs_matrix *vector,
                                               struct dalcs_arena *arena) {
    struct dalcs_matrix work;
    DALCS_TRY(dalcs_matrix_copy(&work, arena, matrix));
    if (matrix->rows > 0) {
        DALCS_TRY(status_of(LAPACKE_dsyevd(LAPACK_COL_MAJOR, vector == NULL ? 'N' : 'V', 'L',
                                           work.rows, work.a, work.rows, value)));
    }
    if (vector != NULL) {
        *vector = work;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_matrix_is_positive(const struct dalcs_matrix *matrix, double shift,
                                           bool *is, struct dalcs_arena *arena) {
    struct dalcs_matrix work;
    DALCS_TRY(dalcs_matrix_copy(&work, arena, matrix));
    for (int i = 0; i < work.rows; i++) {
        *dalcs_at(&work, i, i) += shift;
    }
    *is = true;
    if (work.rows > 0) {
        enum dalcs_status status =
            status_of(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', work.rows, work.a, work.rows));
        *is = status == DALCS_OK;
        return status == DALCS_E_NOMEM ? status : DALCS_OK;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_matrix_symmetric_part(const struct dalcs_matrix *matrix, double *smallest,
                                              double *largest, struct dalcs_arena *arena) {
    int n = matrix->rows;
    struct dalcs_matrix sum;
    *smallest = *largest = 0.0;
    double *value = dalcs_arena_alloc(arena, (size_t)n + 1, sizeof(*value));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_transpose(&sum, arena, matrix));
    dalcs_matrix_add(&sum, 1.0, matrix);
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&sum, value, NULL, arena));
    if (n > 0) {
        *smallest = value[0];
        *largest = value[n - 1];
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_matrix_eigen(const struct dalcs_matrix *matrix, double *re, double *im,
                                     struct dalcs_matrix *vector, struct dalcs_arena *arena) {
    struct dalcs_matrix work;
    int n = matrix->rows;
    DALCS_TRY(dalcs_matrix_copy(&work, arena, matrix));
    if (vector != NULL) {
        DALCS_TRY(dalcs_matrix_new(vector, arena, n, n));
    }
    if (n == 0) {
        return DALCS_OK;
    }
    return status_of(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', vector == NULL ? 'N' : 'V', n, work.a, n,
                                   re, im, NULL, n, vector == NULL ? NULL : vector->a, n));
}

enum dalcs_status dalcs_matrix_singular_values(const struct dalcs_matrix *matrix, double *value,
                                               struct dalcs_matrix *right,
                                               struct dalcs_arena *arena) {
    struct dalcs_matrix work;
    struct dalcs_matrix left;
    int m = matrix->rows;
    int n = matrix->columns;
    DALCS_TRY(dalcs_matrix_copy(&work, arena, matrix));
    DALCS_TRY(dalcs_matrix_new(&left, arena, right == NULL ? 1 : m, right == NULL ? 1 : m));
    if (right != NULL) {
        DALCS_TRY(dalcs_matrix_new(right, arena, n, n));
        for (int i = 0; i < n; i++) {
            *dalcs_at(right, i, i) = 1.0; /* what is left when m is 0 */
        }
    }
    if (m == 0 || n == 0) {
        return DALCS_OK;
    }
    return status_of(LAPACKE_dgesdd(LAPACK_COL_MAJOR, right == NULL ? 'N' : 'A', m, n, work.a, m,
                                    value, left.a, leading(left.rows),
                                    right == NULL ? NULL : right->a, n));
}

enum dalcs_status dalcs_matrix_rank(const struct dalcs_matrix *matrix, int *rank,
                                    struct dalcs_matrix *null, struct dalcs_arena *arena) {
    int n = matrix->columns;
    int most = matrix->rows < n ? matrix->rows : n;
    struct dalcs_matrix right;
    double *value = dalcs_arena_alloc(arena, (size_t)most + 1, sizeof(*value));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_singular_values(matrix, value, null == NULL ? NULL : &right, arena));
    int r = 0;
    while (r < most && value[r] > rank_tolerance * value[0]) {
        r++;
    }
    *rank = r;
    if (null != NULL) {
        DALCS_TRY(dalcs_matrix_new(null, arena, n, n - r));
        for (int j = r; j < n; j++) {
            for (int i = 0; i < n; i++) {
                *dalcs_at(null, i, j - r) = *dalcs_at(&right, j, i);
            }
        }
    }
    return DALCS_OK;
}
