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
    /* closed: a step and one that projects; open: two lengths */
    ck_assert_int_eq(r.part->stages.factorizations, 4);
    finish();
}

END_TEST

RUN_TESTS("segment", test_known_mode)
