/* test_recorder.c - which rows appear, between which steps; events and jumps that are kept. */
#include "recorder.h"

#include "build_network.h"

enum { MAX_ROWS = 4096 };

static struct text_network t;
static struct dalcs_euler e;
static struct dalcs_recorder r;

static int n_rows;
static double row_time[MAX_ROWS], row_value[MAX_ROWS]; /* of the first signal */
static int stop_after;

static enum dalcs_status take_row(void *user, double time, const double *value) {
    (void)user;
    ck_assert_int_lt(n_rows, MAX_ROWS);
    row_time[n_rows] = time;
    row_value[n_rows++] = value[0];
    return n_rows == stop_after ? DALCS_E_CANCELLED : DALCS_OK;
}

static const struct dalcs_sink sink = {.row = take_row};

/* Runs to the end as the session does; the status that ended it. */
static enum dalcs_status run(const char *text, double h, double stop,
                             const struct dalcs_schedule *schedule, size_t limit) {
    build_good_network(&t, text);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, h, stop), DALCS_OK);
    ck_assert_int_eq(dalcs_recorder_setup(&r, &t.network, &sink, schedule, limit > 0, limit),
                     DALCS_OK);
    e.listener.on_jump = dalcs_event_log_jump;
    e.listener.jump_user = &r.log;
    n_rows = 0;
    enum dalcs_status status = dalcs_euler_start(&e, t.network.initial);
    status = status == DALCS_OK ? dalcs_recorder_start(&r, &e) : status;
    while (status == DALCS_OK && !dalcs_grid_at_end(&e.grid)) {
        ck_assert_int_eq(dalcs_euler_step(&e), DALCS_OK);
        status = dalcs_recorder_step(&r, &e);
        if (status == DALCS_OK && e.at_jump && !dalcs_grid_at_end(&e.grid)) {
            ck_assert_int_eq(dalcs_euler_cross(&e), DALCS_OK);
            status = dalcs_recorder_cross(&r, &e);
        }
    }
    return status;
}

static void finish(void) {
    dalcs_recorder_finish(&r);
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

/* v(a) = 1000 t: what is interpolated is exact, to rounding. */
static const char ramp[] = "ramp\nV1 a 0 PWL(0 0 1 1000)\nR1 a 0 1\n.tran 1m 1\n.save v(a)\n";

static void check_rows(int n, double first, double spacing) {
    ck_assert_int_eq(n_rows, n);
    for (int k = 0; k < n; k++) {
        ck_assert_double_eq_tol(row_time[k], first + k * spacing, 1e-15);
        ck_assert_double_eq_tol(row_value[k], 1000.0 * row_time[k], 1e-12);
    }
}

START_TEST(test_schedules) {
    const struct dalcs_schedule every = {.kind = DALCS_EVERY_STEP};
    ck_assert_int_eq(run(ramp, 1e-3, 0.1, &every, 0), DALCS_OK);
    check_rows(101, 0.0, 1e-3);
    finish();
    const struct dalcs_schedule late = {.kind = DALCS_EVERY_STEP, .start = 0.05};
    ck_assert_int_eq(run(ramp, 1e-3, 0.1, &late, 0), DALCS_OK);
    check_rows(51, 0.05, 1e-3);
    finish();
    const struct dalcs_schedule grid = {.kind = DALCS_ON_GRID, .start = 0.02, .step = 0.01};
    ck_assert_int_eq(run(ramp, 1e-3, 0.1, &grid, 0), DALCS_OK);
    check_rows(9, 0.02, 0.01);
    finish();
    /* Several rows within one step, and many steps without a row. */
    const double at[] = {0.0, 0.00025, 0.0005, 0.00075, 0.0333, 0.0671, 0.1};
    const struct dalcs_schedule times = {.kind = DALCS_AT_TIMES, .at = at, .n_at = 7};
    ck_assert_int_eq(run(ramp, 1e-3, 0.1, &times, 0), DALCS_OK);
    ck_assert_int_eq(n_rows, 7);
    for (int k = 0; k < 7; k++) {
        ck_assert(row_time[k] == at[k]);
        ck_assert_double_eq_tol(row_value[k], 1000.0 * at[k], 1e-12);
    }
    finish();
}

END_TEST

/* Both sides of a discontinuity, in that order, whether it is on the print grid or not. */
START_TEST(test_discontinuity) {
    static const char text[] = "edges\nV1 a 0 PULSE(1 5 25m 0 0 20m 1)\nR1 a 0 1\n.tran 1m 1\n"
                               ".save v(a)\n";
    const struct dalcs_schedule grid = {.kind = DALCS_ON_GRID, .step = 0.02};
    ck_assert_int_eq(run(text, 1e-2, 0.1, &grid, 0), DALCS_OK);
    static const double expected[][2] = {{0.0, 1.0},  {0.02, 1.0},  {0.025, 1.0}, {0.025, 5.0},
                                         {0.04, 5.0}, {0.045, 5.0}, {0.045, 1.0}, {0.06, 1.0},
                                         {0.08, 1.0}, {0.1, 1.0}};
    ck_assert_int_eq(n_rows, 10);
    for (int k = 0; k < 10; k++) {
        ck_assert_double_eq_tol(row_time[k], expected[k][0], 1e-15);
        ck_assert_double_eq(row_value[k], expected[k][1]);
    }
    finish();
    /* Also where no row is due for many steps. */
    const struct dalcs_schedule sparse = {.kind = DALCS_ON_GRID, .step = 0.1};
    ck_assert_int_eq(run(text, 1e-3, 0.1, &sparse, 0), DALCS_OK);
    static const double sides[][2] = {{0.0, 1.0},   {0.025, 1.0}, {0.025, 5.0},
                                      {0.045, 5.0}, {0.045, 1.0}, {0.1, 1.0}};
    ck_assert_int_eq(n_rows, 6);
    for (int k = 0; k < 6; k++) {
        ck_assert_double_eq_tol(row_time[k], sides[k][0], 1e-15);
        ck_assert_double_eq(row_value[k], sides[k][1]);
    }
    finish();
}

END_TEST

/* A voltage between two separate systems, a constant one among them. */
START_TEST(test_outputs) {
    build_good_network(&t, "two parts\nV1 a 0 7\nR1 a 0 1\nV2 b 0 2\nR2 b 0 1\n.tran 1 9\n"
                           ".save v(a,b) v(b,a) i(r1) v(a)\n");
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, 1.0, 9.0), DALCS_OK);
    ck_assert_int_eq(dalcs_euler_operating_point(&e, true), DALCS_OK);
    double value[4];
    dalcs_recorder_evaluate(&t.network, &e, value);
    ck_assert_double_eq(value[0], 5.0);
    ck_assert_double_eq(value[1], -5.0);
    ck_assert_double_eq(value[2], 7.0);
    ck_assert_double_eq(value[3], 7.0);
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

END_TEST

static const char rectifier[] = "rectifier\nV1 a 0 SIN(0 1 50)\nD1 a b\nR1 b 0 1\n.tran 1m 1\n"
                                ".save v(b)\n";

/* The diode of a half-wave rectifier: each half period of 10 ms it changes sides, at the first
 * step at which the sine has the other sign. */
START_TEST(test_events) {
    const struct dalcs_schedule every = {.kind = DALCS_EVERY_STEP};
    ck_assert_int_eq(run(rectifier, 0.7e-3, 0.1, &every, 1000), DALCS_OK);
    size_t n_expected = 0;
    bool was_on = r.log.n_events > 0 && !r.log.event[0].on;
    for (int k = 1; k < n_rows; k++) {
        double v = sin(2.0 * acos(-1.0) * 50.0 * row_time[k]);
        if ((v > 0.0) != was_on) {
            was_on = !was_on;
            ck_assert_uint_lt(n_expected, r.log.n_events);
            ck_assert_str_eq(r.log.event[n_expected].element, "d1");
            ck_assert(r.log.event[n_expected].on == was_on);
            ck_assert(r.log.event[n_expected].time == row_time[k]);
            n_expected++;
        }
    }
    ck_assert_uint_eq(r.log.n_events, n_expected);
    ck_assert_uint_ge(n_expected, 9);
    ck_assert_uint_eq(r.log.n_events_dropped, 0);
    finish();
    /* In bounded memory, and none when nobody asked. */
    ck_assert_int_eq(run(rectifier, 0.7e-3, 0.1, &every, 4), DALCS_OK);
    ck_assert_uint_eq(r.log.n_events, 4);
    ck_assert_uint_eq(r.log.n_events_dropped, n_expected - 4);
    finish();
    ck_assert_int_eq(run(rectifier, 0.7e-3, 0.1, &every, 0), DALCS_OK);
    ck_assert_uint_eq(r.log.n_events + r.log.n_events_dropped, 0);
    finish();
}

END_TEST

/* The jump at the start: states by element, what moved and nothing else. */
START_TEST(test_jumps) {
    static const char text[] = "charges\nC1 1 0 1u IC=10\nC2 2 0 3u IC=2\nD1 1 2\nR3 2 3 1\n"
                               "C3 3 0 1u IC=7\n.tran 10u 1m uic\n.save v(1)\n";
    const struct dalcs_schedule every = {.kind = DALCS_EVERY_STEP};
    ck_assert_int_eq(run(text, 1e-5, 1e-4, &every, 10), DALCS_OK);
    ck_assert_uint_eq(r.log.n_jumps, 1);
    const struct dalcs_jump *j = &r.log.jump[0];
    ck_assert_double_eq(j->time, 0.0);
    ck_assert_uint_eq(j->n_states, 2);
    ck_assert_str_eq(j->state[0].element, "c1");
    ck_assert_double_eq(j->state[0].before, 10.0);
    ck_assert_double_eq_tol(j->state[0].after, 4.0, 1e-9);
    ck_assert_str_eq(j->state[1].element, "c2");
    ck_assert_uint_eq(j->n_impulses, 1);
    ck_assert_str_eq(j->impulse[0].element, "d1");
    ck_assert(!j->impulse[0].is_flux);
    ck_assert_double_eq_tol(j->impulse[0].value, 6e-6, 1e-14);
    finish();
}

END_TEST

/* What the receiver of rows says ends the run. */
START_TEST(test_cancelled) {
    const struct dalcs_schedule every = {.kind = DALCS_EVERY_STEP};
    stop_after = 5;
    ck_assert_int_eq(run(ramp, 1e-3, 0.1, &every, 0), DALCS_E_CANCELLED);
    ck_assert_int_eq(n_rows, 5);
    finish();
}

END_TEST

RUN_TESTS("recorder", test_schedules, test_discontinuity, test_outputs, test_events, test_jumps,
          test_cancelled)
