/* test_lu.c - solving with the factors, and refusing what is singular. */
#include "lu_patterns.h"

#include "build_network.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

static klu_common klu;

/* A matrix of order n by columns from its dense rows. */
struct columns {
    int p[64], i[1024];
    double x[1024];
};

/* The same as it is factored. */
#define COLUMNS(order, a)                                                                          \
    (&(struct dalcs_columns){.n = (order), .p = (a).p, .i = (a).i, .x = (a).x})

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

static bool by_small; /* without an analysis */

static enum dalcs_status factor(struct dalcs_lu *lu, int n, const double *dense, double rcond_min) {
    struct columns a = compress(n, dense);
    dalcs_lu_common_init(&klu);
    if (by_small) {
        return dalcs_lu_factor_small(lu, COLUMNS(n, a), 1e-6);
    }
    return dalcs_lu_factor(lu, &klu, COLUMNS(n, a), NULL, rcond_min);
}

/* Backward stable: the residual is some roundings of |A| |x|, n of them at most, times the growth of
 * the elements. */
static void check_solution(int n, const double *dense, const double *x, const double *b,
                           double growth) {
    for (int r = 0; r < n; r++) {
        double sum = -b[r];
        double size = fabs(b[r]);
        for (int c = 0; c < n; c++) {
            sum += dense[r * n + c] * x[c];
            size += fabs(dense[r * n + c] * x[c]);
        }
        ck_assert_double_le(fabs(sum), growth * n * DBL_EPSILON * size);
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
    check_solution(n, dense, x, b, 1.0);
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

START_TEST(test_small) {
    by_small = true;
    for (uint64_t seed = 1; seed <= 100; seed++) {
        double dense[DALCS_LU_SMALL * DALCS_LU_SMALL] = {0.0};
        int n = 1 + (int)(seed % DALCS_LU_SMALL);
        uint64_t random = seed;
        for (int r = 0; r < n; r++) { /* with little on the diagonal */
            dense[r * n + (r + 3) % n] = 4.0 + next_random(&random);
            for (int k = 0; k < 3; k++) {
                dense[r * n + (int)(n * fabs(next_random(&random)))] += next_random(&random);
            }
        }
        check_solves(n, dense, seed);
    }
    by_small = false;
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
    by_small = true;
    check_solves(3, dense, 3);
    by_small = false;
}

END_TEST

enum { MATCHED = 24 };

/* Solves with the rows proposed, checks the answer and that each column has a row of its own. A pivot
 * on the diagonal may be klu.tol of its column. */
static void check_matched(const double *dense, int *row_of_column) {
    struct columns a = compress(MATCHED, dense);
    struct dalcs_lu lu;
    dalcs_lu_common_init(&klu);
    ck_assert_int_eq(dalcs_lu_factor(&lu, &klu, COLUMNS(MATCHED, a), row_of_column, 1e-14),
                     DALCS_OK);
    bool is_taken[MATCHED] = {false};
    double b[MATCHED];
    double x[MATCHED];
    for (int c = 0; c < MATCHED; c++) {
        ck_assert_double_ne(dense[row_of_column[c] * MATCHED + c], 0.0);
        ck_assert(!is_taken[row_of_column[c]]);
        is_taken[row_of_column[c]] = true;
        b[c] = 1.0 + c;
        x[c] = b[c];
    }
    dalcs_lu_solve(&lu, x);
    check_solution(MATCHED, dense, x, b, 1.0 / klu.tol);
    dalcs_lu_finish(&lu);
}

/* Rows of a former matrix are proposed: they stay where they still can, and no proposal is wrong. */
START_TEST(test_matched_rows) {
    double dense[MATCHED * MATCHED] = {0.0};
    uint64_t random = 5;
    for (int c = 0; c < MATCHED; c++) {
        for (int k = 0; k < 4; k++) {
            dense[(5 * c + 3 + k * k) % MATCHED * MATCHED + c] =

                1.0 + 0.1 * next_random(&random) + 3 * (k == 3);
        }
    }
    int free[MATCHED];
    int row_of_column[MATCHED];
    for (int c = 0; c < MATCHED; c++) {
        free[c] = -1;
        row_of_column[c] = (5 * c + 3 + 9) % MATCHED; /* all last in their columns or before it */
    }
    check_matched(dense, free);
    int wanted[MATCHED];
    memcpy(wanted, row_of_column, sizeof(wanted));
    check_matched(dense, row_of_column);
    ck_assert_mem_eq(row_of_column, wanted, sizeof(wanted));
    ck_assert_mem_ne(free, wanted, sizeof(wanted));
    /* One of them is no longer there. */
    dense[wanted[7] * MATCHED + 7] = 0.0;
    check_matched(dense, row_of_column);
    int n_kept = 0;
    for (int c = 0; c < MATCHED; c++) {
        n_kept += row_of_column[c] == wanted[c] ? 1 : 0;
        wanted[c] = 0;
    }
    ck_assert_int_ge(n_kept, MATCHED / 2);
    check_matched(dense, wanted); /* the same row for all */
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

/* Without an analysis whatever may be singular is refused. */
START_TEST(test_small_singular) {
    const double some[][4] = {{1.0, 2.0, 0.0, 0.0},
                              {1.0, 2.0, 2.0, 4.0},
                              {1.0, 1.0, 1.0, 1.0 + 0x1p-50},
                              {1.0, 0.0, 0.0, 1e-15},
                              {1.0, 0.0, 0.0, NAN}};
    by_small = true;
    for (size_t k = 0; k < sizeof(some) / sizeof(some[0]); k++) {
        struct dalcs_lu lu;
        ck_assert_int_eq(factor(&lu, 2, some[k], 1e-14), DALCS_SINGULAR);
        ck_assert_ptr_null(lu.work);
    }
    by_small = false;
}

END_TEST

START_TEST(test_nothing) {
    struct dalcs_lu lu;
    ck_assert_int_eq(factor(&lu, 0, NULL, 1e-14), DALCS_OK);
    dalcs_lu_solve(&lu, NULL);
    ck_assert_uint_eq(dalcs_lu_bytes(&lu), 0);
    dalcs_lu_finish(&lu);
    ck_assert_int_eq(dalcs_lu_factor_small(&lu, &(struct dalcs_columns){0}, 1e-6), DALCS_OK);
    dalcs_lu_solve_ordered(&lu);
    dalcs_lu_finish(&lu);
}

END_TEST

enum { N_PATTERNS = 12, OF_ORDER = 20 };

/* A matrix whose pattern goes with `which`, and whose values with `values`, too. Where it is odd, columns have four entries,
 * and are told apart by their rows alone. */
static struct columns pattern(int which, int values) {
    double dense[OF_ORDER * OF_ORDER] = {0.0};
    for (int r = 0; r < OF_ORDER; r++) {
        dense[r * OF_ORDER + r] = 3.0 + r + values;
        for (int k = 1; k <= 3; k++) {
            int c = (which % 2 == 0 ? r * (which + 2) + k * k : r + k * which) % OF_ORDER;
            dense[r * OF_ORDER + c] += 1.0 / (k + values);
        }
    }
    return compress(OF_ORDER, dense);
}

/* By an analysis that was kept the solution is to the bit what it is without. */
static void check_patterns(struct dalcs_lu_patterns *patterns) {
    dalcs_lu_common_init(&klu);
    for (int k = 0; k < 200; k++) {
        int which = k % 3 == 0 ? k / 3 % N_PATTERNS : k % 5;
        double x[OF_ORDER];
        double wanted[OF_ORDER];
        struct dalcs_lu lu;
        dalcs_lu_keep_diagonal(&klu, k % 7 == 0);
        for (int again = 0; again < 2; again++) {
            struct columns a = pattern(which, k);
            double *b = again == 1 ? x : wanted;
            for (int i = 0; i < OF_ORDER; i++) {
                b[i] = i - 7.0;
            }
            enum dalcs_status status =
                again == 1 ? dalcs_lu_factor_again(&lu, patterns, &klu, COLUMNS(OF_ORDER, a), 1e-14)
                           : dalcs_lu_factor(&lu, &klu, COLUMNS(OF_ORDER, a), NULL, 1e-14);
            ck_assert_int_eq(status, DALCS_OK);
            dalcs_lu_solve(&lu, b);
            dalcs_lu_finish(&lu);
        }
        ck_assert(memcmp(x, wanted, sizeof(x)) == 0);
    }
}

/* Of a run a few of all of them are kept; of variants all, and another run of the same finds each. */
START_TEST(test_patterns) {
    struct dalcs_lu_patterns of_run = {0};
    struct dalcs_lu_patterns of_variants = {.most = DALCS_LU_PATTERNS_OF_RUNS};
    check_patterns(&of_run);
    ck_assert_int_eq(of_run.n, DALCS_LU_PATTERNS);
    check_patterns(&of_variants);
    const int n = of_variants.n;
    ck_assert_int_ge(n, N_PATTERNS);
    check_patterns(&of_variants);
    ck_assert_int_eq(of_variants.n, n);
    dalcs_lu_patterns_finish(&of_run, &klu);
    dalcs_lu_patterns_finish(&of_variants, &klu);
    ck_assert_int_eq(of_run.n + of_variants.n, 0);
}

END_TEST

START_TEST(test_singular_patterns) {
    const double empty_column[4] = {1, 0, 1, 0};
    const double same_rows[4] = {1, 2, 2, 4};
    struct dalcs_lu_patterns patterns = {0};
    struct dalcs_lu lu;
    dalcs_lu_common_init(&klu);
    struct columns a = compress(2, empty_column);
    ck_assert_int_eq(dalcs_lu_factor_again(&lu, &patterns, &klu, COLUMNS(2, a), 0.0),
                     DALCS_SINGULAR);
    ck_assert_int_eq(patterns.n, 0); /* whatever the values */
    a = compress(2, same_rows);
    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(dalcs_lu_factor_again(&lu, &patterns, &klu, COLUMNS(2, a), 1e-14),
                         DALCS_SINGULAR);
        ck_assert_int_eq(patterns.n, 1);
    }
    ck_assert_int_eq(dalcs_lu_factor_again(&lu, &patterns, &klu, &(struct dalcs_columns){0}, 0.0),
                     DALCS_OK);
    dalcs_lu_finish(&lu);
    dalcs_lu_patterns_finish(&patterns, &klu);
}

END_TEST

RUN_TESTS("lu", test_random, test_small, test_blocks, test_zero_diagonal, test_matched_rows,
          test_singular, test_small_singular, test_nothing, test_patterns, test_singular_patterns)
