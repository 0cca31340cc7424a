/* test_extended.c - small systems with known solutions, real and complex. */
#include "extended.h"

#include "run_tests.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static void check_near(long double a, long double b, long double tolerance) {
    ck_assert_msg(fabsl(a - b) <= tolerance, "%.21Lg is not %.21Lg", a, b);
}

START_TEST(test_real) {
    /* zeros where elimination has its pivots; two right-hand sides */
    long double a[3][5] = {{0, 2, 1, 7, 1}, {1, 0, 0, 1, 3}, {4, 0, 2, 10, 12}};
    const long double x[3][2] = {{1, 3}, {2, 0.5L}, {3, 0}};
    ck_assert(dalcs_extended_solve(3, 2, a[0], NULL) > 0.0L);
    for (int i = 0; i < 3; i++) {
        check_near(a[i][3], x[i][0], 1e-18L);
        check_near(a[i][4], x[i][1], 1e-18L);
    }
}

END_TEST

START_TEST(test_complex) {
    /* (1+i) x + 2 y = 5+i, i x - y = -3: x = 1+i... by hand: y = 3 + i x */
    long double re[2][3] = {{1, 2, 5}, {0, -1, -3}};
    long double im[2][3] = {{1, 0, 1}, {1, 0, 0}};
    ck_assert(dalcs_extended_solve(2, 1, re[0], im[0]) > 0.0L);
    const long double complex x = (-1.0L + 1.0L * I) / (1.0L + 3.0L * I);
    const long double complex y = 3.0L + I * x;
    check_near(re[0][2], creall(x), 1e-18L);
    check_near(im[0][2], cimagl(x), 1e-18L);
    check_near(re[1][2], creall(y), 1e-18L);
    check_near(im[1][2], cimagl(y), 1e-18L);
}

END_TEST

START_TEST(test_pivots) {
    long double a[3][4] = {{2, 0, 0, 1}, {0, 0.5L, 0, 1}, {0, 0, -4, 1}};
    check_near(dalcs_extended_solve(3, 1, a[0], NULL), 0.5L, 0.0L);
    check_near(a[2][3], -0.25L, 0.0L);
    long double singular[2][3] = {{1, 2, 1}, {2, 4, 1}};
    check_near(dalcs_extended_solve(2, 1, singular[0], NULL), 0.0L, 0.0L);
    long double empty[2][3] = {{0, 1, 1}, {0, 2, 1}};
    check_near(dalcs_extended_solve(2, 1, empty[0], NULL), 0.0L, 0.0L);
    long double re[2][3] = {{0, 1, 1}, {1, 0, 1}};
    long double im[2][3] = {{1, 0, 0}, {0, -1, 0}}; /* the second row is -i times the first */
    check_near(dalcs_extended_solve(2, 1, re[0], im[0]), 0.0L, 0.0L);
}

END_TEST

/* A 10 x 10 Hilbert matrix, condition 1e13: a double would leave no digit but three. */
START_TEST(test_precision) {
    enum { N = 10 };

    long double a[N][N + 1];
    for (int i = 0; i < N; i++) {
        a[i][N] = 0.0L;
        for (int j = 0; j < N; j++) {
            a[i][j] = 232792560.0L / (i + j + 1); /* whole numbers */
            a[i][N] += a[i][j] * (j % 2 == 0 ? 1 : -2);
        }
    }
    ck_assert(dalcs_extended_solve(N, 1, a[0], NULL) > 0.0L);
    for (int j = 0; j < N; j++) {
        check_near(a[j][N], j % 2 == 0 ? 1.0L : -2.0L, 1e-5L);
    }
}

END_TEST

/* Sparse random systems: what comes out satisfies what went in. */
START_TEST(test_random) {
    enum { N = 12, RHS = 3 };

    uint64_t state = 7;
    for (int trial = 0; trial < 200; trial++) {
        long double re[N][N + RHS];
        long double im[N][N + RHS];
        long double complex a[N][N + RHS];
        bool is_complex = trial % 2 == 1;
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N + RHS; j++) {
                double part[2];
                for (int k = 0; k < 2; k++) {
                    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
                    part[k] = (double)(int64_t)state / 0x1p63;
                }
                bool filled = i == j || j >= N || (state >> 40) % 3 == 0;
                re[i][j] = filled ? part[0] : 0.0;
                im[i][j] = filled && is_complex ? part[1] : 0.0;
                a[i][j] = re[i][j] + im[i][j] * I;
            }
        }
        long double pivot = dalcs_extended_solve(N, RHS, re[0], is_complex ? im[0] : NULL);
        for (int i = 0; i < N && pivot > 1e-6L; i++) {
            for (int k = 0; k < RHS; k++) {
                long double complex sum = -a[i][N + k];
                long double size = 0.0L;
                for (int j = 0; j < N; j++) {
                    long double complex x = re[j][N + k] + im[j][N + k] * I;
                    sum += a[i][j] * x;
                    size = fmaxl(size, cabsl(x));
                }
                check_near(cabsl(sum), 0.0L, 1e-14L * (1.0L + size));
            }
        }
    }
}

END_TEST

/* Unknowns 1 to 3 of four: the third has too small a pivot left, the others follow from it and the
 * first. */
START_TEST(test_eliminate) {
    long double a[4][5] = {
        {5, 1, 1, 1, 9}, {1, 0, 4, 2, 8}, {3, 2, 0, 0, 6}, {2, 1, 3, 1.501L, 14}};
    const long double before[4][5] = {
        {5, 1, 1, 1, 9}, {1, 0, 4, 2, 8}, {3, 2, 0, 0, 6}, {2, 1, 3, 1.501L, 14}};
    int row_of[4] = {-2, 0, 0, 0};
    dalcs_extended_eliminate(1, 4, 5, 0.01L, a[0], row_of);
    ck_assert_int_eq(row_of[0], -2);
    ck_assert_int_eq(row_of[1], 2);
    ck_assert_int_eq(row_of[2], 1);
    ck_assert_int_eq(row_of[3], -1);
    const long double y[4] = {0.25L, 0.0L, 0.0L, -3.0L}; /* the kept ones, chosen */
    long double all[4] = {y[0], 0.0L, 0.0L, y[3]};
    for (int c = 1; c < 3; c++) {
        const long double *row = a[row_of[c]];
        check_near(row[1], 0.0L, 0.0L);
        check_near(row[2], 0.0L, 0.0L);
        all[c] = row[4] - row[0] * y[0] - row[3] * y[3];
    }
    for (int i = 0; i < 4; i++) { /* every row says of all what it says now of the kept ones */
        long double sum = -before[i][4];
        for (int j = 0; j < 4; j++) {
            sum += before[i][j] * all[j];
        }
        bool is_follower = i == 1 || i == 2;
        long double now = is_follower ? 0.0L : a[i][0] * y[0] + a[i][3] * y[3] - a[i][4];
        check_near(sum, now, 1e-17L);
    }
}

END_TEST

RUN_TESTS("extended", test_real, test_complex, test_pivots, test_precision, test_random,
          test_eliminate)
