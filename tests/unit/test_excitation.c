/* test_excitation.c - functions times coefficients against the sources themselves. */
#include "excitation.h"

#include "build_network.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

static struct text_network t;
static struct dalcs_excitation x;

static void start(const char *text) {
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_excitation_setup(&x, &t.circuit, &t.network.system[0], NULL), DALCS_OK);
}

static void finish(void) {
    dalcs_excitation_finish(&x);
    text_network_finish(&t);
}

static int input_named(const char *name) {
    const struct dalcs_system *s = &t.network.system[0];
    for (int k = 1; k < s->n_inputs; k++) {
        if (strcmp(s->input_element[k], name) == 0) {
            return k;
        }
    }
    ck_abort_msg("no input %s", name);
    return -1;
}

static const struct dalcs_excitation_wave *wave_named(const char *name) {
    for (int w = 0; w < x.n_waves; w++) {
        if (x.wave[w].input == input_named(name)) {
            return &x.wave[w];
        }
    }
    return NULL;
}

static void check_near(double a, double b, double tolerance) {
    ck_assert_msg(fabs(a - b) <= tolerance, "%.17g is not %.17g", a, b);
}

/* A step from `at` of length h, all within the present pieces, against the sources. */
static void check_step(double at, double h) {
    const struct dalcs_system *s = &t.network.system[0];
    double coefficient[200];
    double input[10];
    dalcs_excitation_coefficients(&x, at, h, coefficient);
    for (int k = 0; k <= 8; k++) {
        double theta = k / 8.0;
        enum dalcs_side side = k == 0 ? DALCS_RIGHT : DALCS_LEFT;
        dalcs_excitation_inputs(&x, at, theta * h, input);
        ck_assert_double_eq(input[0], 1.0);
        for (int w = 0; w < x.n_waves; w++) {
            const struct dalcs_excitation_wave *wave = &x.wave[w];
            const struct dalcs_stimulus *stimulus = &t.circuit.stimulus[s->stimulus[wave->input]];
            double expected = dalcs_stimulus_value(stimulus, at + theta * h, side);
            double sum = 0.0;
            for (int f = wave->first; f < wave->first + wave->n_functions; f++) {
                ck_assert_int_eq(x.function[f].input, wave->input);
                sum += coefficient[f] * dalcs_excitation_function_at(&x.function[f], h, theta);
            }
            check_near(sum, expected, 1e-12);
            check_near(input[wave->input], expected, 1e-12);
        }
    }
}

/* Sources of all kinds around one capacitor. */
static const char ALL[] = "all kinds\n"
                          "V1 a 0 PULSE(-1 2 0.25 0.5 0.25 1 3)\nR1 a o 1\n"
                          "V2 b 0 SIN(1 2 0.3 0.75 0.2 40)\nR2 b o 2\n"
                          "V3 c 0 PWL(0 1 1 1 1 2 3 -1 4 0)\nR3 c o 3\n"
                          "V4 d 0 EXP(0 2 0.5 0.4 1.5 0.7)\nR4 d o 4\n"
                          "V5 e 0 5\nR5 e o 5\n"
                          "I6 0 o SIN(0 1 2)\n"
                          "C1 o 0 1\n.tran 1 10\n";

/* Those that end, repeat or are modulated. */
static const char MODULATED[] = "modulated\n"
                                "V1 a 0 PULSE(-1 2 0.25 0.5 0.25 1 3 2)\nR1 a o 1\n"
                                "V2 b 0 SIN(1 2 0.3 0.75 0.2 40 1.7)\nR2 b o 2\n"
                                "V3 c 0 PWL(0 1 1 1 1 2 3 -1) r=1\nR3 c o 3\n"
                                "V4 d 0 AM(2 1.5 0.2 1 0.5)\nR4 d o 4\n"
                                "V5 e 0 SFFM(1 2 0.5 -1.5 0.2 30 50)\nR5 e o 5\n"
                                "C1 o 0 1\n.tran 1 10\n";

/* Every step between edges, whole and in parts; returns the number of edges. */
static int check_steps(void) {
    double at = 0.0;
    int n_edges = 0;
    while (at < 10.0) {
        double end = fmin(x.next_edge, 10.0);
        ck_assert(end > at);
        check_step(at, end - at);
        check_step(at, 0.3 * (end - at));
        check_step(at + 0.4 * (end - at), 0.6 * (end - at));
        at = end;
        dalcs_excitation_enter(&x, at);
        n_edges++;
    }
    return n_edges;
}

START_TEST(test_all_kinds) {
    start(ALL);
    ck_assert_int_eq(x.n_waves, 5);
    ck_assert(x.is_curved);
    check_near(x.shortest_period, 0.5, 1e-15);
    ck_assert_int_gt(check_steps(), 15);
    const double at = 10.0;
    const int dc = input_named("v5");
    ck_assert_double_eq(x.constant[dc], 5.0);
    ck_assert_double_eq(x.constant[0], 1.0);
    ck_assert_double_eq(x.constant[input_named("v1")], 0.0);
    double input[10];
    dalcs_excitation_inputs(&x, at, 0.0, input);
    ck_assert_double_eq(input[dc], 5.0);
    finish();
}

END_TEST

START_TEST(test_modulated) {
    start(MODULATED);
    ck_assert_int_eq(x.n_waves, 5);
    ck_assert_int_eq(wave_named("v4")->n_functions, 7);
    ck_assert_int_gt(wave_named("v5")->n_functions, 40);
    ck_assert_int_gt(check_steps(), 15);
    finish();
}

END_TEST

/* Micro-steps look a little ahead: a ramp goes on over its end. */
START_TEST(test_over_edges) {
    start("over\nV1 a 0 PULSE(0 4 1 2 0 1 9)\nR1 a o 1\nV2 b 0 SIN(0 1 0.25 2)\nR2 b o 1\n"
          "C1 o 0 1\n.tran 1 10\n");
    double input[3];
    dalcs_excitation_enter(&x, 1.0);
    ck_assert_double_eq(x.next_edge, 2.0);
    dalcs_excitation_inputs(&x, 1.5, 2.0, input);
    check_near(input[input_named("v1")], 5.0, 1e-14);
    check_near(input[input_named("v2")], 0.0, 0.0);
    finish();
}

END_TEST

START_TEST(test_left_out) {
    /* A gate driver only commands, along a curve, too; one that feeds the circuit besides is a wave. */
    start("gates\nV1 in 0 1\nS1 in o g 0 sm\nS2 in o h 0 sm\nS3 in o k 0 sm\n.model sm SW(Vt=0.5)\n"
          "Vg g 0 PULSE(0 1 0 0 0 1 2)\nRg g 0 1\nVh h 0 SIN(0 1 1)\nRh h 0 1\n"
          "Vk k 0 PULSE(0 1 0 0 0 1 2)\nRk k o 1k\nC1 o 0 1\nR1 o 0 1\n.tran 1 10\n");
    ck_assert_ptr_null(wave_named("vg"));
    ck_assert_ptr_null(wave_named("vh"));
    ck_assert_ptr_nonnull(wave_named("vk"));
    ck_assert_int_eq(wave_named("vk")->n_functions, 2);
    ck_assert_int_eq(x.n_waves, 1);
    finish();
    /* Constants of every kind make no wave, and without waves nothing ends. */
    start("constant\nV1 a 0 1\nR1 a o 1\nC1 o 0 1\n.tran 1 10\n");
    ck_assert(x.n_waves == 0 && !x.is_curved && isinf(x.next_edge) && isinf(x.shortest_period));
    finish();
}

END_TEST

/* A level that is 0 at all times is no function; one before a delay or behind the last cycle is. */
START_TEST(test_levels) {
    start("levels\nV1 a 0 SIN(0 1 2)\nR1 a o 1\nV2 b 0 SIN(1 1 2)\nR2 b o 1\n"
          "V3 c 0 SIN(0 1 2 3)\nR3 c o 1\nC1 o 0 1\n.tran 1 10\n");
    ck_assert_int_eq(wave_named("v1")->n_functions, 2);
    ck_assert_int_eq(wave_named("v2")->n_functions, 3);
    ck_assert_int_eq(wave_named("v3")->n_functions, 3);
    ck_assert_int_gt(check_steps(), 0);
    finish();
}

END_TEST

RUN_TESTS("excitation", test_all_kinds, test_modulated, test_over_edges, test_left_out, test_levels)
