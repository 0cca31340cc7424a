/* test_certificate.c - a wrong answer is refused, whatever is wrong with it. */
#include "osnsp_internal.h"

#include "build_network.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

static struct text_network t;
static struct dalcs_osnsp p;
static const struct dalcs_system *s;
static double u[32], y[64], wrong[64];

static const double sigma = 1e6;

static void setup(const char *text) {
    build_good_network(&t, text);
    s = &t.network.system[0];
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_osnsp_setup(&p, s, &options), DALCS_OK);
    text_network_inputs(&t, 0, u);
    ck_assert_int_eq(dalcs_osnsp_solve(&p, sigma, u, y), DALCS_OK);
    memcpy(wrong, y, sizeof(y));
}

static void finish(void) {
    dalcs_osnsp_finish(&p);
    text_network_finish(&t);
}

static bool evaluate(double *answer) {
    bool sources_clash;
    dalcs_certificate_evaluate(&p, u, answer, &sources_clash);
    return !sources_clash && p.signs.n_violating == 0 &&
           p.certificate.worst <= p.options.certificate_tolerance;
}

static const char rectifier[] = "a bridge that charges through a coil\nV1 a b 9\nR0 b 0 1\nD1 a p\n"
                                "D2 b p\nD3 m a\nD4 m b\nL1 p q 10u IC=1\nC1 q m 1u IC=5\n"
                                "R1 q m 10\n.tran 1u 1m uic\n";

/* Every unknown in turn off by 1e-9 of the answer's size, four digits above the tolerance. */
START_TEST(test_perturbed) {
    setup(rectifier);
    ck_assert(evaluate(y));
    int n_equations = dalcs_system_n_equations(s);
    for (int c = s->n_x; c < dalcs_system_n_columns(s); c++) {
        if (c >= n_equations && !dalcs_osnsp_is_on(&p, c - n_equations)) {
            continue;
        }
        for (int sign = -1; sign <= 1; sign += 2) {
            memcpy(wrong, y, sizeof(y));
            wrong[c] += sign * 1e-9 * 10.0;
            ck_assert(!evaluate(wrong));
            ck_assert(p.signs.n_violating > 0 || p.certificate.where >= 0);
        }
    }
    ck_assert(evaluate(y));
    finish();
}

END_TEST

/* The row that is named is one in which the wrong unknown stands. */
START_TEST(test_where) {
    setup(rectifier);
    int v1 = find_column(s, DALCS_LABEL_BRANCH, "v1");
    wrong[v1] += 1e-3;
    ck_assert(!evaluate(wrong));
    ck_assert_int_ge(p.certificate.where, 0);
    ck_assert_int_lt(p.certificate.where, dalcs_system_n_equations(s));
    ck_assert(entry_of(&s->A, p.certificate.where, v1) != 0.0);
    finish();
}

END_TEST

/* Nothing is remembered of how the answer was found: another state or source makes it wrong. */
START_TEST(test_other_inputs) {
    setup(rectifier);
    for (int i = 0; i < s->n_x + s->n_inputs; i++) {
        if (i == s->n_x) {
            continue; /* the constant, of which this circuit has none */
        }
        double right = u[i];
        u[i] *= 1.0 + 1e-9;
        ck_assert(!evaluate(wrong));
        u[i] = right;
        memcpy(wrong, y, sizeof(y));
    }
    finish();
}

END_TEST

/* Equations that hold in the wrong mode: the signs say which pairs. */
START_TEST(test_wrong_mode) {
    setup("two diodes in series\nV1 a 0 2\nD1 a b\nR1 b 0 1\nD2 0 b\nC1 b 0 1u\n.tran 1u 1m\n");
    uint64_t right = p.mode[0];
    ck_assert_uint_eq(right, 1);
    p.mode[0] = 0;
    for (int k = 0; k < dalcs_system_n_columns(s); k++) {
        wrong[k] = 0.0;
    }
    wrong[find_column(s, DALCS_LABEL_NODE, "a")] = 2.0;
    ck_assert(!evaluate(wrong));
    ck_assert_int_eq(p.signs.n_violating, 1);
    ck_assert_int_eq(p.signs.violating[0], find_pair(s, "d1"));
    ck_assert_double_le(p.certificate.worst, p.options.certificate_tolerance);
    /* d1 carries a current backwards into a source of -2 V. */
    p.mode[0] = right;
    u[s->n_x + 1] = -2.0;
    double *i = wrong + dalcs_system_n_equations(s);
    wrong[find_column(s, DALCS_LABEL_NODE, "a")] = -2.0;
    wrong[find_column(s, DALCS_LABEL_NODE, "b")] = -2.0;
    i[0] = -2.0 - sigma * 1e-6 * 2.0;
    wrong[find_column(s, DALCS_LABEL_BRANCH, "v1")] = -i[0];
    ck_assert(!evaluate(wrong));
    ck_assert_int_eq(p.signs.violating[0], 0); /* backward current of d1, */
    ck_assert_int_eq(p.signs.violating[1], 1); /* forward voltage across d2 */
    finish();
}

END_TEST

/* Numbers that compare with nothing: never certified, wherever they are and whatever follows. */
START_TEST(test_not_a_number) {
    setup(rectifier);
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int c = s->n_x; c < dalcs_system_n_columns(s); c++) {
        for (int k = 0; k < 3; k++) {
            memcpy(wrong, y, sizeof(y));
            wrong[c] = bad[k];
            ck_assert_msg(!evaluate(wrong), "column %d", c);
        }
    }
    finish();
}

END_TEST

/* The reference of a floating island carries nothing; if it had to, sources clash. */
START_TEST(test_reference) {
    setup("island\nV1 a b 5\nR1 a b 2\nC1 a b 1u\n.tran 1u 1m\n");
    int column = find_column(s, DALCS_LABEL_REFERENCE, "a");
    ck_assert_int_ge(column, 0);
    wrong[column] = 1e-9;
    bool sources_clash;
    dalcs_certificate_evaluate(&p, u, wrong, &sources_clash);
    ck_assert(sources_clash);
    finish();
}

END_TEST

/* A matrix of KLU that was tampered with: the solver refines or refuses, it does not pass it on. */
START_TEST(test_tampered_factors) {
    setup(rectifier);
    struct dalcs_mode_entry *e;
    ck_assert_int_eq(dalcs_modes_get(&p, DALCS_PLAIN, &e), DALCS_OK);
    ck_assert(!e->singular);
    for (int i = 0; i < e->lu.n; i++) {
        e->lu.pivot_inverse[i] *= 3.0;
    }
    enum dalcs_status status = dalcs_osnsp_solve(&p, sigma, u, wrong);
    ck_assert(status != DALCS_OK || evaluate(wrong));
    for (int c = 0; status == DALCS_OK && c < dalcs_system_n_columns(s); c++) {
        ck_assert_double_eq_tol(wrong[c], y[c], 1e-9 * 10.0);
    }
    finish();
}

END_TEST

/* 1 MV drives a current through R2, whose KCL at b has terms of twice this current, beside a norm of 1 S * 1 MV. Twice
 * 1000 n roundings of the norm are an answer of their own, half as many may be rounding: a node that is off by 1 pV is
 * seen in the one and not in the other, while 1 uV is in both. The 1 S is a G: the current of a resistor so
 * far from the other would be an unknown. */
static bool accepts(double roundings, double off) {
    char netlist[256];

    enum { N_COLUMNS = 5 }; /* a, b, c, i(V1), lambda */

    double terms = roundings * N_COLUMNS * DBL_EPSILON * 1e6;
    snprintf(netlist, sizeof(netlist),
             "faint\nV1 a 0 1meg\nR2 a b %.17g\nR3 b c 1meg\nG3 b c b 0 1\n"
             "D1 c 0\n.op\n",
             2e6 / terms);
    setup(netlist);
    ck_assert_int_eq(dalcs_system_n_columns(s), N_COLUMNS);
    ck_assert(evaluate(y));
    int c = 0;
    while (strcmp(s->column[c].element, "b") != 0) {
        c++;
    }
    memcpy(wrong, y, sizeof(y));
    wrong[c] += off;
    const bool accepted = evaluate(wrong);
    finish();
    return accepted;
}

START_TEST(test_own_terms) {
    ck_assert(accepts(500.0, 1e-12));
    ck_assert(!accepts(2000.0, 1e-12));
    ck_assert(!accepts(500.0, 1e-6));
}

END_TEST
RUN_TESTS("certificate", test_perturbed, test_own_terms, test_where, test_other_inputs,
          test_wrong_mode, test_not_a_number, test_reference, test_tampered_factors)
