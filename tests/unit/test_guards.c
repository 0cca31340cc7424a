/* test_guards.c - which guard falls first on steps that are written down here. */
#include "guard_segment.h"

#include <math.h>

START_TEST(test_pairs) {
    start();
    draw("d1", 0.3, -0.7);
    draw("d2", 0.4, -0.6);
    draw(NULL, 0.5, 0.5);
    arm();
    ck_assert_double_eq_tol(first_fall(1.0), 0.3, 1e-14);
    ck_assert_int_eq(part.guards.n_crossed, 1);
    ck_assert_int_eq(crossed[0], find_pair(component.system, "d1"));
    ck_assert(isinf(first_fall(0.25)) && part.guards.n_crossed == 0);
    draw("d2", 0.3, -0.7); /* at the same time */
    ck_assert_double_eq_tol(first_fall(1.0), 0.3, 1e-14);
    ck_assert_int_eq(part.guards.n_crossed, 2);
    draw("d1", 0.3, 0.1);
    draw("d2", 0.1, 0.2);
    ck_assert(isinf(first_fall(1.0)));
    finish();
}

END_TEST

/* The switch itself has no sign to keep; its control moves it either way. */
START_TEST(test_watched) {
    start();
    const int s1 = find_pair(component.system, "s1");
    const uint64_t before = component.osnsp.mode[0];
    draw("d1", 1.0, 1.0);
    draw("d2", 1.0, 1.0);
    draw("s1", 1.0, -1.0);
    draw(NULL, 0.5, 1.0);
    arm();
    ck_assert(!dalcs_osnsp_is_on(&component.osnsp, s1));
    ck_assert_double_eq_tol(first_fall(1.0), 0.5, 1e-14);
    ck_assert_int_eq(part.guards.n_crossed, 1);
    dalcs_guards_flip(&part);
    ck_assert(dalcs_osnsp_is_on(&component.osnsp, s1));
    ck_assert_uint_eq(component.osnsp.mode[0] ^ before, UINT64_C(1) << s1);
    draw(NULL, 0.75, 1.0); /* hysteresis: closed, it is clear of its threshold */
    arm();
    ck_assert(isinf(first_fall(1.0)));
    draw(NULL, 0.75, 0.0);
    ck_assert_double_eq_tol(first_fall(1.0), 2.0 / 3.0, 1e-14);
    finish();
}

END_TEST

/* What starts below 0 and is above it at once, or sooner than times can be told apart, is no event; a fall
 * after that is. */
START_TEST(test_over_soon) {
    start();
    arm_beside(-5e-7, 1.0);
    part.guards.fresh = true;
    ck_assert(isinf(first_fall(1.0)));
    ck_assert_double_eq(dalcs_guards_wrong_sign(&r, &part, 1.0, unit), 0.0);
    draw("d1", -2e-6, 1.0); /* above it after 2e-6 steps */
    ck_assert(falls_at_once());
    part.segment.h = 1e-6; /* of which 6.4e-6 is no time */
    ck_assert(isinf(first_fall(1.0)));
    draw("d1", -2e-5, 10.0);
    ck_assert(falls_at_once());
    finish();
}

END_TEST

/* What has died away before the second node and is above 0 at the end may have dipped as the polynomial does;
 * what dips deep, or ends below, has not. Later than in the first step of a mode less is deep. */
START_TEST(test_swing) {
    start();
    const struct dalcs_stage_layout *l = &part.stages.layout;
    double *d1 =
        out + dalcs_system_n_equations(component.system) + find_pair(component.system, "d1");
    arm_beside(1e-3, 1e-3);
    for (int k = 1; k < l->n_nodes; k++) {
        d1[k * l->stride] = k % 2 == 0 ? -4e-5 : 4e-5;
    }
    d1[(l->n_nodes - 1) * l->stride] = 3e-5;
    part.guards.fresh = true;
    ck_assert(first_fall(1.0) < 1.0 && dalcs_guards_swing(&part));
    part.guards.fresh = false;
    ck_assert(first_fall(1.0) < 1.0 && !dalcs_guards_swing(&part));
    for (int k = 1; k < l->n_nodes; k++) {
        d1[k * l->stride] *= 0.1;
    }
    ck_assert(first_fall(1.0) < 1.0 && dalcs_guards_swing(&part));
    part.guards.fresh = true;
    d1[2 * l->stride] = -4e-4;
    ck_assert(first_fall(1.0) < 1.0 && !dalcs_guards_swing(&part));
    d1[2 * l->stride] = -4e-5;
    d1[(l->n_nodes - 1) * l->stride] = -3e-5;
    ck_assert(first_fall(1.0) < 1.0 && !dalcs_guards_swing(&part));
    finish();
}

END_TEST

/* In a short step a capacitor makes a current of the last digits of its voltage: d1 leads to 1 F. The
 * longer the step, the less of it is rounding. */
START_TEST(test_rounding) {
    start_with(without_law);
    dalcs_osnsp_command(&component.osnsp, find_pair(component.system, "d1"), true);
    arm_beside(1.0, -1e-9);
    ck_assert_double_eq_tol(first_fall(1.0), 1.0, 1e-8);
    part.segment.h = 1e-6; /* 16 roundings of 1 V on 1 F in 1 us: 3.6 nA */
    ck_assert(isinf(first_fall(1.0)));
    draw("d1", 1.0, -1e-8);
    ck_assert_double_eq_tol(first_fall(1.0), 1.0, 1e-7);
    finish();
}

END_TEST

/* But what resistors bring to its other node is known, and so is what another diode takes away from there. */
START_TEST(test_law) {
    start();
    dalcs_osnsp_command(&component.osnsp, find_pair(component.system, "d1"), true);
    arm_beside(1.0, -1e-9);
    part.segment.h = 1e-6;
    ck_assert_double_eq_tol(first_fall(1.0), 1.0, 1e-8);
    dalcs_osnsp_command(&component.osnsp, find_pair(component.system, "d2"), true);
    ck_assert_double_eq_tol(first_fall(1.0), 1.0, 1e-8);
    finish();
}

END_TEST

/* What is within the error at the stop time, and crossed just there, is left to a longer run. */
START_TEST(test_stop) {
    start();
    part.segment.t = 99.0;
    arm_beside(1.0, -1e-7);
    ck_assert(isinf(first_fall(1.0)));
    draw("d1", 1e-4, -1e-7); /* crossed before */
    ck_assert_double_eq_tol(first_fall(1.0), 0.999, 1e-5);
    draw("d1", 1.0, -1e-6); /* and is farther off */
    ck_assert_double_eq_tol(first_fall(1.0), 1.0, 1e-5);
    part.segment.t = 98.0;
    draw("d1", 1.0, -1e-7);
    ck_assert_double_eq_tol(first_fall(1.0), 1.0, 1e-5);
    finish();
}

END_TEST

RUN_TESTS("guards", test_rounding, test_law, test_stop, test_pairs, test_watched, test_over_soon,
          test_swing)
