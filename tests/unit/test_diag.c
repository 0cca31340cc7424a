/* test_diag.c - messages as a person reads them. */
#include "diag.h"

#include "run_tests.h"

#include <string.h>

static struct dalcs_diag diag;

static void check_last(enum dalcs_severity severity, const char *text) {
    ck_assert_uint_gt(diag.n, 0);
    ck_assert_int_eq(diag.item[diag.n - 1].severity, severity);
    ck_assert_str_eq(diag.item[diag.n - 1].text, text);
}

START_TEST(test_places) {
    dalcs_diag_add(&diag, DALCS_NOTE, NULL, NULL, "no place, %d values", 3);
    check_last(DALCS_NOTE, "note: no place, 3 values");
    const struct dalcs_location file = {.file = "a.cir"};
    dalcs_diag_add(&diag, DALCS_WARNING, &file, "a hint", "a file");
    check_last(DALCS_WARNING, "a.cir: warning: a file\n  hint: a hint");
    const struct dalcs_location line = {.file = "a.cir", .line = 3};
    dalcs_diag_add(&diag, DALCS_ERROR, &line, NULL, "a line");
    check_last(DALCS_ERROR, "a.cir:3: error: a line");
    const struct dalcs_location place = {
        .file = "a.cir", .source_line = "R1 in out abc", .line = 4, .column = 11, .length = 3};
    dalcs_diag_add(&diag, DALCS_ERROR, &place, "write a number", "'%s' is not a number", "abc");
    check_last(DALCS_ERROR, "a.cir:4:11: error: 'abc' is not a number\n"
                            "R1 in out abc\n"
                            "          ^~~\n"
                            "  hint: write a number");
    ck_assert_uint_eq(diag.n_errors, 2);
    dalcs_diag_finish(&diag);
    ck_assert_uint_eq(diag.n, 0);
}

END_TEST

/* The caret stands right whatever a tab's width, and counts characters, not bytes. */
START_TEST(test_caret) {
    const struct dalcs_location tabs = {
        .file = "t", .source_line = "R1\tin\tx", .line = 1, .column = 7, .length = 1};
    dalcs_diag_add(&diag, DALCS_ERROR, &tabs, NULL, "x");
    check_last(DALCS_ERROR, "t:1:7: error: x\nR1\tin\tx\n  \t  \t^");
    const struct dalcs_location utf8 = {.file = "t",
                                        .source_line = "C\xC2\xB5 \xE2\x84\xA6 x",
                                        .line = 1,
                                        .column = 6,
                                        .length = 1};
    dalcs_diag_add(&diag, DALCS_ERROR, &utf8, NULL, "x");
    check_last(DALCS_ERROR, "t:1:6: error: x\nC\xC2\xB5 \xE2\x84\xA6 x\n     ^");
    /* Underlining stops with the line, and a caret may stand just after it. */
    const struct dalcs_location beyond = {
        .file = "t", .source_line = "ab", .line = 1, .column = 2, .length = 9};
    dalcs_diag_add(&diag, DALCS_ERROR, &beyond, NULL, "x");
    check_last(DALCS_ERROR, "t:1:2: error: x\nab\n ^");
    const struct dalcs_location after = {
        .file = "t", .source_line = "ab", .line = 1, .column = 3, .length = 1};
    dalcs_diag_add(&diag, DALCS_ERROR, &after, NULL, "x");
    check_last(DALCS_ERROR, "t:1:3: error: x\nab\n  ^");
    dalcs_diag_finish(&diag);
}

END_TEST

START_TEST(test_long_line) {
    char text[1001];
    for (int k = 0; k < 1000; k++) {
        text[k] = (char)('a' + k % 26);
    }
    text[1000] = '\0';
    const struct dalcs_location where = {.file = "t",
                                         .source_line = text,
                                         .line = 1,
                                         .column = 521,
                                         .length = 2}; /* character 520 is 'a' */
    dalcs_diag_add(&diag, DALCS_ERROR, &where, NULL, "x");
    const char *line = strchr(diag.item[0].text, '\n') + 1;
    const char *caret_line = strchr(line, '\n') + 1;
    const size_t caret = strcspn(caret_line, "^");
    ck_assert_str_eq(caret_line + caret, "^~");
    ck_assert_int_eq(strncmp(line, "...", 3), 0);
    ck_assert_int_eq(strncmp(line + caret, "abcdef", 6), 0);
    ck_assert_uint_lt(strcspn(line, "\n"), 170);
    dalcs_diag_finish(&diag);
}

END_TEST

/* A flood of warnings must not hide an error, and ends with a word about the rest. */
START_TEST(test_flood) {
    for (int k = 0; k < 5000; k++) {
        dalcs_diag_add(&diag, DALCS_WARNING, NULL, NULL, "warning %d", k);
    }
    dalcs_diag_add(&diag, DALCS_ERROR, NULL, NULL, "the error");
    check_last(DALCS_ERROR, "error: the error");
    ck_assert_uint_eq(diag.n_other, 5000);
    for (int k = 0; k < 5000; k++) {
        dalcs_diag_add(&diag, DALCS_ERROR, NULL, NULL, "error %d", k);
    }
    ck_assert_uint_eq(diag.n_errors, 5001);
    ck_assert_uint_eq(diag.n, DALCS_DIAG_MAX_ERRORS + DALCS_DIAG_MAX_OTHER);
    check_last(DALCS_ERROR, "error: more errors than are shown here");
    dalcs_diag_finish(&diag);
}

END_TEST

START_TEST(test_sort) {
    static const int place[][2] = {{7, 1}, {0, 0}, {2, 5}, {7, 1}, {2, 1}, {1, 9}, {0, 0}};
    for (int k = 0; k < 7; k++) {
        const struct dalcs_location where = {.file = "t",
                                             .source_line = NULL,
                                             .line = place[k][0],
                                             .column = place[k][1],
                                             .length = 1};
        dalcs_diag_add(&diag, DALCS_ERROR, &where, NULL, "%d", k);
    }
    dalcs_diag_sort(&diag);
    static const char wanted[] = "5420316"; /* equal places keep their order, none come last */
    for (int k = 0; k < 7; k++) {
        const char *text = diag.item[k].text;
        ck_assert_int_eq(text[strlen(text) - 1], wanted[k]);
    }
    dalcs_diag_finish(&diag);
}

END_TEST

RUN_TESTS("diag", test_places, test_caret, test_long_line, test_flood, test_sort)
