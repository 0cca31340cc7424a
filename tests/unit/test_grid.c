/* test_grid.c - times are counted, edges are landed on, pieces recur. */
#include "grid.h"

#include "make_pulse.h"
#include "run_tests.h"

#include <math.h>

static struct dalcs_grid grid;

/* A million steps of 0.1 us, which no double holds: the k-th time is k h rounded once, and every
 * step has the very length h, the last one too. */
START_TEST(test_no_drift) {
    const double h = 1e-7;

    enum { N = 1000000 };

    bool jumps;
    dalcs_grid_init(&grid, h, 0.1, 0, NULL);
    int n_wrong = 0; /* an assertion each would take longer than the steps */
    for (int k = 1; k <= N; k++) {
        n_wrong += dalcs_grid_at_end(&grid);
        n_wrong += dalcs_grid_advance(&grid, &jumps) != h || jumps;
        n_wrong += grid.t != (k < N ? k * h : 0.1);
    }
    ck_assert_int_eq(n_wrong, 0);
    ck_assert(dalcs_grid_at_end(&grid));
}

END_TEST

/* A stop that is no multiple of h is met by a shorter step. */
START_TEST(test_short_end) {
    bool jumps;
    dalcs_grid_init(&grid, 0.3, 1.0, 0, NULL);
    int n = 0;
    double length = 0.0;
    for (; !dalcs_grid_at_end(&grid); n++) {
        length = dalcs_grid_advance(&grid, &jumps);
    }
    ck_assert_int_eq(n, 4);
    ck_assert(grid.t == 1.0);
    ck_assert_double_eq_tol(length, 0.1, 1e-15);
}

END_TEST

/* Every edge is a time of the grid, to the bit; multiples of h stay where they were. */
START_TEST(test_edges) {
    const struct dalcs_stimulus source[] = {
        make_pulse(0.0, 1.0, 0.25e-6, 0.0, 0.0, 1.3e-6, 3.1e-6),
        make_pulse(0.0, 1.0, 1e-6, 0.5e-6, 0.2e-6, 2e-6, INFINITY)};
    const double h = 1e-6;
    const double stop = 1e-3;
    dalcs_grid_init(&grid, h, stop, 2, source);
    double edge = 0.0;
    long n_multiples = 0;
    for (double before = 0.0; !dalcs_grid_at_end(&grid); before = grid.t) {
        bool jumps;
        double length = dalcs_grid_advance(&grid, &jumps);
        ck_assert(grid.t > before);
        ck_assert_double_le(length, h);
        ck_assert_double_eq_tol(length, grid.t - before, 1e-18); /* a few ulp of stop */
        double next = fmin(dalcs_stimulus_next_edge(&source[0], edge),
                           dalcs_stimulus_next_edge(&source[1], edge));
        ck_assert_double_le(grid.t, next);
        if (grid.t == next) {
            edge = next;
            bool expected = dalcs_stimulus_jumps_at(&source[0], edge) ||
                            dalcs_stimulus_jumps_at(&source[1], edge);
            ck_assert_int_eq(jumps, expected);
        } else {
            ck_assert(!jumps);
        }
        n_multiples += fabs(grid.t / h - rint(grid.t / h)) < 1e-9;
    }
    ck_assert(grid.t == stop);
    ck_assert_int_eq(n_multiples, 1000);
    ck_assert_double_gt(edge, stop - 3.1e-6);
}

END_TEST

/* An edge on a multiple of h is no second step, however the two roundings differ. */
START_TEST(test_edges_on_the_grid) {
    const struct dalcs_stimulus source = make_pulse(0.0, 1.0, 0.3e-6, 0.0, 0.0, 0.7e-6, 1e-6);
    dalcs_grid_init(&grid, 1e-7, 1e-3, 1, &source);
    long n = 0;
    long n_jumps = 0;
    while (!dalcs_grid_at_end(&grid)) {
        bool jumps;
        double edge = dalcs_stimulus_next_edge(&source, grid.t);
        ck_assert(dalcs_grid_advance(&grid, &jumps) == 1e-7);
        ck_assert(!jumps || grid.t == edge || grid.t == 1e-3); /* there its limits are exact */
        n_jumps += jumps;
        n++;
    }
    ck_assert_int_eq(n, 10000);
    ck_assert_int_eq(n_jumps, 2000); /* two in each period, the last at the stop */
}

END_TEST

/* A PWM pattern of 10.5 steps over 2000 periods: its four edges cut at most eight pieces, whose
 * lengths may fall on either side of a rounding but take no third value, so that their factors are
 * found in the cache. */
START_TEST(test_pieces_recur) {
    const struct dalcs_stimulus source = make_pulse(0.0, 1.0, 0.0, 0.0, 0.0, 3.3e-6, 10.5e-6);
    dalcs_grid_init(&grid, 1e-6, 0.021, 1, &source);
    double seen[17];
    int n_seen = 0;
    while (!dalcs_grid_at_end(&grid)) {
        bool jumps;
        double length = dalcs_grid_advance(&grid, &jumps);
        int k = 0;
        while (k < n_seen && seen[k] != length) {
            k++;
        }
        if (k == n_seen) {
            ck_assert_int_lt(n_seen, 17);
            seen[n_seen++] = length;
        }
    }
    ck_assert_int_gt(n_seen, 2);
}

END_TEST

RUN_TESTS("grid", test_no_drift, test_short_end, test_edges, test_edges_on_the_grid,
          test_pieces_recur)
