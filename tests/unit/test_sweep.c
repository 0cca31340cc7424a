/* Values of sweeps: counted, and where rounding may not lose or add one. */
#include "run_tests.h"
#include "sweep.h"

#include <math.h>

static struct dalcs_sweep linear(double start, double stop, double step) {
    return (struct dalcs_sweep){.spacing = DALCS_LINEAR,
                                .start = start,
                                .stop = stop,
                                .step = step,
                                .n = dalcs_sweep_count(DALCS_LINEAR, start, stop, step)};
}

START_TEST(test_last_value_is_the_stop) {
    for (int n = 1; n <= 1000; n++) {
        const struct dalcs_sweep s = linear(0.0, 1.0, 1.0 / n);
        ck_assert_int_eq(s.n, n + 1);
        ck_assert_double_eq(dalcs_sweep_value(&s, n), 1.0);
        const struct dalcs_sweep down = linear(1.0, -1.0, -2.0 / n);
        ck_assert_int_eq(down.n, n + 1);
        ck_assert_double_eq(dalcs_sweep_value(&down, n), -1.0);
    }
}

END_TEST

START_TEST(test_steps_that_do_not_fit) {
    const struct dalcs_sweep s = linear(0.0, 1.0, 0.3);
    ck_assert_int_eq(s.n, 4);
    ck_assert_double_eq_tol(dalcs_sweep_value(&s, 3), 0.9, 1e-15);
    ck_assert_int_eq(dalcs_sweep_count(DALCS_LINEAR, 0.0, 1.0, 2.0), 1);
    ck_assert_int_eq(dalcs_sweep_count(DALCS_LINEAR, 5.0, 5.0, 0.0), 1);
}

END_TEST

START_TEST(test_no_values) {
    ck_assert_int_eq(dalcs_sweep_count(DALCS_LINEAR, 0.0, 1.0, 0.0), 0);
    ck_assert_int_eq(dalcs_sweep_count(DALCS_LINEAR, 0.0, 1.0, -0.1), 0);
    ck_assert_int_eq(dalcs_sweep_count(DALCS_LINEAR, 1.0, 0.0, 0.1), 0);
    ck_assert_int_lt(dalcs_sweep_count(DALCS_LINEAR, 0.0, 1.0, 1e-12), 0);
}

END_TEST

START_TEST(test_decades_and_octaves) {
    for (int per = 1; per <= 200; per++) {
        ck_assert_int_eq(dalcs_sweep_count(DALCS_DECADES, 1e-3, 1e6, per), 9 * per + 1);
        ck_assert_int_eq(dalcs_sweep_count(DALCS_OCTAVES, 3.0, 96.0, per), 5 * per + 1);
    }
    const struct dalcs_sweep s = {
        .spacing = DALCS_DECADES, .start = 10.0, .stop = 2000.0, .step = 3.0, .n = 7};
    ck_assert_int_eq(dalcs_sweep_count(DALCS_DECADES, 10.0, 2000.0, 3.0), 7);
    ck_assert_double_eq_tol(dalcs_sweep_value(&s, 6), 1000.0, 1e-10);
}

END_TEST

RUN_TESTS("sweep", test_last_value_is_the_stop, test_steps_that_do_not_fit, test_no_values,
          test_decades_and_octaves)
