/* test_stage_join.c - behind a small resistor flows what flows before it, on factors, too. */
#include "run_radau.h"

#include <math.h>

/* What the diode and the coil behind the resistor differ by at the end of a segment, over the current. */
static double largest_difference(const char *text, int coil, double stop) {
    const double tolerance = 1e-6;
    double worst = 0.0;
    double largest = 0.0;
    start_in(text, stop, tolerance, 0, 5); /* more cost digits of their own */
    const struct dalcs_stage_layout *l = &r.part->stages.layout;
    const int diode = dalcs_system_n_equations(r.part->component->system);
    bool happens;
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < stop;) {
        const double *last = r.part->segment.out + (l->n_nodes - 1) * l->stride;
        if (dalcs_osnsp_is_on(&r.part->component->osnsp, 0) && r.part->segment.end == 1.0) {
            worst = fmax(worst, fabs(last[coil] - last[diode]));
            largest = fmax(largest, fabs(last[coil]));
        }
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
    }
    ck_assert_double_gt(largest, 0.1);
    finish();
    return worst / largest;
}

/* 400 V round to 4e-8 A in a microohm. */
START_TEST(test_in_series) {
    ck_assert_double_lt(
        largest_difference(
            "mains\nV1 in 0 SIN(0 400 50)\nR0 in a 1\nD1 a x\nR1 x n 1u\nL1 n out 10m\n"
            "C1 out 0 100u\nR2 out 0 1k\n.tran 1m 40m uic\n",
            1, 40e-3),
        1e-14);
}

END_TEST

/* Two such nodes behind the same one, and a source that feeds one of them. */
START_TEST(test_star) {
    ck_assert_double_lt(
        largest_difference("star\nV1 in 0 SIN(0 400 50)\nR0 in a 1\nD1 a x\nR1 x n 1u\nR3 x m 2u\n"
                           "L1 n out 10m\nI1 0 m 0\nC1 out 0 100u\nR2 out 0 1k\n.tran 1m 40m uic\n",
                           1, 40e-3),
        1e-14);
}

END_TEST

RUN_TESTS("stage_join", test_in_series, test_star)
