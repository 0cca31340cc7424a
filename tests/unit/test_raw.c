/* test_raw.c - the binary raw file: its header to the byte, its values to the bit. That ngspice
 * reads the same is checked in tests/golden. */
#include "sample_plot.h"
#include "table.h"

#include <time.h>

#define N_BYTES(n) ((size_t)(n) * sizeof(double))

static void write_plot(struct dalcs_table *table, enum dalcs_analysis analysis, int n_rows) {
    struct dalcs_plot plot = sample_plot(analysis);
    ck_assert_int_eq(dalcs_table_begin(table, &plot), DALCS_OK);
    for (int i = 0; i < n_rows; i++) {
        ck_assert_int_eq(dalcs_table_rows(table, 1, &(double){0.1 * i}, sample_row[i]), DALCS_OK);
    }
    ck_assert_int_eq(dalcs_table_end(table), DALCS_OK);
}

/* The same wherever the test runs. */
static void fix_the_date(void) {
    setenv("SOURCE_DATE_EPOCH", "0", 1);
    setenv("TZ", "XYZ-3", 1);
    tzset();
}

/* Header text at *place, then n doubles; moves *place behind them. */
static void check_plot(const char **place, const char *header, const double *value, size_t n) {
    ck_assert_msg(strncmp(*place, header, strlen(header)) == 0, "header is %.400s", *place);
    *place += strlen(header);
    ck_assert_mem_eq(*place, value, N_BYTES(n));
    *place += N_BYTES(n);
}

static const char transient_header[] = "Title: a title with a tab\n"
                                       "Date: Thu Jan  1 00:00:00 1970\n"
                                       "Plotname: Transient Analysis\n"
                                       "Flags: real\n"
                                       "Command: * ngspice-compatible, dalcs " DALCS_VERSION "\n"
                                       "No. Variables: 4\n"
                                       "No. Points: 2                   \n"
                                       "Variables:\n"
                                       "\t0\ttime\ttime\n"
                                       "\t1\tv(out)\tvoltage\n"
                                       "\t2\tv(a,b)\tvoltage\n"
                                       "\t3\ti(d1)\tcurrent\n"
                                       "Binary:\n";

static const char point_header[] = "Title: a title with a tab\n"
                                   "Date: Thu Jan  1 00:00:00 1970\n"
                                   "Plotname: Operating Point\n"
                                   "Flags: real\n"
                                   "Command: * ngspice-compatible, dalcs " DALCS_VERSION "\n"
                                   "No. Variables: 3\n"
                                   "No. Points: 1                   \n"
                                   "Variables:\n"
                                   "\t0\tv(out)\tvoltage\n"
                                   "\t1\tv(a,b)\tvoltage\n"
                                   "\t2\ti(d1)\tcurrent\n"
                                   "Binary:\n";

static const double transient_values[] = {0.0, 1.0 / 3.0, -0.0, 5e-324, 0.1, -2.385e300, 0.1, 1e-7};

START_TEST(test_two_plots) {
    fix_the_date();
    struct dalcs_table table;
    ck_assert_int_eq(dalcs_table_init(&table, "out.raw", true), DALCS_OK);
    write_plot(&table, DALCS_OPERATING_POINT, 1);
    write_plot(&table, DALCS_TRANSIENT, 2);
    ck_assert_int_eq(dalcs_table_commit(&table), DALCS_OK);
    dalcs_table_finish(&table);
    size_t length = 0;
    char *text = read_all("out.raw", &length);
    ck_assert_ptr_nonnull(text);
    const char *place = text;
    check_plot(&place, point_header, sample_row[0], 3);
    check_plot(&place, transient_header, transient_values, 8);
    ck_assert_uint_eq((size_t)(place - text), length);
    free(text);
}

END_TEST

/* What an interrupted run leaves has its number of points too. */
START_TEST(test_interrupted) {
    fix_the_date();
    struct dalcs_table table;
    struct dalcs_plot plot = sample_plot(DALCS_TRANSIENT);
    ck_assert_int_eq(dalcs_table_init(&table, "out.raw", true), DALCS_OK);
    ck_assert_int_eq(dalcs_table_begin(&table, &plot), DALCS_OK);
    ck_assert_int_eq(dalcs_table_rows(&table, 1, &(double){0.0}, sample_row[0]), DALCS_OK);
    ck_assert_int_eq(dalcs_table_rows(&table, 1, &(double){0.1}, sample_row[1]), DALCS_OK);
    char *left_at = NULL;
    ck_assert_int_eq(dalcs_table_keep(&table, &left_at), DALCS_OK);
    dalcs_table_finish(&table);
    free(left_at);
    size_t length = 0;
    char *text = read_all("out.partial.raw", &length);
    ck_assert_ptr_nonnull(text);
    const char *place = text;
    check_plot(&place, transient_header, transient_values, 8);
    ck_assert_uint_eq((size_t)(place - text), length);
    free(text);
    ck_assert_ptr_null(read_all("out.raw", &length));
}

END_TEST

RUN_SUITE("raw", test_two_plots, test_interrupted)
