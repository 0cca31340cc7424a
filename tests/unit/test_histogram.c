/* Counts of values that are known, and what a histogram is not of. */
#include "histogram.h"
#include "run_tests.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum dalcs_status histogram_of(const char *text, const char *signal,
                                      struct dalcs_waveforms *histogram, char *message,
                                      size_t size) {
    struct dalcs_diag diag = {0};
    struct dalcs_waveforms waveforms = {0};
    struct dalcs_selection selection = {0};
    enum dalcs_status status =
        dalcs_waveforms_read_text(&waveforms, "a.csv", text, strlen(text), 0, &diag);
    ck_assert_int_eq(status, DALCS_OK);
    const char *const group[] = {signal};
    status =
        dalcs_selection_make(&selection, &waveforms, group, 1, (double)NAN, (double)NAN, &diag);
    ck_assert_int_eq(status, DALCS_OK);
    status = dalcs_histogram_make(histogram, &selection, &diag);
    (void)snprintf(message, size, "%s", diag.n > 0 ? diag.item[diag.n - 1].text : "");
    dalcs_selection_finish(&selection);
    dalcs_waveforms_finish(&waveforms);
    dalcs_diag_finish(&diag);
    return status;
}

/* 64 values give 8 classes: k of the values are in class k. */
START_TEST(test_counts) {
    char *text = NULL;
    char message[200];
    size_t size = 0;
    struct dalcs_waveforms h = {0};
    FILE *out = open_memstream(&text, &size);
    fputs("run,ripple,error\n", out);
    const int wanted[] = {1, 2, 3, 4, 5, 6, 7, 36};
    int n = 0;
    for (int k = 0; k < 8; k++) {
        for (int i = 0; i < wanted[k]; i++) {
            /* in the middle of the classes of 0 to 8, whose ends the first and the last are */
            fprintf(out, "%d,%g,\n", ++n, k == 0 ? 0.0 : k == 7 && i == 0 ? 8.0 : k + 0.5);
        }
    }
    fprintf(out, "%d,nan,\"failed\"\n", ++n);
    fclose(out);
    ck_assert_int_eq(histogram_of(text, "ripple", &h, message, sizeof message), DALCS_OK);
    ck_assert_str_eq(h.name[0], "ripple");
    ck_assert_str_eq(h.name[1], "runs");
    ck_assert_uint_eq(h.n_rows, 18);
    for (size_t k = 0; k < 8; k++) {
        for (size_t end = 0; end < 2; end++) {
            const double *row = h.value + 2 * (1 + 2 * k + end);
            ck_assert_double_eq_tol(row[0], (double)(k + end), 1e-15);
            ck_assert_double_eq(row[1], wanted[k]);
        }
    }
    ck_assert_double_eq(h.value[1], 0.0);
    ck_assert_double_eq(h.value[2 * 17 + 1], 0.0);
    dalcs_waveforms_finish(&h);
    free(text);
}

END_TEST

START_TEST(test_refusals) {
    static const struct {
        const char *text, *signal, *why;
    } known[] = {
        {"run,a,b\n1,2,3\n2,3,4\n", "a,b", "shows one signal, and these are 2"},
        {"run,a\n1,2\n2,2\n", "a", "all values of 'a' are the same"},
        {"run,a\n1,nan\n2,nan\n", "a", "'a' has no values"},
        {"time,v(a)\n1,2\n2,3\n", "v(a)", "not waveforms"},
    };

    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        struct dalcs_waveforms h = {0};
        char message[200];
        ck_assert_int_eq(histogram_of(known[k].text, known[k].signal, &h, message, sizeof message),
                         DALCS_E_OPTION);
        ck_assert_msg(strstr(message, known[k].why) != NULL, "%s", message);
    }
}

END_TEST

RUN_TESTS("histogram", test_counts, test_refusals)
