/* test_witness.c - why there is no answer: exactly the elements of the loop or the cutset. */
#include "osnsp.h"

#include "build_network.h"

#include <stdlib.h>

static int by_name(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* `elements`: sorted, with a blank after each. */
static void check_refused(const char *text, double sigma, enum dalcs_witness_kind kind,
                          const char *elements) {
    struct text_network t;
    struct dalcs_osnsp p;
    double u[64];
    double y[64];
    build_good_network(&t, text);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_osnsp_setup(&p, &t.network.system[0], &options), DALCS_OK);
    text_network_inputs(&t, 0, u);
    for (int d = 0; d < t.network.system[0].n_pairs; d++) {
        dalcs_osnsp_command(&p, d, t.network.system[0].pair[d].initially_on);
    }
    ck_assert_int_eq(dalcs_osnsp_solve(&p, sigma, u, y), DALCS_INFEASIBLE);
    ck_assert_int_eq(p.witness.kind, kind);
    const char *sorted[64];
    memcpy(sorted, p.witness.element, (size_t)p.witness.n_elements * sizeof(*sorted));
    qsort(sorted, (size_t)p.witness.n_elements, sizeof(*sorted), by_name);
    char found[256] = "";
    for (int k = 0; k < p.witness.n_elements; k++) {
        strcat(strcat(found, sorted[k]), " ");
    }
    ck_assert_str_eq(found, elements);
    dalcs_osnsp_finish(&p);
    text_network_finish(&t);
}

START_TEST(test_loops) {
    check_refused("source and diode\nV1 1 0 1\nD1 1 0\nR1 1 0 1\n.op\n", 0.0, DALCS_WITNESS_LOOP,
                  "d1 v1 ");
    check_refused("a chain of diodes between two sources, others beside it\n"
                  "V1 a 0 5\nD1 a b\nD2 b c\nV2 c 0 3\nR1 b 0 1\nD3 b d\nR2 d 0 1\nD4 0 d\n.op\n",
                  0.0, DALCS_WITNESS_LOOP, "d1 d2 v1 v2 ");
    check_refused("a closed switch across a source, an open one\n"
                  "V1 a 0 1\nS1 a 0 a 0 sm on\nS2 a b 0 a sm\nR1 b 0 1\n.model sm SW\n.op\n",
                  0.0, DALCS_WITNESS_LOOP, "s1 v1 ");
    check_refused("a coil is a short at the operating point\nV1 a 0 1\nL1 a 0 1m\nR1 a 0 1\n.op\n",
                  0.0, DALCS_WITNESS_LOOP, "l1 v1 ");
    check_refused("two sources\nV1 a 0 1\nV2 a 0 2\nR1 a 0 1\n.op\n", 0.0, DALCS_WITNESS_LOOP,
                  "v1 v2 ");
}

END_TEST

START_TEST(test_cutsets) {
    check_refused("source against a diode\nI1 1 0 1\nD1 1 0\n.op\n", 0.0, DALCS_WITNESS_CUTSET,
                  "d1 i1 ");
    check_refused("two diodes hold back what a source pulls\n"
                  "I1 a 0 1\nD1 a b\nD2 a c\nR1 b 0 1\nR2 c 0 1\nV1 c d 1\nR3 d 0 1\n.op\n",
                  0.0, DALCS_WITNESS_CUTSET, "d1 d2 i1 ");
    check_refused("an open switch\nI1 0 a 1\nS1 a 0 b 0 sm\nD1 0 a\nV1 b 0 0\nR1 b 0 1\n"
                  ".model sm SW(Vt=1)\n.op\n",
                  0.0, DALCS_WITNESS_CUTSET, "d1 i1 s1 ");
    check_refused("a source feeds an island\nI1 0 a 1\nR1 a b 1\nD1 b a\n.op\n", 0.0,
                  DALCS_WITNESS_CUTSET, "i1 ");
}

END_TEST

/* In a step as well as at the operating point: neither capacitors nor coils take part. */
START_TEST(test_steps) {
    check_refused("step\nV1 a 0 5\nD1 a b\nV2 b 0 1\nC1 b 0 1u\nR1 b 0 1\n.tran 1u 1m uic\n", 1e6,
                  DALCS_WITNESS_LOOP, "d1 v1 v2 ");
}

END_TEST

/* Currents of 1 and 30 in one loop: small beside the largest is not nothing. */
START_TEST(test_transformer) {
    check_refused("transformer\nV1 a 0 5\nL1 a 0 900m\nL2 b 0 1m\nK1 L1 L2 1\nD1 b 0\nR1 b 0 1\n"
                  ".tran 1u 1m uic\n",
                  1e6, DALCS_WITNESS_LOOP, "d1 l2 v1 ");
}

END_TEST

/* Not passive: no ray proves anything, all modes were tried. */
START_TEST(test_modes) {
    check_refused("Heemels, Schumacher and Weiland 1999, example 5.18\n"
                  "C1 1 0 1 ic=1\nC2 2 0 1 ic=-1\nVs1 z1 1 0\nVs2 z2 2 0\nD1 0 z1\nD2 0 z2\n"
                  "F1 1 0 Vs2 1\nF2 0 2 Vs1 1\nF3 2 0 Vs2 2\n.tran 1m 1 uic\n",
                  1e3, DALCS_WITNESS_MODE, "d1 d2 ");
}

END_TEST

RUN_TESTS("witness", test_loops, test_cutsets, test_steps, test_transformer, test_modes)
