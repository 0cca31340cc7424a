/* test_stage_factors.c - steps on sparse factors, and on those of another mode with a few changes,
 * against the dense map. */
#include "stage_comparison.h"

#include <math.h>
#include <stdio.h>

/* All modes of up to 6 pairs, many of more. */
static struct tally check_system(const char *netlist, double h, bool general) {
    struct tally tally = {0};
    for (int s = 1; s <= 7; s += 2) {
        struct three_stages b;
        setup_stages(&b, netlist, s, general);
        int n_pairs = b.system->n_pairs;
        uint64_t random = 17;
        int n_modes = n_pairs <= 6 ? 1 << n_pairs : 64;
        for (int k = 0; k < n_modes; k++) {
            /* up or down, so that pairs close or open */
            uint64_t mode[2] = {(uint64_t)(s % 4 == 1 ? k : n_modes - 1 - k)};
            for (int d = 0; d < n_pairs && n_pairs > 6; d++) {
                bool on = next_random(&random) > (k % 8) * 0.25 - 1.0;
                mode[d / 64] = (mode[d / 64] & ~((uint64_t)1 << (d % 64))) | (uint64_t)on
                                                                                 << (d % 64);
            }
            check_mode(&b, mode, h, &random, &tally);
            if (k % 4 == 0) { /* a known pattern again */
                check_mode(&b, mode, h / 8.0, &random, &tally);
            }
        }
        finish_stages(&b);
    }
    return tally;
}

static struct tally check_netlist(const char *netlist, double h) {
    return check_system(netlist, h, false);
}

/* Updates that are wrong are refused, and thus missing. */
static void check_updates(const struct tally *t) {
    ck_assert_int_gt(t->n_columns, 900);
    ck_assert_int_gt(t->n_closings, 15);
    ck_assert_int_gt(t->n_openings, 15);
    ck_assert_int_gt(t->n_several, 0);
}

START_TEST(test_ladder) {
    struct tally t = check_netlist("ladder\n"
                                   "v1 in 0 sin(0 10 1k)\n"
                                   "rs in n0 10\n"
                                   "d1 n0 m1 di\nr1 m1 n1 1\nc1 n1 0 1u\nrl1 n1 0 10k\n"
                                   "d2 n1 m2 di\nr2 m2 n2 1\nc2 n2 0 1u\nrl2 n2 0 10k\n"
                                   "d3 n2 m3 di\nr3 m3 n3 1\nc3 n3 0 1u\nrl3 n3 0 10k\n"
                                   "d4 n3 m4 di\nr4 m4 n4 1\nc4 n4 0 1u\nrl4 n4 0 10k\n"
                                   ".model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_eq(t.n_singular, 0);
    ck_assert_int_gt(t.n_free, 0);
    check_updates(&t);
}

END_TEST

/* More unknowns than a piece of the combination holds, and two words of pairs. */
START_TEST(test_multiplier) {
    char text[16384];
    int at = snprintf(text, sizeof(text), "multiplier\nv1 a0 0 sin(0 100 50)\nvb b0 0 0\n");
    for (int k = 1; k <= 35; k++) {
        at += snprintf(text + at, sizeof(text) - (size_t)at,
                       "ca%d a%d a%d 1u\ncb%d b%d b%d 1u\nda%d b%d a%d di\ndb%d a%d b%d di\n", k,
                       k - 1, k, k, k - 1, k, k, k - 1, k, k, k, k);
    }
    (void)snprintf(text + at, sizeof(text) - (size_t)at,
                   "rl b35 0 10meg\n.model di d(ron=10)\n.tran 2u 4m uic\n.end\n");
    struct three_stages b;
    setup_stages(&b, text, 5, false);
    struct tally tally = {0};
    uint64_t random = 3;
    for (int k = 0; k < 4; k++) {
        uint64_t mode[2] = {0x0123456789abcdefu << k, 0x2bu >> k};
        check_mode(&b, mode, 1e-4, &random, &tally);
    }
    finish_stages(&b);
    ck_assert_int_gt(tally.n_regular, 0);
}

END_TEST

START_TEST(test_coupled_coils) {
    struct tally t = check_netlist("coils\n"
                                   "v1 a 0 exp(0 10 1u 2u 20u 5u)\n"
                                   "r1 a b 0.5\n"
                                   "l1 b 0 1m\nl2 c 0 4m\nl3 d 0 1m\n"
                                   "k12 l1 l2 0.9\nk13 l1 l3 0.5\nk23 l2 l3 0.6\n"
                                   "d1 c e di\nd2 d e di\nc1 e 0 10u\nr2 e 0 50\n"
                                   "rc c 0 1k\nrd d 0 2k\n"
                                   ".model di d(vfwd=0.7 ron=0.01)\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_gt(t.n_closings, 0);
}

END_TEST

START_TEST(test_controlled_sources) {
    struct tally t = check_netlist("controlled\n"
                                   "v1 a 0 pulse(0 5 0 1u 1u 10u 20u)\n"
                                   "i1 0 c sin(0 1m 2k 0 300 30)\n"
                                   "v2 e 0 3\n"
                                   "r1 a b 100\nc1 b 0 100n\n"
                                   "e1 f 0 b 0 2\nr2 f g 50\nd1 g c di\nrc c 0 1k\nc2 c 0 1u\n"
                                   "g1 0 k c b 1m\nrk k 0 2k\nd2 k e di\n"
                                   "h1 m 0 v2 30\nrm m n 10\nl1 n 0 1m\n"
                                   "f1 0 n v1 0.5\nrn n 0 500\n"
                                   "s1 n c b 0 sw\ns2 k c a 0 sw off\n"
                                   "v3 p 0 sin(0 2 5k)\nrp p c 1k\ns3 m c p a sw\n"
                                   ".model sw sw(vt=1 vh=0.2)\n"
                                   ".model di d(vfwd=0.6)\n.tran 1u 1m uic\n.end\n",
                                   1e-6);
    ck_assert_int_gt(t.n_regular, 0);
    check_updates(&t);
}

END_TEST

/* Closed diodes tie capacitors to sources and to each other: currents of index 2. */
START_TEST(test_index_2) {
    struct tally t =
        check_netlist("loops of sources and capacitors\n"
                      "v1 a 0 sin(1 10 1k 0 100 20)\n"
                      "v2 b 0 pwl(0 0 1m 5)\n"
                      "d1 a c di\nc1 c 0 1u\nr1 c 0 1k\n"
                      "d2 c d di\nc2 d 0 2u\nr2 d 0 2k\n"
                      "rb b e 10\nl1 e f 1m\nd3 f g di\nl2 g 0 2m\nrf f 0 100\nrg g 0 200\n"
                      "c3 e d 1n\n"
                      ".model di d\n.tran 1u 1m uic\n.end\n",
                      1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    check_updates(&t);
}

END_TEST

/* With all diodes open the direct-current side floats; with two closed in a loop a current is
 * open. */
START_TEST(test_floating_bridge) {
    struct tally t = check_netlist("bridge\n"
                                   "v1 a 0 sin(0 10 50)\n"
                                   "rs a s 0.5\n"
                                   "d1 s p di\nd2 0 p di\nd3 m s di\nd4 m 0 di\n"
                                   "cf p m 300n\nr1 p m 1k\n"
                                   ".model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_singular, 0);
    ck_assert_int_eq(t.n_clashes, 0);
}

END_TEST

/* Equal diodes in parallel and in series, with a switch that must not count. */
START_TEST(test_shared_by_diodes) {
    struct tally t = check_netlist("parallel and series\n"
                                   "v1 a 0 sin(0 10 50)\nv2 k 0 pulse(0 1 0 1u 1u 1m 2m)\n"
                                   "r1 a b 1\n"
                                   "d1 b c di\nd2 b c di\nd3 b c di\n"
                                   "c1 c 0 10u\nr2 c 0 100\n"
                                   "d4 c d di\nd5 d e di\nr3 e 0 30\n"
                                   "s1 d f k 0 sw\nd6 f 0 di\n"
                                   ".model di d\n.model sw sw(vt=0.5)\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_singular, 0);
}

END_TEST

/* The same where surroundings differ by a thousand. */
START_TEST(test_shared_unequally) {
    struct tally t = check_netlist("loops and chains of diodes\n"
                                   "v1 a 0 sin(1 10 50)\nr1 a b 10\nr2 a c 1k\nr3 c 0 10k\n"
                                   "d1 b c di\nd2 c d di\nd3 b d di\nr4 d 0 300\n"
                                   "d4 b e di\nd5 e c di\nd6 e d di\nc1 c 0 1u\n"
                                   ".model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_singular, 0);
}

END_TEST

START_TEST(test_general_system) {
    struct tally t = check_system("sources in the sides of pairs\n"
                                  "v1 a 0 sin(0 10 1k)\nv2 b 0 exp(0 5 0 1m 5m 1m)\nv3 f 0 2\n"
                                  "r1 a c 10\nc1 c 0 1u\nd1 c d di\nr2 d b 20\nl1 d 0 1m\n"
                                  "d2 d e di\nr3 e f 30\nc2 e 0 2u\nd3 c e di\n"
                                  ".model di d\n.tran 1u 1m uic\n.end\n",
                                  1e-5, true);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_eq(t.n_singular, 0);
    check_updates(&t);
}

END_TEST

/* A mode may force a state to 0: what is left of it then is nothing but rounding. */
START_TEST(test_forced_to_zero) {
    struct tally t = check_netlist("coil against a diode\n"
                                   "l1 a 0 1m\nd1 a 0 di\n.model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_eq(t.n_singular, 0);
}

END_TEST

/* Sources that closed diodes put in parallel, or open ones in series. */
START_TEST(test_clashes) {
    struct tally t =
        check_netlist("clashes\n"
                      "v1 a 0 sin(0 10 50)\nd1 a b di\nv2 b 0 pulse(0 1 0 1u 1u 1m 2m)\n"
                      "i1 0 c exp(0 1 0 1m 5m 1m)\nd2 c 0 di\nd3 c a di\n"
                      "r1 b d 10\nc1 d 0 1u\n"
                      ".model di d\n.tran 1u 1m uic\n.end\n",
                      1e-5);
    ck_assert_int_gt(t.n_clashes, 0);
}

END_TEST

RUN_TESTS("stage factors", test_ladder, test_multiplier, test_coupled_coils,
          test_controlled_sources, test_index_2, test_floating_bridge, test_shared_by_diodes,
          test_shared_unequally, test_general_system, test_forced_to_zero, test_clashes)
