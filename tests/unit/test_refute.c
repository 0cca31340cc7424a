/* test_refute.c - weights that prove that a problem has no answer, and those that do not. */
#include "refute.h"

#include "farkas.h"

#include "build_network.h"

#include <math.h>

/* Is the problem of the circuit's only system refuted? Switches that no command moves follow their controls. */
static bool is_refuted(const char *text, double sigma) {
    struct text_network t;
    struct dalcs_osnsp p;
    double u[64];
    double y[64];
    bool is_certain = false;
    build_good_network(&t, text);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_osnsp_setup(&p, &t.network.system[0], &options), DALCS_OK);
    text_network_inputs(&t, 0, u);
    for (int d = 0; d < t.network.system[0].n_pairs; d++) {
        dalcs_osnsp_command(&p, d, t.network.system[0].pair[d].initially_on);
    }
    ck_assert_int_ge(dalcs_osnsp_solve(&p, sigma, u, y), DALCS_OK);
    ck_assert_int_eq(dalcs_osnsp_refute(&p, sigma, u, &is_certain), DALCS_OK);
    dalcs_osnsp_finish(&p);
    text_network_finish(&t);
    return is_certain;
}

START_TEST(test_none) {
    ck_assert(is_refuted("a loop\nV1 1 0 1\nD1 1 0\nR1 1 0 1\n.op\n", 0.0));
    ck_assert(is_refuted("a cutset\nI1 1 0 1\nD1 1 0\n.op\n", 0.0));
    ck_assert(is_refuted("a source feeds an island\nI1 0 a 1\nR1 a b 1\nD1 b a\n.op\n", 0.0));
    ck_assert(is_refuted("30 to 1\nV1 a 0 5\nL1 a 0 900m\nL2 b 0 1m\nK1 L1 L2 1\nD1 b 0\n"
                         "R1 b 0 1\n.tran 1u 1m uic\n",
                         1e6));
    ck_assert(is_refuted("a nanovolt beside kilovolts\nV1 a 0 1k\nR1 a b 1u\nR2 b 0 1g\n"
                         "V2 c 0 1n\nD1 c 0\nR3 b c 1\n.op\n",
                         0.0));
}

END_TEST

/* Each case of the diodes has a contradiction of its own. */
START_TEST(test_none_of_the_modes) {
    ck_assert(is_refuted("Heemels, Schumacher and Weiland 1999, example 5.18\n"
                         "C1 1 0 1 ic=1\nC2 2 0 1 ic=-1\nVs1 z1 1 0\nVs2 z2 2 0\nD1 0 z1\n"
                         "D2 0 z2\nF1 1 0 Vs2 1\nF2 0 2 Vs1 1\nF3 2 0 Vs2 2\n.tran 1m 1 uic\n",
                         1e3));
    ck_assert(!is_refuted("w = 1 - lambda\nV1 a 0 1\nE1 b 0 a 0 1\nD1 0 c\nR1 c b -1\n.op\n", 0.0));
    ck_assert(
        is_refuted("w = -1 - lambda\nV1 a 0 1\nE1 b 0 a 0 -1\nD1 0 c\nR1 c b -1\n.op\n", 0.0));
    ck_assert(is_refuted("the same, of a current\nI1 0 a 1\nR1 a 0 -1\nD1 0 a\n.op\n", 0.0));
}

END_TEST

/* A switch that opens when it is closed, and closes when it is open. */
START_TEST(test_no_position) {
    ck_assert(is_refuted("its own voltage\nV1 a 0 1\nR1 a b 1\nS1 b 0 b 0 sm\n"
                         ".model sm SW(Vt=0.5 Ron=0)\n.op\n",
                         0.0));
    ck_assert(!is_refuted("between its thresholds it may stay\nV1 a 0 1\nR1 a b 1\nS1 b 0 b 0 sm\n"
                          ".model sm SW(Vt=0.5 Vh=0.6 Ron=0)\n.op\n",
                          0.0));
    ck_assert(!is_refuted("closed fits, open does not\nV1 a 0 1\nR1 a b 1\nS1 b 0 a b sm\n"
                          ".model sm SW(Vt=-0.5 Ron=0)\n.op\n",
                          0.0));
}

END_TEST

/* Small coefficients and large gains decide whether there is an answer: each of these has one. */
START_TEST(test_some) {
    ck_assert(!is_refuted("a microohm\nV1 a 0 1\nR1 a b 1u\nV2 b 0 0\n.op\n", 0.0));
    ck_assert(!is_refuted("a picoohm and a diode\nV1 a 0 1\nR1 a b 1p\nD1 b 0\n.op\n", 0.0));
    ck_assert(!is_refuted("a femtosiemens\nI1 0 a 1\nR1 a 0 1e15\nD1 0 a\n.op\n", 0.0));
    ck_assert(!is_refuted("1 to 100, across a microohm: 3e10 A\nV1 a 0 3\nL1 a 0 1\nL2 b 0 10k\n"
                          "K1 L1 L2 1\nR1 b 0 1u\n.tran 1 2 uic\n",
                          1.0));
    ck_assert(!is_refuted("gains of 1e6 in a row\nV1 a 0 1\nE1 b 0 a 0 1meg\nE2 c 0 b 0 1meg\n"
                          "E3 d 0 c 0 1meg\nR1 d e 1\nD1 e 0\n.op\n",
                          0.0));
    ck_assert(!is_refuted("an amplifier that is fed back\nV1 a 0 1\nR1 a n 1k\nR2 n o 10k\n"
                          "E1 o 0 0 n 1e12\nD1 o p\nR3 p 0 1\n.op\n",
                          0.0));
    ck_assert(!is_refuted("1e-9 less than it takes to contradict\nV1 a 0 1\nE1 b 0 a 0 1\n"
                          "E2 b c c 0 1e-9\nR1 b 0 1\nR2 c 0 1\n.op\n",
                          0.0));
}

END_TEST

/* ---- The function that verifies -------------------------------------------------------------- */

struct proof {
    struct text_network net;
    double u[16], v[16], sum[64];
    enum dalcs_side_claim side[4];
    struct dalcs_claim claim;
};

/* V1 across a diode: v(1) = V1 and w = -v(1) together say w = -V1. */
static void prove_loop(struct proof *p, const char *text) {
    *p = (struct proof){0};
    build_good_network(&p->net, text);
    const struct dalcs_system *s = &p->net.network.system[0];
    text_network_inputs(&p->net, 0, p->u);
    p->claim = (struct dalcs_claim){.system = s, .u = p->u, .side = p->side, .reach = {1e6, 1e6}};
    int source = find_row(s, DALCS_LABEL_BRANCH, "v1");
    int node = find_column(s, DALCS_LABEL_NODE, "1");
    int diode = dalcs_system_n_equations(s) + find_pair(s, "d1");
    p->v[diode] = 1.0;
    p->v[source] = entry_of(&s->C, find_pair(s, "d1"), node) / entry_of(&s->A, source, node);
}

static bool holds(const struct proof *p) {
    struct proof copy = *p;
    copy.claim.u = copy.u;
    copy.claim.side = copy.side;
    return dalcs_claim_is_refuted(&copy.claim, copy.v, copy.sum);
}

static const char *const loop = "source and diode\nV1 1 0 1\nD1 1 0\nR1 1 0 1\n.op\n";

START_TEST(test_weights) {
    struct proof p;
    prove_loop(&p, loop);
    ck_assert(holds(&p));
    const int n_rows = dalcs_claim_n_rows(p.claim.system);
    for (int row = 0; row < n_rows - 1; row++) { /* each weight, and each that is 0, changed */
        static const double change[] = {1.0, -1.0, 0.5, 1e-3, 1e-6, -1e-6, 1e-9};
        double right = p.v[row];
        for (int k = 0; k < 7; k++) {
            p.v[row] = right + change[k];
            ck_assert_msg(!holds(&p), "row %d, %g", row, change[k]);
        }
        p.v[row] = -right;
        ck_assert(right == 0.0 || !holds(&p));
        p.v[row] = right == 0.0 ? NAN : right;
        ck_assert(right != 0.0 || !holds(&p));
        p.v[row] = right;
    }
    ck_assert(holds(&p));
    text_network_finish(&p.net);
}

END_TEST

/* The same weights prove nothing of a problem that has an answer. */
START_TEST(test_other_problems) {
    struct proof p;
    prove_loop(&p, loop);
    const int n_x = p.claim.system->n_x;
    static const double source[] = {-1.0, 0.0, -1e-300};
    for (int k = 0; k < 3; k++) {
        p.u[n_x + 1] = source[k];
        ck_assert(!holds(&p));
    }
    p.u[n_x + 1] = 1e-30;
    ck_assert(holds(&p));
    p.u[n_x + 1] = 1.0;
    p.side[0] = DALCS_OPENED; /* then w >= 0 is still said */
    ck_assert(holds(&p));
    p.side[0] = DALCS_CLOSED; /* and w = 0 */
    ck_assert(holds(&p));
    text_network_finish(&p.net);
    prove_loop(&p, "a forward voltage of the same size\nV1 1 0 1\nD1 1 0 dm\nR1 1 0 1\n"
                   ".model dm D(Vfwd=1)\n.op\n");
    ck_assert(!holds(&p));
    text_network_finish(&p.net);
}

END_TEST

RUN_TESTS("refute", test_none, test_none_of_the_modes, test_no_position, test_some, test_weights,
          test_other_problems)
