/* test_cycle.c - periods that are leapt over leave no trace: times and events are those of a run that takes
 * every segment, bit for bit, and states are those of closed forms. */
#include "cycle.h"

#include "run_radau.h"

#include <math.h>
#include <string.h>

/* What has changed sides, and when. */
enum { MOST_EVENTS = 1 << 16 };

struct change {
    double time;
    int pair;
    bool is_on;
};

static struct change changes[2][MOST_EVENTS];
static int n_changes[2];

static void note_changes(int run, double time, uint64_t before) {
    uint64_t now = r.part->component->osnsp.mode[0];
    for (int d = 0; d < r.part->component->system->n_pairs; d++) {
        if (((before ^ now) >> d & 1) != 0) {
            ck_assert_int_lt(n_changes[run], MOST_EVENTS);
            changes[run][n_changes[run]++] = (struct change){time, d, (now >> d & 1) != 0};
        }
    }
}

static void note_leap(int run, const struct dalcs_leap *leap) {
    for (long k = 0; k < leap->n_periods; k++) {
        for (int i = 0; i < leap->n_events; i++) {
            const struct dalcs_leap_event *event = &leap->event[i];
            ck_assert_int_lt(n_changes[run], MOST_EVENTS);
            changes[run][n_changes[run]++] =
                (struct change){dalcs_leap_time(event->moment, k), event->pair, event->is_on};
        }
    }
}

/* To the segment that holds `until`; over periods where `leaps`. */
static void walk(int run, double until, bool leaps) {
    for (bool happens;;) {
        if (leaps && r.part->memory.cycles) {
            const struct dalcs_leap *leap;
            ck_assert_int_eq(dalcs_cycle_leap(&r, until, 1000, &leap), DALCS_OK);
            if (leap != NULL) {
                ck_assert(r.part->segment.t < until && r.part->segment.t < r.part->segment.t_end);
                note_leap(run, leap);
            }
        }
        double to = dalcs_radau_next_stop(&r, &happens);
        if (!(to < until)) {
            return;
        }
        uint64_t before = r.part->component->osnsp.mode[0];
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
        note_changes(run, to, before);
    }
}

/* The solution at `at` of either run. */
static void solve_at(double at, double *y) {
    ck_assert_int_eq(dalcs_radau_evaluate(&r, at, DALCS_LEFT), DALCS_OK);
    memcpy(y, r.part->component->y,
           (size_t)dalcs_system_n_columns(r.part->component->system) * sizeof(double));
}

enum { MOST_COLUMNS = 32 };

/* A run that leaps and one that does not, compared at n times and by all that changed sides. Returns the
 * steps that were leapt over, and all. */
static long compare(const char *text, double stop, int n, double close, long *n_steps) {
    double y[2][64][MOST_COLUMNS];
    int n_columns = 0;
    long n_leapt = 0;
    for (int run = 0; run < 2; run++) {
        n_changes[run] = 0;
        start(text, stop);
        n_columns = dalcs_system_n_columns(r.part->component->system);
        ck_assert_int_le(n_columns, MOST_COLUMNS);
        for (int k = 0; k < n; k++) {
            double at = stop * (k + 0.61803) / n;
            walk(run, at, run == 1);
            solve_at(at, y[run][k]);
        }
        n_leapt = r.leapt_steps;
        *n_steps = r.steps;
        finish();
    }
    ck_assert_int_eq(n_changes[0], n_changes[1]);
    for (int k = 0; k < n_changes[0]; k++) {
        ck_assert_msg(changes[0][k].time == changes[1][k].time &&
                          changes[0][k].pair == changes[1][k].pair &&
                          changes[0][k].is_on == changes[1][k].is_on,
                      "change %d: %.17g, %.17g", k, changes[0][k].time, changes[1][k].time);
    }
    for (int c = 0; c < n_columns; c++) {
        double largest = 0.0;
        for (int k = 0; k < n; k++) {
            largest = fmax(largest, fabs(y[0][k][c]));
        }
        for (int k = 0; k < n; k++) {
            ck_assert_msg(fabs(y[0][k][c] - y[1][k][c]) <= close * largest,
                          "column %d, time %d: %.17g, %.17g", c, k, y[0][k][c], y[1][k][c]);
        }
    }
    return n_leapt;
}

#define BUCK(load)                                                                                 \
    "buck\nVin in 0 12\nVg g 0 PULSE(0 1 0 0 0 4u 10u)\nS1 in sw g 0 sm\nD1 0 sw\nL1 sw out 50u\n" \
    "C1 out 0 20u\n" load ".model sm SW(Vt=0.5)\n.tran 1u 10m uic\n"

/* From rest to the steady state; all but a few periods are leapt over. */
START_TEST(test_buck) {
    long n_steps;
    long n_leapt = compare(BUCK("R1 out 0 2\n"), 10e-3, 7, 1e-12, &n_steps);
    ck_assert_msg(n_leapt > n_steps - 100, "%ld of %ld", n_leapt, n_steps);
}

END_TEST

/* With rows in every second period nothing can be leapt over, and the checks are the same. */
START_TEST(test_many_rows) {
    long n_steps;
    long n_leapt = compare(BUCK("R1 out 0 2\n"), 1e-3, 60, 1e-12, &n_steps);
    ck_assert_msg(n_leapt < 100, "%ld of %ld", n_leapt, n_steps);
}

END_TEST

/* A load that jumps, falls slowly and at last so far that the diode opens in every period: edges and ramps of a
 * source end a leap, and so does a guard that gets near to 0. */
START_TEST(test_load) {
    long n_steps;
    long n_leapt =
        compare(BUCK("R1 out 0 5\nI1 out 0 PWL(0 4 3m 4 3.0013m 2 6m 1.5 6.1m 0 10m 0)\n"), 10e-3,
                11, 1e-9, &n_steps);
    ck_assert_msg(n_leapt > 450 && n_leapt < n_steps - 100, "%ld of %ld", n_leapt, n_steps);
}

END_TEST

/* A load that jumps at the very moment of a command: what recurs begins with other inputs. */
START_TEST(test_jump_at_command) {
    long n_steps;
    long n_leapt = compare(BUCK("R1 out 0 5\nI1 out 0 PULSE(2 3 3m 0 0 3m 10m)\n"), 10e-3, 11,
                           1e-11, &n_steps);
    ck_assert_msg(n_leapt > 1500 && n_leapt < n_steps, "%ld of %ld", n_leapt, n_steps);
}

END_TEST

/* Two phases half a period apart, with diodes: four spans. */
START_TEST(test_two_phases) {
    long n_steps;
    long n_leapt = compare(
        "boost\nVin in 0 12\nVg g 0 PULSE(0 1 0 0 0 6u 10u)\nVh h 0 PULSE(0 1 5u 0 0 6u "
        "10u)\nL1 in a 100u\nL2 in b 80u\nS1 a 0 g 0 sm\nS2 b 0 h 0 sm\nD1 a out\nD2 b out\n"
        "C1 out 0 20u IC=20\nR1 out 0 10\n.model sm SW(Vt=0.5)\n.tran 1u 10m uic\n",
        10e-3, 9, 1e-11, &n_steps);
    ck_assert_msg(n_leapt > 3500, "%ld of %ld", n_leapt, n_steps);
}

END_TEST

/* A switch in the place of the diode, which closes when the other opens, but for rounding. */
START_TEST(test_at_once) {
    long n_steps;
    long n_leapt = compare("synchronous\nVin in 0 12\nVg g 0 PULSE(0 1 0 0 0 4u 10u)\n"
                           "Vh h 0 PULSE(0 1 4u 0 0 6u 10u)\nS1 in sw g 0 sm\nS2 sw 0 h 0 sm\n"
                           "L1 sw out 50u\nC1 out 0 20u\nR1 out 0 2\n"
                           ".model sm SW(Vt=0.5)\n.tran 1u 10m uic\n",
                           10e-3, 7, 1e-11, &n_steps);
    ck_assert_msg(n_leapt > n_steps - 150, "%ld of %ld", n_leapt, n_steps);
}

END_TEST

/* A load that is switched in every second period: all spans recur, but not from one period to the next. */
START_TEST(test_two_periods) {
    long n_steps;
    long n_leapt = compare(BUCK("R1 out 0 2\nVh h 0 PULSE(0 1 10u 0 0 10u 20u)\nS3 out x h 0 sm\n"
                                "R3 x 0 10\n"),
                           3e-3, 9, 1e-11, &n_steps);
    ck_assert_int_eq(n_leapt, 0);
}

END_TEST

/* Each period charges a capacitor a little, and in the 1348th it moves a switch: not before, and not later. */
START_TEST(test_watched) {
    const double period = 100e-6;
    const double on = 40e-6;
    const double tau = 100e-3;
    const double charging = tau * log(24.0 / (24.0 - 10.0)); /* until there are 10 V */
    const double exact = floor(charging / on) * period + fmod(charging, on);
    n_changes[0] = 0;
    start("charger\nV1 in 0 24\nVg g 0 PULSE(0 1 0 0 0 40u 100u)\nS1 in a g 0 sm\nR1 a b 10k\n"
          "C1 b 0 10u\nS2 b c b 0 sh\nR2 c 0 1k\n.model sm SW(Vt=0.5)\n"
          ".model sh SW(Vt=6 Vh=4)\n.tran 1u 200m uic\n",
          200e-3);
    walk(0, 199e-3, true);
    ck_assert_int_gt(r.leapt_steps, 2500);
    double closed = 0.0;
    for (int k = 0; k < n_changes[0] && closed == 0.0; k++) {
        closed = changes[0][k].pair == 1 ? changes[0][k].time : 0.0;
    }
    ck_assert_double_eq_tol(closed, exact, 1e-12);
    finish();
}

END_TEST

/* After 1e6 periods the current at the start of one is that of the periodic solution, and the time is exact. */
START_TEST(test_long_run) {
    const double period = 100e-6;
    const double on = 40e-6;
    const double tau = 2e-3;
    const double last = 999999.0 * period;
    const double e_on = exp(-on / tau);
    const double e_off = exp(-(period - on) / tau);
    const double exact =
        ((1.0 - e_on) * (24.0 - 5.0) * e_off - (1.0 - e_off) * 5.0) / (1.0 - e_on * e_off);
    start("chopper\nV1 in 0 24\nVg g 0 PULSE(0 1 0 0 0 40u 100u)\nS1 in a g 0 sm\nD1 0 a\n"
          "L1 a b 2m\nR1 b c 1\nVe c 0 5\n.model sm SW(Vt=0.5)\n.tran 1u 100 uic\n",
          100.0);
    for (bool happens; r.part->segment.t < last - 0.5 * period;) {
        const struct dalcs_leap *leap = NULL;
        if (r.part->memory.cycles) {
            ck_assert_int_eq(dalcs_cycle_leap(&r, last + 1e-9, 1L << 40, &leap), DALCS_OK);
        }
        if (r.part->segment.t < last - 0.5 * period) {
            double to = dalcs_radau_next_stop(&r, &happens);
            ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
        }
    }
    ck_assert_double_eq(r.part->segment.t, last);
    ck_assert_msg(fabs(r.part->x[0] - exact) < 1e-11, "%.17g instead of %.17g", r.part->x[0],
                  exact);
    ck_assert_int_gt(r.leapt_steps, 1999900);
    finish();
}

END_TEST

RUN_TESTS("cycle", test_buck, test_many_rows, test_load, test_jump_at_command, test_two_phases,
          test_at_once, test_two_periods, test_watched, test_long_run)
