/* test_crossing.c - the first fall below zero of polynomials with known roots, and of random ones
 * against a fine scan. */
#include "crossing.h"

#include "run_tests.h"

#include <math.h>
#include <stdint.h>

static struct dalcs_crossing find(int s, double (*f)(double), double end, double depth) {
    const struct dalcs_collocation *c = dalcs_collocation_of(DALCS_RADAU_IIA, s);
    double value[3 * DALCS_MAX_NODES];
    for (int k = 0; k < 3 * DALCS_MAX_NODES; k++) {
        value[k] = -1.0; /* what lies between is not looked at */
    }
    for (int k = 0; k <= s; k++) {
        value[3 * k] = f(c->node[k]);
    }
    return dalcs_crossing_find(c, value, 3, end, depth, 0.0);
}

static void check_falls(struct dalcs_crossing c, double theta, double tolerance) {
    ck_assert(c.falls);
    ck_assert_msg(fabs(c.theta - theta) <= tolerance, "falls at %.17g, not at %.17g", c.theta,
                  theta);
}

static double falling(double x) {
    return 0.3 - x;
}

static double falling_to_the_end(double x) {
    return 1.0 - x;
}

static double rising(double x) {
    return x;
}

static double falling_from_zero(double x) {
    return -x;
}

static double barely_positive(double x) {
    return 1e-12 - x;
}

static double barely_negative(double x) {
    return -1e-9 - x;
}

START_TEST(test_straight) {
    for (int s = 1; s <= 7; s += 2) {
        struct dalcs_crossing c = find(s, falling, 1.0, 0.0);
        check_falls(c, 0.3, 1e-15);
        ck_assert(!c.at_once);
        ck_assert_double_eq_tol(c.peak, 0.3, 1e-15);
        check_falls(find(s, falling, 1.0, 0.1), 0.3, 1e-15); /* the zero, not the depth */
        check_falls(find(s, falling, 0.35, 0.0), 0.3, 1e-15);
        ck_assert(!find(s, falling, 0.35, 0.1).falls);
        ck_assert(!find(s, falling, 0.25, 0.0).falls);
        ck_assert(!find(s, falling_to_the_end, 1.0, 0.0).falls);
        ck_assert(!find(s, rising, 1.0, 0.0).falls);
    }
}

END_TEST

START_TEST(test_at_once) {
    for (int s = 1; s <= 7; s += 2) {
        struct dalcs_crossing c = find(s, falling_from_zero, 1.0, 1e-9);
        check_falls(c, 0.0, 1e-15); /* a rounding may be positive */
        ck_assert(c.peak <= 1e-15);
        c = find(s, barely_negative, 1.0, 1e-8);
        check_falls(c, 0.0, 0.0);
        ck_assert(c.at_once && c.peak == 0.0);
        c = find(s, barely_negative, 1.0, 1e-10);
        check_falls(c, 0.0, 0.0);
        ck_assert(c.at_once && c.peak == 0.0);
        c = find(s, barely_positive, 1.0, 1e-9);
        check_falls(c, 1e-12, 1e-15);
        ck_assert(!c.at_once);
        ck_assert_double_eq_tol(c.peak, 1e-12, 1e-15);
    }
}

END_TEST

static double dip; /* how deep */

/* Two zeros at 0.4 -+ sqrt(dip): between the nodes of all methods. */
static double dipping(double x) {
    return (x - 0.4) * (x - 0.4) - dip;
}

START_TEST(test_grazing) {
    for (int s = 3; s <= 7; s += 2) {
        for (dip = 1e-3; dip > 1e-12; dip *= 0.1) {
            const struct dalcs_collocation *c = dalcs_collocation_of(DALCS_RADAU_IIA, s);
            for (int k = 0; k <= s; k++) {
                ck_assert(dipping(c->node[k]) > 0.0);
            }
            check_falls(find(s, dipping, 1.0, 0.0), 0.4 - sqrt(dip), 1e-14 / sqrt(dip));
            check_falls(find(s, dipping, 1.0, 0.9 * dip), 0.4 - sqrt(dip), 1e-14 / sqrt(dip));
            ck_assert(!find(s, dipping, 1.0, 1.1 * dip).falls);
            ck_assert(!find(s, dipping, 0.4 - 1.01 * sqrt(dip), 0.0).falls);
        }
        dip = 0.0;
        ck_assert(!find(s, dipping, 1.0, 0.0).falls);
        dip = -1e-12;
        ck_assert(!find(s, dipping, 1.0, 0.0).falls);
    }
}

END_TEST

/* Leaves 0 upwards and comes back: the start is not the fall. */
static double hump(double x) {
    return x * (0.5 - x);
}

static double hump_from_below(double x) {
    return x * (0.5 - x) - 1e-9;
}

/* A dip that does not count, then a fall that does. */
static double second_fall(double x) {
    return (x - 0.2) * (x - 0.2001) * (0.7 - x);
}

START_TEST(test_last_zero_before) {
    for (int s = 3; s <= 7; s += 2) {
        struct dalcs_crossing c = find(s, hump, 1.0, 0.0);
        check_falls(c, 0.5, 1e-15);
        ck_assert(!c.at_once && c.peak >= 0.0625 && c.peak < 0.2);
        c = find(s, hump_from_below, 1.0, 1e-8);
        check_falls(c, 0.5 - 2e-9, 1e-15);
        ck_assert(!c.at_once);
        c = find(s, hump_from_below, 1.0, 1e-10);
        check_falls(c, 0.0, 0.0);
        ck_assert(c.at_once);
        check_falls(find(s, second_fall, 1.0, 1e-6), 0.7, 1e-15);
        check_falls(find(s, second_fall, 1.0, 1e-10), 0.2, 1e-11);
    }
}

END_TEST

static uint64_t state = 5;

static double uniform(void) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(state >> 11) / 9007199254740992.0;
}

static double at(const struct dalcs_collocation *c, const double *value, double theta) {
    double weight[DALCS_MAX_NODES];
    double sum = 0.0;
    dalcs_collocation_weights(c, theta, weight);
    for (int k = 0; k <= c->s; k++) {
        sum += weight[k] * value[k];
    }
    return sum;
}

/* By its coefficients alone, where they suffice. */
static double only_fall(const struct dalcs_collocation *c, const double *value, double end,
                        double depth) {
    double coefficient[DALCS_MAX_NODES] = {0.0};
    for (int k = 0; k <= c->s; k++) {
        for (int i = 0; i <= c->s; i++) {
            coefficient[i] += value[k] * c->bernstein.from_nodes[k][i];
        }
    }
    return dalcs_crossing_only(c, coefficient, end, depth);
}

START_TEST(test_random) {
    enum { N_TRIALS = 2000, SCAN = 500 };

    int n_falls = 0;
    int n_hidden = 0;
    int n_only = 0;
    for (int trial = 0; trial < N_TRIALS; trial++) {
        const struct dalcs_collocation *c =
            dalcs_collocation_of(DALCS_RADAU_IIA, 1 + 2 * (trial % 5));
        double value[DALCS_MAX_NODES];
        double end = trial % 3 == 0 ? 1.0 : uniform();
        double depth = trial % 2 == 0 ? 0.0 : 0.3 * uniform();
        double guess = trial % 7 == 0 ? uniform() : 0.0; /* any must do */
        bool hidden = true;
        for (int k = 0; k <= c->s; k++) {
            value[k] = uniform() - (trial % 5 == 0 ? 0.5 : 0.05);
            hidden = hidden && (c->node[k] > end || value[k] >= -depth);
        }
        double first = INFINITY; /* of the scan to be below */
        double least = INFINITY;
        for (int k = 0; k <= SCAN; k++) {
            double theta = end * k / SCAN;
            double v = at(c, value, theta);
            least = fmin(least, v);
            first = v < -depth - 1e-9 && isinf(first) ? theta : first;
        }
        struct dalcs_crossing found = dalcs_crossing_find(c, value, 1, end, depth, guess);
        ck_assert(found.falls || isinf(first));
        double only = value[0] > 0.0 ? only_fall(c, value, end, depth) : INFINITY;
        if (only < INFINITY) {
            n_only++;
            ck_assert(found.falls && fabs(found.theta - only) < 1e-12);
            ck_assert(at(c, value, end) < -depth);
        }
        if (!found.falls) {
            continue;
        }
        n_falls++;
        n_hidden += hidden && at(c, value, end) > 0.0;
        ck_assert(found.theta >= 0.0 && found.theta <= fmin(first, end));
        ck_assert(found.at_once || fabs(at(c, value, found.theta)) < 1e-13);
        bool agrees = true;
        for (int k = 0; k <= SCAN; k++) {
            double theta = end * k / SCAN;
            double v = at(c, value, theta);
            bool before = v > -depth - 1e-9 && v <= found.peak + 1e-12;
            agrees = agrees && (theta >= first || before);
            agrees = agrees && (theta <= found.theta || theta >= first || v <= 1e-12);
        }
        ck_assert(agrees);
        ck_assert(!found.at_once || value[0] <= 1e-15);
    }
    ck_assert_int_gt(n_falls, N_TRIALS / 5);
    ck_assert_int_gt(n_hidden, 20);
    ck_assert_int_gt(n_only, 30);
}

END_TEST

/* Six side by side: no polynomial goes below its bound, and of a straight line that is its lower end. */
START_TEST(test_bounds) {
    enum { N = 6, STRIDE = 7, N_TRIALS = 200, SCAN = 100 };

    for (int trial = 0; trial < N_TRIALS; trial++) {
        const struct dalcs_collocation *c =
            dalcs_collocation_of(DALCS_RADAU_IIA, 1 + 2 * (trial % 4));
        double value[DALCS_MAX_NODES * STRIDE + 8] = {0.0};
        double bound[8];
        for (int k = 0; k <= c->s; k++) {
            for (int i = 0; i < N - 1; i++) {
                value[k * STRIDE + i] = uniform() - 0.3;
            }
            value[k * STRIDE + N - 1] = 2.0 - c->node[k];
        }
        dalcs_crossing_bounds(c, N, value, STRIDE, bound);
        ck_assert_double_eq_tol(bound[N - 1], 1.0, 1e-13);
        for (int i = 0; i < N; i++) {
            double of_one[DALCS_MAX_NODES];
            for (int k = 0; k <= c->s; k++) {
                of_one[k] = value[k * STRIDE + i];
            }
            for (int k = 0; k <= SCAN; k++) {
                ck_assert_double_ge(at(c, of_one, (double)k / SCAN), bound[i]);
            }
        }
    }
}

END_TEST

RUN_TESTS("crossing", test_straight, test_at_once, test_grazing, test_last_zero_before, test_random,
          test_bounds)
