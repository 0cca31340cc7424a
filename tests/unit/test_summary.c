/* test_summary.c - the lines that say which method was taken, and why, and what is open. */
#include "summary.h"

#include "run_tests.h"

#include <stdlib.h>
#include <string.h>

/* The line of that kind in the summary of `report`, or "". */
static void check_kind(const struct dalcs_report *report, const char *kind, const char *expected) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(stream);
    dalcs_summary_write_run(stream, report);
    ck_assert_int_eq(fclose(stream), 0);
    char *line = strstr(text, kind);
    if (line != NULL) {
        line += strlen(kind);
        *strchr(line, '\n') = '\0';
    }
    ck_assert_str_eq(line != NULL ? line : "", expected);
    free(text);
}

static void check_line(const struct dalcs_report *report, const char *expected) {
    check_kind(report, "  method    ", expected);
}

START_TEST(test_open) {
    struct dalcs_report report = {.n_nonunique = 0};
    check_kind(&report, "  open      ", "");
    report.n_nonunique = 1;
    check_kind(&report, "  open      ",
               "1 signal is not determined by the circuit: see the messages");
    report.n_nonunique = 4;
    check_kind(&report, "  open      ",
               "4 signals are not determined by the circuit: see the messages");
}

END_TEST

START_TEST(test_fixed_step) {
    const struct dalcs_component_method euler[] = {{"euler", 1, NULL}, {"euler", 1, NULL}};
    const struct dalcs_component_method radau[] = {{"radau", 3, NULL}};
    check_line(&(struct dalcs_report){.method = "euler",
                                      .step = 20e-6,
                                      .n_components = 2,
                                      .component = euler,
                                      .work.steps = 2000},
               "euler, step 20 us: 2000 steps");
    check_line(&(struct dalcs_report){.method = "radau",
                                      .tolerance = 1e-6,
                                      .step = 1.0,
                                      .n_components = 1,
                                      .component = radau,
                                      .work = {.steps = 1, .euler_steps = 1}},
               "radau, 3 stages, step 1 s: 1 step, 1 by euler");
}

END_TEST

START_TEST(test_controlled_error) {
    const struct dalcs_component_method asked[] = {{"radau", 1, NULL}};
    const struct dalcs_component_method chosen[] = {{"radau", 5, "tolerance 1e-06"}};
    struct dalcs_report report = {.method = "radau",
                                  .tolerance = 1e-3,
                                  .n_components = 1,
                                  .component = asked,
                                  .work = {.steps = 412, .rejected = 31, .restarts = 24}};
    check_line(&report, "radau, 1 stage (tolerance 0.001): 412 steps, 31 rejected, 24 restarts");
    report.method = "auto";
    report.component = chosen;
    report.work.rejected = report.work.restarts = 0;
    check_line(&report, "auto: radau, 5 stages (tolerance 1e-06): 412 steps");
}

END_TEST

START_TEST(test_groups) {
    struct dalcs_component_method part[251];
    for (size_t k = 0; k < 251; k++) {
        part[k] = (struct dalcs_component_method){"radau", 5, "tolerance 1e-06"};
    }
    struct dalcs_report report = {
        .method = "auto", .n_components = 250, .component = part, .work.steps = 9};
    check_line(&report, "auto: radau, 5 stages in 250 components (tolerance 1e-06): 9 steps");
    report.n_components = 251;
    part[100] = (struct dalcs_component_method){"algebraic", 1, "no state and no diode"};
    check_line(&report, "auto: radau, 5 stages in 250 components (tolerance 1e-06); "
                        "algebraic in 1 component (no state and no diode): 9 steps");
    for (size_t k = 0; k < 251; k++) {
        part[k].stages = (int)k; /* all differ */
    }
    report.n_components = 6;
    check_line(&report, "auto: radau, 0 stages in 1 component (tolerance 1e-06); "
                        "radau, 1 stage in 1 component (tolerance 1e-06); "
                        "radau, 2 stages in 1 component (tolerance 1e-06); "
                        "radau, 3 stages in 1 component (tolerance 1e-06); ...: 9 steps");
}

END_TEST

START_TEST(test_no_transient) {
    check_line(&(struct dalcs_report){.method = "auto", .size.components = 1}, "");
}

END_TEST

RUN_TESTS("summary", test_open, test_fixed_step, test_controlled_error, test_groups,
          test_no_transient)
