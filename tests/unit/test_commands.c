/* test_commands.c - when sources move switches: known times, and random pulses against a walk along
 * their edges that knows nothing of periods. */
#include "commands.h"

#include "build_network.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

static struct text_network t;
static struct dalcs_commands c;

/* A switch between a source and a resistor; the card of Vg, between g and z, and what else there is. */
static void start(const char *vg, const char *others) {
    char text[1000];
    snprintf(text, sizeof text,
             "command\nV1 in 0 1\nS1 in out g 0 sm\nR1 out 0 1\nRg g 0 1k\nVg g z %s\n%s\n"
             ".tran 1 1\n",
             vg, others);
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_commands_setup(&c, &t.circuit, &t.network.system[0]), DALCS_OK);
    dalcs_commands_start(&c);
}

static void finish(void) {
    dalcs_commands_finish(&c);
    text_network_finish(&t);
}

/* The next move of the only command, INFINITY if it comes after `stop`. */
static double next_move(double stop) {
    double before = 0.0;
    while (c.next <= stop) {
        double at = c.next;
        bool was_on = c.command[0].is_on;
        ck_assert(at >= before);
        before = at;
        bool moved = dalcs_commands_obey(&c, at);
        ck_assert(moved == (c.command[0].is_on != was_on));
        ck_assert(c.next > at);
        if (moved) {
            return at;
        }
    }
    return INFINITY;
}

static void check_moves(const char *vg, const char *others, bool is_on, size_t n,
                        const double *time) {
    start(vg, others);
    ck_assert_int_eq(c.n, 1);
    ck_assert(c.command[0].is_on == is_on);
    for (size_t k = 0; k < n; k++) {
        double at = next_move(1e3);
        ck_assert_msg(at == time[k] || fabs(at - time[k]) <= 4 * DBL_EPSILON * time[k],
                      "%s, %s: move %zu at %.17g, not at %.17g", vg, others, k, at, time[k]);
        is_on = isinf(time[k]) ? is_on : !is_on;
        ck_assert(c.command[0].is_on == is_on);
    }
    finish();
}

#define CHECK_MOVES(vg, others, is_on, ...)                                                        \
    check_moves(vg, others, is_on, sizeof((const double[]){__VA_ARGS__}) / sizeof(double),         \
                (const double[]){__VA_ARGS__})

static const char HARD[] = "Vz z 0 0\n.model sm SW(Vt=0.5)";
static const char HYSTERESIS[] = "Vz z 0 0\n.model sm SW(Vt=0.5 Vh=0.25)";

START_TEST(test_pulse) {
    CHECK_MOVES("PULSE(0 1 1 0 0 2 5)", HARD, false, 1, 3, 6, 8, 11, 13);
    CHECK_MOVES("PULSE(1 0 1 0 0 2 5)", HARD, true, 1, 3, 6, 8, 11, 13);
    CHECK_MOVES("PULSE(0 1 0 0 0 2 5)", HARD, true, 2, 5, 7, 10);
    CHECK_MOVES("PULSE(1 0 0 0 0 2 5)", HARD, false, 2, 5, 7, 10);
    CHECK_MOVES("PULSE(0 1 1 1 2 2 8)", HARD, false, 1.5, 5, 9.5, 13);
    CHECK_MOVES("PULSE(0 1 1 1 2 2 8)", HYSTERESIS, false, 1.75, 5.5, 9.75, 13.5);
    CHECK_MOVES("PULSE(1 0 1 1 2 2 8)", HYSTERESIS, true, 1.75, 5.5, 9.75, 13.5);
    /* A triangle; a saw tooth; one that began before t = 0, low, high and on a ramp there. */
    CHECK_MOVES("PULSE(0 1 1 1 1 0 4)", HYSTERESIS, false, 1.75, 2.75, 5.75, 6.75);
    CHECK_MOVES("PULSE(0 1 1 1 0 0 4)", HYSTERESIS, false, 1.75, 2, 5.75, 6);
    CHECK_MOVES("PULSE(0 1 -4 0 0 2 5)", HARD, false, 1, 3, 6, 8);
    CHECK_MOVES("PULSE(0 1 -6 0 0 2 5)", HARD, true, 1, 4, 6, 9);
    CHECK_MOVES("PULSE(0 1 -16.25 1 1 2 5)", HYSTERESIS, true, 2.5, 4.5, 7.5);
}

END_TEST

/* Shapes that have no regular pair of moves in a period. */
START_TEST(test_odd_pulses) {
    CHECK_MOVES("PULSE(0 1 1 0 0 2)", HARD, false, 1, 3, INFINITY);
    CHECK_MOVES("PULSE(0 1 1)", HARD, false, 1, INFINITY);
    CHECK_MOVES("PULSE(0 1 0 0 0 0 5)", HARD, false, INFINITY); /* of no width */
    CHECK_MOVES("PULSE(0 1 1 0 0 9 5)", HARD, false, 1, INFINITY);
    CHECK_MOVES("PULSE(0 0.6 1 0 0 2 5)", HYSTERESIS, false, INFINITY); /* closes never */
    CHECK_MOVES("PULSE(0.3 1 1 0 0 2 5)", HYSTERESIS, false, 1, INFINITY);
    CHECK_MOVES("PULSE(0 1 1 2 2 3 5)", HARD, false, 2, 6, 7, 11); /* cut by the next */
}

END_TEST

START_TEST(test_sums) {
    CHECK_MOVES("PULSE(0 1 1 1 2 2 8)", "Vz z 0 0.25\n.model sm SW(Vt=0.75)", false, 1.5, 5, 9.5);
    CHECK_MOVES("PULSE(0 1 1 0 0 2 5)", "Vz z 0 PULSE(0 1 2 0 0 2 10)\n.model sm SW(Vt=0.5)", false,
                1, 4, 6, 8, 11, 14);
    CHECK_MOVES("PULSE(0 1 1 0 0 2 5)", "Vz z 0 PULSE(0 1 2 0 0 2 10)\n.model sm SW(Vt=1.5)", false,
                2, 3, 12, 13);
    CHECK_MOVES("PWL(0 0 4 1 4 0 6 -1 10 1)", HARD, false, 2, 4, 9, INFINITY);
    CHECK_MOVES("PWL(0 1 1 0.5 2 1 3 0.5 4 0.5)", HARD, true, 3, INFINITY); /* touches, and rests */
    CHECK_MOVES("PWL(0 0 1 1 2 0 3 0 4 -1 5 0 6 1)", "Vz z 0 0\n.model sm SW", false, 0, 2, 5);
    CHECK_MOVES("PULSE(0 1 1 1 1 1 5)", "Vz z 0 0\n.model sm SW", false, 1, 4, 6, 9);
    CHECK_MOVES("PULSE(0 1 1 0 0 1 5)", "Vz z 0 0\n.model sm SW", false, 1, 2, 6, 7);
    /* a saw tooth against a level that falls, as of a modulator */
    CHECK_MOVES("PWL(0 0.5 10 0)", "Vz 0 z PULSE(0 1 0 1 0 0 1)\n.model sm SW(Vt=0)", true,
                0.5 / 1.05, 1, 1 + 0.45 / 1.05, 2, 2 + 0.4 / 1.05, 3);
}

END_TEST

/* Sines, an approach, and both with straight lines: closed forms. */
START_TEST(test_curves) {
    CHECK_MOVES("SIN(0 1 1)", HARD, false, 1 / 12.0, 5 / 12.0, 13 / 12.0, 17 / 12.0);
    CHECK_MOVES("SIN(0 1 0.125 0 0 60)", "Vz z 0 0\n.model sm SW(Vt=0 Vh=0.5)", true, 10 / 3.0,
                22 / 3.0, 34 / 3.0);
    CHECK_MOVES("SIN(0 1 1)", "Vz z 0 0\n.model sm SW", false, 0, 0.5, 1, 1.5);
    CHECK_MOVES("SIN(0 0.5 1)", HARD, false, INFINITY); /* touches it at each peak */
    CHECK_MOVES("SIN(0 1 1 0 0 0 1.5)", "Vz z 0 0\n.model sm SW", false, 0, 0.5, 1, 1.5, INFINITY);
    CHECK_MOVES("EXP(0 1 1 2 1e9 1)", HARD, false, 1 + 2 * log(2.0), INFINITY);
    CHECK_MOVES("EXP(1 0 1 2 1e9 1)", HYSTERESIS, true, 1 + 2 * log(4.0), INFINITY);
    CHECK_MOVES("SIN(0 1 1)", "Vz 0 z PULSE(0 1 1 0 0 1 10)\n.model sm SW(Vt=0.5)", false, 1 / 12.0,
                5 / 12.0, 2 + 1 / 12.0, 2 + 5 / 12.0);
    CHECK_MOVES("SIN(0 1 1)", "Vz z 0 PULSE(0 1 1 0 0 1 10)\n.model sm SW(Vt=0.5)", false, 1 / 12.0,
                5 / 12.0, 1, 1 + 7 / 12.0, 1 + 11 / 12.0, 2, 2 + 1 / 12.0);
}

END_TEST

/* A control that the circuit makes has no such schedule. */
START_TEST(test_not_commands) {
    start("PULSE(0 1 1 0 0 2 5)", "Cz z 0 1\n.model sm SW(Vt=0.5)");
    ck_assert_int_eq(c.n, 0);
    finish();
    start("1", HARD); /* never moves */
    ck_assert_int_eq(c.n, 1);
    ck_assert(c.command[0].is_on && isinf(c.next));
    finish();
}

END_TEST

/* ---- Random pulses -------------------------------------------------------------------------- */

static double uniform(uint64_t *random) {
    return 0.5 + 0.5 * next_random(random);
}

/* The same source next to one that is constant, but of a kind that has edges: the general way. */
static const char WALKED[] = "Vz z 0 PWL(0 0 1e9 0)\n.model sm SW(Vt=%.17g Vh=%.17g)";
static const char COUNTED[] = "Vz z 0 0\n.model sm SW(Vt=%.17g Vh=%.17g)";

START_TEST(test_counted_and_walked) {
    enum { N_TRIALS = 40, N_MOVES = 2000 };

    static double time[N_MOVES];
    uint64_t random = 20222;
    for (int trial = 0; trial < N_TRIALS; trial++) {
        double period = pow(10.0, 6.0 * next_random(&random));
        double rise = trial % 3 == 0 ? 0.0 : 0.3 * period * uniform(&random);
        double fall = trial % 5 == 0 ? 0.0 : 0.3 * period * uniform(&random);
        double width = trial % 4 == 1 && rise > 0.0 ? 0.0 : 0.35 * period * uniform(&random);
        double delay = trial % 2 == 0 ? 0.0 : 3.0 * period * next_random(&random);
        double vt = uniform(&random);
        double vh = trial % 7 == 0 ? 0.0 : 0.5 * uniform(&random);
        double low = vt - vh - 0.1 - uniform(&random);
        double high = vt + vh + 0.1 + uniform(&random);
        bool inverse = trial % 2 == 1;
        char vg[200];
        char others[200];
        snprintf(vg, sizeof vg, "PULSE(%.17g %.17g %.17g %.17g %.17g %.17g %.17g)",
                 inverse ? high : low, inverse ? low : high, delay, rise, fall, width, period);
        snprintf(others, sizeof others, WALKED, vt, vh);
        start(vg, others);
        bool starts_on = c.command[0].is_on;
        ck_assert_ptr_null(c.command[0].pulse);
        for (int k = 0; k < N_MOVES; k++) {
            time[k] = next_move(INFINITY);
        }
        finish();
        snprintf(others, sizeof others, COUNTED, vt, vh);
        start(vg, others);
        ck_assert((c.command[0].pulse != NULL) == (delay >= 0.0));
        ck_assert(c.command[0].is_on == starts_on);
        for (int k = 0; k < N_MOVES; k++) {
            double at = next_move(INFINITY);
            ck_assert_msg(fabs(at - time[k]) <= 4 * DBL_EPSILON * at + 1e-15 * period,
                          "%s, %s: move %d at %.17g and %.17g", vg, others, k, at, time[k]);
        }
        finish();
    }
}

END_TEST

/* Adding 0.1 a million times is off by 1e-6. */
START_TEST(test_late) {
    start("PULSE(0 1 0 0.01 0.01 0.04 0.1)", HARD);
    for (int move = 0; move < 1999999; move++) {
        (void)dalcs_commands_obey(&c, c.next);
    }
    ck_assert_double_eq_tol(c.next, 999999 * 0.1 + 0.055, 3e-11);
    finish();
}

END_TEST

/* Two switches in one system, each in its own time; obeying one leaves the other. */
START_TEST(test_two) {
    build_good_network(&t, "two\nV1 in 0 1\nS1 in out g 0 sm\nS2 in out h 0 sm\nR1 out 0 1\n"
                           "Vg g 0 PULSE(0 1 1 0 0 2 4)\nVh h 0 PULSE(0 1 2 0 0 2 4)\n"
                           ".model sm SW(Vt=0.5)\n.tran 1 1\n");
    int at[2] = {-1, -1};
    ck_assert_int_eq(dalcs_commands_setup(&c, &t.circuit, &t.network.system[0]), DALCS_OK);
    ck_assert_int_eq(c.n, 2);
    dalcs_commands_start(&c);
    for (int k = 0; k < 2; k++) {
        at[k] =
            c.command[k].pair == find_pair(&t.network.system[0], k == 0 ? "s1" : "s2") ? k : 1 - k;
    }
    static const bool expected[][2] = {{true, false}, {true, true}, {false, true}, {false, false}};
    for (int k = 1; k < 50; k++) {
        ck_assert_double_eq(c.next, k);
        ck_assert(!dalcs_commands_obey(&c, k - 0.5));
        ck_assert(dalcs_commands_obey(&c, k));
        ck_assert(!dalcs_commands_obey(&c, k));
        for (int i = 0; i < 2; i++) {
            ck_assert(c.command[at[i]].is_on == expected[(k - 1) % 4][i]);
        }
    }
    finish();
}

END_TEST

RUN_TESTS("commands", test_pulse, test_odd_pulses, test_sums, test_curves, test_not_commands,
          test_counted_and_walked, test_late, test_two)
