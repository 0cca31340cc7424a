/* test_guards_arming.c - guards that are at 0, or faint: when they are armed. */
#include "guard_segment.h"

#include <math.h>
#include <string.h>

/* A guard that has just crossed starts within the error of 0: it may go up, and a fall after that counts;
 * one that goes down from there was wrong from the start. */
START_TEST(test_arming) {
    bool at_once;
    start();
    arm_beside(1e-9, -0.5);
    ck_assert(!armed[find_pair(component.system, "d1")]);
    ck_assert(armed[find_pair(component.system, "d2")]);
    ck_assert(!armed[find_pair(component.system, "s1")]);
    ck_assert(dalcs_guards_first_fall(&r, &part, 1.0, unit, &at_once) < 1e-8);
    ck_assert(at_once);
    draw("d1", -1e-9, 0.5);
    arm();
    ck_assert(isinf(first_fall(1.0)));
    dalcs_guards_arm(&part, true, unit); /* later on it is clear */
    ck_assert(armed[find_pair(component.system, "d1")]);
    draw("d1", 1e-9, -1e-9); /* an armed one falls */
    ck_assert_double_eq_tol(first_fall(1.0), 0.5, 1e-14);
    armed[find_pair(component.system, "d1")] = false;
    part.guards.fresh = true;
    ck_assert(isinf(first_fall(1.0))); /* within the error */
    part.guards.fresh = false;
    draw("d1", -1e-9, -1e-10); /* later steps let it come back from there, but not go on */
    ck_assert(isinf(first_fall(1.0)));
    draw("d1", -1e-10, -1e-9);
    ck_assert_double_eq(dalcs_guards_first_fall(&r, &part, 1.0, unit, &at_once), 0.0);
    finish();
}

END_TEST

/* A current that has died away ends in nothing: how errors have it on the way is no event. One that goes on
 * below 0 is. */
START_TEST(test_faint) {
    bool at_once;
    start();
    const int d1 = find_pair(component.system, "d1");
    const struct dalcs_stage_layout *l = &part.stages.layout;
    double *value = out + dalcs_system_n_equations(component.system) + d1;
    arm_beside(1.0, 2e-10);
    ck_assert(isinf(first_fall(1.0)) && armed[d1]);
    draw("d1", 2e-10, -1e-10);
    ck_assert_double_eq_tol(first_fall(1.0), 2.0 / 3.0, 1e-14);
    value[(l->n_nodes - 1) * l->stride] = 1e-14;
    ck_assert(isinf(first_fall(1.0)) && !armed[d1]);
    draw("d1", -1e-10, 0.5);
    ck_assert(isinf(first_fall(1.0)));
    arm_beside(
        1.0,
        1.0); /* so is one that only touches 0, but for an error; one that is farther below is one */
    for (int k = 0; k < l->n_nodes; k++) {
        value[k * l->stride] = pow(part.stages.method->node[k] - 0.5, 2.0) - 1e-10;
    }
    ck_assert(isinf(first_fall(1.0)) && armed[d1]);
    for (int k = 0; k < l->n_nodes; k++) {
        value[k * l->stride] -= 0.01;
    }
    ck_assert_double_eq_tol(first_fall(1.0), 0.4, 1e-8);
    draw("d1", 2e-10, -0.5);
    ck_assert_double_eq_tol(dalcs_guards_first_fall(&r, &part, 1.0, unit, &at_once), 4e-10, 1e-14);
    finish();
}

END_TEST

/* What starts below 0 by an error and comes back may be the polynomial's, what stays is not. */
START_TEST(test_recover) {
    start();
    arm_beside(-1e-6, 0.5);
    ck_assert(falls_at_once() && dalcs_guards_recover(&part, unit));
    draw("d2", -1e-6, -1e-7);
    ck_assert(falls_at_once() && !dalcs_guards_recover(&part, unit));
    draw("d2", 1.0, 1.0);
    draw("d1", -1e-4, 0.5);
    ck_assert(falls_at_once() && !dalcs_guards_recover(&part, unit));
    finish();
}

END_TEST

/* One that goes on where the segment before ended is known, be it within the error of 0. */
START_TEST(test_goes_on) {
    start();
    const int d1 = find_pair(component.system, "d1");
    draw("d1", 2e-9, -2e-9); /* the segment before, up to its middle */
    memcpy(out_before, out, sizeof(out));
    part.segment.end_before = 0.25;
    draw("d1", 1.001e-9, -0.5);
    arm();
    ck_assert(armed[d1]);
    ck_assert_double_eq_tol(first_fall(1.0), 2e-9, 1e-11);
    draw("d1", 1.03e-9, -0.5); /* elsewhere */
    arm();
    ck_assert(!armed[d1]);
    draw("d1", 1.001e-9, -0.5);
    modes_before[0] ^= UINT64_C(1) << d1; /* on the other side */
    arm();
    ck_assert(!armed[d1]);
    modes_before[0] ^= UINT64_C(1) << d1;
    part.segment.by_euler = true; /* after a step of low order */
    arm();
    ck_assert(!armed[d1]);
    part.segment.by_euler = false;
    draw("d1", 2e-14, -2e-14); /* rounding */
    memcpy(out_before, out, sizeof(out));
    draw("d1", 1e-14, -0.5);
    arm();
    ck_assert(!armed[d1]);
    finish();
}

END_TEST

START_TEST(test_signs_and_ties) {
    start();
    draw("d1", 0.5, -0.5);
    draw("d2", 1.0, 1.0);
    (void)first_fall(1.0);
    ck_assert_double_eq_tol(dalcs_guards_wrong_sign(&r, &part, 1.0, unit), 0.5, 1e-15);
    double last = 0.0; /* the last node before the end */
    for (int k = 0; k <= 5; k++) {
        last = part.stages.method->node[k] <= 0.8 ? part.stages.method->node[k] : last;
    }
    ck_assert_double_eq_tol(dalcs_guards_wrong_sign(&r, &part, 0.8, unit), last - 0.5, 1e-15);
    ck_assert_double_eq(dalcs_guards_wrong_sign(&r, &part, 0.3, unit), 0.0);
    draw("s1", -1.0, -1.0);
    (void)first_fall(1.0);
    ck_assert_double_eq(dalcs_guards_wrong_sign(&r, &part, 0.3, unit), 0.0);
    ck_assert(!dalcs_tied_stay(&part, true, unit));
    draw("d1", 0.0, 1e-14);
    ck_assert(dalcs_tied_stay(&part, true, unit));
    draw("d1", 0.0, 1e-9);
    ck_assert(!dalcs_tied_stay(&part, true, unit));
    finish();
}

END_TEST

/* A closed diode that has died away keeps its side at the event of another, an open one is asked for: it may
 * have got a closed one in parallel. */
START_TEST(test_stays) {
    start();
    const int d1 = find_pair(component.system, "d1");
    draw("d1", 0.0, 1e-14);
    draw("d2", 1.0, 1.0);
    memset(out_before, 0, sizeof(out_before));
    part.guards.flipped = true;
    ck_assert(dalcs_tied_stay(&part, true, unit));
    dalcs_osnsp_command(&component.osnsp, d1, true);
    ck_assert(dalcs_tied_stay(&part, true, unit)); /* it was open */
    modes_before[0] = component.osnsp.mode[0];
    ck_assert(!dalcs_tied_stay(&part, true, unit));
    ck_assert(dalcs_tied_stay(&part, false, unit));
    draw("d1", 1.0, 0.0);
    memcpy(out_before, out, sizeof(out)); /* it had a current */
    draw("d1", 0.0, 1e-14);
    ck_assert(dalcs_tied_stay(&part, true, unit));
    memset(out_before, 0, sizeof(out_before));
    part.guards.flipped = false; /* at an edge */
    ck_assert(dalcs_tied_stay(&part, true, unit));
    finish();
}

END_TEST

/* A pair that starts within the error of its unit, but not within its own, keeps its sign: a leak where all that
 * drives it is small. */
START_TEST(test_own_doubt) {
    double in[8] = {0.0};
    double scale[8] = {0.0};
    start();
    ck_assert_int_le(part.stages.n_in, 8);
    part.guards.fresh = true;
    arm_beside(5e-8, -5e-8);
    ck_assert(isinf(first_fall(1.0)));
    part.segment.in = in;
    part.scales.column = scale;
    ck_assert_int_eq(
        dalcs_stages_get(&part.stages, osnsp.mode, part.segment.h, &part.segment.entry), DALCS_OK);
    arm();
    ck_assert_double_eq_tol(first_fall(1.0), 0.5, 1e-4);
    scale[0] = 1.0; /* the voltage of c1 was that: so is its error */
    arm();
    ck_assert(isinf(first_fall(1.0)));
    finish();
}

END_TEST

/* When what is wrong from the start is over. */
START_TEST(test_recovery) {
    start();
    arm_beside(-1e-2, 1.0);
    ck_assert(falls_at_once());
    ck_assert_double_eq_tol(dalcs_guards_recovery(&part), 0.01 / 1.01, 1e-12);
    draw("d2", -2e-2, 1.0);
    ck_assert(falls_at_once());
    ck_assert_double_eq_tol(dalcs_guards_recovery(&part), 0.02 / 1.02, 1e-12);
    draw("d2", -2e-2, -1e-2);
    ck_assert(falls_at_once());
    ck_assert(isinf(dalcs_guards_recovery(&part)));
    finish();
}

END_TEST

RUN_TESTS("guards that are armed", test_own_doubt, test_recovery, test_arming, test_faint,
          test_recover, test_goes_on, test_signs_and_ties, test_stays)
