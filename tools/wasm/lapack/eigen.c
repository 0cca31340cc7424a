/* eigen.c - eigenvalues of real matrices by the QR algorithm with double shifts, right eigenvectors by inverse
 * iteration.
 *
 * G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed., sections 7.4 to 7.6. Matrices lie by columns here:
 * a[j * n + i] is entry (i, j). */
#include "lapacke.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int most_steps = 60; /* for each eigenvalue; two or three do */

#define H(i, j) h[(size_t)(j) * (size_t)n + (size_t)(i)]

/* scale[i]: powers of 2 that make rows and columns of D^-1 a D alike in length. */
static void balance(lapack_int n, double *h, double *scale) {
    int moved = 1;
    for (lapack_int i = 0; i < n; i++) {
        scale[i] = 1.0;
    }
    for (int round = 0; moved && round < 100; round++) {
        moved = 0;
        for (lapack_int i = 0; i < n; i++) {
            double row = 0.0;
            double column = 0.0;
            for (lapack_int j = 0; j < n; j++) {
                row += j == i ? 0.0 : fabs(H(i, j));
                column += j == i ? 0.0 : fabs(H(j, i));
            }
            if (!(row > 0.0) || !(column > 0.0)) {
                continue;
            }
            double f = exp2(rint(0.5 * log2(row / column)));
            if (!(column * f + row / f < 0.95 * (column + row))) {
                continue;
            }
            moved = 1;
            scale[i] *= f;
            for (lapack_int j = 0; j < n; j++) {
                H(i, j) /= f;
            }
            for (lapack_int j = 0; j < n; j++) {
                H(j, i) *= f;
            }
        }
    }
}

/* The reflection that takes x[0..m) to a multiple of the first unit vector: I - beta v v', v in x. 0: none. */
static double reflection(double *x, int m) {
    double rest = 0.0;
    for (int i = 1; i < m; i++) {
        rest = hypot(rest, x[i]);
    }
    if (rest == 0.0) {
        return 0.0;
    }
    double length = hypot(x[0], rest);
    double first = x[0] + (x[0] >= 0.0 ? length : -length);
    for (int i = 1; i < m; i++) {
        x[i] /= first;
    }
    x[0] = 1.0;
    return 2.0 / (1.0 + (rest / first) * (rest / first));
}

/* Rows k to k + m of columns from..n, then columns k to k + m of rows 0..to. */
static void reflect(lapack_int n, double *h, const double *v, double beta, lapack_int k, int m,
                    lapack_int from, lapack_int to) {
    for (lapack_int j = from; j < n; j++) {
        double sum = 0.0;
        for (int i = 0; i < m; i++) {
            sum += v[i] * H(k + i, j);
        }
        for (int i = 0; i < m; i++) {
            H(k + i, j) -= beta * sum * v[i];
        }
    }
    for (lapack_int i = 0; i < to; i++) {
        double sum = 0.0;
        for (int j = 0; j < m; j++) {
            sum += v[j] * H(i, k + j);
        }
        for (int j = 0; j < m; j++) {
            H(i, k + j) -= beta * sum * v[j];
        }
    }
}

static void make_hessenberg(lapack_int n, double *h, double *v) {
    for (lapack_int k = 0; k + 2 < n; k++) {
        const int m = n - k - 1;
        for (int i = 0; i < m; i++) {
            v[i] = H(k + 1 + i, k);
        }
        double beta = reflection(v, m);
        if (beta != 0.0) {
            reflect(n, h, v, beta, k + 1, m, k, n);
        }
        for (lapack_int i = k + 2; i < n; i++) {
            H(i, k) = 0.0;
        }
    }
}

/* Eigenvalues of rows and columns l and l + 1. */
static void pair_of(lapack_int n, const double *h, lapack_int l, double *re, double *im) {
    double half = 0.5 * (H(l, l) - H(l + 1, l + 1));
    double product = H(l, l + 1) * H(l + 1, l);
    double root = half * half + product;
    if (root < 0.0) {
        re[l] = re[l + 1] = H(l + 1, l + 1) + half;
        im[l] = sqrt(-root);
        im[l + 1] = -im[l];
        return;
    }
    double far = half + (half >= 0.0 ? sqrt(root) : -sqrt(root));
    re[l] = H(l + 1, l + 1) + far;
    re[l + 1] = far == 0.0 ? H(l + 1, l + 1) : H(l + 1, l + 1) - product / far;
    im[l] = im[l + 1] = 0.0;
}

/* A double step of rows and columns from l to the last, u. */
static void double_step(lapack_int n, double *h, lapack_int l, lapack_int u, int is_exceptional) {
    double s = H(u - 1, u - 1) + H(u, u);
    double t = H(u - 1, u - 1) * H(u, u) - H(u - 1, u) * H(u, u - 1);
    if (is_exceptional) { /* against a cycle */
        double size = fabs(H(u, u - 1)) + fabs(H(u - 1, u - 2));
        s = 1.5 * size;
        t = size * size;
    }
    double v[3] = {H(l, l) * H(l, l) + H(l, l + 1) * H(l + 1, l) - s * H(l, l) + t,
                   H(l + 1, l) * (H(l, l) + H(l + 1, l + 1) - s), H(l + 1, l) * H(l + 2, l + 1)};
    for (lapack_int k = l; k < u; k++) {
        const int m = u - k >= 2 ? 3 : 2;
        double size = fmax(fabs(v[0]), fmax(fabs(v[1]), m == 3 ? fabs(v[2]) : 0.0));
        for (int i = 0; i < m && size > 0.0; i++) {
            v[i] /= size;
        }
        double beta = reflection(v, m);
        if (beta != 0.0) {
            reflect(n, h, v, beta, k, m, k > l ? k - 1 : l, k + 4 < u + 1 ? k + 4 : u + 1);
        }
        for (int i = 1; k > l && i < m; i++) {
            H(k + i, k - 1) = 0.0;
        }
        v[0] = H(k + 1, k);
        v[1] = k + 2 <= u ? H(k + 2, k) : 0.0;
        v[2] = k + 3 <= u ? H(k + 3, k) : 0.0;
    }
}

/* Eigenvalues of a Hessenberg matrix, from the last on. */
static int find_values(lapack_int n, double *h, double *re, double *im) {
    double size = 0.0;
    for (lapack_int k = 0; k < n * n; k++) {
        size = fmax(size, fabs(h[k]));
    }
    int steps = 0;
    for (lapack_int u = n - 1; u >= 0;) {
        lapack_int l = u;
        while (l > 0) {
            double around = fabs(H(l, l)) + fabs(H(l - 1, l - 1));
            if (fabs(H(l, l - 1)) <= DBL_EPSILON * (around > 0.0 ? around : size)) {
                H(l, l - 1) = 0.0;
                break;
            }
            l--;
        }
        if (l == u) {
            re[u] = H(u, u);
            im[u] = 0.0;
            u--;
            steps = 0;
        } else if (l == u - 1) {
            pair_of(n, h, l, re, im);
            u -= 2;
            steps = 0;
        } else {
            if (steps++ == most_steps) {
                return 0;
            }
            double_step(n, h, l, u, steps % 10 == 0);
        }
    }
    return 1;
}

/* Turns x so that its length is 1 and its largest entry real. */
static void normalise(lapack_int n, lapack_complex_double *x) {
    lapack_int most = 0;
    double length = 0.0;
    for (lapack_int i = 0; i < n; i++) {
        most = cabs(x[i]) > cabs(x[most]) ? i : most;
        length = hypot(length, cabs(x[i]));
    }
    lapack_complex_double by = conj(x[most]) / cabs(x[most]) / length;
    for (lapack_int i = 0; i < n; i++) {
        x[i] *= by;
    }
    x[most] = creal(x[most]);
}

/* The eigenvector of a for value, in x. Each k starts from other numbers: values that repeat get vectors apart. */
static int find_vector(lapack_int n, const double *a, lapack_complex_double value, int k,
                       lapack_complex_double *x, lapack_complex_double *work, lapack_int *pivot) {
    const size_t N = (size_t)n;
    lapack_complex_double *y = x + N;
    double size = 0.0;
    unsigned state = 12345u + 977u * (unsigned)k;
    for (size_t i = 0; i < N * N; i++) {
        size = fmax(size, fabs(a[i]));
    }
    for (size_t i = 0; i < N; i++) {
        state = state * 1664525u + 1013904223u;
        x[i] = 0.5 + (double)(state >> 8) / 16777216.0;
    }
    /* Next to the value, not on it: the factors must exist. The second time from the first one's answer. */
    int done = 0;
    for (int off = 1; done < 2 && off < 10; off++) {
        lapack_complex_double near = value + off * DBL_EPSILON * (size > 0.0 ? size : 1.0);
        for (size_t i = 0; i < N * N; i++) {
            work[i] = a[i] - (i / N == i % N ? near : 0.0);
        }
        memcpy(y, x, N * sizeof(*y));
        if (LAPACKE_zgesv(LAPACK_COL_MAJOR, n, 1, work, n, pivot, y, n) == 0) {
            memcpy(x, y, N * sizeof(*x));
            normalise(n, x);
            done++;
        }
    }
    return done == 2;
}

static int find_vectors(lapack_int n, const double *a, const double *scale, const double *re,
                        const double *im, double *right, lapack_int ld, lapack_complex_double *work,
                        lapack_int *pivot) {
    lapack_complex_double *x = work + (size_t)n * (size_t)n;
    for (lapack_int k = 0; k < n; k++) {
        if (!find_vector(n, a, re[k] + im[k] * I, k, x, work, pivot)) {
            return 0;
        }
        for (lapack_int i = 0; i < n; i++) {
            x[i] *= scale[i];
        }
        normalise(n, x);
        double *to = right + (size_t)k * (size_t)ld;
        for (lapack_int i = 0; i < n; i++) {
            to[i] = creal(x[i]);
            if (im[k] != 0.0) {
                to[(size_t)ld + (size_t)i] = cimag(x[i]);
            }
        }
        k += im[k] != 0.0 ? 1 : 0;
    }
    return 1;
}

/* By columns, lda = n, and only scaling: job is 'S'. Rows and columns are measured by their sums, those of LAPACK by the
 * roots of the sums of squares: a power of 2 may differ. */
lapack_int LAPACKE_dgebal(int layout, char job, lapack_int n, double *a, lapack_int lda,
                          lapack_int *low, lapack_int *high, double *scale) {
    (void)layout, (void)job, (void)lda;
    balance(n, a, scale);
    *low = 1;
    *high = n;
    return 0;
}

/* By columns, without left vectors; the rest of a column of lda is not looked at. */
lapack_int LAPACKE_dgeev(int layout, char job_left, char job_right, lapack_int n, double *a,
                         lapack_int lda, double *re, double *im, double *left, lapack_int ld_left,
                         double *right, lapack_int ld_right) {
    (void)layout, (void)job_left, (void)lda, (void)left, (void)ld_left;
    const size_t N = (size_t)n;
    double *h = malloc((N * N + 1) * sizeof(*h));
    double *scale = malloc((2 * N + 1) * sizeof(*scale));
    lapack_complex_double *work = malloc((N * N + 2 * N + 1) * sizeof(*work));
    lapack_int *pivot = malloc((N + 1) * sizeof(*pivot));
    lapack_int info = LAPACK_WORK_MEMORY_ERROR;
    if (h != NULL && scale != NULL && work != NULL && pivot != NULL) {
        balance(n, a, scale);
        memcpy(h, a, N * N * sizeof(*h));
        make_hessenberg(n, h, scale + N);
        info = find_values(n, h, re, im) ? 0 : 1;
        if (info == 0 && job_right == 'V' &&
            !find_vectors(n, a, scale, re, im, right, ld_right, work, pivot)) {
            info = 1;
        }
    }
    free(h);
    free(scale);
    free(work);
    free(pivot);
    return info;
}
