/* test_choice.c - stages, tolerance and maps by size, sources and spread of conductances. */
#include "choice.h"

#include "build_network.h"

#include <stdio.h>

enum { DENSE_LIMIT = 64, TEXT = 8192 };

static const char source[] = "V1 n0 0 SIN(0 1 50)\n";
static const char gate[] = "V2 n0 0 PULSE(0 1 0 1n 1n 1u 2u)\n";

/* A source and a chain of so many resistors, each with a capacitor: n unknowns and a few. */
static struct dalcs_choice choice_of(const char *first, int sections, double farads,
                                     const struct dalcs_radau_options *options) {
    char text[TEXT];
    int used = snprintf(text, sizeof(text), "choice\n%s", first);
    for (int k = 0; k < sections; k++) {
        used += snprintf(text + used, sizeof(text) - (size_t)used, "R%d n%d n%d 1\nC%d n%d 0 %g\n",
                         k, k, k + 1, k, k + 1, farads);
    }
    (void)snprintf(text + used, sizeof(text) - (size_t)used, ".tran 1m 1\n");
    struct text_network t;
    build_good_network(&t, text);
    const struct dalcs_component c = {.system = &t.network.system[0], .circuit = &t.circuit};
    struct dalcs_conductances g = dalcs_conductances_find(c.system, options->stop);
    /* Two resistors meet at a node; storage over the whole run, which is 1 s. */
    ck_assert_double_eq_tol(g.most / g.least * farads, 2.0, 1e-9);
    struct dalcs_choice choice = dalcs_choice_make(options, &c, &g, DENSE_LIMIT);
    text_network_finish(&t);
    return choice;
}

static const struct dalcs_radau_options usual = {.tolerance = 1e-6, .stop = 1.0};

START_TEST(test_small_parts_aim_higher) {
    struct dalcs_choice few = choice_of(source, 2, 1e-3, &usual);
    ck_assert_double_eq(few.tolerance, 1e-9);
    ck_assert_int_eq(few.stages, 9);
    ck_assert_str_eq(few.because, "very small, held to 1e-9");
    ck_assert_double_eq(choice_of(gate, 2, 1e-3, &usual).tolerance, 1e-9);
    ck_assert_int_eq(choice_of(gate, 2, 1e-3, &usual).stages, 7);
    struct dalcs_radau_options fine = usual;
    fine.tolerance = 1e-11;
    ck_assert_double_eq(choice_of(source, 2, 1e-3, &fine).tolerance, 1e-11);
    ck_assert_str_eq(choice_of(source, 2, 1e-3, &fine).because, "very small");
    ck_assert_double_eq(choice_of(source, 15, 1e-3, &usual).tolerance, 1e-9);
    ck_assert_double_eq(choice_of(source, 40, 1e-3, &usual).tolerance, 1e-6);
}

END_TEST

START_TEST(test_what_is_asked_for_is_taken) {
    struct dalcs_radau_options asked = usual;
    asked.stages = 5;
    struct dalcs_choice choice = choice_of(source, 2, 1e-3, &asked);
    ck_assert_double_eq(choice.tolerance, 1e-6);
    ck_assert_int_eq(choice.stages, 5);
    ck_assert_ptr_null(choice.because);
    struct dalcs_radau_options fixed = usual;
    fixed.fixed_step = 1e-3;
    ck_assert_double_eq(choice_of(source, 2, 1e-3, &fixed).tolerance, 1e-6);
}

END_TEST

static const char wave[] = "V1 n0 0 SIN(0 1 50)\n.model DI D(ron=1)\n";
static const char pulse[] = "V1 n0 0 PULSE(0 1 0 1n 1n 1u 2u)\n.model DI D(ron=1)\n";

/* The choice for a source and a chain of 40 sections, 83 unknowns or more, with n diodes along its resistors. */
static struct dalcs_choice choice_with_diodes(const char *first, int n,
                                              const struct dalcs_radau_options *options) {
    char text[TEXT];
    int used = snprintf(text, sizeof(text), "%s", first);
    for (int k = 0; k < n; k++) {
        used += snprintf(text + used, sizeof(text) - (size_t)used, "D%d n%d n%d DI\n", k, k, k + 1);
    }
    return choice_of(text, 40, 1e-3, options);
}

/* Factors of few modes serve all steps: many stages, whatever drives it and how loose the tolerance. 2^6 is less than the
 * number of unknowns, 2^7 is not. */
START_TEST(test_large_parts) {
    struct dalcs_radau_options loose = usual;
    loose.tolerance = 1e-3;
    ck_assert_int_eq(choice_of(source, 40, 1e-3, &usual).stages, 9);
    ck_assert_int_eq(choice_of(gate, 40, 1e-3, &loose).stages, 9);
    ck_assert_str_eq(choice_of(gate, 40, 1e-3, &loose).because, "large, few modes");
    ck_assert_int_eq(choice_with_diodes(wave, 6, &usual).stages, 9);
    ck_assert_int_eq(choice_with_diodes(pulse, 6, &loose).stages, 9);
    ck_assert_int_eq(choice_with_diodes(wave, 7, &usual).stages, 7);
    ck_assert_str_eq(choice_with_diodes(wave, 7, &usual).because, "large, sine");
}

END_TEST

/* Each new mode is a factorisation for each stage. A loose tolerance takes as many: errors are held to 1e-6 at least, for
 * which three stages take twice the steps. */
START_TEST(test_large_parts_that_are_switched) {
    struct dalcs_radau_options asked = usual;
    asked.tolerance = 1e-2;
    ck_assert_int_eq(choice_with_diodes(pulse, 7, &asked).stages, 5);
    asked.tolerance = 5e-5;
    ck_assert_int_eq(choice_with_diodes(pulse, 7, &asked).stages, 5);
    ck_assert_str_eq(choice_with_diodes(pulse, 7, &asked).because, "large");
}

END_TEST

/* Maps beyond half the limit: at tight tolerances, where digits are lost on factors. */
START_TEST(test_maps) {
    struct dalcs_radau_options fine = usual;
    fine.tolerance = 1e-9;
    ck_assert_int_eq(choice_of(source, 40, 1e-3, &usual).map_limit, 32);
    ck_assert_int_eq(choice_of(source, 40, 1e-3, &fine).map_limit, 32);
    ck_assert_int_eq(choice_of(source, 40, 1e-7, &fine).map_limit, 96);
    ck_assert_int_eq(choice_of(source, 40, 1e-7, &usual).map_limit, 32);
    fine.stages = 3;
    ck_assert_int_eq(choice_of(source, 40, 1e-3, &fine).map_limit, 96);
}

END_TEST

RUN_TESTS("choice", test_small_parts_aim_higher, test_what_is_asked_for_is_taken, test_large_parts,
          test_large_parts_that_are_switched, test_maps)
