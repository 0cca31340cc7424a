/* The LAPACK of the pages of lessons against LAPACK itself, on random matrices, some of them singular.
 *
 * Its functions are compiled a second time as own_dgesv() and so on: see meson.build. */
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 12

lapack_int own_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                      lapack_int *pivot);
lapack_int own_dgetrs(int layout, char trans, lapack_int n, lapack_int n_right, const double *a,
                      lapack_int lda, const lapack_int *pivot, double *b, lapack_int ldb);
lapack_int own_dgecon(int layout, char norm, lapack_int n, const double *a, lapack_int lda,
                      double anorm, double *rcond);
lapack_int own_zgesv(int layout, lapack_int n, lapack_int n_right, lapack_complex_double *a,
                     lapack_int lda, lapack_int *pivot, lapack_complex_double *b, lapack_int ldb);
lapack_int own_dpotrf(int layout, char uplo, lapack_int n, double *a, lapack_int lda);
lapack_int own_dpstrf(int layout, char uplo, lapack_int n, double *a, lapack_int lda,
                      lapack_int *pivot, lapack_int *rank, double tol);
lapack_int own_zheev(int layout, char job, char uplo, lapack_int n, lapack_complex_double *a,
                     lapack_int lda, double *value);
lapack_int own_dsyevd(int layout, char job, char uplo, lapack_int n, double *a, lapack_int lda,
                      double *value);
lapack_int own_dgesvd(int layout, char job_u, char job_vt, lapack_int m, lapack_int n, double *a,
                      lapack_int lda, double *s, double *u, lapack_int ldu, double *vt,
                      lapack_int ldvt, double *superb);
lapack_int own_dgelss(int layout, lapack_int m, lapack_int n, lapack_int n_right, double *a,
                      lapack_int lda, double *b, lapack_int ldb, double *s, double rcond,
                      lapack_int *rank);
lapack_int own_dgebal(int layout, char job, lapack_int n, double *a, lapack_int lda,
                      lapack_int *low, lapack_int *high, double *scale);
lapack_int own_dgeev(int layout, char job_left, char job_right, lapack_int n, double *a,
                     lapack_int lda, double *re, double *im, double *left, lapack_int ld_left,
                     double *right, lapack_int ld_right);

static unsigned state = 1;
static int n_wrong, n_looked_at;

static double draw(void) {
    state = state * 1664525u + 1013904223u;
    return (double)(state >> 8) / 8388608.0 - 1.0;
}

static void look(double off, double most, const char *what, int n) {
    n_looked_at++;
    if (!(off <= most)) {
        printf("FAIL %s of %d: off by %.3g, more than %.3g\n", what, n, off, most);
        n_wrong++;
    }
}

/* By columns m x n; of rank at most r. */
static void fill(double *a, int m, int n, int r) {
    memset(a, 0, (size_t)(m * n) * sizeof(*a));
    for (int k = 0; k < r; k++) {
        double x[MOST], y[MOST];
        for (int i = 0; i < MOST; i++) {
            x[i] = draw();
            y[i] = draw();
        }
        for (int i = 0; i < m * n; i++) {
            a[i] += x[i % m] * y[i / m];
        }
    }
}

static double entry(const double *a, int layout, int ld, int i, int j) {
    return layout == LAPACK_ROW_MAJOR ? a[i * ld + j] : a[j * ld + i];
}

static void solves(int n, int layout) {
    double a[MOST * MOST], b[MOST * 2], lu[MOST * MOST], x[MOST * 2], off = 0.0, anorm = 0.0,
                                                                      wanted, found;
    lapack_int pivot[MOST];
    const int ldb = layout == LAPACK_ROW_MAJOR ? 2 : n;
    fill(a, n, n, n);
    fill(b, n, 2, 2);
    for (int t = 0; t < 2; t++) {
        memcpy(lu, a, sizeof(a));
        memcpy(x, b, sizeof(b));
        look(own_dgetrf(layout, n, n, lu, n, pivot), 0.0, "dgetrf", n);
        own_dgetrs(layout, t ? 'T' : 'N', n, 2, lu, n, pivot, x, ldb);
        for (int i = 0; i < n; i++) {
            for (int c = 0; c < 2; c++) {
                double rest = entry(b, layout, ldb, i, c);
                for (int k = 0; k < n; k++) {
                    rest -= (t ? entry(a, layout, n, k, i) : entry(a, layout, n, i, k)) *
                            entry(x, layout, ldb, k, c);
                }
                off = fmax(off, fabs(rest));
            }
        }
    }
    look(off, 1e-9, "dgetrs", n);
    for (int j = 0; j < n; j++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++) {
            sum += fabs(entry(a, layout, n, i, j));
        }
        anorm = fmax(anorm, sum);
    }
    LAPACKE_dgetrf(layout, n, n, a, n, pivot);
    for (int k = 0; k < 2; k++) {
        own_dgecon(layout, "1I"[k], n, lu, n, anorm, &found);
        LAPACKE_dgecon(layout, "1I"[k], n, a, n, anorm, &wanted);
        /* LAPACK's is an estimate, never too small by more than rounding */
        look(found > wanted * (1 + 1e-8) || found < 0.1 * wanted, 0.0, "dgecon", n);
    }
}

static void solves_complex(int n) {
    double re[MOST * MOST], im[MOST * MOST];
    lapack_complex_double a[MOST * MOST], lu[MOST * MOST], b[MOST], x[MOST];
    lapack_int pivot[MOST];
    double off = 0.0;
    fill(re, n, n, n);
    fill(im, n, n, n);
    for (int k = 0; k < n * n; k++) {
        lu[k] = a[k] = re[k] + im[k] * I;
    }
    for (int k = 0; k < n; k++) {
        x[k] = b[k] = draw() + draw() * I;
    }
    look(own_zgesv(LAPACK_COL_MAJOR, n, 1, lu, n, pivot, x, n), 0.0, "zgesv", n);
    for (int i = 0; i < n; i++) {
        lapack_complex_double rest = b[i];
        for (int j = 0; j < n; j++) {
            rest -= a[j * n + i] * x[j];
        }
        off = fmax(off, cabs(rest));
    }
    look(off, 1e-9, "zgesv", n);
}

static void symmetric(int n, int r) {
    double f[MOST * MOST], a[MOST * MOST], b[MOST * MOST], wanted[MOST], found[MOST], off = 0.0;
    lapack_complex_double c[MOST * MOST], d[MOST * MOST];
    fill(f, n, n, r);
    for (int k = 0; k < n * n; k++) {
        a[k] = b[k] = f[k] + f[k % n * n + k / n];
        c[k] = d[k] = a[k] + (f[k] - f[k % n * n + k / n]) * I;
    }
    LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n, a, n, wanted);
    look(own_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n, b, n, found), 0.0, "dsyevd", n);
    for (int k = 0; k < n; k++) {
        off = fmax(off, fabs(found[k] - wanted[k]));
        for (int i = 0; i < n; i++) {
            double rest = -found[k] * b[k * n + i];
            for (int j = 0; j < n; j++) {
                rest += (f[j * n + i] + f[i * n + j]) * b[k * n + j];
            }
            off = fmax(off, fabs(rest));
        }
    }
    look(off, 1e-13 * n, "dsyevd", n);
    memcpy(c, d, sizeof(c));
    LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', n, c, n, wanted);
    memcpy(c, d, sizeof(c));
    look(own_zheev(LAPACK_COL_MAJOR, 'V', 'L', n, c, n, found), 0.0, "zheev", n);
    off = 0.0;
    for (int k = 0; k < n; k++) {
        off = fmax(off, fabs(found[k] - wanted[k]));
        for (int i = 0; i < n; i++) {
            lapack_complex_double rest = -found[k] * c[k * n + i];
            for (int j = 0; j < n; j++) { /* the lower half counts */
                rest += (i >= j ? d[j * n + i] : conj(d[i * n + j])) * c[k * n + j];
            }
            off = fmax(off, cabs(rest));
        }
    }
    look(off, 1e-13 * n, "zheev", n);
}

static void positive(int n, int r) {
    double f[MOST * MOST], g[MOST * MOST], a[MOST * MOST], b[MOST * MOST], off = 0.0;
    lapack_int pa[MOST], pb[MOST], ra, rb;
    fill(f, n, n, r);
    for (int k = 0; k < n * n; k++) {
        g[k] = 0.0;
        for (int i = 0; i < n; i++) {
            g[k] += f[k % n * n + i] * f[k / n * n + i];
        }
        a[k] = b[k] = g[k];
    }
    look(fabs((double)((LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, a, n) == 0) -
                       (own_dpotrf(LAPACK_COL_MAJOR, 'L', n, b, n) == 0))),
         r < n, "dpotrf", n); /* a singular one may pass or not, by rounding */
    memcpy(a, g, sizeof(a));
    memcpy(b, g, sizeof(b));
    LAPACKE_dpstrf(LAPACK_ROW_MAJOR, 'U', n, a, n, pa, &ra, 1e-10);
    own_dpstrf(LAPACK_ROW_MAJOR, 'U', n, b, n, pb, &rb, 1e-10);
    look(abs(ra - rb), 0.0, "rank of dpstrf", n);
    for (int i = 0; i < ra && i < rb; i++) {
        off = fmax(off, abs(pa[i] - pb[i]));
        for (int j = i; j < ra; j++) {
            off = fmax(off, fabs(a[i * n + j] - b[i * n + j]));
        }
    }
    look(off, 1e-9, "dpstrf", n);
}

static void singular(int m, int n, int r, int layout, int spread) {
    double a[MOST * MOST], b[MOST * MOST], s[MOST], t[MOST], u[MOST * MOST], vt[MOST * MOST],
        work[MOST];
    const int ld = layout == LAPACK_ROW_MAJOR ? n : m;
    const int k_most = m < n ? m : n;
    double off = 0.0;
    fill(a, m, n, r);
    for (int k = 0; spread > 0 && k < m * n;
         k++) { /* columns of volts and amperes; entries up to 1 */
        a[k] *= pow(10.0, -spread * (k / m % 4));
    }
    for (int k = 0; spread < 0 && k < m * n;
         k++) { /* as circuits have them: few entries, alike, many ranks lost */
        a[k] = draw() < 0.4 ? 0.0 : draw() < -0.3 ? 2000.0 : a[k] > 0.0 ? 1.0 : -1.0;
    }
    memcpy(b, a, sizeof(a));
    look(own_dgesvd(layout, 'A', 'A', m, n, b, ld, s, u, m, vt, n, work), 0.0, "dgesvd", m);
    for (int i = 0; i < m; i++) {
        for (int j = 0; j < n; j++) {
            double rest = entry(a, layout, ld, i, j);
            for (int k = 0; k < k_most; k++) {
                rest -= entry(u, layout, m, i, k) * s[k] * entry(vt, layout, n, k, j);
            }
            off = fmax(off, fabs(rest) / fmax(1.0, s[0]));
        }
    }
    for (int i = 0; i < m; i++) {
        for (int j = 0; j < m; j++) {
            double rest = i == j ? -1.0 : 0.0;
            for (int k = 0; k < m; k++) {
                rest += entry(u, layout, m, k, i) * entry(u, layout, m, k, j);
            }
            off = fmax(off, fabs(rest));
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            double rest = i == j ? -1.0 : 0.0;
            for (int k = 0; k < n; k++) {
                rest += entry(vt, layout, n, i, k) * entry(vt, layout, n, j, k);
            }
            off = fmax(off, fabs(rest));
        }
    }
    memcpy(b, a, sizeof(a));
    LAPACKE_dgesvd(layout, 'N', 'N', m, n, b, ld, t, u, m, vt, n, work);
    for (int k = 0; k < k_most; k++) {
        off = fmax(off, fabs(s[k] - t[k]) / fmax(1.0, s[0]));
    }
    look(off, 2e-13, "dgesvd", m);
    if (m >= n && layout == LAPACK_COL_MAJOR) {
        memcpy(b, a, sizeof(a));
        own_dgesvd(layout, 'O', 'A', m, n, b, ld, s, NULL, 1, vt, n, work);
        off = 0.0;
        for (int i = 0; i < m * n; i++) {
            double rest = a[i];
            for (int k = 0; k < n; k++) {
                rest -= b[k * m + i % m] * s[k] * vt[i / m * n + k];
            }
            off = fmax(off, fabs(rest) / fmax(1.0, s[0]));
        }
        look(off, 2e-13, "dgesvd in place", m);
    }
}

static void least_squares(int n, int r) {
    double a[MOST * MOST], b[MOST * MOST], x[MOST], y[MOST], s[MOST], off = 0.0;
    lapack_int rank, wanted;
    fill(a, n, n, r);
    memcpy(b, a, sizeof(a));
    for (int i = 0; i < n; i++) {
        x[i] = y[i] = draw();
    }
    LAPACKE_dgelss(LAPACK_COL_MAJOR, n, n, 1, a, n, x, n, s, 1e-10, &wanted);
    own_dgelss(LAPACK_COL_MAJOR, n, n, 1, b, n, y, n, s, 1e-10, &rank);
    for (int i = 0; i < n; i++) {
        off = fmax(off, fabs(x[i] - y[i]) / fmax(1.0, fabs(x[i])));
    }
    look(abs(rank - wanted), 0.0, "rank of dgelss", n);
    look(off, 1e-8, "dgelss", n);
}

static double length_of(const double *a, int n) {
    double length = 0.0;
    for (int k = 0; k < n * n; k++) {
        length = hypot(length, a[k]);
    }
    return length;
}

/* States whose units are up to 3 (n - 1) decades apart. Scaling is by powers of 2, so it does not round. */
static void balances(int n) {
    double a[MOST * MOST], b[MOST * MOST], wanted[MOST * MOST], scale[MOST], ratio = 1.0, off = 0.0;
    lapack_int low, high;
    fill(a, n, n, n);
    for (int k = 0; k < n * n; k++) {
        a[k] *= pow(1e3, k % n - k / n);
    }
    memcpy(b, a, sizeof(a));
    memcpy(wanted, a, sizeof(a));
    look(own_dgebal(LAPACK_COL_MAJOR, 'S', n, b, n, &low, &high, scale), 0.0, "dgebal", n);
    look(abs(low - 1) + abs(high - n), 0.0, "the range of dgebal", n);
    for (int i = 0; i < n; i++) {
        double row = 0.0, column = 0.0;
        for (int j = 0; j < n; j++) {
            off = fmax(off, fabs(b[j * n + i] - a[j * n + i] / scale[i] * scale[j]));
            row += i == j ? 0.0 : fabs(b[j * n + i]);
            column += i == j ? 0.0 : fabs(b[i * n + j]);
        }
        ratio = n > 1 ? fmax(ratio, fmax(row / column, column / row)) : 1.0;
    }
    look(off, 0.0, "D^-1 A D of dgebal", n);
    /* 2 + r / 2 < 0.95 (1 + r): another step by 2 pays from r = 21/9 on */
    look(ratio, 2.34, "rows over columns of dgebal", n);
    LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, wanted, n, &low, &high, scale);
    look(length_of(b, n), 2.0 * length_of(wanted, n), "length of dgebal", n);
}

/* scale: how far apart the units of states are */
static void eigen(int n, int kind) {
    double a[MOST * MOST], b[MOST * MOST], re[MOST], im[MOST], wr[MOST], wi[MOST],
        right[MOST * MOST], off = 0.0;
    fill(a, n, n, n);
    for (int k = 0; k < n * n; k++) {
        a[k] *= kind == 1 ? pow(1e3, k % n - k / n) : 1.0;
        a[k] -= kind == 2 ? a[k] - (k / n == k % n ? 2.0 : 0.0) : 0.0; /* twice the unit matrix */
    }
    memcpy(b, a, sizeof(a));
    look(own_dgeev(LAPACK_COL_MAJOR, 'N', 'V', n, b, n, re, im, NULL, 1, right, n), 0.0, "dgeev",
         n);
    for (int k = 0; k < n; k++) {
        const double *x = right + k * n;
        const double *y = im[k] != 0.0 ? x + n : NULL;
        double size = 0.0, rest = 0.0;
        for (int i = 0; i < n; i++) {
            double u = -re[k] * x[i] + (y == NULL ? 0.0 : im[k] * y[i]);
            double v = y == NULL ? 0.0 : -re[k] * y[i] - im[k] * x[i];
            double row = 0.0;
            for (int j = 0; j < n; j++) {
                u += a[j * n + i] * x[j];
                v += y == NULL ? 0.0 : a[j * n + i] * y[j];
                row += fabs(a[j * n + i] * x[j]) + (y == NULL ? 0.0 : fabs(a[j * n + i] * y[j]));
            }
            rest = fmax(rest, hypot(u, v) / fmax(row, DBL_MIN));
            size = hypot(size, hypot(x[i], y == NULL ? 0.0 : y[i]));
        }
        off = fmax(off, fmax(kind == 1 ? 0.0 : rest, fabs(size - 1.0)));
        k += y != NULL;
    }
    look(off, 1e-10, "vectors of dgeev", n);
    memcpy(b, a, sizeof(a));
    LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, b, n, wr, wi, NULL, 1, NULL, 1);
    off = 0.0;
    for (int k = 0; k < n; k++) {
        double nearest = INFINITY;
        for (int i = 0; i < n; i++) {
            nearest = fmin(nearest, hypot(re[k] - wr[i], im[k] - wi[i]));
        }
        off = fmax(off, nearest);
    }
    look(off, 1e-9, "dgeev", n);
}

int main(void) {
    for (int round = 0; round < 200; round++) {
        const int n = 1 + round % MOST;
        const int r = round % 3 == 0 ? (n + 1) / 2 : n;
        const int m = 1 + (round * 7) % MOST;
        const int layout = round % 2 == 0 ? LAPACK_ROW_MAJOR : LAPACK_COL_MAJOR;
        solves(n, layout);
        solves_complex(n);
        symmetric(n, r);
        positive(n, r);
        singular(m, n, r, layout, 0);
        singular(m, n, r, layout, 1 + round % 5);
        singular(m, n, r, layout, -1);
        least_squares(n, r);
        eigen(n, round % 4);
        balances(n);
    }
    printf("lapack: %d comparisons, %d wrong\n", n_looked_at, n_wrong);
    return n_wrong == 0 && n_looked_at > 2000 ? 0 : 1;
}
