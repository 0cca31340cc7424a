/* test_lu.c - solving with the factors, and refusing what is singular. */
#include "lu.h"

#include "build_network.h"

#include <float.h>
#include <stdlib.h>

static klu_common klu;

/* A matrix of order n by columns from its dense rows. */
struct columns {
    int p[64], i[1024];
    double x[1024];
};

static struct columns compress(int n, const double *dense) {
    struct columns a = {.p = {0}};
    int out = 0;
    for (int c = 0; c < n; c++) {
        for (int r = 0; r < n; r++) {
            if (dense[r * n + c] != 0.0) {
                a.i[out] = r;
                a.x[out++] = dense[r * n + c];
            }
        }
        a.p[c + 1] = out;
    }
    return a;
}

static enum dalcs_status factor(struct dalcs_lu *lu, int n, const double *dense, double rcond_min) {
    struct columns a = compress(n, dense);
    dalcs_lu_common_init(&klu);
    return dalcs_lu_factor(lu, &klu, n, a.p, a.i, a.x, rcond_min);
}

/* Backward stable: the residual is some roundings of |A| |x|, n of them at most. */
static void check_solution(int n, const double *dense, const double *x, const double *b) {
    for (int r = 0; r < n; r++) {
        double sum = -b[r];
        double size = fabs(b[r]);
        for (int c = 0; c < n; c++) {
            sum += dense[r * n + c] * x[c];
            size += fabs(dense[r * n + c] * x[c]);
        }
        ck_assert_double_le(fabs(sum), n * DBL_EPSILON * size);
    }
}

static void check_solves(int n, const double *dense, uint64_t random) {
    struct dalcs_lu lu;
    ck_assert_int_eq(factor(&lu, n, dense, 1e-14), DALCS_OK);
    ck_assert_uint_gt(dalcs_lu_bytes(&lu), (size_t)n * sizeof(double));
    double b[32];
    double x[32];
    double ordered[32];
    for (int r = 0; r < n; r++) {
        b[r] = next_random(&random);
        x[r] = b[r];
    }
    dalcs_lu_solve(&lu, x);
    check_solution(n, dense, x, b);
    for (int k = 0; k < n; k++) {
        lu.work[k] = b[lu.from[k]];
    }
    dalcs_lu_solve_ordered(&lu);
    for (int k = 0; k < n; k++) {
        ordered[lu.to[k]] = lu.work[k];
    }
    for (int k = 0; k < n; k++) {
        ck_assert_double_eq(ordered[k], x[k]);
    }
    dalcs_lu_finish(&lu);
    ck_assert_ptr_null(lu.work);
}

START_TEST(test_random) {
    enum { N = 30 };

    for (uint64_t seed = 1; seed <= 50; seed++) {
        double dense[N * N] = {0.0};
        uint64_t random = seed;
        for (int r = 0; r < N; r++) {
            dense[r * N + r] = 4.0 + next_random(&random);
            for (int k = 0; k < 3; k++) {
                dense[r * N + (int)(N * fabs(next_random(&random)))] += next_random(&random);
            }
        }
        check_solves(N, dense, seed);
    }
}

END_TEST

/* Several diagonal blocks that depend on each other, hidden by permutations. */
START_TEST(test_blocks) {
    enum { N = 24 };

    double dense[N * N] = {0.0};
    uint64_t random = 7;
    for (int r = 0; r < N; r++) {
        for (int c = 0; c < N; c++) {
            bool within = r / 4 == c / 4;
            bool later = c / 4 > r / 4 && (r + c) % 5 == 0;
            int row = (5 * r + 3) % N;
            int column = (7 * c + 1) % N;
            dense[row * N + column] = within || later ? next_random(&random) : 0.0;
        }
    }
    struct dalcs_lu lu;
    ck_assert_int_eq(factor(&lu, N, dense, 1e-14), DALCS_OK);
    ck_assert_int_gt(lu.n_blocks, 1);
    dalcs_lu_finish(&lu);
    check_solves(N, dense, 11);
}

END_TEST

/* As in a circuit of sources: no entry on the diagonal. */
START_TEST(test_zero_diagonal) {
    const double dense[] = {0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 1.0, 4.0, 0.0};
    check_solves(3, dense, 3);
}

END_TEST

START_TEST(test_singular) {
    struct dalcs_lu lu;
    const double empty_row[] = {1.0, 2.0, 0.0, 0.0};
    ck_assert_int_eq(factor(&lu, 2, empty_row, 1e-14), DALCS_SINGULAR);
    ck_assert_ptr_null(lu.work);
    const double equal_rows[] = {1.0, 2.0, 2.0, 4.0};
    ck_assert_int_eq(factor(&lu, 2, equal_rows, 1e-14), DALCS_SINGULAR);
    ck_assert_ptr_null(lu.work);
    /* No pivot vanishes, but one is a rounding of its column. */
    const double nearly[] = {1.0, 1.0, 1.0, 1.0 + 0x1p-50};
    ck_assert_int_eq(factor(&lu, 2, nearly, 1e-14), DALCS_SINGULAR);
    ck_assert_ptr_null(lu.work);
    ck_assert_int_eq(factor(&lu, 2, nearly, 0.0), DALCS_OK);
    dalcs_lu_finish(&lu);
    /* Columns that have little to do with each other may be far apart. */
    const double apart[] = {1.0, 0.0, 0.0, 1e-15};
    ck_assert_int_eq(factor(&lu, 2, apart, 1e-14), DALCS_OK);
    dalcs_lu_finish(&lu);
}

END_TEST

START_TEST(test_nothing) {
    struct dalcs_lu lu;
    ck_assert_int_eq(factor(&lu, 0, NULL, 1e-14), DALCS_OK);
    dalcs_lu_solve(&lu, NULL);
    ck_assert_uint_eq(dalcs_lu_bytes(&lu), 0);
    dalcs_lu_finish(&lu);
}

END_TEST

RUN_TESTS("lu", test_random, test_blocks, test_zero_diagonal, test_singular, test_nothing)
