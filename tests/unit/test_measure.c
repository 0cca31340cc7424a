/* test_measure.c - averages and rms of piecewise linear waveforms, and how quantities are shown. */
#include "measure.h"
#include "quantity.h"
#include "sample_plot.h"

#include <math.h>

static struct dalcs_measure measure_rows(const double (*row)[2], size_t n) {
    static const char *const name[] = {"v(a)"};

    static const enum dalcs_unit unit[] = {DALCS_VOLT};
    static const struct dalcs_plot plot = {.analysis = DALCS_TRANSIENT,
                                           .title = "t",
                                           .scale = "time",
                                           .scale_unit = DALCS_UNIT_SECOND,
                                           .n_signals = 1,
                                           .name = name,
                                           .unit = unit,
                                           .n_steps = 1};
    struct dalcs_measure measure = {0};
    ck_assert_int_eq(dalcs_measure_begin(&measure, &plot), DALCS_OK);
    for (size_t i = 0; i < n; i++) {
        dalcs_measure_row(&measure, row[i][0], &row[i][1]);
    }
    return measure;
}

/* A jump from -2 to 6 at t = 1, then a ramp to 0 at 4, on an uneven grid. */
START_TEST(test_uneven_grid) {
    const double row[][2] = {{0, -2}, {1, -2}, {1, 6}, {1.5, 5}, {4, 0}};
    struct dalcs_measure measure = measure_rows(row, 5);
    ck_assert_double_eq(dalcs_measure_of(&measure, 0).min, -2.0);
    ck_assert_double_eq(dalcs_measure_of(&measure, 0).max, 6.0);
    ck_assert_double_eq(dalcs_measure_of(&measure, 0).final, 0.0);
    ck_assert_double_eq_tol(dalcs_measure_average(&measure, 0), (-2.0 + 9.0) / 4.0, 1e-15);
    ck_assert_double_eq_tol(dalcs_measure_rms(&measure, 0), sqrt((4.0 + 36.0) / 4.0), 1e-15);
    dalcs_measure_finish(&measure);
}

END_TEST

START_TEST(test_one_row) {
    const double row[][2] = {{3, -2.5}};
    struct dalcs_measure measure = measure_rows(row, 1);
    ck_assert_double_eq(dalcs_measure_of(&measure, 0).min, -2.5);
    ck_assert_double_eq(dalcs_measure_of(&measure, 0).max, -2.5);
    ck_assert_double_eq(dalcs_measure_average(&measure, 0), -2.5);
    ck_assert_double_eq(dalcs_measure_rms(&measure, 0), 2.5);
    dalcs_measure_finish(&measure);
}

END_TEST

START_TEST(test_quantities) {
    static const struct {
        double value;
        const char *text, *column;
    } expected[] = {
        {0.0, "0 V", "0.000  V"},       {4.0, "4 V", "4.000  V"},
        {1e-3, "1 mV", "1.000 mV"},     {-0.01234567, "-12.35 mV", "-12.35 mV"},
        {999.96, "1 kV", "1.000 kV"},   {999.94, "999.9 V", "999.9  V"},
        {9.9996, "10 V", "10.00  V"},   {1e-6, "1 uV", "1.000 uV"},
        {1e-30, "1e-30 V", "1e-30  V"}, {INFINITY, "inf V", "inf  V"},
    };

    char text[DALCS_QUANTITY_SIZE];
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        ck_assert_str_eq(dalcs_quantity_write(text, expected[i].value, "V", 4), expected[i].text);
        ck_assert_str_eq(dalcs_quantity_write_column(text, expected[i].value, "V", 4),
                         expected[i].column);
    }
    ck_assert_double_eq(dalcs_quantity_scale(0.1), 1e-3);
    ck_assert_double_eq(dalcs_quantity_scale(1.0), 1.0);
    ck_assert_str_eq(dalcs_quantity_prefix(1e-6), "u");
}

END_TEST

RUN_SUITE("measure", test_uneven_grid, test_one_row, test_quantities)
