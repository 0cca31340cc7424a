/* test_segment.c - how a segment begins where pairs have just changed sides. */
#include "radau.h"

#include "build_network.h"

static struct text_network t;
static struct dalcs_euler e;
static struct dalcs_radau r;

static const double stop = 0.2;

static void start(const char *text) {
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    const struct dalcs_radau_options o = {.tolerance = 1e-9, .stop = stop};
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, stop, stop), DALCS_OK);
    ck_assert_int_eq(dalcs_radau_setup(&r, &e, &o, &options), DALCS_OK);
    ck_assert_int_eq(dalcs_radau_start(&r, t.network.initial), DALCS_OK);
}

static void walk_to(double end) {
    bool happens;
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < end;) {
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
    }
}

static void finish(void) {
    dalcs_radau_finish(&r);
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

/* A half-wave rectifier begins with its diode closed, in steps half as long as where it is open. When it
 * closes again, that is the length to begin with: it has its map, while the longer one would have to get
 * one, and be refused. */
START_TEST(test_known_mode) {
    start("half-wave\nv1 in 0 sin(0 10 50)\nd1 in out\nr1 out 0 1k\nc1 out 0 20u\n"
          ".tran 1m 200m uic\n");
    walk_to(stop);
    ck_assert_int_eq(r.rejected, 0);
    ck_assert_int_eq(r.restarts, 1);
    /* closed: a step and one that projects; open: two lengths */
    ck_assert_int_eq(r.part->stages.factorizations, 4);
    finish();
}

END_TEST

RUN_TESTS("segment", test_known_mode)
