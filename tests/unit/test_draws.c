/* The generator against the vectors of its authors, the quantile against erfc, the functions against their
 * definitions. Seeds are fixed: these tests fail always or never. */
#include "draws.h"
#include "run_tests.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MANY = 20000 };

/* kat_vectors of Random123, philox4x32 10. */
START_TEST(test_philox_known_answers) {
    static const struct {
        uint32_t counter[4], key[2], wanted[4];
    } known[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
         {0xffffffff, 0xffffffff},
         {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
         {0xa4093822, 0x299f31d0},
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };

    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        uint32_t out[4];
        dalcs_philox(known[k].counter, known[k].key, out);
        ck_assert_mem_eq(out, known[k].wanted, sizeof out);
    }
}

END_TEST

/* Phi(quantile(p)) is p: to what an error of the quantile by one rounding makes of it. */
START_TEST(test_quantile_inverts_erfc) {
    static const double p[] = {1e-300,  1e-100,  1e-30, 1e-16, 1e-9, 1e-5, 1e-3,  0.02,
                               0.07499, 0.07501, 0.1,   0.25,  0.4,  0.49, 0.4999};
    for (size_t k = 0; k < sizeof p / sizeof p[0]; k++) {
        const double z = dalcs_normal_quantile(p[k]);
        const double back = 0.5 * erfc(-z / sqrt(2.0));
        ck_assert_double_eq_tol(back / p[k], 1.0, 4e-16 * (2.0 + z * z));
        if (p[k] > 1e-9) {
            const double other = dalcs_normal_quantile(1.0 - p[k]);
            ck_assert_double_eq_tol(other, -z, 1e-15 / p[k] / (1.0 + fabs(z)));
        }
    }
    ck_assert_double_eq(dalcs_normal_quantile(0.5), 0.0);
    ck_assert_double_eq_tol(dalcs_normal_quantile(0.975), 1.959963984540054, 5e-16);
}

END_TEST

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The distance of Kolmogorov and Smirnov times sqrt(n), of values that should be uniform on (0, 1): above 1.95 once in
 * a thousand times. */
static double distance(double *value, int n) {
    double worst = 0.0;
    qsort(value, (size_t)n, sizeof *value, ascending);
    for (int k = 0; k < n; k++) {
        worst = fmax(worst, fmax((k + 1.0) / n - value[k], value[k] - (double)k / n));
    }
    return worst * sqrt(n);
}

static double correlation(const double *x, const double *y, int n) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        sum += (x[k] - 0.5) * (y[k] - 0.5);
    }
    return sum / n * 12.0;
}

/* Along runs, places, draws of a place and seeds; none follows its neighbour. */
START_TEST(test_uniform_along_every_axis) {
    static double value[MANY], next[MANY];
    for (int axis = 0; axis < 4; axis++) {
        for (int k = 0; k < MANY; k++) {
            for (int ahead = 0; ahead < 2; ahead++) {
                const uint32_t i = (uint32_t)(k + ahead);
                (ahead ? next : value)[k] = dalcs_draw_uniform(
                    axis == 0 ? i : 1, axis == 1 ? i : 1, axis == 2 ? i : 77, axis == 3 ? i : 0);
            }
        }
        /* its standard deviation is 1 / sqrt(n) */
        ck_assert_double_lt(fabs(correlation(value, next, MANY)), 4.0 / sqrt(MANY));
        ck_assert_double_lt(distance(value, MANY), 1.95);
    }
}

END_TEST

START_TEST(test_names_of_places_differ) {
    const uint64_t start = dalcs_draw_hash_start;
    ck_assert(dalcs_draw_hash(dalcs_draw_hash(start, "ab"), "c") !=
              dalcs_draw_hash(dalcs_draw_hash(start, "a"), "bc"));
    ck_assert(dalcs_draw_hash(start, "r1") != dalcs_draw_hash(start, "r2"));
}

END_TEST

/* x at u: three functions of a simulator's manual each. */
START_TEST(test_functions_are_their_definitions) {
    static const struct {
        const char *name;
        int n;
        double x[3], u, wanted;
    } known[] = {
        {"gauss", 1, {2.0}, 0.975, 2.0 * 1.959963984540054},
        {"gauss", 3, {1e3, 0.1, 2.0}, 0.975, 1e3 + 1e3 * 0.05 * 1.959963984540054},
        {"gauss", 2, {1e3, 0.1}, 0.025, 1e3 - 1e3 * 0.1 * 1.959963984540054},
        {"agauss", 3, {1e3, 30.0, 3.0}, 0.975, 1e3 + 10.0 * 1.959963984540054},
        {"agauss", 2, {1e3, 30.0}, 0.5, 1e3},
        {"flat", 1, {3.0}, 0.25, -1.5},
        {"mc", 2, {1e3, 0.1}, 0.75, 1050.0},
        {"unif", 2, {1e3, 0.1}, 0.25, 950.0},
        {"aunif", 2, {1e3, 10.0}, 0.75, 1005.0},
        {"limit", 2, {1e3, 10.0}, 0.75, 1010.0},
        {"limit", 2, {1e3, 10.0}, 0.25, 990.0},
        {"limit", 2, {1e3, 10.0}, 0.5, 1e3},
        {"rand", 0, {0.0}, 0.3, 0.3},
    };

    bool is_known;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        dalcs_draw *draw = dalcs_draw_find(known[k].name, known[k].n, &is_known);
        ck_assert(draw != NULL && is_known);
        const double value = draw(known[k].x, known[k].n, known[k].u);
        ck_assert_double_eq_tol(value, known[k].wanted, 1e-14 * fabs(known[k].wanted));
    }
    ck_assert(dalcs_draw_find("gauss", 4, &is_known) == NULL && is_known);
    ck_assert(dalcs_draw_find("sin", 1, &is_known) == NULL && !is_known);
}

END_TEST

RUN_TESTS("draws", test_philox_known_answers, test_quantile_inverts_erfc,
          test_uniform_along_every_axis, test_names_of_places_differ,
          test_functions_are_their_definitions)
