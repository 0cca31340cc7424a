/* test_csv.c - the CSV file, byte by byte. */
#include "sample_plot.h"
#include "table.h"

static const char header[] = "time,v(out),\"v(a,b)\",i(d1)\n";

static void write_plot(struct dalcs_table *table, enum dalcs_analysis analysis, int n_rows) {
    struct dalcs_plot plot = sample_plot(analysis);
    ck_assert_int_eq(dalcs_table_begin(table, &plot), DALCS_OK);
    for (int i = 0; i < n_rows; i++) {
        ck_assert_int_eq(dalcs_table_rows(table, 1, &(double){0.1 * i}, sample_row[i]), DALCS_OK);
    }
    ck_assert_int_eq(dalcs_table_end(table), DALCS_OK);
}

static void check_file(const char *rows) {
    char expected[512];
    snprintf(expected, sizeof expected, "%s%s", header, rows);
    check_contents("out.csv", expected);
}

START_TEST(test_rows) {
    struct dalcs_table table;
    ck_assert_int_eq(dalcs_table_init(&table, "out.csv", true), DALCS_OK);
    write_plot(&table, DALCS_TRANSIENT, 2);
    ck_assert_int_eq(dalcs_table_commit(&table), DALCS_OK);
    dalcs_table_finish(&table);
    check_file("0,0.3333333333333333,-0,4.94065645841247e-324\n"
               "0.1,-2.385e+300,0.1,"
               "1e-07\n");
}

END_TEST

START_TEST(test_operating_point_alone) {
    struct dalcs_table table;
    ck_assert_int_eq(dalcs_table_init(&table, "out.csv", false), DALCS_OK);
    write_plot(&table, DALCS_OPERATING_POINT, 1);
    ck_assert_int_eq(dalcs_table_commit(&table), DALCS_OK);
    dalcs_table_finish(&table);
    check_file("0,0.3333333333333333,-0,4.94065645841247e-324\n");
}

END_TEST

/* A table holds one plot: the transient one wins. */
START_TEST(test_operating_point_before_transient) {
    struct dalcs_table table;
    ck_assert_int_eq(dalcs_table_init(&table, "out.csv", true), DALCS_OK);
    write_plot(&table, DALCS_OPERATING_POINT, 2);
    write_plot(&table, DALCS_TRANSIENT, 1);
    ck_assert_int_eq(dalcs_table_commit(&table), DALCS_OK);
    dalcs_table_finish(&table);
    check_file("0,0.3333333333333333,-0,4.94065645841247e-324\n");
}

END_TEST

START_TEST(test_interrupted) {
    write_all("out.csv", "of an earlier run\n");
    struct dalcs_table table;
    struct dalcs_plot plot = sample_plot(DALCS_TRANSIENT);
    ck_assert_int_eq(dalcs_table_init(&table, "out.csv", true), DALCS_OK);
    ck_assert_int_eq(dalcs_table_begin(&table, &plot), DALCS_OK);
    ck_assert_int_eq(dalcs_table_rows(&table, 1, &(double){0.0}, sample_row[0]), DALCS_OK);
    char *left_at = NULL;
    ck_assert_int_eq(dalcs_table_keep(&table, &left_at), DALCS_OK);
    dalcs_table_finish(&table);
    ck_assert_str_eq(left_at, "out.partial.csv");
    free(left_at);
    check_contents("out.csv", "of an earlier run\n");
    check_contents("out.partial.csv", "time,v(out),\"v(a,b)\",i(d1)\n"
                                      "0,0.3333333333333333,-0,4.94065645841247e-324\n");
}

END_TEST

START_TEST(test_no_rows_no_file) {
    struct dalcs_plot plot = sample_plot(DALCS_TRANSIENT);
    for (int begun = 0; begun < 2; begun++) {
        struct dalcs_table table;
        ck_assert_int_eq(dalcs_table_init(&table, "out.csv", true), DALCS_OK);
        if (begun) {
            ck_assert_int_eq(dalcs_table_begin(&table, &plot), DALCS_OK);
        }
        char *left_at = NULL;
        ck_assert_int_eq(dalcs_table_keep(&table, &left_at), DALCS_OK);
        ck_assert_ptr_null(left_at);
        dalcs_table_finish(&table);
        size_t length = 0;
        ck_assert_ptr_null(read_all("out.csv", &length));
        ck_assert_ptr_null(read_all("out.partial.csv", &length));
    }
}

END_TEST

START_TEST(test_formats_by_name) {
    ck_assert_ptr_eq(dalcs_table_find_format("a.CSV"), &dalcs_csv_format);
    ck_assert_ptr_eq(dalcs_table_find_format("a.csv.raw"), &dalcs_raw_format);
    ck_assert_ptr_null(dalcs_table_find_format("a.txt"));
    ck_assert_ptr_null(dalcs_table_find_format(".csv"));
}

END_TEST

RUN_SUITE("csv", test_rows, test_operating_point_alone, test_operating_point_before_transient,
          test_interrupted, test_no_rows_no_file, test_formats_by_name)
