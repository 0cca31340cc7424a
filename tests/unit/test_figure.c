/* test_figure.c - which points and which signals a figure shows, and how gnuplot is told. */
#include "band.h"
#include "figure.h"
#include "gnuplot.h"
#include "sample_plot.h"

#include <math.h>

/* A spike of one row among a million is still there, and there are never more than 4 points a
 * column. */
START_TEST(test_curve_keeps_extremes) {
    struct dalcs_curve curve;
    ck_assert_int_eq(dalcs_curve_init(&curve, 0.0, 1.0), DALCS_OK);
    const long n = 1000000;
    for (long i = 0; i <= n; i++) {
        dalcs_curve_add(&curve, (double)i / (double)n,
                        i == 123456   ? 7.0
                        : i == 123457 ? -9.0
                                      : 1.0);
    }
    ck_assert_double_eq(curve.highest, 7.0);
    ck_assert_double_eq(curve.lowest, -9.0);
    struct dalcs_curve_point point[4];
    ck_assert_int_eq(dalcs_curve_column_points(&curve.column[123], point), 4);
    ck_assert_double_eq(point[1].value, 7.0);
    ck_assert_double_eq(point[2].value, -9.0);
    ck_assert_double_eq(point[1].time, 0.123456);
    ck_assert_double_eq(point[0].time, 0.123);
    ck_assert_double_eq(point[3].time, 0.123999);
    ck_assert_int_eq(dalcs_curve_column_points(&curve.column[7], point), 2);
    dalcs_curve_finish(&curve);
}

END_TEST

/* Both sides of a discontinuity have the same time and must stay in order. */
START_TEST(test_curve_keeps_order) {
    struct dalcs_curve curve;
    ck_assert_int_eq(dalcs_curve_init(&curve, 0.0, 1.0), DALCS_OK);
    const double value[] = {5.0, 1.0, NAN, 9.0, INFINITY, 4.0, -INFINITY, NAN};
    for (int i = 0; i < 8; i++) {
        dalcs_curve_add(&curve, 0.5, value[i]);
    }
    struct dalcs_curve_point point[4];
    ck_assert_int_eq(dalcs_curve_column_points(&curve.column[500], point), 4);
    ck_assert_double_eq(point[0].value, 5.0);
    ck_assert_double_eq(point[1].value, 1.0);
    ck_assert_double_eq(point[2].value, 9.0);
    ck_assert_double_eq(point[3].value, 4.0);
    dalcs_curve_finish(&curve);
}

END_TEST

/* Lines on each other between rows that are far apart count over the whole way. */
START_TEST(test_overlap_of_few_rows) {
    struct dalcs_curve a, b;
    ck_assert_int_eq(dalcs_curve_init(&a, 0.0, 1.0), DALCS_OK);
    ck_assert_int_eq(dalcs_curve_init(&b, 0.0, 1.0), DALCS_OK);
    const double time[4] = {0.0, 0.3, 0.5, 1.0};
    const double first[4] = {0.0, 3.0, 3.0, 3.0}, second[4] = {0.0, 3.0, 4.0, 3.0};
    for (int i = 0; i < 4; i++) {
        dalcs_curve_add(&a, time[i], first[i]);
        dalcs_curve_add(&b, time[i], second[i]);
    }
    ck_assert_double_eq_tol(dalcs_curve_overlap(&a, &b, 1e-3), 0.3, 0.005);
    ck_assert_double_eq_tol(dalcs_curve_overlap(&a, &a, 1e-3), 1.0, 0.005);
    dalcs_curve_finish(&a);
    dalcs_curve_finish(&b);
}

END_TEST

/* Of 100 periods the band is where the signal moves, and the mean that of a period, also where the period is known to
 * 1 part in 100 only: of a swing of 5 that leaves 5e-4, and the places where the integral is known, 40 in a period, as much again. */
START_TEST(test_band_of_dense_run) {
    struct dalcs_band_point point[DALCS_CURVE_COLUMNS];
    struct dalcs_curve curve;
    ck_assert_int_eq(dalcs_curve_init(&curve, 0.0, 1.0), DALCS_OK);
    for (int k = 0; k < 100; k++) {
        const double time[4] = {0.0, 0.003, 0.003, 0.01};
        const double value[4] = {3.0, 5.0, 0.0, 1.0};
        for (int i = 0; i < 4; i++) {
            dalcs_curve_add(&curve, 0.01 * k + time[i], value[i]);
        }
    }
    for (double period = 0.0099; period < 0.0102; period += 0.0001) {
        ck_assert_int_eq(dalcs_band_find(&curve, period, point), DALCS_CURVE_COLUMNS);
        for (int i = 0; i < DALCS_CURVE_COLUMNS; i++) {
            ck_assert_double_eq(point[i].low, 0.0);
            ck_assert_double_eq(point[i].high, 5.0);
            const bool is_inside = i > 20 && i < 980; /* a window at an end is not averaged again */
            ck_assert_double_eq_tol(point[i].mean, 1.55, is_inside ? 2e-3 : 0.08);
        }
    }
    dalcs_curve_finish(&curve);
    ck_assert_int_eq(dalcs_curve_init(&curve, 0.0, 1.0),
                     DALCS_OK); /* that ends early, with a gap */
    dalcs_curve_add(&curve, 0.0, 2.0);
    dalcs_curve_add(&curve, 0.2, NAN);
    dalcs_curve_add(&curve, 0.4, 2.0);
    dalcs_curve_add(&curve, 0.5, 2.0);
    ck_assert_int_eq(dalcs_band_find(&curve, 0.01, point) > 0, 1);
    ck_assert_double_eq_tol(curve.integral, 0.2, 1e-15);
    dalcs_curve_finish(&curve);
}

END_TEST

START_TEST(test_choice_of_signals) {
    static const char *const name[] = {"v(n1)", "v(n2)", "i(v1)", "v(n3)", "v(n4)", "v(n5)",
                                       "v(n6)", "v(n7)", "i(l1)", "v(n8)", "v(out)"};

    enum { N = sizeof name / sizeof name[0] };
    enum dalcs_unit unit[N];
    for (int i = 0; i < N; i++) {
        unit[i] = name[i][0] == 'v' ? DALCS_VOLT : DALCS_AMPERE;
    }
    const struct dalcs_plot plot = {.analysis = DALCS_TRANSIENT,
                                    .title = "t",
                                    .scale = "time",
                                    .scale_unit = DALCS_UNIT_SECOND,
                                    .n_signals = N,
                                    .name = name,
                                    .unit = unit,
                                    .n_steps = 1};
    struct dalcs_figure figure;
    dalcs_figure_init(&figure, "a.svg", 0.0, 1.0);
    ck_assert_int_eq(dalcs_figure_begin(&figure, &plot), DALCS_OK);
    ck_assert_int_eq(figure.panel[0].n, 8);
    ck_assert_uint_eq(figure.panel[0].n_left_out, 1);
    ck_assert_uint_eq(figure.panel[0].signal[0], 0);
    ck_assert_uint_eq(figure.panel[0].signal[6], 7);
    ck_assert_uint_eq(figure.panel[0].signal[7], 10); /* v(out) instead of v(n8) */
    ck_assert_int_eq(figure.panel[1].n, 2);
    ck_assert_uint_eq(figure.panel[1].signal[1], 8);
    dalcs_figure_finish(&figure);
}

END_TEST

/* A run of n_rows rows over one second: v(n1) has that many periods and a jump's impulse at 0.5. */
static void run_figure(struct dalcs_figure *figure, const struct dalcs_plot *plot, double n_periods,
                       double impulse) {
    const long n_rows = 20000;
    dalcs_figure_init(figure, "a.svg", 0.0, 1.0);
    ck_assert_int_eq(dalcs_figure_begin(figure, plot), DALCS_OK);
    for (long i = 0; i <= n_rows; i++) {
        double t = (double)i / (double)n_rows;
        double value[] = {sin(2.0 * acos(-1.0) * n_periods * t), 2 * i == n_rows ? impulse : 0.25};
        dalcs_figure_row(figure, t, value);
    }
}

static const char *const two_names[] = {"v(n1)", "i(d1)"};

static const enum dalcs_unit two_units[] = {DALCS_VOLT, DALCS_AMPERE};
static const struct dalcs_plot two_signals = {.analysis = DALCS_TRANSIENT,
                                              .title = "t",
                                              .scale = "time",
                                              .scale_unit = DALCS_UNIT_SECOND,
                                              .n_signals = 2,
                                              .name = two_names,
                                              .unit = two_units,
                                              .n_steps = 1};

/* A few periods need no closer look; of many the last four are shown. */
START_TEST(test_end_of_dense_run) {
    struct dalcs_figure figure;
    run_figure(&figure, &two_signals, 20.0, 0.0);
    ck_assert_int_eq(dalcs_figure_compose(&figure, NULL), DALCS_OK);
    ck_assert_int_eq(figure.n_views, 1);
    dalcs_figure_finish(&figure);

    run_figure(&figure, &two_signals, 200.0, 0.0);
    ck_assert_int_eq(dalcs_figure_compose(&figure, NULL), DALCS_OK);
    ck_assert_int_eq(figure.n_views, 2);
    ck_assert_double_eq(figure.view[1].stop, 1.0);
    ck_assert_double_eq_tol(figure.view[1].start, 1.0 - 4.5 / 200.0, 1.0 / 200.0);
    ck_assert_double_eq_tol(figure.view[1].largest[0], 1.0, 1e-3);
    ck_assert_double_gt(figure.view[1].low[1], 0.0); /* the 0 at half time is not there */
    dalcs_figure_finish(&figure);
}

END_TEST

/* The height of an impulse depends on the step: it must not set the scale. A regular peak does. */
START_TEST(test_impulse_leaves_scale) {
    const struct dalcs_jump jump = {.time = 0.5};
    struct dalcs_report report = {.step = 1e-4};
    for (int n_jumps = 0; n_jumps < 2; n_jumps++) {
        struct dalcs_figure figure;
        run_figure(&figure, &two_signals, 1.0, 100.0);
        report.n_jumps = (size_t)n_jumps;
        report.jump = &jump;
        ck_assert_int_eq(dalcs_figure_compose(&figure, &report), DALCS_OK);
        ck_assert(figure.view[0].clipped[1] == (n_jumps == 1));
        ck_assert(!figure.view[0].clipped[0]);
        ck_assert_double_eq(figure.view[0].largest[1], n_jumps == 1 ? 0.25 : 100.0);
        dalcs_figure_finish(&figure);
    }
}

END_TEST

/* Rounding noise is neither a range nor a train of periods. */
START_TEST(test_noise_is_constant) {
    struct dalcs_figure figure;
    dalcs_figure_init(&figure, "a.svg", 0.0, 1.0);
    ck_assert_int_eq(dalcs_figure_begin(&figure, &two_signals), DALCS_OK);
    for (int i = 0; i <= 1000; i++) {
        const double value[] = {i % 2 == 0 ? 1.0 : 1.0 + 2e-16, i % 2 == 0 ? -1e-15 : 2e-15};
        dalcs_figure_row(&figure, 1e-3 * i, value);
    }
    ck_assert_int_eq(dalcs_figure_compose(&figure, NULL), DALCS_OK);
    ck_assert_int_eq(figure.n_views, 1);
    ck_assert_double_eq_tol(figure.view[0].low[0], 0.9, 1e-9);
    ck_assert_double_eq_tol(figure.view[0].high[0], 1.1, 1e-9);
    ck_assert_double_eq(figure.view[0].low[1], -0.5);
    dalcs_figure_finish(&figure);
}

END_TEST

/* Nor does noise make one of a signal that moves later. */
START_TEST(test_noise_before_a_step) {
    struct dalcs_figure figure;
    dalcs_figure_init(&figure, "a.svg", 0.0, 1.0);
    ck_assert_int_eq(dalcs_figure_begin(&figure, &two_signals), DALCS_OK);
    for (int i = 0; i <= 1000; i++) {
        double noise = i % 2 == 0 ? 0.0 : 2e-16;
        const double value[] = {i < 500 ? 4.0 + 4.0 * noise : 6.0, i < 500 ? noise : 1.0};
        dalcs_figure_row(&figure, 1e-3 * i, value);
    }
    ck_assert_int_eq(dalcs_figure_compose(&figure, NULL), DALCS_OK);
    ck_assert_int_eq(figure.n_views, 1);
    dalcs_figure_finish(&figure);
}

END_TEST

static char *write_script(const char *title, const char *signal) {
    const enum dalcs_unit unit = DALCS_AMPERE;
    const struct dalcs_plot plot = {.analysis = DALCS_TRANSIENT,
                                    .title = title,
                                    .scale = "time",
                                    .scale_unit = DALCS_UNIT_SECOND,
                                    .n_signals = 1,
                                    .name = &signal,
                                    .unit = &unit,
                                    .n_steps = 1};
    struct dalcs_figure figure;
    dalcs_figure_init(&figure, "a.png", 0.0, 2e-5);
    ck_assert_int_eq(dalcs_figure_begin(&figure, &plot), DALCS_OK);
    const double value[] = {0.0, 0.25, 0.002};
    for (int i = 0; i < 3; i++) {
        dalcs_figure_row(&figure, 1e-5 * i, &value[i]);
    }
    ck_assert_int_eq(dalcs_figure_compose(&figure, NULL), DALCS_OK);
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ck_assert_ptr_nonnull(stream);
    dalcs_gnuplot_write(stream, &figure);
    ck_assert_int_eq(fclose(stream), 0);
    dalcs_figure_finish(&figure);
    return text;
}

/* Nothing in a netlist may become a command. */
START_TEST(test_quoting) {
    char *text = write_script("it's\n`id` \"x\" caf\303\251 \351", "i(d')");
    ck_assert_ptr_nonnull(strstr(text, "'it''s?`id` \"x\" caf\303\251 ?'"));
    ck_assert_ptr_nonnull(strstr(text, "title 'i(d'')'"));
    free(text);
    text = write_script("t", "i(a_resistor_of_the_filter)");
    ck_assert_ptr_nonnull(strstr(text, "title 'i(a_resistor_of_the_filt\342\200\246'"));
    free(text);
}

END_TEST

START_TEST(test_units) {
    char *text = write_script("t", "i(d1)");
    ck_assert_ptr_nonnull(strstr(text, "'current (mA)'"));
    ck_assert_ptr_nonnull(strstr(text, "'time (\302\265s)'"));
    ck_assert_ptr_nonnull(strstr(text, "\n0 0\n10 250\n20 2\n"));
    free(text);
}

END_TEST

RUN_SUITE("figure", test_curve_keeps_extremes, test_curve_keeps_order, test_overlap_of_few_rows,
          test_band_of_dense_run, test_choice_of_signals, test_end_of_dense_run,
          test_impulse_leaves_scale, test_noise_is_constant, test_noise_before_a_step, test_quoting,
          test_units)
