/* test_source_products.c - integrals of products of sources against closed forms and sums. */
#include "source_products.h"

#include "run_tests.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

enum { N = 5 };

static const double TIMES[] = {0.0, 0.4, 0.4, 2.0};
static const double VALUES[] = {1.0, 3.0, -1.0, 0.5};

static const struct dalcs_stimulus SOURCE[N] = {
    {.kind = DALCS_STIMULUS_DC, .dc = 2.0},
    {.kind = DALCS_STIMULUS_SIN, .u.sine = {0.5, 2.0, 3.0, 0.3, 0.7, 40.0, 0.0}},
    {.kind = DALCS_STIMULUS_PULSE, .u.pulse = {-1.0, 2.0, 0.1, 0.05, 0.0, 0.2, 0.5, 0.0}},
    {.kind = DALCS_STIMULUS_PWL, .u.pwl = {4, TIMES, VALUES, false, 0.0}},
    {.kind = DALCS_STIMULUS_EXP, .u.exponential = {0.0, 2.0, 0.2, 1e-3, 0.9, 0.5}},
};

static void integrate(int n, const struct dalcs_stimulus *const *source, double stop,
                      double *integral) {
    struct dalcs_stimulus_piece piece[N];
    struct dalcs_stimulus_term term[2 * N];
    for (int i = 0; i < n; i++) {
        piece[i].term = term + 2 * (ptrdiff_t)i;
    }
    dalcs_source_products(n, source, stop, piece, integral);
}

/* The sine's mean square over whole periods and in between, at any frequency. */
START_TEST(test_sine) {
    for (double f = 1e-3; f < 1e10; f *= 100.0) {
        const struct dalcs_stimulus sine = {.kind = DALCS_STIMULUS_SIN,
                                            .u.sine = {.amplitude = 3.0, .frequency = f}};
        const struct dalcs_stimulus *const source[] = {&sine};
        double integral;
        integrate(1, source, 1.0 / f, &integral);
        ck_assert_double_eq_tol(integral * f, 4.5, 1e-13);
        integrate(1, source, 0.125 / f, &integral);
        ck_assert_double_eq_tol(integral * f, 4.5 * (0.125 - 1.0 / (4.0 * PI)), 1e-14);
        integrate(1, source, 1e-4 / f, &integral); /* 3 (2 pi f)^2 T^3 */
        double small = 2.0 * PI * 1e-4;
        double exact = 3.0 * small * small * 1e-4 * (1.0 - small * small / 5.0);
        ck_assert_double_eq_tol(integral * f, exact, 1e-9 * exact);
    }
}

END_TEST

/* All kinds with each other against the midpoint rule. */
START_TEST(test_all_kinds) {
    enum { STEPS = 400000 };

    const double stop = 1.7;
    const struct dalcs_stimulus *source[N];
    double integral[N * N];
    double sum[N * N] = {0.0};
    for (int i = 0; i < N; i++) {
        source[i] = &SOURCE[i];
    }
    integrate(N, source, stop, integral);
    for (int k = 0; k < STEPS; k++) {
        double value[N];
        for (int i = 0; i < N; i++) {
            value[i] = dalcs_stimulus_value(&SOURCE[i], (k + 0.5) * stop / STEPS, DALCS_RIGHT);
        }
        for (int i = 0; i < N * N; i++) {
            sum[i] += value[i / N] * value[i % N] * stop / STEPS;
        }
    }
    for (int i = 0; i < N * N; i++) {
        ck_assert_double_eq_tol(integral[i], sum[i], 3e-5); /* a jump within a midpoint's reach */
    }
}

END_TEST

/* A ramp with a decay so slow that it is nearly constant. */
START_TEST(test_slow) {
    const struct dalcs_stimulus ramp = {
        .kind = DALCS_STIMULUS_PWL,
        .u.pwl = {.n = 2, .t = (double[]){0, 1}, .v = (double[]){0, 1}}};
    const struct dalcs_stimulus slow = {.kind = DALCS_STIMULUS_EXP,
                                        .u.exponential = {1.0, 0.0, 0.0, 1e9, INFINITY, 1.0}};
    const struct dalcs_stimulus *const source[] = {&ramp, &slow};
    double integral[4];
    integrate(2, source, 1.0, integral);
    ck_assert_double_eq_tol(integral[0], 1.0 / 3.0, 1e-15);
    ck_assert_double_eq_tol(integral[1], 0.5 - 1e-9 / 3.0, 1e-15);
    ck_assert_double_eq(integral[1], integral[2]);
}

END_TEST

RUN_TESTS("source_products", test_sine, test_all_kinds, test_slow)
