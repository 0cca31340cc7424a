/* test_thinning.c - which rows are left out: never more than the bound allows, and most of a smooth
 * waveform. */
#include "thinning.h"

#include "run_tests.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { N_SIGNALS = 3, MAX_ROWS = 20000 };

struct rows {
    int n;
    double time[MAX_ROWS], value[MAX_ROWS][N_SIGNALS];
    int stop_after; /* refuse this row; 0: none */
    int n_ended;
    bool stop; /* what progress says */
};

static struct rows all, kept;

static void add_row(struct rows *rows, double time, double a, double b, double c) {
    ck_assert_int_lt(rows->n, MAX_ROWS);
    rows->time[rows->n] = time;
    rows->value[rows->n][0] = a;
    rows->value[rows->n][1] = b;
    rows->value[rows->n++][2] = c;
}

static enum dalcs_status take_begin(void *user, const struct dalcs_plot *plot) {
    (void)plot;
    ((struct rows *)user)->n = 0;
    return DALCS_OK;
}

static enum dalcs_status take_row(void *user, double time, const double *value) {
    struct rows *rows = user;
    add_row(rows, time, value[0], value[1], value[2]);
    return rows->n == rows->stop_after ? DALCS_E_IO : DALCS_OK;
}

static enum dalcs_status take_end(void *user) {
    ((struct rows *)user)->n_ended++;
    return DALCS_OK;
}

static enum dalcs_status take_progress(void *user, double time, double stop) {
    (void)time;
    (void)stop;
    return ((struct rows *)user)->stop ? DALCS_E_CANCELLED : DALCS_OK;
}

static const struct dalcs_sink sink = {.user = &kept,
                                       .begin = take_begin,
                                       .row = take_row,
                                       .end = take_end,
                                       .progress = take_progress};

/* All rows through the sink into `kept`. */
static void thin(double bound) {
    struct dalcs_thinning t;
    ck_assert_int_eq(dalcs_thinning_setup(&t, &sink, N_SIGNALS, bound), DALCS_OK);
    kept = (struct rows){0};
    ck_assert_int_eq(t.sink.begin(t.sink.user, NULL), DALCS_OK);
    for (int k = 0; k < all.n; k++) {
        ck_assert_int_eq(t.sink.row(t.sink.user, all.time[k], all.value[k]), DALCS_OK);
    }
    ck_assert_int_eq(t.sink.end(t.sink.user), DALCS_OK);
    dalcs_thinning_finish(&t);
    ck_assert_int_eq(kept.n_ended, 1);
}

/* How far the lines between kept rows are from any row, over the largest value up to that row; INFINITY
 * where a kept row is none of all, or the first, the last or a side of a discontinuity is missing. */
static double distance(void) {
    double worst = 0.0;
    double scale[N_SIGNALS] = {0.0};
    int next = 0; /* the kept row at or after this one */
    for (int k = 0; k < all.n; k++) {
        bool is_side = (k > 0 && all.time[k - 1] == all.time[k]) ||
                       (k + 1 < all.n && all.time[k + 1] == all.time[k]);
        bool must_stay = k == 0 || k == all.n - 1 || is_side;
        bool is_kept = next < kept.n && kept.time[next] == all.time[k] &&
                       memcmp(kept.value[next], all.value[k], sizeof(all.value[k])) == 0;
        if (next >= kept.n || (must_stay && !is_kept)) {
            return INFINITY;
        }
        for (int i = 0; i < N_SIGNALS; i++) {
            scale[i] = fmax(scale[i], fabs(all.value[k][i]));
        }
        if (is_kept) {
            next++;
            continue;
        }
        double part = (all.time[k] - kept.time[next - 1]) / (kept.time[next] - kept.time[next - 1]);
        for (int i = 0; i < N_SIGNALS; i++) {
            double a = kept.value[next - 1][i], b = kept.value[next][i];
            double off = fabs(a + part * (b - a) - all.value[k][i]);
            worst = fmax(worst, off == 0.0 ? 0.0 : off / scale[i]);
        }
    }
    return next == kept.n ? worst : INFINITY;
}

/* 0 to 1, the same on every machine. */
static double draw(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

/* Steps of many sizes, values of any scale, with jumps and stretches that stand still. */
static void walk(uint64_t seed) {
    uint64_t state = seed;
    double time = 0.0, a = 0.0, b = 1e6, c = 0.0;
    all.n = 0;
    for (int k = 0; k < 5000; k++) {
        add_row(&all, time, a, b, c);
        if (draw(&state) < 0.01) {
            add_row(&all, time, a, -b, c + 1.0);
        }
        time += pow(10.0, -6.0 * draw(&state));
        bool still = (k / 100) % 3 == 0;
        a += still ? 0.0 : 0.01 * (draw(&state) - 0.5);
        b *= still ? 1.0 : 1.0 + 0.01 * (draw(&state) - 0.5);
        c = still ? c : 1e-9 * sin(time);
    }
}

START_TEST(test_bound_holds) {
    static const double bound[] = {0.3, 1e-2, 1e-3, 1e-6, 1e-12, 1e-18};
    for (uint64_t seed = 1; seed <= 20; seed++) {
        walk(seed);
        for (size_t k = 0; k < sizeof(bound) / sizeof(*bound); k++) {
            thin(bound[k]);
            ck_assert_double_le(distance(), bound[k] + 1e-15);
            ck_assert_int_lt(kept.n, all.n);
        }
    }
}

END_TEST

/* The check above would notice: each other kept row away, or one side of a jump. */
START_TEST(test_bound_can_fail) {
    walk(1);
    thin(1e-3);
    ck_assert(isfinite(distance()));
    static struct rows whole;
    whole = kept;
    kept.n = 0;
    for (int k = 0; k < whole.n; k++) {
        bool is_side = (k > 0 && whole.time[k - 1] == whole.time[k]) ||
                       (k + 1 < whole.n && whole.time[k + 1] == whole.time[k]);
        if (k % 2 == 0 || is_side || k == whole.n - 1) {
            add_row(&kept, whole.time[k], whole.value[k][0], whole.value[k][1], whole.value[k][2]);
        }
    }
    ck_assert_double_gt(distance(), 2e-3);
    kept = whole;
    int side = 1;
    while (kept.time[side] != kept.time[side - 1]) {
        side++;
    }
    memmove(&kept.time[side], &kept.time[side + 1], (size_t)(kept.n - side) * sizeof(double));
    memmove(kept.value[side], kept.value[side + 1],
            (size_t)(kept.n - side) * sizeof(kept.value[0]));
    kept.n--;
    ck_assert(isinf(distance()));
}

END_TEST

/* Each row alone is near the line from the row before; the drift is not. */
START_TEST(test_slow_bend) {
    all.n = 0;
    for (int k = 0; k <= 10000; k++) {
        double t = k * 1e-4;
        add_row(&all, t, 1.0 + t * t, 1.0, -1.0 - t * t * t);
    }
    thin(1e-4);
    ck_assert_double_le(distance(), 1e-4 + 1e-15);
    ck_assert_double_gt(distance(), 0.5e-4); /* it is used */
    ck_assert_int_gt(kept.n, 20);
    ck_assert_int_lt(kept.n, 200);
}

END_TEST

START_TEST(test_sine) {
    all.n = 0;
    for (int k = 0; k < 10000; k++) {
        double t = k * 1e-4;
        add_row(&all, t, 10.0 * sin(6.0 * acos(-1.0) * t), 0.0, 1e-3);
    }
    thin(1e-3);
    ck_assert_double_le(distance(), 1e-3 + 1e-15);
    ck_assert_int_lt(20 * kept.n, all.n);
}

END_TEST

/* Two rows at the times of discontinuities, next to each other and at the ends. */
START_TEST(test_discontinuities) {
    all.n = 0;
    for (int k = 0; k <= 100; k++) {
        add_row(&all, k, 1.0, 2.0, 3.0);
        if (k == 0 || k == 50 || k == 51 || k == 100) {
            add_row(&all, k, 1.0, 2.0, 3.0); /* even if nothing jumps */
        }
        if (k == 50) {
            add_row(&all, k, -1.0, 2.0, 3.0); /* three at once */
        }
    }
    thin(0.5);
    ck_assert_int_eq(kept.n, 2 + 3 + 2 + 2);
    static const double time[] = {0, 0, 50, 50, 50, 51, 51, 100, 100};
    ck_assert_mem_eq(kept.time, time, sizeof(time));
    ck_assert_double_eq(kept.value[4][0], -1.0);
    ck_assert_double_eq(distance(), 0.0);
}

END_TEST

START_TEST(test_few_rows) {
    for (int n = 0; n <= 3; n++) {
        all.n = 0;
        for (int k = 0; k < n; k++) {
            add_row(&all, 1.0 + k, 0.0, 1.0, k);
        }
        thin(1e-3);
        ck_assert_int_eq(kept.n, n < 3 ? n : 2);
    }
}

END_TEST

/* A sink that refuses a row gets no other; one that stops the run gets the row held back. */
START_TEST(test_stopped) {
    const double value[N_SIGNALS] = {0.0};
    struct dalcs_thinning t;
    kept = (struct rows){.stop_after = 2};
    ck_assert_int_eq(dalcs_thinning_setup(&t, &sink, N_SIGNALS, 0.1), DALCS_OK);
    for (int k = 0; k < 5; k++) {
        ck_assert_int_eq(t.sink.row(t.sink.user, k, value), DALCS_OK);
    }
    ck_assert_int_eq(t.sink.row(t.sink.user, 4.0, value), DALCS_E_IO);
    ck_assert_int_eq(dalcs_thinning_flush(&t), DALCS_OK);
    ck_assert_int_eq(kept.n, 2);
    dalcs_thinning_finish(&t);

    kept = (struct rows){.stop = true};
    ck_assert_int_eq(dalcs_thinning_setup(&t, &sink, N_SIGNALS, 0.1), DALCS_OK);
    for (int k = 0; k < 5; k++) {
        ck_assert_int_eq(t.sink.row(t.sink.user, k, value), DALCS_OK);
    }
    ck_assert_int_eq(t.sink.progress(t.sink.user, 4.0, 9.0), DALCS_E_CANCELLED);
    ck_assert_int_eq(kept.n, 1);
    ck_assert_int_eq(dalcs_thinning_flush(&t), DALCS_OK);
    ck_assert_int_eq(dalcs_thinning_flush(&t), DALCS_OK);
    ck_assert_int_eq(kept.n, 2);
    ck_assert_double_eq(kept.time[1], 4.0);
    dalcs_thinning_finish(&t);
}

END_TEST

RUN_TESTS("thinning", test_bound_holds, test_bound_can_fail, test_slow_bend, test_sine,
          test_discontinuities, test_few_rows, test_stopped)
