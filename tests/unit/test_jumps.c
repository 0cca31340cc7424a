/* test_jumps.c - jumps without a step: closed forms, one for each kind of element that takes part. */
#include "jumps.h"

#include "build_network.h"

#include <stdio.h>

enum { MOST = 16 };

static struct text_network t;
static struct dalcs_jumps jumps;
static struct dalcs_jump_answer answer;
static double after[MOST], charge[MOST], flux[MOST];
static uint64_t mode;
static double inputs[MOST];

/* The jump of the first system from its IC=, all diodes guessed open. inputs[] and mode are set before. */
static void jump(const char *text) {
    build_good_network(&t, text);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    const struct dalcs_system *s = &t.network.system[0];
    ck_assert_int_le(s->n_x, MOST);
    ck_assert_int_le(s->n_pairs, MOST);
    answer = (struct dalcs_jump_answer){.after = after, .charge = charge, .flux = flux};
    inputs[0] = 1.0;
    for (int i = 1; i < s->n_inputs; i++) {
        inputs[i] = dalcs_stimulus_value(&t.circuit.stimulus[s->stimulus[i]], 0.0, DALCS_RIGHT);
    }
    ck_assert_int_eq(dalcs_jumps_build(&jumps, &t.circuit, &t.network, &options), DALCS_OK);
    ck_assert_int_eq(dalcs_jumps_solve(&jumps, 0, &mode, t.network.initial[0], inputs, &answer),
                     DALCS_OK);
}

static void finish(void) {
    dalcs_jumps_finish(&jumps);
    text_network_finish(&t);
    mode = 0;
}

static double state(const char *name) {
    return after[find_column(&t.network.system[0], DALCS_LABEL_STATE, name)];
}

static int pair(const char *name) {
    return find_pair(&t.network.system[0], name);
}

/* 1 uF at 10 V into 3 uF at 2 V: 40 V uF on 4 uF after 6 V uF have passed, less what Vfwd keeps. The
 * resistors and the coil have no time for anything. */
START_TEST(test_charge) {
    jump("t\nC1 1 0 1u IC=10\nD1 1 2 DI\nC2 2 0 3u IC=2\nR1 2 0 1m\nL1 2 3 1n IC=7\nR2 3 0 1\n"
         ".model DI D(Ron=0 Vfwd=2)\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known && answer.moves);
    ck_assert_double_eq_tol(state("c1"), 5.5, 1e-14);
    ck_assert_double_eq_tol(state("c2"), 3.5, 1e-14);
    ck_assert_double_eq(state("l1"), 7.0);
    ck_assert_double_eq_tol(charge[pair("d1")], 4.5e-6, 1e-20);
    ck_assert_double_eq(flux[pair("d1")], 0.0);
    ck_assert_double_eq(answer.source_work, 0.0);
    finish();
}

END_TEST

/* A diode with resistance lets no charge pass in no time. */
START_TEST(test_resistance) {
    jump("t\nC1 1 0 1u IC=10\nD1 1 2 DR\nC2 2 0 3u IC=2\n.model DR D(Ron=1u)\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known && !answer.moves);
    ck_assert_double_eq(state("c1"), 10.0);
    ck_assert_double_eq(charge[pair("d1")], 0.0);
    finish();
}

END_TEST

/* 12 V over 1 uF in series with 2 uF: 8 uC, and 96 uJ from the source, half of them lost. */
START_TEST(test_source) {
    jump("t\nV1 1 0 12\nC1 1 2 1u\nC2 2 0 2u\nR1 2 0 1\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known && answer.moves);
    ck_assert_double_eq_tol(state("c1"), 8.0, 1e-14);
    ck_assert_double_eq_tol(state("c2"), 4.0, 1e-14);
    ck_assert_double_eq_tol(answer.source_work, 96e-6, 1e-19);
    finish();
    static const char *const formula[] = {"V=12", "V=15-3", "V=12*v(3)", "V=11+v(3)+5*time"};
    for (int k = 0; k < 4; k++) {
        char text[200];
        snprintf(
            text, sizeof text,
            "t\nB1 1 0 %s\nV3 3 0 1\nR3 3 0 1\nC1 1 2 1u\nC2 2 0 2u\nR1 2 0 1\n.tran 1u 1m uic\n",
            formula[k]);
        jump(text);
        ck_assert(answer.is_known && answer.moves);
        ck_assert_double_eq_tol(state("c2"), 4.0, 1e-14);
        ck_assert_double_eq_tol(answer.source_work, 96e-6, 1e-19);
        finish();
    }
}

END_TEST

/* A Zener voltage: the breakdown branch is a pair of its own. */
START_TEST(test_breakdown) {
    jump("t\nC1 1 0 1u IC=9\nC2 2 0 1u IC=1\nD1 2 1 DZ\n.model DZ D(Ron=0 Vrev=4)\n"
         ".tran 1u 1m uic\n");
    ck_assert_double_eq_tol(state("c1"), 7.0, 1e-14);
    ck_assert_double_eq_tol(state("c2"), 3.0, 1e-14);
    ck_assert_double_eq(charge[pair("d1")], 0.0);
    ck_assert_double_eq_tol(charge[pair("d1") + 1], 2e-6, 1e-20);
    finish();
}

END_TEST

/* 3 A in 1 mH against nothing but a diode and 2 mH the other way: the currents become one, 2 A, and the
 * fluxes of both coils meet. With a source of 1 A at the node, one more. */
START_TEST(test_flux) {
    jump("t\nL1 0 1 1m IC=3\nD1 1 0 DI\nL2 1 0 2m IC=4.5\nR1 1 2 5\nC1 2 0 1u IC=3\n"
         ".model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known && !answer.moves); /* the capacitor lets it pass */
    finish();
    jump("t\nL1 0 1 1m IC=3\nD1 1 0 DI\nL2 1 0 2m IC=4.5\n.model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known && answer.moves);
    ck_assert_double_eq_tol(state("l1"), 4.0, 1e-14);
    ck_assert_double_eq_tol(state("l2"), 4.0, 1e-14);
    ck_assert_double_eq_tol(flux[pair("d1")], 1e-3, 1e-17);
    ck_assert_double_eq(charge[pair("d1")], 0.0);
    finish();
    jump("t\nL1 0 1 1m IC=3\nI1 0 1 1\nD1 1 0 DI\nL2 1 0 2m IC=5.5\n.model DI D(Ron=0)\n"
         ".tran 1u 1m uic\n");
    ck_assert_double_eq_tol(state("l1"), 4.0, 1e-14);
    ck_assert_double_eq_tol(state("l2"), 5.0, 1e-14);
    ck_assert_double_eq_tol(flux[pair("d1")], 1e-3, 1e-17);
    ck_assert_double_eq_tol(answer.source_work, -1e-3, 1e-17); /* at -1 mWb across 1 A */
    finish();
    jump("t\nL1 0 1 1m IC=3\nB1 0 1 I=1+time\nD1 1 0 DI\nB2 2 0 V=7\nL2 1 2 2m IC=5.5\n"
         ".model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert_double_eq_tol(state("l2"), 5.0, 1e-14);
    ck_assert_double_eq_tol(answer.source_work, -1e-3, 1e-17);
    finish();
}

END_TEST

/* An opened switch: the coil's current stops. With a leak it goes on, whatever the voltage. */
START_TEST(test_switch) {
    jump("t\nV1 1 0 10\nL1 1 2 2m IC=3\nS1 2 0 g 0 SI\nVg g 0 0\n.model SI SW(vt=1 ron=0)\n"
         ".tran 1u 1m uic\n");
    ck_assert_double_eq(state("l1"), 0.0);
    ck_assert_double_eq_tol(fabs(flux[pair("s1")]), 6e-3, 1e-16);
    finish();
    mode = 1;
    jump("t\nV1 1 0 10\nL1 1 2 2m IC=3\nS1 2 0 g 0 SI\nVg g 0 0\n.model SI SW(vt=1 ron=0)\n"
         ".tran 1u 1m uic\n");
    ck_assert(!answer.moves);
    finish();
    jump("t\nV1 1 0 10\nL1 1 2 2m IC=3\nS1 2 0 g 0 SL\nVg g 0 0\n.model SL SW(vt=1 ron=0 roff=1g)\n"
         ".tran 1u 1m uic\n");
    ck_assert(answer.is_known && !answer.moves);
    finish();
}

END_TEST

/* 2 mH and 2 mH with k = 1/2, the first forced to 0: the flux of the second stays, 2 A + 1/2 of 4 A. */
START_TEST(test_coupling) {
    jump(
        "t\nL1 1 0 2m IC=4\nL2 2 0 2m IC=2\nK1 L1 L2 0.5\nD1 1 0 DI\nR2 2 0 1\n.model DI D(Ron=0)\n"
        ".tran 1u 1m uic\n");
    ck_assert(answer.is_known && answer.moves);
    ck_assert_double_eq_tol(state("l1"), 0.0, 1e-14);
    ck_assert_double_eq_tol(state("l2"), 4.0, 1e-14);
    finish();
}

END_TEST

/* 1 : 2, perfect: 8 V on 1 uF asks for 16 V at the other side, where 1 uF has 4 V. q there is 2 q here:
 * 2 (8 V - 2 q / 1 uF) = 4 V + q / 1 uF, q = 2.4 uC. The magnetising current stays. */
START_TEST(test_transformer) {
    jump("t\nC1 1 0 1u IC=8\nL1 1 0 1m IC=0.5\nL2 2 0 4m\nK1 L1 L2 1\nD1 2 3 DI\nC2 3 0 1u IC=4\n"
         "R3 3 0 1k\n.model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known && answer.moves);
    ck_assert_double_eq_tol(charge[pair("d1")], 2.4e-6, 1e-20);
    ck_assert_double_eq_tol(state("c1"), 3.2, 1e-14);
    ck_assert_double_eq_tol(state("c2"), 6.4, 1e-14);
    ck_assert_double_eq(state("l1"), 0.5);
    finish();
    /* Its current goes on at the other side, unless a diode is in the way there, too. */
    jump("t\nL1 1 0 1m IC=3\nL2 2 0 4m\nK1 L1 L2 1\nD1 1 0 DI\nD2 0 2 DI\n.model DI D(Ron=0)\n"
         ".tran 1u 1m uic\n");
    ck_assert(answer.is_known && !answer.moves);
    finish();
    jump("t\nL1 1 0 1m IC=3\nL2 2 0 4m\nK1 L1 L2 1\nD1 1 0 DI\nD2 2 0 DI\n.model DI D(Ron=0)\n"
         ".tran 1u 1m uic\n");
    ck_assert(answer.is_known && answer.moves);
    ck_assert_double_eq_tol(state("l1"), 0.0, 1e-14);
    ck_assert_double_eq_tol(flux[pair("d1")], 3e-3, 1e-17);
    ck_assert_double_eq_tol(flux[pair("d2")], 6e-3, 1e-17);
    finish();
}

END_TEST

/* A source that only reads takes no part in a jump: charge goes from 10 V of 1 uF to 2 V of 3 uF until both have 4 V. */
START_TEST(test_readers) {
    static const char *const reader[] = {"E1 3 0 2 0 2\nR1 3 0 1\n", "G1 3 0 2 0 2\nR1 3 0 1\n",
                                         "B1 3 0 V=abs(v(1))-v(2)\nR1 3 0 1\n",
                                         "V0 1 a\nF1 3 0 V0 2\nR1 3 0 1\n"};
    for (size_t k = 0; k < sizeof(reader) / sizeof(*reader); k++) {
        char text[512];
        snprintf(text, sizeof(text),
                 "t\nC1 1 0 1u IC=10\nD1 %s 2 DI\nC2 2 0 3u IC=2\n%s.model DI D(Ron=0)\n"
                 ".tran 1u 1m uic\n",
                 k == 3 ? "a" : "1", reader[k]);
        jump(text);
        ck_assert(answer.is_known && answer.moves);
        ck_assert_double_eq_tol(state("c1"), 4.0, 1e-14);
        ck_assert_double_eq_tol(state("c2"), 4.0, 1e-14);
        ck_assert_double_eq_tol(charge[pair("d1")], 6e-6, 1e-20);
        finish();
    }
}

END_TEST

/* What acts on states and is not passive is said not to be known, and so are three coils that are two. */
START_TEST(test_not_covered) {
    jump("t\nC1 1 0 1u IC=10\nD1 1 2 DI\nC2 2 0 3u IC=2\nE1 3 0 2 0 2\nR1 3 2 1\n"
         ".model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert(!answer.is_known);
    finish();
    jump("t\nC1 1 0 1u IC=10\nD1 1 2 DI\nC2 2 0 3u IC=2\nE1 3 0 2 0 2\nR1 3 4 1\nC3 4 0 1u\n"
         ".model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert(!answer.is_known);
    finish();
    jump("t\nL1 1 0 1m IC=1\nL2 2 0 1m\nL3 3 0 1m\nK12 L1 L2 0.5\nK13 L1 L3 0.5\nK23 L2 L3 -0.5\n"
         "D1 1 0 DI\nR2 2 0 1\nR3 3 0 1\n.model DI D(Ron=0)\n.tran 1u 1m uic\n");
    ck_assert(!answer.is_known);
    finish();
}

END_TEST

/* Nothing has to move, but thirteen diodes, most of them between nodes without a capacitor, leave much open, and
 * beside 1 uF the proximal iteration for 10 nF takes for ever: the singular modes are answered exactly. */
START_TEST(test_far_apart) {
    jump("t\nL8 n6 n9 10u\nD9 n6 n10\nR10 n9 n11 0.1\nD18 n15 n19\nD19 n19 n20\nD20 n20 n21\n"
         "R21 n21 n22 100\nD22 n23 n21\nC27 n1 0 10n IC=0\nC28 n2 0 1u IC=1\nD38 0 n16\n"
         "D39 n21 n19\nD42 n25 n1\nD43 n1 n20\nD44 n2 n10\nD45 n21 n10\nD47 n23 n10\nD48 n1 n20\n"
         "C50 n23 n16 10n IC=0\nC51 n22 n4 1u IC=0\n.tran 1u 1m uic\n");
    ck_assert(answer.is_known);
    ck_assert_double_eq_tol(state("c27"), 0.0, 1e-12);
    ck_assert_double_eq_tol(state("c28"), 1.0, 1e-12);
    ck_assert_double_eq_tol(state("c50"), 0.0, 1e-12);
    finish();
}

END_TEST

/* A thyristor opens where its diode ends the current. In networks of impulses it is commanded: the resistors before it are not
 * there, and its diode has another place, or none. */
START_TEST(test_valve) {
    build_good_network(
        &t, "t\nV1 1 0 1\nR1 1 2 1\nR2 2 3 1\nR3 3 4 1\nC1 4 0 1u\nR4 4 5 1\nA1 5 6 7 scr\n"
            "L1 6 8 1m\nR5 8 0 1\nVg 7 6 0\n.model scr thyristor\n.tran 1u 1m uic\n");
    for (int kind = 0; kind < 2; kind++) {
        struct dalcs_impulse_network impulse;
        ck_assert_int_eq(
            dalcs_impulse_network_build(&impulse, &t.circuit,
                                        kind == 0 ? DALCS_IMPULSE_CHARGE : DALCS_IMPULSE_FLUX),
            DALCS_OK);
        for (int i = 0; i < impulse.circuit.n_devices; i++) {
            ck_assert_int_lt(impulse.circuit.device[i].valve, 0);
        }
        dalcs_impulse_network_finish(&impulse);
    }
    text_network_finish(&t);
}

END_TEST

RUN_TESTS("jumps", test_charge, test_resistance, test_source, test_breakdown, test_flux,
          test_switch, test_coupling, test_transformer, test_readers, test_not_covered,
          test_far_apart, test_valve)
