/* test_osnsp.c - finding the mode: warm starts, pivots, commands, least-norm answers. */
#include "osnsp.h"

#include "build_network.h"

#include <stdio.h>

static struct text_network t;
static struct dalcs_osnsp p;
static const struct dalcs_system *s;
static double u[64], y[256];

static void setup(const char *text) {
    build_good_network(&t, text);
    s = &t.network.system[0];
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_osnsp_setup(&p, s, &options), DALCS_OK);
    text_network_inputs(&t, 0, u);
}

static void finish(void) {
    dalcs_osnsp_finish(&p);
    text_network_finish(&t);
}

static void solve(double sigma) {
    ck_assert_int_eq(dalcs_osnsp_solve(&p, sigma, u, y), DALCS_OK);
    ck_assert_double_le(p.certificate.worst, p.options.certificate_tolerance);
}

static double voltage(const char *node) {
    return y[find_column(s, DALCS_LABEL_NODE, node)];
}

static double current(const char *element) {
    return y[dalcs_system_n_equations(s) + find_pair(s, element)];
}

static const char bridge[] = "bridge with a resistor\nV1 a b 3\nR0 b 0 1\nD1 a p\nD2 b p\nD3 m a\n"
                             "D4 m b\nR1 p m 1k\nC1 p m 1u\n.tran 1u 1m\n";

/* The answer, and that a mode which comes again costs neither factors nor pivots. */
START_TEST(test_recurring) {
    setup(bridge);
    long after_two = 0;
    long pivots = 0;
    double h = 1e-5;
    for (int step = 0; step < 200; step++) {
        u[s->n_x + 1] = step / 10 % 2 == 0 ? 3.0 : -3.0;
        long before = p.counters.pivots;
        solve(1.0 / h);
        /* The side that is fed conducts: full rectification, to rounding. */
        ck_assert_double_eq_tol(voltage("p") - voltage("m"), 3.0, 1e-14);
        ck_assert(dalcs_osnsp_is_on(&p, 0) == (step / 10 % 2 == 0));
        if (step % 10 != 0) {
            ck_assert_int_eq(p.counters.pivots, before);
        }
        if (step == 40) {
            after_two = p.counters.factorizations;
            pivots = p.counters.pivots;
        }
        memcpy(u, y, (size_t)s->n_x * sizeof(*u));
    }
    ck_assert_int_eq(p.counters.factorizations, after_two);
    ck_assert_int_le(p.counters.pivots - pivots, 16 * 4);
    ck_assert_int_eq(p.counters.solved, 200);
    finish();
}

END_TEST

/* Twenty diodes onto a common resistor, from any of 2^20 starts: found in a few changes of many
 * diodes at a time, not diode by diode. */
START_TEST(test_pivoting) {
    char text[4096] = "diode or\nR0 c 0 1\n";
    for (int k = 1; k <= 20; k++) {
        char line[128];
        snprintf(line, sizeof(line), "V%d s%d 0 %d\nR%d s%d a%d %d\nD%d a%d c\n", k, k, 5 * k % 21,
                 k, k, k, k, k, k);
        strcat(text, line);
    }
    strcat(text, ".op\n");
    setup(text);
    solve(0.0);
    double first[256];
    memcpy(first, y, sizeof(first));
    uint64_t answer = p.mode[0];
    for (uint64_t start = 0; start < (1u << 20); start = 3 * start + 1) {
        p.mode[0] = start & 0xfffff;
        long before = p.counters.pivots;
        solve(0.0);
        ck_assert_int_le(p.counters.pivots - before, 4);
        ck_assert_uint_eq(p.mode[0], answer);
        for (int c = 0; c < dalcs_system_n_columns(s); c++) {
            ck_assert_double_eq_tol(y[c], first[c], 1e-12 * 20.0);
        }
    }
    finish();
}

END_TEST

/* Switches are commanded: pivoting leaves them alone, whatever their signs. */
START_TEST(test_commands) {
    setup("switch\nV1 a 0 -2\nR1 a b 1\nS1 b 0 c 0 sm\nVc c 0 0\nRc c 0 1\nD1 b d\nR2 d 0 3\n"
          ".model sm SW(Ron=0)\n.op\n");
    int s1 = find_pair(s, "s1");
    dalcs_osnsp_command(&p, s1, true);
    solve(0.0);
    ck_assert(dalcs_osnsp_is_on(&p, s1));
    ck_assert_double_eq_tol(current("s1"), -2.0, 1e-14);
    dalcs_osnsp_command(&p, s1, false);
    solve(0.0);
    ck_assert(!dalcs_osnsp_is_on(&p, s1));
    ck_assert_double_eq_tol(voltage("b"), -2.0, 1e-14);
    ck_assert_double_eq(current("s1"), 0.0);
    finish();
}

END_TEST

/* Where the answer is not unique: the limit of equal small resistances, not some answer. The share
 * of each is good to about the proximal weight, 1e-8; what is unique, to rounding. */
START_TEST(test_least_norm) {
    setup("two diodes side by side\n"
          "I1 0 a 3\nD1 a b\nD2 a b\nR1 b 0 1\n.op\n");
    for (int k = 0; k < 8; k++) { /* by iteration, then by the map that replaces it */
        solve(0.0);
        ck_assert(p.least_norm);
        ck_assert_double_eq_tol(current("d1"), 1.5, 1e-7);
        ck_assert_double_eq_tol(current("d2"), 1.5, 1e-7);
        ck_assert_double_eq_tol(voltage("b"), 3.0, 1e-12);
    }
    ck_assert_int_eq(p.counters.singular, 8);
    finish();
}

END_TEST

/* sigma = 0 is another problem than a step: the capacitor is open, the coil a short. */
START_TEST(test_operating_point) {
    setup("op\nV1 a 0 6\nR1 a b 2\nL1 b c 1m IC=9\nR2 c 0 1\nC1 c 0 1u IC=9\n.tran 1u 1m uic\n");
    solve(0.0);
    ck_assert_double_eq_tol(voltage("c"), 2.0, 1e-14);
    solve(1e12);
    ck_assert_double_eq_tol(voltage("c"), 9.0, 1e-4); /* t / (R C) = 1e-6 */
    solve(0.0);
    ck_assert_double_eq_tol(voltage("c"), 2.0, 1e-14);
    finish();
}

END_TEST

/* Same input, same bits, whatever was solved before. */
START_TEST(test_same_bits) {
    setup(bridge);
    double first[256];
    for (int k = 0; k < 12; k++) {
        u[s->n_x + 1] = 3.0;
        u[0] = 1.0;
        solve(1e5);
        if (k == 6) { /* from here on by the dense map of the recurring mode */
            memcpy(first, y, sizeof(first));
        }
        ck_assert(k <= 6 ||
                  memcmp(first, y, (size_t)dalcs_system_n_columns(s) * sizeof(double)) == 0);
    }
    finish();
}

END_TEST

/* A large capacitor fills a tiny one, between others: the charge is the small change of a large
 * charge, which the residual of KCL does not see. */
START_TEST(test_refines) {
    static const double capacitance[10] = {867e-6,   5.88e-12, 46.8e-6,  4.04e-9, 381e-12,
                                           3.75e-12, 146e-9,   1.34e-12, 720e-9,  11.1e-12};
    static const double before[10] = {1.94, -0.799, 8.38,  -2.27, -2.1,
                                      1.98, -6.55,  -1.05, -6.15, -5.09};
    char text[1024] = "ladder\n";
    for (int k = 0; k < 10; k++) {
        char line[64];
        snprintf(line, sizeof(line), "C%d %d 0 %.17g\n", k, k + 1, capacitance[k]);
        strcat(text, line);
        if (k > 0) {
            snprintf(line, sizeof(line), "D%d %d %d\n", k, k, k + 1);
            strcat(text, line);
        }
    }
    strcat(text, ".tran 1u 1m uic\n");
    setup(text);
    memcpy(u, before, sizeof(before));
    p.asks.refines = true;
    for (int times = 0; times < 6; times++) { /* not by a map either */
        solve(1.0);
        double charge = (before[0] - before[1]) / (1.0 / capacitance[0] + 1.0 / capacitance[1]);
        ck_assert_double_eq_tol(current("d1"), charge, 1e-12 * charge);
        ck_assert_double_eq(current("d2"), 0.0);
    }
    finish();
}

END_TEST

/* A flyback that has run empty: its coils, coupled by 0.9999, carry 50 uA through the open switch, which is what
 * is left of 6 S between their voltages. The primary and the leak alone are left of the equations. */
START_TEST(test_coupled_coils) {
    const double L = 25e-6;
    const double sigma = 33554432.0;
    const double before = 1.0378889097053092e-4;
    setup("flyback\nVin in 0 48\nVg g 0 PULSE(0 1 1 0 0 1 2)\nS1 d 0 g 0 SW\n"
          ".model SW SW(Vt=0.5 Ron=10m Roff=1Meg)\n.model DX D(Vfwd=0.5 Ron=36m)\nL0 in d 25u\nL1 "
          "0 a 25u\n"
          "D1 a o DX\nC1 o 0 100u\nR1 o 0 10\nK1 L1 L0 0.9999\n.tran 1u 1m\n");
    for (int x = 0; x < s->n_x; x++) {
        bool is_primary = strcmp(s->column[x].element, "l0") == 0;
        u[x] = !s->column_is_current[x] ? 55.284329609691632 : is_primary ? before : 0.0;
    }
    solve(sigma);
    double i = (48.0 + sigma * L * before) / (sigma * L + 1e6);
    ck_assert_double_eq_tol(voltage("d") / (1e6 * i), 1.0, 1e-12);
    for (int x = 0; x < s->n_x; x++) {
        if (s->column_is_current[x]) {
            double expected = strcmp(s->column[x].element, "l0") == 0 ? i : 0.0;
            ck_assert_double_eq_tol(y[x], expected, 1e-12 * i);
        }
    }
    finish();
}

END_TEST

RUN_TESTS("osnsp", test_recurring, test_pivoting, test_commands, test_least_norm,
          test_operating_point, test_same_bits, test_refines, test_coupled_coils)
