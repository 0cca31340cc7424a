/* run_radau.h - for the tests: one part of a netlist text on its way with the Radau methods. */
#ifndef DALCS_TEST_RUN_RADAU_H
#define DALCS_TEST_RUN_RADAU_H

#include "radau.h"

#include "build_network.h"

static struct text_network t;
static struct dalcs_euler e;
static struct dalcs_radau r;

/* From IC= at t = 0, to a tolerance; parts of more unknowns than dense_limit on factors. 0 stages: the
 * program's choice. */
static inline void start_in(const char *text, double stop, double tolerance, int dense_limit,
                            int stages) {
    struct dalcs_osnsp_options options = usual_osnsp_options();
    const struct dalcs_radau_options o = {.tolerance = tolerance, .stop = stop, .stages = stages};
    options.dense_limit = dense_limit;
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, stop, stop), DALCS_OK);
    ck_assert_int_eq(dalcs_radau_setup(&r, &e, &o, &options), DALCS_OK);
    dalcs_radau_start(&r, t.network.initial);
    ck_assert_int_eq(dalcs_radau_begin(&r), DALCS_OK);
}

static inline void start_with(const char *text, double stop, double tolerance, int dense_limit) {
    start_in(text, stop, tolerance, dense_limit, 0);
}

static inline void start(const char *text, double stop) {
    start_with(text, stop, 1e-9, usual_osnsp_options().dense_limit);
}

/* All segments that end before `end`. */
static inline void walk_to(double end) {
    bool happens;
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < end;) {
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
    }
}

static inline void finish(void) {
    dalcs_radau_finish(&r);
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

#endif
