/* test_dense_solve.c - small systems with known solutions, and rows that do not fill whole quads. */
#include "dense_solve.h"

#include "run_tests.h"

#include <math.h>

enum { MOST = 12 };

START_TEST(test_known) {
    /* zeros where elimination has its pivots; two right-hand sides; behind them what is no part of it */
    double a[3][8] = {
        {0, 2, 1, 7, 1, 9, 9, 9}, {1, 0, 0, 1, 3, 9, 9, 9}, {4, 0, 2, 10, 12, 9, 9, 9}};
    const double x[3][2] = {{1, 3}, {2, 0.5}, {3, 0}};
    ck_assert_int_eq(dalcs_dense_row(3, 2), 8);
    ck_assert(dalcs_dense_solve(3, 2, a[0]) > 0.0);
    for (int i = 0; i < 3; i++) {
        ck_assert_double_eq_tol(a[i][3], x[i][0], 1e-15);
        ck_assert_double_eq_tol(a[i][4], x[i][1], 1e-15);
    }
}

END_TEST

START_TEST(test_pivots) {
    double a[3][4] = {{2, 0, 0, 1}, {0, 0.5, 0, 1}, {0, 0, -4, 1}};
    ck_assert_double_eq(dalcs_dense_solve(3, 1, a[0]), 0.5);
    ck_assert_double_eq(a[2][3], -0.25);
    double singular[2][4] = {{1, 2, 1}, {2, 4, 1}};
    ck_assert_double_eq(dalcs_dense_solve(2, 1, singular[0]), 0.0);
    double not_a_number[1][4] = {{NAN, 1}};
    ck_assert_double_eq(dalcs_dense_solve(1, 1, not_a_number[0]), 0.0);
}

END_TEST

/* A X = B for all sizes and numbers of right-hand sides, with a small element where a pivot would be. */
START_TEST(test_sizes) {
    for (int n = 1; n <= MOST; n++) {
        for (int n_rhs = 1; n_rhs <= 6; n_rhs++) {
            double a[MOST * (MOST + 8)] = {0.0};
            const int row = dalcs_dense_row(n, n_rhs);
            for (int i = 0; i < n; i++) {
                for (int j = 0; j < n; j++) {
                    double element = i == j ? 1e-9 : 1.0 / (1.0 + (double)((i + 2 * j) % 7));
                    a[i * row + j] = element;
                    for (int k = 0; k < n_rhs; k++) {
                        a[i * row + n + k] += element * (double)(j - 2 * k);
                    }
                }
            }
            ck_assert(dalcs_dense_solve(n, n_rhs, a) > 0.0);
            for (int i = 0; i < n; i++) {
                for (int k = 0; k < n_rhs; k++) {
                    ck_assert_double_eq_tol(a[i * row + n + k], (double)(i - 2 * k), 1e-11);
                }
            }
        }
    }
}

END_TEST

RUN_TESTS("dense_solve", test_known, test_pivots, test_sizes)
