/* test_assemble.c - the equations of a circuit: only what it needs, named, passive. */
#include "build_network.h"

static struct text_network t;

static const struct dalcs_system *system_of(const char *text) {
    build_good_network(&t, text);
    return &t.network.system[0];
}

START_TEST(test_rectifier) {
    const struct dalcs_system *s = system_of("rectifier\nV1 in 0 5\nD1 in out\nC1 out 0 2u\n"
                                             "R1 out 0 4\n.tran 1u 1m\n");
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(s->n_x, 1);
    ck_assert_int_eq(s->n_z, 3); /* two voltages and the current of v1; none of the capacitor */
    ck_assert_int_eq(s->n_pairs, 1);
    ck_assert_int_eq(s->n_inputs, 2);
    ck_assert(s->monotone);
    int c1 = find_column(s, DALCS_LABEL_STATE, "c1");
    int in = find_column(s, DALCS_LABEL_NODE, "in");
    int out = find_column(s, DALCS_LABEL_NODE, "out");
    int v1 = find_column(s, DALCS_LABEL_BRANCH, "v1");
    int d1 = dalcs_system_n_equations(s);
    ck_assert_int_eq(find_column(s, DALCS_LABEL_BRANCH, "c1"), -1);
    ck_assert(!s->column_is_current[c1] && !s->column_is_current[in] && s->column_is_current[v1] &&
              s->column_is_current[d1]);

    int kcl_out = find_row(s, DALCS_LABEL_NODE, "out"); /* C v' = -v/R + i_D */
    ck_assert_int_lt(kcl_out, s->n_x);
    ck_assert_double_eq(entry_of(&s->P, kcl_out, c1), 2e-6);
    ck_assert_double_eq(entry_of(&s->A, kcl_out, out), -0.25);
    ck_assert_double_eq(entry_of(&s->A, kcl_out, d1), 1.0);
    int kcl_in = find_row(s, DALCS_LABEL_NODE, "in"); /* 0 = -i_V - i_D */
    ck_assert_double_eq(entry_of(&s->A, kcl_in, v1), -1.0);
    ck_assert_double_eq(entry_of(&s->A, kcl_in, d1), -1.0);
    int branch = find_row(s, DALCS_LABEL_BRANCH, "v1"); /* 0 = v(in) - V */
    ck_assert_double_eq(entry_of(&s->A, branch, in), entry_of(&s->E, branch, 1) * -1.0);
    ck_assert_double_eq(entry_of(&s->C, 0, out), 1.0); /* w = v(out) - v(in) */
    ck_assert_double_eq(entry_of(&s->C, 0, in), -1.0);
    ck_assert_str_eq(s->pair[0].element, "d1");
    ck_assert_str_eq(s->input_element[1], "v1");
    ck_assert_int_eq(s->stimulus[0], -1);
    text_network_finish(&t);
}

END_TEST

START_TEST(test_nothing_unused) {
    const struct dalcs_system *s = system_of("no diode, no state\nV1 a 0 1\nR1 a b 1\nR2 b 0 1\n"
                                             ".op\n");
    ck_assert_int_eq(s->n_pairs, 0);
    ck_assert_int_eq(s->n_x, 0);
    ck_assert_int_eq(s->n_z, 3);
    text_network_finish(&t);
    /* The current of a capacitor or of a short is an unknown if it is read. */
    s = system_of("asked for\nV1 a 0 1\nR1 a b 1\nR2 b c 0\nC1 c 0 1u\n.tran 1u 1m\n.save i(c1) "
                  "i(r2)\n");
    ck_assert_int_ge(find_column(s, DALCS_LABEL_BRANCH, "c1"), 0);
    ck_assert_int_ge(find_column(s, DALCS_LABEL_BRANCH, "r2"), 0);
    ck_assert_int_eq(s->n_z, 6);
    text_network_finish(&t);
    s = system_of("not asked for\nV1 a 0 1\nR1 a b 1\nR2 b c 0\nC1 c 0 1u\n.tran 1u 1m\n"
                  ".save v(c)\n");
    ck_assert_int_eq(s->n_z, 3);
    text_network_finish(&t);
    s = system_of("a loop of capacitors has one current of its own\nC1 a 0 1\nC2 a 0 2\nR1 a 0 1\n"
                  ".tran 1u 1m\n");
    ck_assert_int_eq(s->n_x, 2);
    ck_assert_int_eq(s->n_z, 2);
    text_network_finish(&t);
}

END_TEST

START_TEST(test_separate) {
    build_good_network(&t, "three parts\nV1 a 0 1\nD1 a b\nR1 b 0 1\nI2 0 c 1\nC2 c 0 1u\n"
                           "V3 d 0 1\nD3 d e\nR3 e 0 1\n.tran 1u 1m\n");
    ck_assert_int_eq(t.network.n_systems, 3);
    static const int pairs[] = {1, 0, 1};
    static const int states[] = {0, 1, 0};
    for (int k = 0; k < 3; k++) {
        ck_assert_int_eq(t.network.system[k].n_pairs, pairs[k]);
        ck_assert_int_eq(t.network.system[k].n_x, states[k]);
        ck_assert_int_eq(t.network.system[k].n_inputs, 2);
    }
    /* A voltage between two parts is the difference of two probes. */
    text_network_finish(&t);
    build_good_network(&t, "two parts\nV1 a 0 1\nR1 a 0 1\nV2 b 0 1\nR2 b 0 1\n.op\n"
                           ".save v(a,b)\n");
    ck_assert_int_eq(t.network.output[0].plus.system, 0);
    ck_assert_int_eq(t.network.output[0].minus.system, 1);
    text_network_finish(&t);
}

END_TEST

START_TEST(test_reference) {
    const struct dalcs_system *s = system_of("nothing ties a and b to ground\nC1 a b 1u\nR1 a b 1\n"
                                             ".tran 1u 1m\n");
    int column = find_column(s, DALCS_LABEL_REFERENCE, "a");
    int row = find_row(s, DALCS_LABEL_REFERENCE, "a");
    ck_assert_int_ge(column, 0);
    ck_assert_int_eq(s->dual[row], column);
    ck_assert(s->column_is_current[column]);
    ck_assert_double_eq(entry_of(&s->A, row, find_column(s, DALCS_LABEL_NODE, "a")), 1.0);
    text_network_finish(&t);
}

END_TEST

START_TEST(test_pairs) {
    const struct dalcs_system *s = system_of(
        "breakdown, threshold, resistance, a switch that a source commands and one that is not\n"
        "V1 a 0 5\nD1 a b dz\nR1 b 0 1\nS1 a b a 0 sm on\nS2 a b b 0 sm\n"
        ".model dz D(Ron=0.5 Vfwd=0.7 Vrev=6 Rrev=0.25)\n.model sm SW(Ron=2 Vt=1 Vh=0.5)\n.op\n");
    ck_assert_int_eq(s->n_pairs, 4);
    int n = dalcs_system_n_equations(s);
    ck_assert(!s->pair[0].is_breakdown && s->pair[1].is_breakdown);
    ck_assert_double_eq(entry_of(&s->C, 0, n), 0.5);
    ck_assert_double_eq(entry_of(&s->C, 1, n + 1), 0.25);
    ck_assert_double_eq(entry_of(&s->F, 0, 0), 0.7);
    ck_assert_double_eq(entry_of(&s->F, 1, 0), 6.0);
    int a = find_column(s, DALCS_LABEL_NODE, "a");
    ck_assert_double_eq(entry_of(&s->C, 0, a), -entry_of(&s->C, 1, a));
    const struct dalcs_pair *s1 = &s->pair[find_pair(s, "s1")];
    const struct dalcs_pair *s2 = &s->pair[find_pair(s, "s2")];
    ck_assert(s1->kind == DALCS_PAIR_SWITCH && s1->initially_on && s1->is_direct);
    ck_assert(!s2->initially_on && !s2->is_direct);
    ck_assert_double_eq(s1->turn_on, 1.5);
    ck_assert_double_eq(s1->turn_off, 0.5);
    ck_assert_double_eq(entry_of(&s->direct_control, find_pair(s, "s1"), 1), 1.0);
    text_network_finish(&t);
}

END_TEST

/* What a system takes from its sources is not negative: with rows in the order of their duals,
 * v'(sigma P - A, C) v >= 0 beyond rounding, for all v in which a capacitor of the forest has the
 * voltage between its nodes. Trees of capacitors are rooted at ground here. */
START_TEST(test_passive) {
    static const char *const text[] = {
        "bridge\nV1 a b 1\nR0 b a 1\nD1 a p\nD2 b p\nD3 0 a\nD4 0 b\nC1 p 0 1\nR1 p 0 3\nL1 p 0 2\n"
        ".tran 1 9\n",
        "coils and a transformer\nV1 a 0 1\nL1 a b 1\nL2 c 0 4\nK1 L1 L2 1\nL3 b 0 2\nK2 L1 L3 .5\n"
        "K3 L2 L3 .5\nD1 c e\nR1 e 0 1\nC1 e 0 2\n.tran 1 9\n",
        "loop of capacitors, switch, short\nI1 0 a 1\nC1 a b 1\nC2 b 0 1\nC3 a 0 1\nS1 a c b 0 s\n"
        "R1 c d 0\nR2 d 0 2\n.model s SW(Ron=1 Roff=10)\n.tran 1 9\n.save i(r1) i(c2)\n",
    };
    uint64_t random = 5;
    for (size_t k = 0; k < sizeof(text) / sizeof(text[0]); k++) {
        const struct dalcs_system *s = system_of(text[k]);
        ck_assert(s->monotone);
        int n_equations = dalcs_system_n_equations(s);
        for (int trial = 0; trial < 200; trial++) {
            double v[32];
            for (int c = 0; c < dalcs_system_n_columns(s); c++) {
                v[c] = next_random(&random);
            }
            for (int i = s->n_x; i < n_equations; i++) {
                int x = s->dual[i];
                bool is_alias = x < s->n_x && entry_of(&s->A, i, x) == -1.0;
                v[x] += is_alias ? dalcs_csr_row_dot(&s->A, i, v) : 0.0;
            }
            double sigma = exp2(10.0 * next_random(&random));
            double product = 0.0;
            double size = 0.0;
            for (int i = 0; i < n_equations; i++) {
                double row = -dalcs_csr_row_dot(&s->A, i, v);
                row += i < s->n_x ? sigma * dalcs_csr_row_dot(&s->P, i, v) : 0.0;
                product += v[s->dual[i]] * row;
                size += fabs(v[s->dual[i]] * row);
            }
            for (int d = 0; d < s->n_pairs; d++) {
                double row = dalcs_csr_row_dot(&s->C, d, v);
                product += v[n_equations + d] * row;
                size += fabs(v[n_equations + d] * row);
            }
            ck_assert_double_ge(product, -1e-14 * size);
        }
        text_network_finish(&t);
    }
    ck_assert(!system_of("not passive\nV1 a 0 1\nE1 b 0 a 0 2\nR1 b 0 1\n.op\n")->monotone);
    text_network_finish(&t);
    ck_assert(!system_of("not passive\nV1 a 0 1\nR1 a 0 -1\n.op\n")->monotone);
    text_network_finish(&t);
}

END_TEST

/* x(0-) for uic: IC= before .ic, the sign by the order of the nodes. */
START_TEST(test_initial) {
    const struct dalcs_system *s = system_of("initial\nV1 a 0 1\nR1 a b 1\nC1 b 0 1 IC=3\n"
                                             "C2 c b 1\nR2 c 0 1\nC3 d c 1\nL1 d 0 1 IC=-2\n"
                                             ".ic v(b)=7 v(b,c)=4 v(d)=1\n.tran 1 9 uic\n");
    const double *x = t.network.initial[0];
    ck_assert_double_eq(x[find_column(s, DALCS_LABEL_STATE, "c1")], 3.0);
    ck_assert_double_eq(x[find_column(s, DALCS_LABEL_STATE, "c2")], -4.0);
    ck_assert_double_eq(x[find_column(s, DALCS_LABEL_STATE, "c3")], 1.0);
    ck_assert_double_eq(x[find_column(s, DALCS_LABEL_STATE, "l1")], -2.0);
    text_network_finish(&t);
}

END_TEST

/* A condition on both nodes comes before those on one; shorts make nodes one; ground may be an end. */
START_TEST(test_initial_pairs) {
    const struct dalcs_system *s = system_of(
        "pairs\nV1 in 0 1\nR1 in a 1\nRs c d 0\nR2 c 0 1\nR3 b 0 1\n"
        "C1 a b 1\nC2 b a 1\nC3 d 0 1\nC4 0 b 1\nC5 a d 1\nC6 in b 1\nC7 e a 1\nR4 e 0 1\n"
        ".ic v(a)=9 v(c,a)=6 v(a,b)=2 v(c)=5 v(0,b)=3\n.tran 1 9 uic\n");
    const double *x = t.network.initial[0];

    static const struct {
        const char *name;
        double voltage;
    } wanted[] = {{"c1", 2}, {"c2", -2}, {"c3", 5}, {"c4", 3}, {"c5", -6}, {"c6", 0}, {"c7", -9}};

    for (size_t k = 0; k < sizeof wanted / sizeof wanted[0]; k++) {
        ck_assert_double_eq(x[find_column(s, DALCS_LABEL_STATE, wanted[k].name)],
                            wanted[k].voltage);
    }
    text_network_finish(&t);
}

END_TEST

RUN_TESTS("assemble", test_rectifier, test_nothing_unused, test_separate, test_reference,
          test_pairs, test_passive, test_initial, test_initial_pairs)
