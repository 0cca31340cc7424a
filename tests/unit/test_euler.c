/* test_euler.c - single steps against closed forms, starts, jumps, commands. */
#include "euler.h"

#include "build_network.h"

static struct text_network t;
static struct dalcs_euler e;

static int n_jumps;
static struct dalcs_euler_jump jump;
static double jump_before[8], jump_after[8], jump_charge[8], jump_flux[8];

static enum dalcs_status note_jump(void *user, const struct dalcs_euler_jump *j) {
    (void)user;
    const struct dalcs_system *s = &t.network.system[j->system];
    n_jumps++;
    jump = *j;
    memcpy(jump_before, j->before, (size_t)s->n_x * sizeof(double));
    memcpy(jump_after, j->after, (size_t)s->n_x * sizeof(double));
    memcpy(jump_charge, j->charge, (size_t)s->n_pairs * sizeof(double));
    memcpy(jump_flux, j->flux, (size_t)s->n_pairs * sizeof(double));
    return DALCS_OK;
}

static void setup(const char *text, double h, double stop) {
    build_good_network(&t, text);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, h, stop), DALCS_OK);
    e.listener.on_jump = note_jump;
    e.listener.detects_jumps = true;
    n_jumps = 0;
}

static void start(const char *text, double h, double stop) {
    setup(text, h, stop);
    ck_assert_int_eq(dalcs_euler_start(&e, t.network.initial), DALCS_OK);
}

static void step(void) {
    ck_assert_int_eq(dalcs_euler_step(&e), DALCS_OK);
}

static void finish(void) {
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

static double value(enum dalcs_label_kind kind, const char *name) {
    const struct dalcs_component *c = &e.component[0];
    return c->y[find_column(c->system, kind, name)];
}

static double state(const char *name) {
    return value(DALCS_LABEL_STATE, name);
}

/* v+ = (v + h V / (R C)) / (1 + h / (R C)), the source at the end of the step: a hundred of them. */
START_TEST(test_rc) {
    const double h = 1e-4;
    const double tau = 1e3 * 1e-6;
    start("rc\nV1 a 0 SIN(0 10 50)\nR1 a b 1k\nC1 b 0 1u IC=2\n.tran 100u 10m uic\n", h, 10e-3);
    double v = 2.0;
    for (int k = 1; k <= 100; k++) {
        step();
        ck_assert(e.t == k * h || k == 100);
        v = (v + h / tau * 10.0 * sin(2.0 * acos(-1.0) * 50.0 * k * h)) / (1.0 + h / tau);
        ck_assert_double_eq_tol(state("c1"), v, 1e-13); /* 100 steps, each to a rounding of 10 V */
    }
    ck_assert_int_eq(e.steps, 100);
    ck_assert(dalcs_grid_at_end(&e.grid));
    ck_assert_int_eq(n_jumps, 0);
    finish();
}

END_TEST

/* v+ = v - h i+ / C, i+ = i + h v+ / L: solved for v+ by hand. */
START_TEST(test_lc) {
    const double h = 1e-5;
    const double L = 1e-3;
    const double C = 2e-6;
    start("lc\nC1 a 0 2u IC=1\nL1 a 0 1m IC=0.5\n.tran 10u 1m uic\n", h, 1e-3);
    double v = 1.0;
    double i = 0.5;
    for (int k = 0; k < 100; k++) {
        step();
        v = (v - h / C * i) / (1.0 + h * h / (L * C));
        i += h / L * v;
        ck_assert_double_eq_tol(state("c1"), v, 1e-13);
        ck_assert_double_eq_tol(state("l1"), i, 1e-13);
    }
    finish();
}

END_TEST

/* A diode into a resistor and a coil: on while current flows, and it stops at exactly 0. */
START_TEST(test_freewheel) {
    const double h = 1e-5;
    start("rl\nV1 a 0 -1\nD1 a b\nL1 b c 1m IC=0.02\nR1 c 0 10\n.tran 10u 1m uic\n", h, 1e-3);
    double i = 0.02;
    for (int k = 0; k < 20; k++) {
        step();
        i = fmax(0.0, (i - h / 1e-3) / (1.0 + h * 10.0 / 1e-3));
        ck_assert_double_eq_tol(state("l1"), i, 1e-16);
    }
    ck_assert_double_eq(state("l1"), 0.0);
    ck_assert(!dalcs_osnsp_is_on(&e.component[0].osnsp, 0));
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "b"), 0.0, 1e-13);
    finish();
}

END_TEST

/* Charge Q = 1u 10 V + 3u 2 V on 4u: both at 4 V, 6 uC through the diode, 24 uJ lost. */
START_TEST(test_inconsistent_start) {
    start("charges\nC1 1 0 1u IC=10\nC2 2 0 3u IC=2\nD1 1 2\n.tran 10u 1m uic\n", 1e-5, 1e-3);
    ck_assert_int_eq(n_jumps, 1);
    ck_assert_double_eq(jump.time, 0.0);
    ck_assert_double_eq(jump_before[0], 10.0);
    ck_assert_double_eq(jump_before[1], 2.0);
    ck_assert_double_eq_tol(jump_after[0], 4.0, 1e-12);
    ck_assert_double_eq_tol(jump_charge[0], 6e-6, 1e-17);
    ck_assert_double_eq(jump_flux[0], 0.0);
    ck_assert_double_eq_tol(jump.energy_lost, 24e-6, 1e-16);
    ck_assert_double_eq_tol(state("c2"), 4.0, 1e-12);
    step();
    ck_assert_double_eq_tol(state("c1"), 4.0, 1e-12);
    ck_assert_int_eq(n_jumps, 1);
    finish();
}

END_TEST

/* A coil cut off by a switch: its flux is the diode's voltage impulse that no diode limits here. */
START_TEST(test_flux) {
    start("flux\nI1 0 a 1\nL1 a 0 2m IC=0\nD1 0 b\nL2 b a 3m IC=0\n.tran 10u 1m uic\n", 1e-5, 1e-3);
    /* L1 must carry what I1 drives at once: 1 A times 2 mH; d1 blocks and sees it reversed. */
    ck_assert_int_eq(n_jumps, 1);
    ck_assert_double_eq_tol(state("l1"), 1.0, 1e-12);
    ck_assert_double_eq_tol(jump_flux[0], 2e-3, 1e-14);
    ck_assert_double_eq(jump_charge[0], 0.0);
    finish();
}

END_TEST

START_TEST(test_operating_point) {
    setup("op\nV1 a 0 6\nR1 a b 2\nL1 b c 1m\nR2 c 0 1\nC1 c 0 1u\n.tran 10u 1m\n", 1e-5, 1e-3);
    ck_assert_int_eq(dalcs_euler_operating_point(&e, true), DALCS_OK);
    ck_assert_double_eq_tol(state("l1"), 2.0, 1e-14);
    ck_assert_double_eq_tol(state("c1"), 2.0, 1e-14);
    ck_assert_int_eq(dalcs_euler_start(&e, NULL), DALCS_OK);
    for (int k = 0; k < 100; k++) {
        step();
    }
    ck_assert_double_eq_tol(state("l1"), 2.0, 1e-13); /* at rest it stays */
    ck_assert_double_eq_tol(state("c1"), 2.0, 1e-13);
    ck_assert_int_eq(n_jumps, 0);
    finish();
}

END_TEST

/* An edge between two multiples of h: landed on with its left limit, crossed to its right one. */
START_TEST(test_edge) {
    start("edge\nV1 a 0 PULSE(1 5 25u 0 0 1)\nR1 a b 1k\nC1 b 0 1u IC=1\n.tran 10u 1m uic\n", 1e-5,
          1e-3);
    step();
    step();
    ck_assert(!e.at_jump);
    step();
    ck_assert(e.t == 25e-6 && e.at_jump);
    ck_assert_double_eq_tol(e.h, 5e-6, 1e-18);
    ck_assert_double_eq(value(DALCS_LABEL_NODE, "a"), 1.0);
    ck_assert_double_eq_tol(state("c1"), 1.0, 1e-15);
    ck_assert_int_eq(dalcs_euler_cross(&e), DALCS_OK);
    ck_assert_double_eq(value(DALCS_LABEL_NODE, "a"), 5.0);
    ck_assert_double_eq_tol(state("c1"), 1.0, 1e-7); /* no jump: a micro-step of h / 1e6 */
    ck_assert_int_eq(n_jumps, 0);
    step();
    ck_assert(e.t == 3 * 1e-5 && !e.at_jump);
    double ratio = 5e-6 / 1e-3; /* the state did not move while crossing */
    ck_assert_double_eq_tol(state("c1"), (1.0 + ratio * 5.0) / (1.0 + ratio), 1e-14);
    finish();
}

END_TEST

/* The values just after an edge do not depend on the next one, however near it is. */
START_TEST(test_next_edge_near) {
    start(
        "edges\nV1 a 0 PULSE(0 1 10u 0 0 3u 50u)\nV2 b 0 PULSE(0 2 10.0000000000001u 0 0 3u 50u)\n"
        "R1 a x 1\nR2 b x 1\nC1 x 0 1u\n.tran 1u 1m uic\n",
        1e-6, 1e-3);
    for (int k = 0; k < 10; k++) {
        step();
    }
    ck_assert(e.at_jump);
    ck_assert_int_eq(dalcs_euler_cross(&e), DALCS_OK);
    ck_assert_double_eq(value(DALCS_LABEL_NODE, "a"), 1.0);
    ck_assert_double_eq(value(DALCS_LABEL_NODE, "b"), 0.0);
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "x"), 0.0, 1e-12);
    step();
    ck_assert(e.at_jump);
    ck_assert_double_eq_tol(e.t, 10e-6, 2e-19 + 1e-19);
    ck_assert_int_eq(dalcs_euler_cross(&e), DALCS_OK);
    ck_assert_double_eq(value(DALCS_LABEL_NODE, "b"), 2.0);
    finish();
}

END_TEST

/* A source commands the switch with hysteresis: on above 1.5 V, off below 0.5 V. */
START_TEST(test_switch) {
    start("switch\nV1 a 0 9\nS1 a b c 0 sm\nR1 b 0 3\nVc c 0 PWL(0 0 1m 2 2m 0)\nRc c 0 1\n"
          ".model sm SW(Ron=0 Vt=1 Vh=0.5)\n.tran 100u 2m uic\n",
          1e-4, 2e-3);
    for (int k = 1; k <= 20; k++) {
        step();
        double control = k <= 10 ? 0.2 * k : 4.0 - 0.2 * k;
        bool is_on = k <= 10 ? control > 1.5 + 1e-9 : control > 0.5 - 1e-9;
        ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "b"), is_on ? 9.0 : 0.0, 1e-14);
    }
    finish();
}

END_TEST

/* What cannot be solved names the component and its time. */
START_TEST(test_failure) {
    start("refused at 5.5 steps\nV2 z 0 1\nR2 z 0 1\nV1 a 0 PWL(0 -1 110u 1)\nD1 a 0\nR1 a 0 1\n"
          ".tran 10u 1m uic\n",
          1e-5, 1e-3);
    for (int k = 0; k < 5; k++) {
        step();
    }
    ck_assert_int_eq(dalcs_euler_step(&e), DALCS_INFEASIBLE);
    ck_assert_int_eq(e.failure.system, 1);
    ck_assert_double_eq_tol(e.failure.time, 6e-5, 1e-18);
    ck_assert_int_eq(e.steps, 5);
    finish();
}

END_TEST

RUN_TESTS("euler", test_rc, test_lc, test_freewheel, test_inconsistent_start, test_flux,
          test_operating_point, test_edge, test_next_edge_near, test_switch, test_failure)
