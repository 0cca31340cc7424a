/* test_extended_rows.c - sums of products with twice a double's digits, and systems of them four at a time,
 * against whole numbers and against the same in long double. */
#include "extended_rows.h"

#include "extended.h"
#include "extended_four.h"

#include "run_tests.h"
#include "wide_vectors.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static double random_number(uint64_t *state) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)*state / 0x1p63;
}

START_TEST(test_pairs) {
    const long double third = 1.0L / 3.0L;
    struct dalcs_extended pair = dalcs_extended_of(third);
    ck_assert_double_eq(pair.high, 1.0 / 3.0);
    ck_assert(dalcs_extended_value(pair) == third);
    struct dalcs_extended rest =
        dalcs_extended_plus(pair, (struct dalcs_extended){-pair.high, 0.0});
    ck_assert_double_eq(rest.high, pair.low);
    struct dalcs_extended tiny = dalcs_extended_plus((struct dalcs_extended){1.0, 0.0},
                                                     (struct dalcs_extended){0x1p-80, 0.0});
    ck_assert_double_eq(tiny.high, 1.0);
    ck_assert_double_eq(tiny.low, 0x1p-80);
}

END_TEST

/* What cancels but for its hundredth bit is left, in every place of rows of any width. */
START_TEST(test_cancelling) {
    enum { ROOM = 20, ROWS = 3 };

    for (int width = 1; width <= ROOM; width++) {
        double row[ROWS][2][ROOM];
        double sum[2][ROOM];
        for (int i = 0; i < ROOM; i++) {
            row[0][0][i] = 1.0 + ldexp(i, -30);
            row[0][1][i] = ldexp(1.0, -56);
            row[1][0][i] = NAN;
            row[1][1][i] = NAN;
            row[2][0][i] = -1.0;
            row[2][1][i] = 0.0;
        }
        /* (1 + i 2^-30 + 2^-56) (1 + 2^-40) - (1 + 2^-40): i 2^-30 + 2^-56 + i 2^-70 + 2^-96 */
        const struct dalcs_extended factor[2] = {{1.0, 0x1p-40}, {1.0, 0x1p-40}};
        const int of[2] = {0, 2};
        dalcs_extended_combine_long(ROOM, width, 2, factor, row[0][0], of, sum[0]);
        for (int i = 0; i < width; i++) {
            long double exact = ldexpl(i, -30) + ldexpl(1.0L, -56) + ldexpl(i, -70);
            long double found = (long double)sum[0][i] + sum[1][i];
            ck_assert(fabsl(found - exact) <= ldexpl(1.0L, -90));
            ck_assert_double_eq(sum[0][i], (double)found);
        }
    }
}

END_TEST

/* Of a matrix with large numbers that cancel, and its first rows. */
START_TEST(test_short_rows) {
    enum { N = 9 };

    uint64_t state = 3;
    struct dalcs_extended_row row[N];
    struct dalcs_extended factor[N];
    long double exact[DALCS_EXTENDED_ROW] = {0.0L};
    for (int k = 0; k < N; k++) {
        long double of = k % 2 == 0 ? 3500.0L * random_number(&state)
                                    : -dalcs_extended_value(factor[k - 1]) + 1e-3L * k;
        factor[k] = dalcs_extended_of(of);
        for (int i = 0; i < DALCS_EXTENDED_ROW; i++) {
            dalcs_extended_put(&row[k], i, 1.0L + 1e-3L * random_number(&state));
            exact[i] += of * dalcs_extended_at(&row[k], i);
        }
    }
    struct dalcs_extended_row sum;
    double rounded[DALCS_EXTENDED_ROW];
    dalcs_extended_combine(DALCS_EXTENDED_ROW, N, factor, row, NULL, &sum);
    dalcs_extended_round(DALCS_EXTENDED_ROW, &sum, 0.25, 1.0, rounded);
    for (int i = 0; i < DALCS_EXTENDED_ROW; i++) {
        ck_assert(fabsl(dalcs_extended_at(&sum, i) - exact[i]) <= 4 * N * 3500.0L * LDBL_EPSILON);
        ck_assert_double_eq(rounded[i], (double)(dalcs_extended_at(&sum, i) * 0.25L + 1.0L));
    }
}

END_TEST

enum { N = 12, RHS = 3, FOUR = 4 };

static void put(struct dalcs_extended_four *to, int p, long double complex x) {
    struct dalcs_extended re = dalcs_extended_of(creall(x));
    struct dalcs_extended im = dalcs_extended_of(cimagl(x));
    to->re[p] = re.high;
    to->re_low[p] = re.low;
    to->im[p] = im.high;
    to->im_low[p] = im.low;
}

static long double complex at(const struct dalcs_extended_four *x, int p) {
    return ((long double)x->re[p] + x->re_low[p]) + ((long double)x->im[p] + x->im_low[p]) * I;
}

/* Four sparse random systems of one pattern: what comes out satisfies what went in, better than a long double
 * could. */
START_TEST(test_four) {
    uint64_t state = 7;
    for (int trial = 0; trial < 100; trial++) {
        static struct dalcs_extended_four a[N][N + RHS];
        static struct dalcs_extended_four before[N][N + RHS];
        bool filled[N][N + RHS];
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N + RHS; j++) {
                bool is_diagonal = (i + trial) % N == j; /* not where pivots are looked for first */
                filled[i][j] = is_diagonal || j >= N || random_number(&state) > 0.5;
                for (int p = 0; p < FOUR; p++) {
                    double re = random_number(&state);
                    double im = random_number(&state);
                    put(&a[i][j], p, filled[i][j] ? re + im * I : 0.0L);
                }
            }
        }
        memcpy(before, a, sizeof(a));
        double pivot = dalcs_extended_solve_four(N, RHS, a[0], filled[0]);
        for (int p = 0; p < FOUR; p++) {
            for (int i = 0; i < N && pivot > 1e-3; i++) {
                for (int k = 0; k < RHS; k++) {
                    long double complex sum = -at(&before[i][N + k], p);
                    long double size = 1.0L;
                    for (int j = 0; j < N; j++) {
                        sum += at(&before[i][j], p) * at(&a[j][N + k], p);
                        size = fmaxl(size, cabsl(at(&a[j][N + k], p)));
                    }
                    ck_assert(cabsl(sum) <= 100.0L * LDBL_EPSILON * size);
                }
            }
        }
    }
}

END_TEST

/* Hilbert's matrix of order 10 has a condition of 1e13: of 106 bits sixty are left. */
START_TEST(test_four_precision) {
    enum { ORDER = 10 };

    static struct dalcs_extended_four a[ORDER][ORDER + 1];
    bool filled[ORDER][ORDER + 1];
    for (int i = 0; i < ORDER; i++) {
        for (int p = 0; p < FOUR; p++) {
            long double sum = 0.0L;
            for (int j = 0; j < ORDER; j++) {
                long double whole = 232792560.0L / (i + j + 1); /* a whole number */
                put(&a[i][j], p, whole * (p + 1) * I);
                sum += whole * (p + 1) * (j % 2 == 0 ? 1 : -2);
            }
            put(&a[i][ORDER], p, sum * I);
        }
        for (int j = 0; j <= ORDER; j++) {
            filled[i][j] = true;
        }
    }
    ck_assert(dalcs_extended_solve_four(ORDER, 1, a[0], filled[0]) > 0.0);
    for (int j = 0; j < ORDER; j++) {
        for (int p = 0; p < FOUR; p++) {
            ck_assert(cabsl(at(&a[j][ORDER], p) - (j % 2 == 0 ? 1.0L : -2.0L)) < 1e-16L);
        }
    }
}

END_TEST

START_TEST(test_four_singular) {
    static struct dalcs_extended_four a[2][3];
    bool filled[2][3] = {{true, true, true}, {true, true, true}};
    for (int p = 0; p < FOUR; p++) { /* the second row is twice the first, in the last of them */
        put(&a[0][0], p, 1.0L);
        put(&a[0][1], p, 2.0L * I);
        put(&a[0][2], p, 1.0L);
        put(&a[1][0], p, 2.0L);
        put(&a[1][1], p, p < 3 ? 5.0L : 4.0L * I);
        put(&a[1][2], p, 1.0L);
    }
    ck_assert_double_eq(dalcs_extended_solve_four(2, 1, a[0], filled[0]), 0.0);
    bool empty[2][3] = {{false, true, true}, {false, true, true}};
    ck_assert_double_eq(dalcs_extended_solve_four(2, 1, a[0], empty[0]), 0.0);
}

END_TEST

/* Machines without fma() get the same bits. */
START_TEST(test_any_machine) {
#ifdef DALCS_MAY_BE_WIDE
    enum { TERMS = 9, ORDER = 4 };

    uint64_t state = 11;
    const bool is_wide = dalcs_is_wide;
    for (int trial = 0; trial < 200; trial++) {
        struct dalcs_extended_row row[TERMS];
        struct dalcs_extended factor[TERMS];
        struct dalcs_extended_row sum[2];
        static struct dalcs_extended_four a[2][ORDER][ORDER + 1];
        for (int k = 0; k < TERMS; k++) {
            factor[k] = dalcs_extended_of(ldexpl(random_number(&state), trial % 40) / 3.0L);
            for (int i = 0; i < DALCS_EXTENDED_ROW; i++) {
                dalcs_extended_put(&row[k], i, random_number(&state) / 7.0L);
            }
        }
        for (int i = 0; i < ORDER; i++) {
            for (int j = 0; j <= ORDER; j++) {
                for (int p = 0; p < FOUR; p++) {
                    put(&a[0][i][j], p, (random_number(&state) + random_number(&state) * I) / 3.0L);
                }
            }
        }
        memcpy(a[1], a[0], sizeof(a[0]));
        for (int wide = 0; wide < 2; wide++) {
            bool filled[ORDER][ORDER + 1];
            memset(filled, true, sizeof(filled));
            dalcs_is_wide = wide == 1 && is_wide;
            dalcs_extended_combine(DALCS_EXTENDED_ROW, TERMS, factor, row, NULL, &sum[wide]);
            (void)dalcs_extended_solve_four(ORDER, 1, a[wide][0], filled[0]);
        }
        ck_assert_mem_eq(&sum[0], &sum[1], sizeof(sum[0]));
        ck_assert_mem_eq(a[0], a[1], sizeof(a[0]));
    }
    dalcs_is_wide = is_wide;
#endif
}

END_TEST

RUN_TESTS("extended_rows", test_pairs, test_cancelling, test_short_rows, test_four,
          test_four_precision, test_four_singular, test_any_machine)
