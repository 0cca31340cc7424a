/* test_guards.c - which guard falls first on steps that are written down here. */
#include "guards.h"
#include "tied.h"

#include "build_network.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 400 };

static struct text_network t;
static struct dalcs_osnsp osnsp;
static struct dalcs_component component;
static struct dalcs_excitation x;
static struct dalcs_radau r;
static struct dalcs_radau_part part;
static double out[MOST];
static double out_before[MOST];
static uint64_t modes_before[2];
static bool armed[8];
static int crossed[8];
static const double unit[2] = {1.0, 1.0};

/* Two diodes and a switch that closes above 0.75 V and opens below 0.25 V of a voltage of its own. */
static const char usual[] = "guards\nV1 a 0 1\nR1 a b 1\nD1 b c\nD2 b d\nR2 d 0 1\nC1 c 0 1\n"
                            "S1 c 0 b 0 sm\n.model sm SW(Vt=0.5 Vh=0.25)\n.tran 1 100\n";

/* The same, but the source's current is not known. */
static const char without_law[] = "guards\nV1 b 0 1\nD1 b c\nD2 b d\nR2 d 0 1\nC1 c 0 1\n"
                                  "S1 c 0 d 0 sm\n.model sm SW(Vt=0.5 Vh=0.25)\n.tran 1 100\n";

static void start_with(const char *netlist) {
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    build_good_network(&t, netlist);
    const struct dalcs_system *s = &t.network.system[0];
    ck_assert_int_eq(dalcs_osnsp_setup(&osnsp, s, &options), DALCS_OK);
    component = (struct dalcs_component){.system = s, .circuit = &t.circuit};
    component.osnsp = osnsp;
    r = (struct dalcs_radau){.options = {.stop = 100.0}, .resolution = 1e-13};
    part = (struct dalcs_radau_part){.component = &component,
                                     .inner_tolerance = 3e-8,
                                     .segment.h = 1.0,
                                     .segment.rounding = 1.0,
                                     .segment.out = out,
                                     .segment.out_before = out_before,
                                     .memory.modes_before = modes_before,
                                     .guards.armed = armed,
                                     .guards.crossed = crossed};
    ck_assert_int_eq(dalcs_excitation_setup(&x, &t.circuit, s, NULL), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&part.stages, s, &x,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, 5),
                                        &(struct dalcs_stage_limits){64, 1e-14, 1 << 20}),
                     DALCS_OK);
    ck_assert_int_eq(part.stages.n_watched, 1);
    ck_assert_int_eq(dalcs_step_setup(&part), DALCS_OK);
    ck_assert_int_eq(dalcs_guards_setup(&part), DALCS_OK);
    for (int k = 0; k < 8; k++) {
        armed[k] = false;
    }
    memset(out_before, 0, sizeof(out_before));
    modes_before[0] = component.osnsp.mode[0];
}

static void start(void) {
    start_with(usual);
}

static void finish(void) {
    dalcs_arena_finish(&part.arena);
    dalcs_stages_finish(&part.stages);
    dalcs_excitation_finish(&x);
    dalcs_osnsp_finish(&osnsp);
    text_network_finish(&t);
}

/* The straight line from `first` to `last` in the place of a pair, or of the watched voltage. */
static void draw(const char *name, double first, double last) {
    const struct dalcs_system *s = component.system;
    const struct dalcs_stage_layout *l = &part.stages.layout;
    int at =
        name != NULL ? dalcs_system_n_equations(s) + find_pair(s, name) : dalcs_system_n_columns(s);
    for (int k = 0; k < l->n_nodes; k++) {
        out[k * l->stride + at] = first + (last - first) * part.stages.method->node[k];
    }
}

static double first_fall(double end) {
    bool at_once;
    double theta = dalcs_guards_first_fall(&r, &part, end, unit, &at_once);
    ck_assert(!at_once);
    return theta;
}

/* Is there a fall, and is it one from the start? */
static bool falls_at_once(void) {
    bool at_once;
    ck_assert_double_eq(dalcs_guards_first_fall(&r, &part, 1.0, unit, &at_once), 0.0);
    return at_once;
}

static void arm(void) {
    dalcs_guards_arm(&part, false, unit);
}

/* One line for d1, all else far above 0. */
static void arm_beside(double first, double last) {
    draw("d1", first, last);
    draw("d2", 1.0, 1.0);
    draw(NULL, 0.5, 0.5);
    arm();
}

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

RUN_TESTS("guards", test_rounding, test_law, test_own_doubt, test_stop, test_recovery, test_pairs,
          test_watched, test_arming, test_faint, test_recover, test_goes_on, test_signs_and_ties,
          test_stays, test_over_soon, test_swing)
