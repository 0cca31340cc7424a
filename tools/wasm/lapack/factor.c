/* factor.c - triangular factors of dense matrices: LU with partial pivots, Cholesky with and without.
 *
 * G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed., algorithms 3.4.1, 4.2.1 and 4.2.2. */
#include "lapacke.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Where entry (i, j) is. */
static size_t at(int layout, lapack_int ld, lapack_int i, lapack_int j) {
    return layout == LAPACK_ROW_MAJOR ? (size_t)i * (size_t)ld + (size_t)j
                                      : (size_t)j * (size_t)ld + (size_t)i;
}

#define A(i, j) a[at(layout, lda, i, j)]
#define B(i, j) b[at(layout, ldb, i, j)]

lapack_int LAPACKE_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                          lapack_int *pivot) {
    lapack_int info = 0;
    for (lapack_int k = 0; k < m && k < n; k++) {
        lapack_int p = k;
        for (lapack_int i = k + 1; i < m; i++) {
            p = fabs(A(i, k)) > fabs(A(p, k)) ? i : p;
        }
        pivot[k] = p + 1;
        if (A(p, k) == 0.0) {
            info = info == 0 ? k + 1 : info;
            continue;
        }
        for (lapack_int j = 0; p != k && j < n; j++) {
            double swap = A(k, j);
            A(k, j) = A(p, j);
            A(p, j) = swap;
        }
        for (lapack_int i = k + 1; i < m; i++) {
            double factor = A(i, k) /= A(k, k);
            for (lapack_int j = k + 1; factor != 0.0 && j < n; j++) {
                A(i, j) -= factor * A(k, j);
            }
        }
    }
    return info;
}

static void swap_rows(int layout, lapack_int n_right, double *b, lapack_int ldb, lapack_int i,
                      lapack_int p) {
    for (lapack_int c = 0; p != i && c < n_right; c++) {
        double swap = B(i, c);
        B(i, c) = B(p, c);
        B(p, c) = swap;
    }
}

/* trans is 'N' or 'T'. */
lapack_int LAPACKE_dgetrs(int layout, char trans, lapack_int n, lapack_int n_right, const double *a,
                          lapack_int lda, const lapack_int *pivot, double *b, lapack_int ldb) {
    const int is_transposed = trans != 'N';
    for (lapack_int i = 0; !is_transposed && i < n; i++) {
        swap_rows(layout, n_right, b, ldb, i, pivot[i] - 1);
    }
    for (lapack_int c = 0; c < n_right; c++) {
        for (lapack_int i = 0; i < n; i++) {
            for (lapack_int k = 0; k < i; k++) {
                B(i, c) -= (is_transposed ? A(k, i) : A(i, k)) * B(k, c);
            }
            B(i, c) /= is_transposed ? A(i, i) : 1.0;
        }
        for (lapack_int i = n - 1; i >= 0; i--) {
            for (lapack_int k = i + 1; k < n; k++) {
                B(i, c) -= (is_transposed ? A(k, i) : A(i, k)) * B(k, c);
            }
            B(i, c) /= is_transposed ? 1.0 : A(i, i);
        }
    }
    for (lapack_int i = n - 1; is_transposed && i >= 0; i--) {
        swap_rows(layout, n_right, b, ldb, i, pivot[i] - 1);
    }
    return 0;
}

lapack_int LAPACKE_dgesv(int layout, lapack_int n, lapack_int n_right, double *a, lapack_int lda,
                         lapack_int *pivot, double *b, lapack_int ldb) {
    lapack_int info = LAPACKE_dgetrf(layout, n, n, a, lda, pivot);
    return info != 0 ? info : LAPACKE_dgetrs(layout, 'N', n, n_right, a, lda, pivot, b, ldb);
}

/* Of the 1-norm, from the inverse itself instead of an estimate. Pivots move rows of the matrix, and so columns of the
 * inverse: its 1-norm does not need them. */
lapack_int LAPACKE_dgecon(int layout, char norm, lapack_int n, const double *a, lapack_int lda,
                          double anorm, double *rcond) {
    double *column = malloc(((size_t)n + 1) * sizeof(*column));
    double *row = calloc((size_t)n + 1, sizeof(*row)); /* sums of the inverse, for 'I' */
    lapack_int *in_place = malloc(((size_t)n + 1) * sizeof(*in_place));
    const int has_memory = column != NULL && row != NULL && in_place != NULL;
    double largest = 0.0;
    for (lapack_int j = 0; has_memory && j < n; j++) {
        double sum = 0.0;
        for (lapack_int i = 0; i < n; i++) {
            column[i] = i == j ? 1.0 : 0.0;
            in_place[i] = i + 1;
        }
        (void)LAPACKE_dgetrs(layout, 'N', n, 1, a, lda, in_place, column,
                             layout == LAPACK_ROW_MAJOR ? 1 : n);
        for (lapack_int i = 0; i < n; i++) {
            sum += fabs(column[i]);
            row[i] += fabs(column[i]);
        }
        largest = norm == 'I' ? largest : fmax(largest, sum);
    }
    for (lapack_int i = 0; has_memory && norm == 'I' && i < n; i++) {
        largest = fmax(largest, row[i]);
    }
    free(column);
    free(row);
    free(in_place);
    *rcond = n == 0 ? 1.0 : largest > 0.0 && anorm > 0.0 ? 1.0 / (largest * anorm) : 0.0;
    return has_memory ? 0 : LAPACK_WORK_MEMORY_ERROR;
}

lapack_int LAPACKE_zgesv(int layout, lapack_int n, lapack_int n_right, lapack_complex_double *a,
                         lapack_int lda, lapack_int *pivot, lapack_complex_double *b,
                         lapack_int ldb) {
    for (lapack_int k = 0; k < n; k++) {
        lapack_int p = k;
        for (lapack_int i = k + 1; i < n; i++) {
            p = cabs(A(i, k)) > cabs(A(p, k)) ? i : p;
        }
        pivot[k] = p + 1;
        if (cabs(A(p, k)) == 0.0) {
            return k + 1;
        }
        for (lapack_int j = 0; p != k && j < n + n_right; j++) {
            lapack_complex_double *one = j < n ? &A(k, j) : &B(k, j - n);
            lapack_complex_double *other = j < n ? &A(p, j) : &B(p, j - n);
            lapack_complex_double swap = *one;
            *one = *other;
            *other = swap;
        }
        for (lapack_int i = k + 1; i < n; i++) {
            lapack_complex_double factor = A(i, k) /= A(k, k);
            for (lapack_int j = k + 1; j < n; j++) {
                A(i, j) -= factor * A(k, j);
            }
            for (lapack_int c = 0; c < n_right; c++) {
                B(i, c) -= factor * B(k, c);
            }
        }
    }
    for (lapack_int c = 0; c < n_right; c++) {
        for (lapack_int i = n - 1; i >= 0; i--) {
            for (lapack_int k = i + 1; k < n; k++) {
                B(i, c) -= A(i, k) * B(k, c);
            }
            B(i, c) /= A(i, i);
        }
    }
    return 0;
}

/* uplo is 'L'. */
lapack_int LAPACKE_dpotrf(int layout, char uplo, lapack_int n, double *a, lapack_int lda) {
    (void)uplo;
    for (lapack_int j = 0; j < n; j++) {
        for (lapack_int i = j; i < n; i++) {
            for (lapack_int k = 0; k < j; k++) {
                A(i, j) -= A(i, k) * A(j, k);
            }
            if (i == j && !(A(j, j) > 0.0)) {
                return j + 1;
            }
            A(i, j) = i == j ? sqrt(A(j, j)) : A(i, j) / A(j, j);
        }
    }
    return 0;
}

/* Of a symmetric matrix whose both halves are given; uplo is 'U'. */
lapack_int LAPACKE_dpstrf(int layout, char uplo, lapack_int n, double *a, lapack_int lda,
                          lapack_int *pivot, lapack_int *rank, double tol) {
    (void)uplo;
    double stop = tol;
    for (lapack_int i = 0; i < n; i++) {
        pivot[i] = i + 1;
        if (isnan(A(i, i))) {
            return -4;
        }
        stop = tol < 0.0 ? fmax(stop, n * 0.5 * DBL_EPSILON * A(i, i)) : stop;
    }
    for (lapack_int k = 0; k < n; k++) {
        lapack_int p = k;
        for (lapack_int i = k + 1; i < n; i++) {
            p = A(i, i) > A(p, p) ? i : p;
        }
        if (!(A(p, p) > stop)) {
            *rank = k;
            return 1;
        }
        for (lapack_int j = 0; p != k && j < n; j++) { /* rows, */
            double swap = A(k, j);
            A(k, j) = A(p, j);
            A(p, j) = swap;
        }
        for (lapack_int i = 0; p != k && i < n; i++) { /* then columns */
            double swap = A(i, k);
            A(i, k) = A(i, p);
            A(i, p) = swap;
        }
        lapack_int name = pivot[k];
        pivot[k] = pivot[p];
        pivot[p] = name;
        A(k, k) = sqrt(A(k, k));
        for (lapack_int j = k + 1; j < n; j++) {
            A(k, j) /= A(k, k);
        }
        for (lapack_int i = k + 1; i < n; i++) {
            for (lapack_int j = k + 1; j < n; j++) {
                A(i, j) -= A(k, i) * A(k, j);
            }
        }
    }
    *rank = n;
    return 0;
}
