/* test_segment.c - how a segment begins where pairs have just changed sides. */
#include "run_radau.h"

/* A half-wave rectifier begins with its diode closed, in steps half as long as where it is open. When it
 * closes again, that is the length to begin with: it has its map, while the longer one would have to get
 * one, and be refused. */
START_TEST(test_known_mode) {
    start("half-wave\nv1 in 0 sin(0 10 50)\nd1 in out\nr1 out 0 1k\nc1 out 0 20u\n"
          ".tran 1m 200m uic\n",
          0.2);
    walk_to(0.2);
    ck_assert_int_eq(r.rejected, 0);
    ck_assert_int_eq(r.restarts, 1);
    /* closed: a step, and none that projects, in which the state moves farther than it is off; open: one twice as
     * long from the start, for nothing drives the state any more */
    ck_assert_int_eq(r.part->stages.cache.factorizations, 2);
    finish();
}

END_TEST

static void walk_without_euler(double end, int most_steps) {
    walk_to(end);
    ck_assert_int_eq(r.euler_steps, 0);
    ck_assert_int_lt(r.steps, most_steps);
    finish();
}

/* Four diodes in parallel, two each way, and a capacitor across them: on factors, too, what they leave open
 * is chosen exactly, and what the capacitor makes of an error of that, C/h, is no current. */
START_TEST(test_open_across_a_capacitor) {
    start_with("four across a capacitor\nv1 s 0 sin(0 100 50 0 0 30)\nrs s n1 0.1\nr1 n1 0 50\n"
               "r2 n2 0 1k\nr3 n3 0 100k\nd1 n3 n1\nd2 n3 n1\nd3 0 n2\nd4 n1 n3\nd5 n1 n3\n"
               "c6 n1 n3 100u ic=0\nc7 0 n3 100n ic=0\nl8 n2 n3 100u\nr10 n2 n1 100\n"
               ".tran 0.4m 80m uic\n",
               0.08, 1e-6, 0);
    walk_without_euler(0.08, 600);
}

END_TEST

/* A capacitor across a diode that conducts, and one the other way: what rounding leaves of a voltage of 100 V
 * that should be 0 is little where steps are solved for what changes. */
START_TEST(test_nothing_across_a_capacitor) {
    start_with("both ways\nv1 s 0 sin(0 100 60 0 0 90)\nrs s n1 10\nr1 n1 0 100k\nr2 n2 0 10k\n"
               "r3 n3 0 100k\nr4 n4 0 10k\nd1 n1 n4\nd2 n1 n2\nd3 n4 n1\nd4 n3 n2\nd5 n3 n2\n"
               "c6 n1 n4 10u ic=-2\nc7 n1 0 100n ic=1\nc8 n1 n4 10u ic=0\nl9 0 n2 100u\n"
               "l10 0 n1 100u\nr11 n4 n3 100\nr12 n2 n1 1k\n.tran 0.3m 66.7m uic\n",
               0.0667, 1e-9, 0);
    walk_without_euler(0.0667, 2000);
}

END_TEST

/* Behind the jump of its capacitors the circuit is for 9 ns in a mode that micro-steps of 7 ns pass over: shorter
 * ones, which are asked as the state moves in the first and no more in the second, are in it. */
START_TEST(test_brief_behind_a_jump) {
    start_with("three in a loop\nv1 s 0 sin(0 100 50)\nrs s n1 0.1\nr1 n1 0 1k\nr2 n2 0 10k\n"
               "r3 n3 0 100\nd1 n2 n3\nd2 0 n3\nd3 n3 n1\nd4 0 n2\nc5 n2 n1 100n ic=-2\n"
               "c6 n1 n3 10u ic=1\nc7 n2 n3 1u ic=0\nr8 n2 0 10\nr9 n3 n1 1\n.tran 0.4m 80m uic\n",
               0.08, 1e-6, 64);
    ck_assert_uint_eq(r.part->component->osnsp.mode[0], 8); /* d4 alone */
    ck_assert_double_lt(r.part->segment.t_end, 20e-9);
    walk_to(1e-5);
    ck_assert_int_eq(r.euler_steps, 0);
    finish();
}

END_TEST

/* Where no step has factors, steps of Euler in a row get longer all the same. */
START_TEST(test_falls_back_in_longer_steps) {
    start_with("half wave\nv1 a 0 sin(0 10 50)\nr1 a b 10\nd1 b c\nc1 c 0 100u\nr2 c 0 1k\n"
               ".tran 0.1m 1m uic\n",
               1e-3, 1e-6, 0);
    r.part->stages.cache.most_bytes = 0;
    r.part->stages.rcond_min = 10.0;
    r.part->length.level += 20;
    walk_to(2e-5);
    ck_assert_int_gt(r.euler_steps, 0);
    ck_assert_int_lt(r.euler_steps, 1000);
    finish();
}

END_TEST

/* Beside a transient of 0.1 us rounding looks like a jump to the first micro-steps: the state stays where it is. */
START_TEST(test_start_without_jump) {
    start_with("from -2 V\nv1 s 0 sin(0 10 1k 0 0 30)\nrs s n1 50\nr1 n1 0 100\nr2 n2 0 10k\n"
               "r3 n3 0 100k\nr4 n4 0 10k\nd1 n2 n1\nd2 n2 n4\nd3 0 n2\nd4 n1 n4\nd5 n1 0\n"
               "c6 0 n4 100u ic=0\nc7 n1 0 1u ic=0\nc8 n4 n3 100n ic=-2\nr9 n2 n4 1k\n"
               "r10 n4 n3 100\nr11 n1 n3 1\n.tran 20u 4m uic\n",
               4e-3, 1e-6, 64);
    for (int k = 0; k < t.network.system[0].n_x; k++) {
        ck_assert_double_eq_tol(r.part->x[k], t.network.initial[0][k], 1e-12);
    }
    finish();
}

END_TEST

/* A buck converter: no step is longer than the first power of 2 beyond the longest span, from the start on, and
 * when the switch opens or closes the first time the circuit is asked at once where the current goes, instead of
 * making maps of two modes in which it has nowhere to go. */
START_TEST(test_commutation) {
    bool happens;
    start("buck\nvin in 0 12\nvg g 0 pulse(0 1 0 0 0 4u 10u)\ns1 in sw g 0 sm\nd1 0 sw\n"
          "l1 sw out 50u\nc1 out 0 20u\nr1 out 0 2\n.model sm sw(vt=0.5)\n.tran 1u 10m uic\n",
          10e-3);
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < 25e-6;) {
        ck_assert(r.part->segment.h < 12e-6);
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
    }
    ck_assert_int_eq(r.restarts, 3);                          /* at 0, 4 and 10 us */
    ck_assert_int_eq(r.part->stages.cache.factorizations, 2); /* each span its own */
    finish();
}

END_TEST

RUN_TESTS("segment", test_known_mode, test_start_without_jump, test_open_across_a_capacitor,
          test_nothing_across_a_capacitor, test_brief_behind_a_jump,
          test_falls_back_in_longer_steps, test_commutation)
