/* test_part.c - the papers' own examples: what each theorem says of them, and where it fails though
 * the step is solvable. Numbers beside a system are its paper's or follow from it by hand. */
#include "part.h"

#include "build_system.h"

#include <math.h>
#include <string.h>

static struct dalcs_system system_;
static struct dalcs_arena arena;
static struct dalcs_checked_part part;

static void check(const struct dense_system *d, double h) {
    build_system(&system_, d);
    ck_assert_int_eq(dalcs_part_check(&part, &arena, &system_, NULL, NULL, h), DALCS_OK);
}

static void finish(void) {
    dalcs_system_finish(&system_);
    dalcs_arena_finish(&arena);
}

static const struct dalcs_condition *condition(const char *id) {
    for (size_t i = 0; i < part.n_conditions; i++) {
        if (strcmp(part.condition[i].id, id) == 0) {
            return &part.condition[i];
        }
    }
    ck_abort_msg("no condition %s", id);
}

static const struct dalcs_verdict *verdict(const char *question) {
    for (size_t i = 0; i < part.n_verdicts; i++) {
        if (strcmp(part.verdict[i].question, question) == 0) {
            return &part.verdict[i];
        }
    }
    ck_abort_msg("no verdict on %s", question);
}

#define HOLDS(id, answer)                                                                          \
    ck_assert_msg(condition(id)->holds == (enum dalcs_answer)(answer), "%s: %s (%s)", id,          \
                  dalcs_answer_text(condition(id)->holds), condition(id)->because)
#define SAYS(question, expected)                                                                   \
    ck_assert_msg(verdict(question)->answer == (enum dalcs_answer)(expected), "%s: %s", question,  \
                  verdict(question)->sentence)

static double only_value(const char *id) {
    const struct dalcs_condition *c = condition(id);
    ck_assert_uint_eq(c->n_witnesses, 1);
    ck_assert_uint_eq(c->witness[0].n_rows, 1);
    return c->witness[0].value[0];
}

/* ---- Brogliato 2022, section 6 --------------------------------------------------------------- */

/* 6.1, with -1/(RC) at (2, 2), which the equation has and the matrix printed lacks; R = 2, C = 1/2. */
START_TEST(example_1) {
    const double A[] = {-2, 1, 0, 0.5, 0, /* */ 0.5, -1, 0, 0, 0.25, /* */ 1, -2, -2, 0, 1.5};
    const double C[] = {-2, 1, 0, 0.5, 0, /* */ 0, 0, 1, 0, 0};
    check(&(struct dense_system){.n = 2, .p = 1, .m = 2, .A = A, .C = C}, 0.1);
    HOLDS("A3", DALCS_YES);
    HOLDS("A5", DALCS_YES);
    HOLDS("A8", DALCS_YES);
    HOLDS("A9", DALCS_YES);
    HOLDS("P4.8.1", DALCS_YES);
    HOLDS("P4.8.3", DALCS_YES);
    ck_assert_double_eq_tol(only_value("A9"), 2.0 / 3.0, 1e-12);
    HOLDS("A2", DALCS_NO);
    HOLDS("A6", DALCS_NO);
    HOLDS("P4.4.3", DALCS_NO);
    HOLDS("A10", DALCS_NO);
    HOLDS("P5.2", DALCS_NO);
    finish();
}

END_TEST

/* 6.2 with u = 2 R3 z; R1 = 1, R2 = 2, R3 = 3, L = 1, C = 1. */
START_TEST(example_2_first_feedback) {
    const double A[] = {-1, 0, 3, 1, /* */ 0, -0.5, 1.5, 0, /* */ 1, 0.5, -2.5, 0};
    const double C[] = {1, 0, 0, 0};
    check(&(struct dense_system){.n = 2, .p = 1, .m = 1, .A = A, .C = C}, 0.01);
    HOLDS("A2", DALCS_YES);
    ck_assert_double_eq_tol(only_value("A2"), 3.0, 1e-9);
    HOLDS("A3", DALCS_YES); /* trivially: both sides are 0 */
    HOLDS("A4", DALCS_YES);
    HOLDS("C4.6.3", DALCS_YES); /* strictly for each h > 0 */
    HOLDS("P4.3.2", DALCS_YES);
    HOLDS("A5", DALCS_YES);
    HOLDS("A10", DALCS_NO); /* Dt -> 0 */
    HOLDS("P4.8.1", DALCS_CONDITIONAL);
    finish();
}

END_TEST

/* (6.3): u = 2 R3 z + R1 x1 + a L x1 + v, all parameters 1: h < 1/a. */
START_TEST(example_2_second_feedback) {
    const double A[] = {1, 0, 1, 1, /* */ 0, -1, 1, 0, /* */ 1, 1, -2, 0};
    const double C[] = {1, 0, 0, 0};
    const double storage[] = {1, 0, 0, 1};
    check(&(struct dense_system){.n = 2, .p = 1, .m = 1, .A = A, .C = C, .storage = storage}, 0.5);
    HOLDS("A1", DALCS_YES);
    SAYS("passive", DALCS_NO);
    SAYS("unique", DALCS_YES); /* K1 and D = 0 need no passivity */
    /* the reduced system with the diode blocking nothing: [1.5 0.5; 0.5 -0.5] */
    const double root = 0.5 + sqrt(1.25);
    SAYS("step", DALCS_CONDITIONAL);
    ck_assert_double_eq_tol(verdict("step")->value, 1.0 / root, 1e-9);
    finish();
    check(&(struct dense_system){.n = 2, .p = 1, .m = 1, .A = A, .C = C}, 1.5);
    HOLDS("A1", DALCS_NO);
    finish();
}

END_TEST

/* (6.5) with small a and b: strictly passive; proposition 5.2 hangs on A_I alone. */
START_TEST(example_3_first) {
    for (int sign = -1; sign <= 1; sign += 2) {
        const double A[] = {sign, 1, 0, 0, 0, 0, /* */ 0, -1, 0.1, 0.1, 0.1, 0.1};
        const double C[] = {-1, 0,  1, 0, 0, 0, /* */ 1, 0, 0, 1, 0, 0,
                            0,  -1, 0, 0, 1, 0, /* */ 0, 1, 0, 0, 0, 1};
        check(&(struct dense_system){.n = 1, .p = 1, .m = 4, .A = A, .C = C}, 0.01);
        HOLDS("L4.1", DALCS_YES);
        HOLDS("A10", DALCS_YES);
        HOLDS("A11", sign < 0 ? DALCS_YES : DALCS_NO);
        HOLDS("P5.2", sign < 0 ? DALCS_YES : DALCS_NO);
        SAYS("convergence", sign < 0 ? DALCS_YES : DALCS_UNDECIDED);
        SAYS("jumps", DALCS_YES);
        finish();
    }
}

END_TEST

/* (6.7): c3 = 1 > 0 violates the paper's own condition, and the step is solvable all the same. */
START_TEST(example_3_second) {
    const double A[] = {1, 1, 10, 0, 0, /* */ 1, 1, 20, 0, 0, /* */ 0, 1, 1, -1, 1};
    const double C[] = {1, 0, 0, 1, 0, /* */ -1, 0, 0, 0, 1};
    check(&(struct dense_system){.n = 2, .p = 1, .m = 2, .A = A, .C = C}, 2e-3);
    HOLDS("A4", DALCS_NO);
    HOLDS("A5", DALCS_NO);
    HOLDS("A10", DALCS_NO);
    HOLDS("C4.6.3", DALCS_NO);
    HOLDS("P4.3.2", DALCS_YES);
    HOLDS("K6", DALCS_YES);
    SAYS("exists", DALCS_YES);
    SAYS("unique", DALCS_YES);
    SAYS("step", DALCS_CONDITIONAL);
    /* of [1 -9; 1 -19], both off */
    ck_assert_double_eq_tol(verdict("step")->value, 1.0 / (sqrt(91.0) - 9.0), 1e-7);
    finish();
}

END_TEST

/* 6.4 with m = k = 1: z acts on the second mass. */
START_TEST(example_4) {
    const double A[] = {0, 1, 0, 0,       0, 0, 0, /* */ 0, 0, 0, 0, 0, 1, -1, 0,  0, 0, 1,
                        0, 0, 0, /* */ 0, 0, 0, 0, 1,       0, 0, 0, 0, 0, 0,  -1, 0, 0};
    const double C[] = {1, 0, 0, 0, 0, 1, 0, /* */ -1, 0, 0, 0, 0, 0, 1};
    check(&(struct dense_system){.n = 4, .p = 1, .m = 2, .A = A, .C = C}, 0.01);
    HOLDS("L4.1", DALCS_YES);
    HOLDS("K6", DALCS_YES);
    SAYS("exists", DALCS_YES);
    SAYS("jumps", DALCS_YES);
    finish();
}

END_TEST

/* 6.5, R2 = L = C = 1: with a = 0 the index is 2 while the diode conducts, and u2 can make x2 jump;
 * with a > 0 nothing can. */
START_TEST(example_5) {
    for (int a = 0; a <= 1; a++) {
        const double A[] = {-1, 0, 0, 1, /* */ 1, 0, -1, 0, /* */ 0, 1, -a, 1};
        const double E[] = {1, 0, /* */ 0, 0, /* */ 0, 1};
        const double C[] = {0, 0, 1, 0};
        const double storage[] = {1, 0, 0, 1};
        check(
            &(struct dense_system){
                .n = 2, .p = 1, .m = 1, .k = 2, .A = A, .E = E, .C = C, .storage = storage},
            0.01);
        HOLDS("A3", DALCS_YES);
        HOLDS("A5", DALCS_YES);
        SAYS("passive", DALCS_YES);
        SAYS("step", DALCS_YES);
        SAYS("unique", DALCS_YES);
        if (a == 0) {
#ifdef DALCS_WITH_GLPK
            SAYS("jumps", DALCS_CONDITIONAL);
            ck_assert_uint_eq(verdict("jumps")->n_elements, 1);
            ck_assert_str_eq(verdict("jumps")->element[0], "u2");
#endif
        } else {
            SAYS("jumps", DALCS_YES);
        }
        finish();
    }
}

END_TEST

/* ---- Lur'e ----------------------------------------------------------------------------------- */

static const double energy_33[] = {2, -1, 0, /* */ -1, 2, 0, /* */ 0, 0, 1};

/* (33) put right: block I alone is coupled, the whole pair is not; passive by its energy. */
START_TEST(two_diodes_corrected) {
    const double A[] = {-2, 1, 0, 0, 1, /* */ 1, -2, 1, 0, 0, /* */ -1, 2, -1, 1, 0};
    const double C[] = {0, 0, 1, 0, 0, /* */ -2, 1, 0, 0, 1};
    check(&(struct dense_system){.n = 3, .m = 2, .A = A, .C = C, .storage = energy_33}, 0.01);
    HOLDS("K1", DALCS_NO);
    HOLDS("K7", DALCS_YES);
    HOLDS("K10", DALCS_YES);
    SAYS("passive", DALCS_YES);
    SAYS("unique", DALCS_YES);
    finish();
}

END_TEST

/* (33) as printed must be rejected. */
START_TEST(two_diodes_as_printed) {
    const double A[] = {-2, 1, 0, 0, 1, /* */ 1, -2, 1, 0, 0, /* */ 0, 0, 0, 1, 0};
    const double C[] = {0, 0, 1, 0, 0, /* */ -2, 1, 0, 0, 1};
    check(&(struct dense_system){.n = 3, .m = 2, .A = A, .C = C, .storage = energy_33}, 0.01);
    HOLDS("K10", DALCS_NO);
    SAYS("passive", DALCS_NO);
    ck_assert_uint_gt(verdict("passive")->n_witnesses, 0);
    finish();
}

END_TEST

/* (36): the bridge over an LC tank, all parameters 1. */
START_TEST(bridge_over_a_tank) {
    const double A[] = {0, -1, 0, 0, -1, 1, /* */ 1, 0, 0, 0, 0, 0};
    const double C[] = {0,  0, 1, 1, -1, 0, /* */ 0, 0, 1, 1, 0, -1,
                        -1, 0, 1, 0, 0,  0, /* */ 1, 0, 0, 1, 0, 0};
    const double storage[] = {1, 0, 0, 1};
    check(&(struct dense_system){.n = 2, .m = 4, .A = A, .C = C, .storage = storage}, 0.01);
    HOLDS("K6", DALCS_NO);
    HOLDS("PSD-D", DALCS_YES);
    HOLDS("K1", DALCS_YES);
    SAYS("passive", DALCS_YES);
    SAYS("step", DALCS_YES);
#ifdef DALCS_WITH_GLPK
    HOLDS("Prop3", DALCS_NO);
    HOLDS("K8", DALCS_YES);
    SAYS("exists", DALCS_YES);
    SAYS("jumps", DALCS_YES);
    SAYS("convergence", DALCS_YES);
#endif
    finish();
}

END_TEST

/* (38): D is skew, the states are bounded, one voltage is free. */
START_TEST(bridge_with_capacitor) {
    const double A[] = {-1, 1, 0, 1, 0};
    const double C[] = {1, 0, -1, 0, 0, /* */ 0, 1, 0, 1, -1, /* */ 1, 0, -1, 0, 0, 0, 0, 1, 0, 0};
    const double storage[] = {1};
    check(&(struct dense_system){.n = 1, .m = 4, .A = A, .C = C, .storage = storage}, 0.01);
    HOLDS("K6", DALCS_NO);
    HOLDS("PSD-D", DALCS_YES);
    HOLDS("K1", DALCS_YES);
    ck_assert_double_eq_tol(only_value("K1"), 1.0, 1e-12);
    HOLDS("K13", DALCS_NO);
    SAYS("passive", DALCS_YES);
    ck_assert(verdict("multipliers")->answer != DALCS_YES);
    SAYS("contracting", DALCS_YES);
    ck_assert_double_eq_tol(verdict("contracting")->value, 1.0, 1e-3);
    SAYS("periodic", DALCS_YES);
    finish();
}

END_TEST

/* Where proposition 3 and its corollary 1 as printed would say "one value" of a whole interval. */
START_TEST(misprinted_21) {
    const double A[2][3] = {{0, 0, 1}, {0, 1, -1}};
    const double C[2][6] = {{1, 1, -1, 0, 1, 0}, {1, 0.5, 0.5, 1, 0.5, 0.5}};
    for (int k = 0; k < 2; k++) {
        check(&(struct dense_system){.n = 1, .m = 2, .A = A[k], .C = C[k]}, 0.01);
        HOLDS("PSD-D", DALCS_YES);
        ck_assert_int_ne(condition("Prop3")->holds, DALCS_YES);
        finish();
    }
}

END_TEST

#ifdef DALCS_WITH_GLPK
/* A.7 of Brogliato and Thibault: (22) holds for max(a, b) > 0, not for min(a, b) < 0 as printed. */
START_TEST(qualification) {
    const double ab[3][2] = {{-1, -1}, {-1, 2}, {1, 1}};
    for (int k = 0; k < 3; k++) {
        const double a = ab[k][0];
        const double b = ab[k][1];
        const double A[] = {0, 0, 1, 0, a, /* */ 0, 0, 0, 1, b};
        const double C[] = {1, 0, 0, 0, 0, /* */ 0, 1, 0, 0, 0, /* */ a, b, 0, 0, 0};
        check(&(struct dense_system){.n = 2, .m = 3, .A = A, .C = C}, 0.01);
        HOLDS("K8", k == 0 ? DALCS_NO : DALCS_YES);
        HOLDS("K1", DALCS_YES);
        finish();
    }
}

END_TEST
#endif

/* ---- Heemels, Schumacher and Weiland 1999 ---------------------------------------------------- */

/* Example 4.11, M = [1 + 1/s 1; 1 1], and 4.2 b, [1 + 1/s -1; -1 1 + 1/s]: P-matrices for every s. */
START_TEST(p_matrices) {
    const double A1[] = {0, 1, 0};
    const double C1[] = {1, 1, 1, /* */ 0, 1, 1};
    check(&(struct dense_system){.n = 1, .m = 2, .A = A1, .C = C1}, 0.01);
    SAYS("step", DALCS_YES);
    SAYS("unique", DALCS_YES);
    ck_assert_int_ne(verdict("exists")->answer, DALCS_NO);
#ifdef DALCS_WITH_GLPK
    SAYS("exists", DALCS_YES);
#endif
    finish();
    const double A2[] = {0, 0, 1, 0, /* */ 0, 0, 0, 1};
    const double C2[] = {1, 0, 1, -1, /* */ 0, 1, -1, 1};
    check(&(struct dense_system){.n = 2, .m = 2, .A = A2, .C = C2}, 0.01);
    SAYS("step", DALCS_YES);
    SAYS("unique", DALCS_YES);
    HOLDS("K1", DALCS_YES);
    finish();
}

END_TEST

/* A mass above the floor, q'' = u, 0 <= u _|_ q >= 0: relative degree 2. */
START_TEST(relative_degree_2) {
    const double A[] = {0, 1, 0, /* */ 0, 0, 1};
    const double C[] = {1, 0, 0};
    check(&(struct dense_system){.n = 2, .m = 1, .A = A, .C = C}, 0.01);
    HOLDS("impulse", DALCS_NO);
    HOLDS("P", DALCS_YES);
    SAYS("step", DALCS_YES);
    SAYS("passive", DALCS_NO);
    finish();
}

END_TEST

/* Example 5.18: B = [1 -1; 1 -1]: a negative minor of d2. Example 5.11, B = [1 1; 1 1]: no minor is
 * negative and one is 0; M(s) = B/s >= 0 for every s, so the states are unique and the currents not. */
START_TEST(minors) {
    const double C[] = {1, 0, 0, 0, /* */ 0, 1, 0, 0};
    const double bad[] = {0, 0, 1, -1, /* */ 0, 0, 1, -1};
    check(&(struct dense_system){.n = 2, .m = 2, .A = bad, .C = C}, 0.01);
    SAYS("unique", DALCS_NO);
    SAYS("step", DALCS_NO);
    const struct dalcs_evidence *w = &verdict("unique")->witness[0];
    ck_assert_str_eq(w->kind, "minor");
    ck_assert_double_lt(w->entry[1].re, 0.0);
    ck_assert_str_eq(w->entry[2].name, "v(d2)");
    finish();
    const double flat[] = {0, 0, 1, 1, /* */ 0, 0, 1, 1};
    check(&(struct dense_system){.n = 2, .m = 2, .A = flat, .C = C}, 0.01);
    SAYS("unique", DALCS_YES);
    SAYS("multipliers", DALCS_CONDITIONAL);
    SAYS("step", DALCS_YES);
    finish();
}

END_TEST

#ifdef DALCS_WITH_GLPK
RUN_TESTS("part", example_1, example_2_first_feedback, example_2_second_feedback, example_3_first,
          example_3_second, example_4, example_5, two_diodes_corrected, two_diodes_as_printed,
          bridge_over_a_tank, bridge_with_capacitor, misprinted_21, qualification, p_matrices,
          relative_degree_2, minors)
#else
RUN_TESTS("part", example_1, example_2_first_feedback, example_2_second_feedback, example_3_first,
          example_3_second, example_4, example_5, two_diodes_corrected, two_diodes_as_printed,
          bridge_over_a_tank, bridge_with_capacitor, misprinted_21, p_matrices, relative_degree_2,
          minors)
#endif
