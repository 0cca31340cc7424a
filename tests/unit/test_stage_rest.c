/* test_stage_rest.c - steps that leave out what is at rest, against steps that leave out nothing. */
#include "stage_update.h"

#include "build_network.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SECTIONS = 60, TEXT = 20000 };

static struct text_network text;
static struct dalcs_excitation excitation;
static struct dalcs_stages whole;   /* nothing is ever at rest */
static struct dalcs_stages resting; /* what may be is */
static double *in, *x, *y;

/* A chain of sections behind diodes; every third has a coil, a controlled source or a switch too. */
static void write_chain(char *to, const char *feed, const char *more) {
    int at = snprintf(to, TEXT, "chain\n%s\nrs in n0 10\n", feed);
    for (int k = 1; k <= SECTIONS; k++) {
        at += snprintf(to + at, TEXT - (size_t)at,
                       "d%d n%d m%d di\nr%d m%d n%d 1\nc%d n%d 0 1u\nrl%d n%d 0 10k\n", k, k - 1, k,
                       k, k, k, k, k, k, k);
        if (k % 3 == 0) {
            at += snprintf(to + at, TEXT - (size_t)at, "l%d n%d q%d 1m\nrq%d q%d 0 20\n", k, k, k,
                           k, k);
        } else if (k % 3 == 1) {
            at += snprintf(to + at, TEXT - (size_t)at,
                           "e%d q%d 0 n%d 0 2\nrq%d q%d p%d 1k\ncq%d p%d 0 100n\n", k, k, k, k, k,
                           k, k, k);
        } else {
            at += snprintf(to + at, TEXT - (size_t)at, "s%d n%d q%d n%d 0 sw\nrq%d q%d 0 50\n", k,
                           k, k, k, k, k);
        }
    }
    (void)snprintf(to + at, TEXT - (size_t)at,
                   "%s.model di d\n.model sw sw(vt=100)\n.tran 1u 1m uic\n.end\n", more);
}

static void setup_fed(const char *feed, const char *more) {
    static char netlist[TEXT];
    write_chain(netlist, feed, more);
    build_good_network(&text, netlist);
    ck_assert_int_eq(text.network.n_systems, 1);
    const struct dalcs_system *s = &text.network.system[0];
    ck_assert_int_eq(dalcs_excitation_setup(&excitation, &text.circuit, s, NULL), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&whole, s, &excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, 5), 0, 1e-14,
                                        SIZE_MAX),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&resting, s, &excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, 5), 0, 1e-14,
                                        SIZE_MAX),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stage_plan_get(&whole), DALCS_OK);
    ck_assert_int_eq(dalcs_stage_plan_get(&resting), DALCS_OK);
    dalcs_stage_rest_end(whole.plan);
    size_t n_out = (size_t)whole.layout.n_fixed + 64;
    in = dalcs_alloc((size_t)whole.n_in, sizeof(*in));
    x = dalcs_alloc(n_out, sizeof(*x));
    y = dalcs_alloc(n_out, sizeof(*y));
    ck_assert(in != NULL && x != NULL && y != NULL);
}

static void setup(const char *more) {
    setup_fed("v1 in 0 sin(0 10 1k)", more);
}

static void finish(void) {
    free(in);
    free(x);
    free(y);
    dalcs_stages_finish(&whole);
    dalcs_stages_finish(&resting);
    dalcs_excitation_finish(&excitation);
    text_network_finish(&text);
}

/* "cq17", "l17": 17 */
static int section_of(const char *element) {
    return atoi(element + strcspn(element, "0123456789"));
}

/* Any state up to section `front`, none beyond. */
static void set_states(int front, uint64_t *random) {
    const struct dalcs_system *s = &text.network.system[0];
    for (int k = 0; k < whole.n_in; k++) {
        double value = next_random(random);
        in[k] = k >= s->n_x || section_of(s->column[k].element) <= front ? value : 0.0;
    }
    in[s->n_x] = 1.0;
}

/* A step of each from in[] in the mode: the same answer, to rounding. */
static void compare(const uint64_t *mode, double h) {
    struct dalcs_stage_entry *of_whole;
    struct dalcs_stage_entry *of_resting;
    int n_out = whole.layout.n_fixed;
    for (int k = 0; k < n_out; k++) {
        x[k] = 1e300; /* what is not written is seen */
        y[k] = 1e300;
    }
    ck_assert_int_eq(dalcs_stages_step(&whole, mode, h, in, x, &of_whole), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_step(&resting, mode, h, in, y, &of_resting), DALCS_OK);
    ck_assert(!whole.plan->rest.any);
    ck_assert_int_eq(dalcs_stage_n_clashes(of_whole), dalcs_stage_n_clashes(of_resting));
    double largest = 0.0;
    for (int k = 0; k < n_out; k++) {
        largest = fmax(largest, fabs(x[k]));
    }
    for (int k = 0; k < n_out; k++) {
        ck_assert_msg(fabs(x[k] - y[k]) <= 1e-11 * largest, "out[%d]: %.17g, resting %.17g", k,
                      x[k], y[k]);
        ck_assert(x[k] != 0.0 || y[k] == 0.0);
    }
}

/* The first n diodes, and some more. */
static void close_first(int n, uint64_t *mode) {
    const struct dalcs_system *s = &text.network.system[0];
    mode[0] = mode[1] = 0;
    for (int d = 0; d < s->n_pairs; d++) {
        if (s->pair[d].kind == DALCS_PAIR_DIODE && section_of(s->pair[d].element) <= n) {
            mode[d / 64] |= (uint64_t)1 << (d % 64);
        }
    }
}

static double part_awake(void) {
    return (double)resting.plan->rest.n_awake / dalcs_system_n_equations(&text.network.system[0]);
}

START_TEST(test_front) {
    uint64_t mode[2];
    uint64_t random = 11;
    int n_chosen = 0;
    int awake = 0;
    const int at_once = SECTIONS / of_cases(15, 5);
    setup("");
    for (int front = 1; front <= SECTIONS; front += at_once) {
        close_first(front, mode);
        for (int step = 0; step < 2; step++) {
            set_states(front, &random);
            compare(mode, 1e-6);
            compare(mode, 1e-9);
        }
        n_chosen += resting.plan->rest.n_awake != awake;
        awake = resting.plan->rest.n_awake;
        if (front <= SECTIONS / 4) {
            ck_assert(resting.plan->rest.any && part_awake() < 0.7);
        }
    }
    ck_assert(!resting.plan->rest.any);
    ck_assert_int_lt(n_chosen, 8); /* ahead of the front, not with it */
    finish();
}

END_TEST

/* Nothing is closed on the way: a diode far ahead, a state far ahead. */
START_TEST(test_far_ahead) {
    uint64_t mode[2];
    uint64_t random = 12;
    for (int what = 0; what < 3; what++) {
        setup("");
        close_first(2, mode);
        set_states(2, &random);
        compare(mode, 1e-6);
        compare(mode, 1e-6);
        ck_assert(resting.plan->rest.any);
        int far = find_pair(&text.network.system[0], "d60");
        if (what == 0) {
            in[find_column(&text.network.system[0], DALCS_LABEL_STATE, "c60")] = 1.0;
            compare(mode, 1e-6);
            ck_assert(resting.plan->rest.any);
        } else if (what == 1) {
            mode[far / 64] |= (uint64_t)1 << (far % 64);
            compare(mode, 1e-6);
            ck_assert(resting.plan->rest.any);
        } else { /* asked for without states: then nothing is known to be at rest */
            struct dalcs_stage_entry *entry;
            mode[far / 64] |= (uint64_t)1 << (far % 64);
            ck_assert_int_eq(dalcs_stages_get(&resting, mode, 1e-6, &entry), DALCS_OK);
            ck_assert(!resting.plan->rest.any && resting.plan->rest.settled);
        }
        compare(mode, 1e-6);
        finish();
    }
}

END_TEST

/* Sources keep awake what they drive, in an equation or in the side of a diode. */
START_TEST(test_sources) {
    static const char *const more[] = {"i1 0 n55 2\n", "v9 z 0 sin(0 1 1k)\nrz z n55 10\n",
                                       "dz99 n54 z2 dv\nrz z2 0 10\n.model dv d(vfwd=0.7)\n"};
    for (int k = 0; k < 3; k++) {
        uint64_t mode[2];
        uint64_t random = 13;
        setup(more[k]);
        close_first(1, mode);
        for (int step = 0; step < 3; step++) {
            set_states(1, &random);
            compare(mode, 1e-6);
        }
        ck_assert(resting.plan->rest.any);
        finish();
    }
}

END_TEST

/* A mode that leaves something open is solved with all there is. */
START_TEST(test_singular) {
    uint64_t mode[2];
    uint64_t random = 14;
    setup("dp99 n1 m2 di\n");
    int parallel = find_pair(&text.network.system[0], "dp99");
    close_first(2, mode);
    for (int step = 0; step < 2; step++) {
        set_states(2, &random);
        compare(mode, 1e-6);
    }
    ck_assert(resting.plan->rest.any);
    mode[parallel / 64] |= (uint64_t)1 << (parallel % 64);
    struct dalcs_stage_entry *entry;
    ck_assert_int_eq(dalcs_stages_step(&resting, mode, 1e-6, in, y, &entry), DALCS_OK);
    ck_assert_int_gt(dalcs_stage_n_clashes(entry), 0);
    ck_assert(!resting.plan->rest.any && resting.plan->rest.settled);
    finish();
}

END_TEST

/* Where everything moves nothing is given up for it. */
START_TEST(test_all_moves) {
    uint64_t mode[2];
    uint64_t random = 15;
    setup("");
    close_first(0, mode);
    for (int step = 0; step < 3; step++) {
        set_states(SECTIONS, &random);
        compare(mode, 1e-6);
    }
    ck_assert(!resting.plan->rest.any && resting.plan->rest.settled);
    ck_assert_int_eq(resting.factorizations, 1);
    finish();
}

END_TEST

/* Without a source and from 0 nothing moves, which is no reason to leave out everything. */
START_TEST(test_nothing_moves) {
    uint64_t mode[2];
    uint64_t random = 16;
    setup_fed("rin in 0 1k", "");
    close_first(0, mode);
    for (int step = 0; step < 3; step++) {
        set_states(0, &random);
        compare(mode, 1e-6);
    }
    ck_assert(!resting.plan->rest.any);
    set_states(1, &random);
    compare(mode, 1e-6);
    finish();
}

END_TEST

RUN_TESTS("stage rest", test_nothing_moves, test_front, test_far_ahead, test_sources, test_singular,
          test_all_moves)
