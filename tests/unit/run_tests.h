/* run_tests.h - the main function of a unit test. */
#ifndef DALCS_TEST_RUN_TESTS_H
#define DALCS_TEST_RUN_TESTS_H

#include <check.h>

/* s; a busy machine may take this long for what takes a second. */
enum { MOST_SECONDS = 60 };

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
