/* sample_plot.h - a small table of results, and files in a folder of their own. */
#ifndef DALCS_SAMPLE_PLOT_H
#define DALCS_SAMPLE_PLOT_H

#include "dalcs.h"

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const sample_name[] = {"v(out)", "v(a,b)", "i(d1)"};

static const enum dalcs_unit sample_unit[] = {DALCS_VOLT, DALCS_VOLT, DALCS_AMPERE};

static const double sample_row[2][3] = {{1.0 / 3.0, -0.0, 5e-324}, {-2.385e300, 0.1, 1e-7}};

static inline struct dalcs_plot sample_plot(enum dalcs_analysis analysis) {
    return (struct dalcs_plot){.analysis = analysis,
                               .title = "a title\twith a tab",
                               .scale = "time",
                               .scale_unit = DALCS_UNIT_SECOND,
                               .n_signals = 3,
                               .name = sample_name,
                               .unit = sample_unit,
                               .n_steps = 1};
}

/* "folder/name"; the folder is new for each test and the current one. */
static char sample_folder[64];

static inline void enter_folder(void) {
    strcpy(sample_folder, "/tmp/dalcs-unit-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(sample_folder));
    ck_assert_int_eq(chdir(sample_folder), 0);
}

static inline void leave_folder(void) {
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", sample_folder);
    ck_assert_int_eq(chdir("/"), 0);
    ck_assert_int_eq(system(command), 0);
}

/* A file's bytes, NUL-terminated; NULL when there is no such file. free() it. */
static inline char *read_all(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        return NULL;
    }
    struct stat status;
    ck_assert_int_eq(fstat(fileno(file), &status), 0);
    char *text = calloc((size_t)status.st_size + 1, 1);
    ck_assert_ptr_nonnull(text);
    *length = fread(text, 1, (size_t)status.st_size, file);
    fclose(file);
    return text;
}

static inline void write_all(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    fputs(text, file);
    ck_assert_int_eq(fclose(file), 0);
}

static inline void check_contents(const char *path, const char *expected) {
    size_t length = 0;
    char *text = read_all(path, &length);
    ck_assert_msg(text != NULL, "there is no file %s", path);
    ck_assert_str_eq(text, expected);
    free(text);
}

static inline int run_suite(const char *name, const TTest *const *test, size_t n) {
    Suite *suite = suite_create(name);
    TCase *tests = tcase_create(name);
    tcase_set_timeout(tests, 60); /* s; of a busy machine, for what takes less than one */
    tcase_add_checked_fixture(tests, enter_folder, leave_folder);
    for (size_t i = 0; i < n; i++) {
        tcase_add_test(tests, test[i]);
    }
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    int n_failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return n_failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#define RUN_SUITE(name, ...)                                                                       \
    int main(void) {                                                                               \
        const TTest *const tests[] = {__VA_ARGS__};                                                \
        return run_suite(name, tests, sizeof tests / sizeof tests[0]);                             \
    }

#endif
