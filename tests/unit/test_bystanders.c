/* test_bystanders.c - which columns sources alone decide, and what they are. */
#include "bystanders.h"

#include "build_network.h"

#include <math.h>

static struct text_network t;
static struct dalcs_bystanders b;

static void start(const char *text) {
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_bystanders_find(&b, &t.circuit, &t.network.system[0]), DALCS_OK);
}

static void finish(void) {
    dalcs_bystanders_finish(&b);
    text_network_finish(&t);
}

/* The column's value with the sources at 1 V, 10 V, 100 V, ... in the order of the netlist; NaN if it is
 * not found. */
static double value(enum dalcs_label_kind kind, const char *name) {
    const struct dalcs_system *s = &t.network.system[0];
    int column = find_column(s, kind, name);
    ck_assert_int_ge(column, 0);
    for (int i = 0; i < b.n; i++) {
        if (b.column[i] == column) {
            double sum = b.gain[i * s->n_inputs];
            for (int k = 1; k < s->n_inputs; k++) {
                sum += b.gain[i * s->n_inputs + k] * pow(10.0, s->stimulus[k]);
            }
            return sum;
        }
    }
    return NAN;
}

static int n_rows(void) {
    int n = 0;
    for (int r = 0; r < dalcs_system_n_equations(&t.network.system[0]); r++) {
        n += b.row[r] ? 1 : 0;
    }
    return n;
}

#define POWER "V1 in 0 1\nS1 in o g 0 sm\n.model sm SW(Vt=0.5)\nR1 o 0 1\nC1 o 0 1\n"

#define DIVIDED "V1 in 0 1\nS1 in o h 0 sm\n.model sm SW(Vt=0.5)\nR1 o 0 1\nC1 o 0 1\n"

START_TEST(test_gate_driver) {
    start("gate\n" POWER "Vg g 0 PULSE(0 1 0 0 0 1 2)\nRg g 0 4\n.tran 1 1\n");
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "g"), 10.0, 1e-14);
    ck_assert_double_eq_tol(value(DALCS_LABEL_BRANCH, "vg"), -2.5, 1e-14);
    ck_assert(isnan(value(DALCS_LABEL_NODE, "o")));
    ck_assert(isnan(value(DALCS_LABEL_STATE, "c1")));
    ck_assert_int_eq(n_rows(), b.n);
    finish();
}

END_TEST

START_TEST(test_coupled_sources) {
    start("coupled\n" POWER "Vg g z PULSE(0 1 0 0 0 1 2)\nVz z 0 SIN(0 1 1)\nRg g 0 4\nRz z 0 5\n"
          "E1 e 0 g z 3\nRe e 0 1\nF1 0 f Vg 2\nRf f 0 1\n.tran 1 1\n");
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "g"), 110.0, 1e-13);
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "z"), 100.0, 1e-13);
    ck_assert_double_eq_tol(value(DALCS_LABEL_BRANCH, "vg"), -27.5, 1e-13);
    ck_assert_double_eq_tol(value(DALCS_LABEL_BRANCH, "vz"), -47.5, 1e-13);
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "e"), 30.0, 1e-13);
    ck_assert_double_eq_tol(value(DALCS_LABEL_NODE, "f"), -55.0, 1e-13);
    ck_assert_int_eq(n_rows(), b.n);
    finish();
}

END_TEST

/* A state, a pair or the control of a switch that no source fixes by itself: taken part. */
START_TEST(test_involved) {
    static const char *const others[] = {
        "state\n" POWER "Vg g 0 1\nRg g h 4\nCg h 0 1\n.tran 1 1\n",
        "pair\n" POWER "Vg g 0 1\nRg g h 4\nDg h 0\n.tran 1 1\n",
        "load\n" POWER "Vg g 0 1\nRg g o 4\n.tran 1 1\n",
        "divider\n" DIVIDED "Vg g 0 1\nRg g h 4\nRh h 0 4\n.tran 1 1\n",
    };
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        start(others[k]);
        ck_assert_msg(isnan(value(DALCS_LABEL_NODE, "g")), "%s", others[k]);
        finish();
    }
    start("nothing\nV1 in 0 1\nR1 in o 1\nC1 o 0 1\n.tran 1 1\n");
    ck_assert(b.n == 0 && n_rows() == 0);
    finish();
}

END_TEST

RUN_TESTS("bystanders", test_gate_driver, test_coupled_sources, test_involved)
