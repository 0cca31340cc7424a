/* test_courses.c - stimuli at times close together, formulas of sources among them, against their own values. */
#include "audit_internal.h"

#include "build_network.h"
#include "run_tests.h"

#include <math.h>
#include <stdlib.h>

static const char SOURCES[] =
    "courses\n"
    "Va a 0 SIN(0.1 2 1k 0 0 20)\n"
    "Vp p 0 PULSE(-1 1 0.2m 0.3m 0.3m 0.1m 1m)\n"
    "Vd d 0 0.3\n"
    "B1 b1 0 V=abs(v(a))\n"
    "B2 b2 0 V=max(v(a)-0.5, 0)\n"
    "B3 b3 0 V=min(max(v(a)+2*v(p), -1), 1.5)\n"
    "B4 b4 0 V=u(v(a)-v(p))\n"
    "B5 b5 0 V=abs(3*v(p)-v(d))\n"
    "B6 b6 0 V=max(v(d)-0.5, 0)\n"
    "B7 b7 0 V=abs(abs(v(a))-1)\n"
    "R1 b1 0 1\nR2 b2 0 1\nR3 b3 0 1\nR4 b4 0 1\nR5 b5 0 1\nR6 b6 0 1\nR7 b7 0 1\n"
    ".tran 1u 10m\n";

static struct text_network t;
static struct dalcs_audit audit;

static void start(void) {
    build_good_network(&t, SOURCES);
    audit = (struct dalcs_audit){.circuit = &t.circuit};
    audit.course = calloc((size_t)t.circuit.n_stimuli, sizeof(*audit.course));
    ck_assert_ptr_nonnull(audit.course);
    for (int k = 0; k < t.circuit.n_stimuli; k++) {
        audit.course[k].from = audit.course[k].origin = INFINITY;
    }
}

static void finish(void) {
    free(audit.course);
    text_network_finish(&t);
}

/* Is an edge of the stimulus no farther than a rounding away? */
static bool is_at_edge(const struct dalcs_stimulus *s, double time) {
    return dalcs_stimulus_next_edge(s, time - 1e-12) <= time + 1e-12;
}

/* At n times `step` apart. Returns at how many its course was known already. */
static int compare(int k, int n, double step) {
    const struct dalcs_stimulus *s = &t.circuit.stimulus[k];
    int known = 0;
    for (int i = 1; i <= n; i++) {
        double time = i * step;
        const struct audit_course *c = &audit.course[k];
        known += c->from <= time && time <= c->to ? 1 : 0;
        if (is_at_edge(s, time)) {
            continue;
        }
        double is = audit_stimulus_at(&audit, k, time);
        double wanted = dalcs_stimulus_value(s, time, DALCS_RIGHT);
        ck_assert_msg(fabs(is - wanted) <= 1e-13, "stimulus %d at %.17g s: %.17g, not %.17g", k,
                      time, is, wanted);
    }
    return known;
}

START_TEST(test_they_have_their_values) {
    start();
    for (int k = 0; k < t.circuit.n_stimuli; k++) {
        for (double step = 0.7e-7; step < 1e-3; step *= 3.1) {
            (void)compare(k, of_cases(4000, 200), step);
        }
    }
    finish();
}

END_TEST

/* Of times so close the most are in a course that is known; of times apart no more than of lines. */
START_TEST(test_formulas_have_courses) {
    const int n_times = of_cases(40000, 4000);
    int n_formulas = 0;
    start();
    for (int k = 0; k < t.circuit.n_stimuli; k++) {
        if (t.circuit.stimulus[k].kind == DALCS_STIMULUS_FORMULA) {
            int known = compare(k, n_times, 1.1e-7);
            ck_assert_msg(known > n_times / 20 * 19, "stimulus %d: at %d times of %d", k, known,
                          n_times);
            n_formulas++;
        }
    }
    ck_assert_int_ge(n_formulas, 7);
    finish();
}

END_TEST

RUN_TESTS("courses", test_they_have_their_values, test_formulas_have_courses)
