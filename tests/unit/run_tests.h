/* run_tests.h - the main function of a unit test. */
#ifndef DALCS_TEST_RUN_TESTS_H
#define DALCS_TEST_RUN_TESTS_H

#include <check.h>
#include <stdlib.h>

/* Check writes to a file at each assertion that holds, to say where a test was that a signal ended. That took half of the
 * time of all unit tests. */
#define _mark_point(file, line) ((void)0)

/* s; a busy machine may take this long for what takes a second. */
enum { MOST_SECONDS = 60 };

/* How many of equal cases to go through: `all`, or `few` where DALCS_TEST_FEW is set, as .ci/run does for
 * valgrind: it is fifty times slower, and a value that nothing has set shows in few of them as in all. */
static inline int of_cases(int all, int few) {
    return getenv("DALCS_TEST_FEW") != NULL ? few : all;
}

static inline int run_tests(const char *name, const TTest *const *test, size_t n) {
    Suite *suite = suite_create(name);
    TCase *tests = tcase_create(name);
    tcase_set_timeout(tests, MOST_SECONDS);
    for (size_t k = 0; k < n; k++) {
        tcase_add_test(tests, test[k]);
    }
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int n_failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return n_failed == 0 ? 0 : 1;
}

#define RUN_TESTS(name, ...)                                                                       \
    int main(void) {                                                                               \
        const TTest *const tests[] = {__VA_ARGS__};                                                \
        return run_tests(name, tests, sizeof tests / sizeof tests[0]);                             \
    }

#endif
