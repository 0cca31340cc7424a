/* test_stimulus.c - sources as functions of time: values, edges, limits.
 *
 * Besides known values, every kind is held to its contract on random sources and times: edges ascend,
 * between two edges the value is smooth, and the limits at an edge are the values beside it. */
#include "make_stimulus.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

/* Zero-width edges over many periods, at times computed in other ways than the edge itself. */
START_TEST(test_pulse_jumps) {
    const struct dalcs_stimulus s = make_pulse(-1, 5, 1e-3, 0, 0, 4e-6, 1e-5);
    check_limits(&s, 0, -1, -1);
    check_limits(&s, 1e-3, -1, 5);
    check_limits(&s, 1.002e-3, 5, 5);
    check_limits(&s, 1.004e-3, 5, -1);
    double accumulated = 1e-3;
    for (long n = 0; n < 1000000; n += n < 1000 ? 1 : 997) {
        const double t = 1e-3 + (double)n * 1e-5;
        check_limits(&s, t, -1, 5);
        check_limits(&s, nextafter(t, INFINITY), -1, 5);
        check_limits(&s, nextafter(t, 0), -1, 5);
        check_limits(&s, (double)(100 + n) / 1e5, -1, 5);
        check_limits(&s, t + 4e-6, 5, -1);
        check_limits(&s, t + 2.385e-6, 5, 5);
        check_limits(&s, t + 7.1e-6, -1, -1);
        ck_assert_double_eq_tol(dalcs_stimulus_next_edge(&s, t), t + 4e-6, 4 * DBL_EPSILON * t);
        accumulated += 1e-5;
    }
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 0), 1e-3);
    ck_assert(accumulated > 1e-3);
}

END_TEST

START_TEST(test_pulse_edges) {
    const struct dalcs_stimulus s = make_pulse(1, 3, 0.5, 0.25, 0.5, 1, 4);
    const double edge[] = {0.5, 0.75, 1.75, 2.25, 4.5, 4.75, 5.75, 6.25, 8.5};
    double t = 0;
    for (size_t k = 0; k < sizeof edge / sizeof edge[0]; k++) {
        t = dalcs_stimulus_next_edge(&s, t);
        ck_assert_double_eq(t, edge[k]);
        ck_assert(!dalcs_stimulus_jumps_at(&s, t));
    }
    check_limits(&s, 0.625, 2, 2);
    check_limits(&s, 2, 2, 2);
    check_limits(&s, 6.125, 1.5, 1.5);
    check_limits(&s, 3, 1, 1);
}

END_TEST

START_TEST(test_pulse_once_and_for_ever) {
    struct dalcs_stimulus s = make_pulse(0, 1, 1, 0, 0, INFINITY, INFINITY);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 0), 1);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 1)));
    check_limits(&s, 1, 0, 1);
    check_limits(&s, 1e9, 1, 1);
    s = make_pulse(0, 1, 1, 0, 0, 2, INFINITY);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 1), 3);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 3)));
    check_limits(&s, 3, 1, 0);
    /* Wider than its period, without a rise: the restarts are no edges. */
    s = make_pulse(0, 1, 1, 0, 0, 20, 10);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 1)));
    check_limits(&s, 11, 1, 1);
    s = make_pulse(2, 2, 1, 0, 0, 1, 10);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 0)));
}

END_TEST

START_TEST(test_pulse_triangle) {
    /* Rise and fall fill the period but for rounding: no sliver of an edge at its end. */
    const struct dalcs_stimulus s = make_pulse(0, 1, 0, 0.3e-6, 0.7e-6, 0, 1e-6);
    double t = 0;
    for (int n = 0; n < 3000; n++) {
        check_limits(&s, t, 0, 0);
        const double top = dalcs_stimulus_next_edge(&s, t);
        ck_assert_double_eq_tol(top - t, 0.3e-6, 1e-18 + 4 * DBL_EPSILON * t);
        check_limits(&s, top, 1, 1);
        t = dalcs_stimulus_next_edge(&s, top);
        ck_assert_double_eq_tol(t, (n + 1) * 1e-6, 4 * DBL_EPSILON * t);
    }
}

END_TEST

START_TEST(test_pulse_cut_short) {
    /* The rise is cut by the next period at half its height. */
    struct dalcs_stimulus s = make_pulse(0, 2, 0, 2, 1, 5, 1);
    check_limits(&s, 0.5, 0.5, 0.5);
    check_limits(&s, 1, 1, 0);
    check_limits(&s, 7, 1, 0);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 0.2), 1);
    /* The same for a fall. */
    s = make_pulse(0, 2, 0, 0, 2, 1, 2);
    check_limits(&s, 1, 2, 2);
    check_limits(&s, 1.5, 1.5, 1.5);
    check_limits(&s, 2, 1, 2);
}

END_TEST

START_TEST(test_pulse_narrow_edges) {
    /* Narrower than times can resolve: a jump, like zero. */
    const struct dalcs_stimulus s = make_pulse(0, 1, 1, 1e-30, 1e-18, 1, 10);
    check_limits(&s, 1, 0, 1);
    check_limits(&s, 2, 1, 0);
    check_limits(&s, 11, 0, 1);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 1), 2);
    /* A negative delay: running at 0. */
    const struct dalcs_stimulus running = make_pulse(0, 1, -3, 0, 0, 1, 2);
    check_limits(&running, 0, 1, 0);
    check_limits(&running, 1, 0, 1);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&running, 0), 1);
}

END_TEST

START_TEST(test_sine) {
    struct dalcs_stimulus s = make_sine(0, 10, 50, 0, 0, 0);
    for (int k = 0; k < 1000; k++) { /* zeros and peaks are exact */
        check_limits(&s, k * 0.25, 0, 0);
    }
    check_limits(&s, 0.005, 10, 10);
    check_limits(&s, 0.01, 0, 0);
    check_limits(&s, 0.015, -10, -10);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 0)));

    /* Before the delay the value at phase, as ngspice. */
    s = make_sine(1, 2, 3, 0.5, 0.7, 30);
    check_limits(&s, 0, 1 + 2 * sin(2 * PI * (30. / 360)), 1 + 2 * sin(2 * PI * (30. / 360)));
    check_limits(&s, 0.5, dalcs_stimulus_value(&s, 0, DALCS_LEFT),
                 dalcs_stimulus_value(&s, 0, DALCS_LEFT));
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 0), 0.5);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 0.5)));
    const double wanted = 1 + 2 * exp(-0.7 * 0.385) * sin(2 * PI * (3 * 0.385 + 1. / 12));
    ck_assert_double_eq_tol(dalcs_stimulus_value(&s, 0.885, DALCS_LEFT), wanted, 1e-14);
}

END_TEST

/* A million cycles on, no digit of the phase is lost. */
START_TEST(test_sine_late) {
    const struct dalcs_stimulus s = make_sine(0, 1, 997.3, 0, 0, 17);
    for (int k = 0; k < 10000; k++) {
        const double t = 1000 + 0.0001237 * k;
        /* The product in two exact parts, without long double, which valgrind cuts to double. */
        const double product = 997.3 * t;
        const double lost = fma(997.3, t, -product);
        const double wanted = sin(2 * PI * (fmod(product, 1.0) + (lost + 17.0 / 360)));
        ck_assert_double_eq_tol(dalcs_stimulus_value(&s, t, DALCS_RIGHT), wanted, 2e-12);
    }
}

END_TEST

START_TEST(test_exponential) {
    struct dalcs_stimulus s = make_exponential(1, 3, 0.5, 0.25, 2, 0.5);
    check_limits(&s, 0.2, 1, 1);
    check_limits(&s, 0.5, 1, 1);
    const double rise = 1 - exp(-(1.7 - 0.5) / 0.25);
    ck_assert_double_eq_tol(dalcs_stimulus_value(&s, 1.7, DALCS_LEFT), 1 + 2 * rise, 1e-15);
    const double later = (1 - exp(-(2.385 - 0.5) / 0.25)) - (1 - exp(-0.385 / 0.5));
    ck_assert_double_eq_tol(dalcs_stimulus_value(&s, 2.385, DALCS_LEFT), 1 + 2 * later, 1e-15);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 0), 0.5);
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 0.5), 2);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 2)));
    /* Time constants of 0 are jumps, and a fall may never come. */
    s = make_exponential(1, 3, 0.5, 0, 2, 0);
    check_limits(&s, 0.5, 1, 3);
    check_limits(&s, 2, 3, 1);
    s = make_exponential(1, 3, 0, 0, INFINITY, 0);
    check_limits(&s, 0, 1, 3);
    check_limits(&s, 1e6, 3, 3);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 0)));
}

END_TEST

START_TEST(test_pwl) {
    static const double t[] = {1, 2, 2, 2, 3, 5};
    static const double v[] = {4, 6, 9, 1, 1, -3};
    struct dalcs_stimulus s = make_pwl(t, v, 6);
    check_limits(&s, 0, 4, 4);
    check_limits(&s, 1, 4, 4);
    check_limits(&s, 1.25, 4.5, 4.5);
    check_limits(&s, 2, 6, 1);
    check_limits(&s, nextafter(2, 3), 6, 1);
    check_limits(&s, nextafter(2, 1), 6, 1);
    check_limits(&s, 4, -1, -1);
    check_limits(&s, 5, -3, -3);
    check_limits(&s, 1e9, -3, -3);
    const double edge[] = {1, 2, 3, 5};
    double at = 0;
    for (size_t k = 0; k < 4; k++) {
        at = dalcs_stimulus_next_edge(&s, at);
        ck_assert_double_eq(at, edge[k]);
    }
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, at)));
    s = make_pwl(t, v, 1);
    check_limits(&s, 0, 4, 4);
    check_limits(&s, 7, 4, 4);
    /* A jump at the very start. */
    static const double t0[] = {0, 0, 1};
    static const double v0[] = {0, 5, 5};
    s = make_pwl(t0, v0, 3);
    check_limits(&s, 0, 0, 5);
    ck_assert_double_eq(dalcs_stimulus_operating_value(&s, true), 0);
}

END_TEST

/* An operating point lies before an edge at t = 0. */
START_TEST(test_operating_value) {
    struct dalcs_stimulus s = make_pulse(1, 2, 0, 0, 0, 1, 2);
    ck_assert_double_eq(dalcs_stimulus_operating_value(&s, false), 1);
    s.has_dc = true;
    s.dc = 7;
    ck_assert_double_eq(dalcs_stimulus_operating_value(&s, false), 7);
    ck_assert_double_eq(dalcs_stimulus_operating_value(&s, true), 1);
    s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .dc = 5, .has_dc = true};
    ck_assert_double_eq(dalcs_stimulus_operating_value(&s, true), 5);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 0)));
    ck_assert(!dalcs_stimulus_jumps_at(&s, 0));
}

END_TEST

RUN_TESTS("stimulus", test_pulse_jumps, test_pulse_edges, test_pulse_once_and_for_ever,
          test_pulse_triangle, test_pulse_cut_short, test_pulse_narrow_edges, test_sine,
          test_sine_late, test_exponential, test_pwl, test_operating_value)
