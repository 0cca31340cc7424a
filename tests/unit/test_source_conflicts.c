/* test_source_conflicts.c - what sources alone make impossible or leave open, and what is left to the
 * run. */
#include "source_conflicts.h"

#include "build_network.h"

#include <stdio.h>

/* The messages about a circuit, their first lines. */
static void check_messages(const char *text, const char *expected) {
    struct text_network t;
    char found[2048] = "";
    build_good_network(&t, text);
    size_t n_before = t.diag.n;
    enum dalcs_status status = dalcs_source_conflicts(&t.circuit, &t.diag);
    ck_assert_int_eq(status, strstr(expected, "error: ") != NULL ? DALCS_E_NETLIST : DALCS_OK);
    for (size_t k = n_before; k < t.diag.n; k++) {
        const char *said = strchr(t.diag.item[k].text, ' ') + 1; /* behind the place */
        size_t n = strcspn(said, "\n");
        ck_assert_uint_lt(strlen(found) + n + 2, sizeof(found));
        strncat(found, said, n);
        strcat(found, "\n");
    }
    ck_assert_str_eq(found, expected);
    text_network_finish(&t);
}

#define AGREE ": the voltages agree, but that current is not determined; by convention "

START_TEST(test_constants) {
    check_messages("agree\nV1 a 0 5\nV2 0 a -5\nR1 a 0 1\n.op\n",
                   "warning: nothing limits the current around the loop v2 (-5 V), v1 (5 V)" AGREE
                   "v2 carries none\n");
    check_messages(
        "agree but for rounding\nV1 a 0 0.1\nV2 b a 0.2\nV3 b 0 0.3\nR1 b 0 1\n.op\n",
        "warning: nothing limits the current around the loop v3 (300 mV), v1 (100 mV), v2 "
        "(200 mV)" AGREE "v3 carries none\n");
    check_messages("neither surely\nV1 a 0 1\nV2 a 0 1.00000000001\nR1 a 0 1\n.op\n", "");
    check_messages("no loop\nV1 a 0 1\nV2 b a 1\nV3 c 0 1\nR1 b c 1\n.op\n", "");
    check_messages("no short\nV1 a 0 1\nR1 a b 0\nR2 b 0 1\n.op\n", "");
}

END_TEST

/* Equal functions cancel, where one goes with the loop and one against it. */
START_TEST(test_functions) {
    static const char *const function[] = {"SIN(0 5 50)", "PULSE(0 1 0 1u 1u 1m 2m)",
                                           "EXP(0 1 0 1m)", "PWL(0 0 1m 1 2m 0)"};
    static const char *const other[] = {"SIN(0 5 51)", "PULSE(0 1 0 1u 1u 1m 3m)", "EXP(0 1 0 2m)",
                                        "PWL(0 0 1m 1 2m 1)"};
    for (int k = 0; k < 4; k++) {
        char text[256];
        snprintf(text, sizeof(text), "same\nV1 a 0 %s\nV2 a 0 %s\nR1 a 0 1\n.tran 1u 1m\n",
                 function[k], function[k]);
        check_messages(text, "warning: nothing limits the current around the loop v2, v1" AGREE
                             "v2 carries none\n");
        snprintf(text, sizeof(text), "head to tail\nV1 a 0 %s\nV2 0 a %s\nR1 a 0 1\n.tran 1u 1m\n",
                 function[k], function[k]);
        check_messages(text, "");
        snprintf(text, sizeof(text), "another\nV1 a 0 %s\nV2 a 0 %s\nR1 a 0 1\n.tran 1u 1m\n",
                 function[k], other[k]);
        check_messages(text, "");
    }
    check_messages("another DC value\nV1 a 0 DC 1 SIN(0 5 50)\nV2 a 0 SIN(0 5 50)\nR1 a 0 1\n.op\n",
                   "");
}

END_TEST

/* A short whose current is not read makes no conflict. */
START_TEST(test_shorts) {
    check_messages("two shorts\nV1 a 0 1\nR1 a b 0\nR2 a b 0\nR3 b 0 1\n.op\n.save v(b)\n", "");
    check_messages("one is asked for\nV1 a 0 1\nR1 a b 0\nR2 a b 0\nR3 b 0 1\n.op\n.save i(r1)\n",
                   "warning: nothing limits the current around the loop r1, r2" AGREE
                   "r1 carries none\n");
}

END_TEST

START_TEST(test_parts) {
    check_messages("balanced\nI1 0 a 1\nR1 a b 1\nI2 b 0 1\n.op\n", "");
    check_messages("a controlled source may balance it\nI1 0 a 1\nG1 a 0 b 0 1\nV1 b 0 1\n.op\n",
                   "");
    check_messages("two parts\nI1 a b 2\nR1 a c 1\nR2 b d 1\nV1 x 0 1\n.op\n",
                   "error: nothing but i1 (2 A) reaches nodes a, c: its current has no way in\n"
                   "error: nothing but i1 (2 A) reaches nodes b, d: its current has no way out\n");
    check_messages("nothing flows\nI1 0 a 0\nR1 a b 1\n.op\n", "");
}

END_TEST

/* A source that closes a loop carries nothing, so that no method divides by rounding. */
START_TEST(test_idle) {
    struct text_network t;
    build_good_network(&t, "three\nV1 a 0 5\nV2 a 0 5\nV3 a 0 5\nR1 a 0 1\n.op\n");
    const struct dalcs_system *s = &t.network.system[0];
    for (int k = 1; k <= 3; k++) {
        const char name[] = {'v', (char)('0' + k), '\0'};
        int row = find_row(s, DALCS_LABEL_BRANCH, name);
        int column = find_column(s, DALCS_LABEL_BRANCH, name);
        int kcl = find_row(s, DALCS_LABEL_NODE, "a");
        ck_assert_double_eq(entry_of(&s->A, row, column), k == 1 ? 0.0 : -1.0);
        ck_assert_int_eq(entry_of(&s->A, kcl, column) != 0.0, k == 1);
    }
    text_network_finish(&t);
}

END_TEST

RUN_TESTS("source_conflicts", test_constants, test_functions, test_shorts, test_parts, test_idle)
