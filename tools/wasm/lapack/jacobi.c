/* jacobi.c - eigenvalues of Hermitian matrices and singular values, by plane rotations.
 *
 * Cyclic Jacobi (G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed., section 8.5) and its one-sided form
 * (M. R. Hestenes, J. SIAM 6, 1958): slower than LAPACK's methods, a tenth of their code, and accurate to small
 * singular values. */
#include "lapacke.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int most_sweeps = 60; /* six to ten do */

/* A column that is shorter than this part of the longest one is what two rotations leave of one that depends on the
 * others: it has no direction of its own. */
static const double negligible = DBL_EPSILON * DBL_EPSILON;

/* tan of the angle that makes [a c; c b] diagonal, the smaller one. */
static double rotation(double a, double b, double c) {
    double tau = (b - a) / (2.0 * c);
    return (tau >= 0.0 ? 1.0 : -1.0) / (fabs(tau) + hypot(1.0, tau));
}

/* ---- Hermitian matrices, by columns ---- */

/* One rotation, unless entry (p, q) is no more than `least`. */
static int turn(lapack_int n, lapack_complex_double *a, lapack_complex_double *v, lapack_int p,
                lapack_int q, double least) {
    const size_t N = (size_t)n;
    lapack_complex_double c = a[(size_t)q * N + (size_t)p];
    double size = cabs(c);
    double app = creal(a[(size_t)p * N + (size_t)p]);
    double aqq = creal(a[(size_t)q * N + (size_t)q]);
    if (!(size > least)) {
        return 0;
    }
    double t = rotation(app, aqq, size);
    double cosine = 1.0 / hypot(1.0, t);
    lapack_complex_double sine = t * cosine * (c / size); /* column q turns by the phase of c */
    for (size_t i = 0; i < N; i++) {                      /* columns of a and of v */
        lapack_complex_double *of[] = {a, v};
        for (int k = 0; k < 2; k++) {
            lapack_complex_double x = of[k][(size_t)p * N + i];
            lapack_complex_double y = of[k][(size_t)q * N + i];
            of[k][(size_t)p * N + i] = cosine * x - conj(sine) * y;
            of[k][(size_t)q * N + i] = sine * x + cosine * y;
        }
    }
    for (size_t j = 0; j < N; j++) { /* rows of a */
        lapack_complex_double x = a[j * N + (size_t)p];
        lapack_complex_double y = a[j * N + (size_t)q];
        a[j * N + (size_t)p] = cosine * x - sine * y;
        a[j * N + (size_t)q] = conj(sine) * x + cosine * y;
    }
    a[(size_t)q * N + (size_t)p] = a[(size_t)p * N + (size_t)q] = 0.0;
    return 1;
}

/* Values in rising order, vectors in the columns of a. Only the lower half of a is read. */
static lapack_int hermitian(lapack_int n, lapack_complex_double *a, double *value) {
    const size_t N = (size_t)n;
    lapack_complex_double *v = calloc(N * N + 1, sizeof(*v));
    if (v == NULL) {
        return LAPACK_WORK_MEMORY_ERROR;
    }
    double size = 0.0;
    for (size_t j = 0; j < N; j++) {
        v[j * N + j] = 1.0;
        a[j * N + j] = creal(a[j * N + j]);
        size = fmax(size, cabs(a[j * N + j]));
        for (size_t i = j + 1; i < N; i++) {
            a[i * N + j] = conj(a[j * N + i]);
            size = fmax(size, cabs(a[i * N + j]));
        }
    }
    int moved = 1;
    for (int sweep = 0; moved && sweep < most_sweeps; sweep++) {
        moved = 0;
        for (lapack_int p = 0; p < n; p++) {
            for (lapack_int q = p + 1; q < n; q++) {
                moved |= turn(n, a, v, p, q, 0.01 * DBL_EPSILON * size);
            }
        }
    }
    for (size_t k = 0; k < N; k++) {
        value[k] = creal(a[k * N + k]);
    }
    for (size_t k = 0; k < N; k++) {
        size_t least = k;
        for (size_t i = k + 1; i < N; i++) {
            least = value[i] < value[least] ? i : least;
        }
        double first = value[k];
        value[k] = value[least];
        value[least] = first;
        for (size_t i = 0; i < N; i++) {
            lapack_complex_double x = v[k * N + i];
            a[k * N + i] = v[least * N + i];
            v[least * N + i] = x;
        }
    }
    free(v);
    return moved ? 1 : 0;
}

/* uplo is 'L', vectors are always found; the rest of a row of lda is not looked at. */
lapack_int LAPACKE_zheev(int layout, char job, char uplo, lapack_int n, lapack_complex_double *a,
                         lapack_int lda, double *value) {
    (void)layout, (void)job, (void)uplo, (void)lda;
    return hermitian(n, a, value);
}

/* uplo is 'L' by columns; by rows both halves are given, and vectors are not asked for. */
lapack_int LAPACKE_dsyev(int layout, char job, char uplo, lapack_int n, double *a, lapack_int lda,
                         double *value) {
    (void)layout, (void)job, (void)uplo;
    const size_t N = (size_t)n;
    lapack_complex_double *b = malloc((N * N + 1) * sizeof(*b));
    if (b == NULL) {
        return LAPACK_WORK_MEMORY_ERROR;
    }
    for (size_t k = 0; k < N * N; k++) {
        b[k] = a[k / N * (size_t)lda + k % N];
    }
    lapack_int info = hermitian(n, b, value);
    for (size_t k = 0; k < N * N; k++) {
        a[k / N * (size_t)lda + k % N] = creal(b[k]);
    }
    free(b);
    return info;
}

lapack_int LAPACKE_dsyevd(int layout, char job, char uplo, lapack_int n, double *a, lapack_int lda,
                          double *value) {
    return LAPACKE_dsyev(layout, job, uplo, n, a, lda, value);
}

/* ---- Singular values ---- */

static double product(const double *x, const double *y, size_t m) {
    double sum = 0.0;
    for (size_t i = 0; i < m; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

static void turn_columns(double *x, double *y, size_t m, double cosine, double sine) {
    for (size_t i = 0; i < m; i++) {
        double a = x[i];
        x[i] = cosine * a - sine * y[i];
        y[i] = sine * a + cosine * y[i];
    }
}

/* Makes the columns of w[n][m] orthogonal; w = U S and v[n][n], its columns, with a v = w. */
static int orthogonalise(size_t m, size_t n, double *w, double *v) {
    double longest = 0.0;
    for (size_t k = 0; k < n; k++) {
        longest = fmax(longest, sqrt(product(w + k * m, w + k * m, m)));
    }
    int moved = 1;
    for (int sweep = 0; moved && sweep < most_sweeps; sweep++) {
        moved = 0;
        for (size_t p = 0; p < n; p++) {
            for (size_t q = p + 1; q < n; q++) {
                double a = product(w + p * m, w + p * m, m);
                double b = product(w + q * m, w + q * m, m);
                double c = product(w + p * m, w + q * m, m);
                if (!(fabs(c) > DBL_EPSILON * (double)m * sqrt(a) * sqrt(b)) ||
                    !(sqrt(fmin(a, b)) > negligible * longest)) {
                    continue;
                }
                double t = rotation(a, b, c);
                double cosine = 1.0 / hypot(1.0, t);
                turn_columns(w + p * m, w + q * m, m, cosine, t * cosine);
                turn_columns(v + p * n, v + q * n, n, cosine, t * cosine);
                moved = 1;
            }
        }
    }
    return !moved;
}

static void exchange(double *x, double *y, size_t n) {
    for (size_t i = 0; i < n; i++) {
        double swap = x[i];
        x[i] = y[i];
        y[i] = swap;
    }
}

/* Lengths of the columns of w into s, in falling order. */
static void sort_columns(size_t m, size_t n, double *w, double *v, double *s) {
    for (size_t k = 0; k < n; k++) {
        s[k] = sqrt(product(w + k * m, w + k * m, m));
    }
    for (size_t k = 0; k < n; k++) {
        size_t most = k;
        for (size_t i = k + 1; i < n; i++) {
            most = s[i] > s[most] ? i : most;
        }
        if (most != k) {
            exchange(w + k * m, w + most * m, m);
            exchange(v + k * n, v + most * n, n);
            exchange(s + k, s + most, 1);
        }
    }
}

/* Columns of w[m][m] from k on: each is the unit vector that is farthest from those before, less its part in them. */
static void complete(size_t m, size_t k, double *w) {
    for (; k < m; k++) {
        size_t best = 0;
        double left = -1.0;
        for (size_t i = 0; i < m; i++) {
            double rest = 1.0;
            for (size_t j = 0; j < k; j++) {
                rest -= w[j * m + i] * w[j * m + i];
            }
            best = rest > left ? i : best;
            left = fmax(rest, left);
        }
        double *x = w + k * m;
        memset(x, 0, m * sizeof(*x));
        x[best] = 1.0;
        for (size_t twice = 0; twice < 2 * k; twice++) {
            const double *y = w + twice % k * m;
            double part = product(x, y, m);
            for (size_t i = 0; i < m; i++) {
                x[i] -= part * y[i];
            }
        }
        double length = sqrt(product(x, x, m));
        for (size_t i = 0; i < m; i++) {
            x[i] /= length;
        }
    }
}

/* Of a[m][n] in any layout: s, U by columns w[m][m], V by columns v[n][n], where m >= n. */
static lapack_int tall(size_t m, size_t n, double *w, double *v, double *s) {
    for (size_t k = 0; k < n * n; k++) {
        v[k] = k / n == k % n ? 1.0 : 0.0;
    }
    if (!orthogonalise(m, n, w, v)) {
        return 1;
    }
    sort_columns(m, n, w, v, s);
    size_t full = 0;
    while (full < n && s[full] > negligible * s[0]) {
        for (size_t i = 0; i < m; i++) {
            w[full * m + i] /= s[full];
        }
        full++;
    }
    complete(m, full, w);
    return 0;
}

/* job_u is 'A', 'O' or 'N', job_vt is 'A' or 'N'. */
lapack_int LAPACKE_dgesvd(int layout, char job_u, char job_vt, lapack_int m, lapack_int n,
                          double *a, lapack_int lda, double *s, double *u, lapack_int ldu,
                          double *vt, lapack_int ldvt, double *superb) {
    (void)superb;
    const int by_rows = layout == LAPACK_ROW_MAJOR;
    const int is_wide = m < n; /* then of the transpose, whose U is V */
    const size_t M = (size_t)(is_wide ? n : m);
    const size_t N = (size_t)(is_wide ? m : n);
    double *w = malloc((M * M + 1) * sizeof(*w));
    double *v = malloc((N * N + 1) * sizeof(*v));
    lapack_int info = LAPACK_WORK_MEMORY_ERROR;
    if (w != NULL && v != NULL) {
        for (size_t j = 0; j < N; j++) {
            for (size_t i = 0; i < M; i++) {
                w[j * M + i] = a[(is_wide != by_rows) ? i * (size_t)lda + j : j * (size_t)lda + i];
            }
        }
        info = tall(M, N, w, v, s);
    }
    double *to_u = info != 0 ? NULL : job_u == 'A' ? u : job_u == 'O' ? a : NULL;
    const double *left = is_wide ? v : w;
    const double *right = is_wide ? w : v;
    const size_t kept = job_u == 'O' && n < m ? (size_t)n : (size_t)m;
    const size_t step = job_u == 'O' ? (size_t)lda : (size_t)ldu;
    for (size_t k = 0; to_u != NULL && k < kept; k++) {
        for (size_t i = 0; i < (size_t)m; i++) {
            to_u[by_rows ? i * step + k : k * step + i] = left[k * (size_t)m + i];
        }
    }
    for (size_t k = 0; info == 0 && job_vt == 'A' && k < (size_t)n; k++) {
        for (size_t i = 0; i < (size_t)n; i++) {
            vt[by_rows ? k * (size_t)ldvt + i : i * (size_t)ldvt + k] = right[k * (size_t)n + i];
        }
    }
    free(w);
    free(v);
    return info;
}

/* job is 'A' or 'N'. */
lapack_int LAPACKE_dgesdd(int layout, char job, lapack_int m, lapack_int n, double *a,
                          lapack_int lda, double *s, double *u, lapack_int ldu, double *vt,
                          lapack_int ldvt) {
    return LAPACKE_dgesvd(layout, job, job, m, n, a, lda, s, u, ldu, vt, ldvt, NULL);
}

/* One right side, m = n, by columns; rcond < 0 stands for the rounding of a double. */
lapack_int LAPACKE_dgelss(int layout, lapack_int m, lapack_int n, lapack_int n_right, double *a,
                          lapack_int lda, double *b, lapack_int ldb, double *s, double rcond,
                          lapack_int *rank) {
    (void)n_right, (void)ldb;
    const size_t N = (size_t)n;
    double *u = malloc((N * N + 1) * sizeof(*u));
    double *vt = malloc((N * N + 1) * sizeof(*vt));
    double *x = calloc(N + 1, sizeof(*x));
    lapack_int info = LAPACK_WORK_MEMORY_ERROR;
    if (u != NULL && vt != NULL && x != NULL) {
        info = LAPACKE_dgesvd(layout, 'A', 'A', m, n, a, lda, s, u, n, vt, n, NULL);
    }
    *rank = 0;
    for (size_t k = 0; info == 0 && k < N && s[k] > (rcond < 0.0 ? DBL_EPSILON : rcond) * s[0];
         k++) {
        double part = product(u + k * N, b, N) / s[k];
        for (size_t i = 0; i < N; i++) {
            x[i] += part * vt[i * N + k];
        }
        ++*rank;
    }
    if (info == 0) {
        memcpy(b, x, N * sizeof(*b));
    }
    free(u);
    free(vt);
    free(x);
    return info;
}
