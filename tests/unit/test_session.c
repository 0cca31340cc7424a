/* test_session.c - the public interface: rows, options, reports, what initial conditions hold, the names of
 * a loop, cancelling, two threads. */
#include "run_session.h"

#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

/* The first row of the only plot. */
static const double *first_row(const char *text) {
    struct dalcs_session *session = read_good(text);
    ck_assert_int_eq(run(session, &rows), DALCS_OK);
    dalcs_session_destroy(session);
    return rows.value + 1;
}

/* Who takes several at once gets the same rows in the same order; those beside an edge come alone, and a
 * signal that is there to be measured does not come at all. */
START_TEST(test_rows_together) {
    struct dalcs_session *session = read_good(
        "rectifier\nV1 in 0 PULSE(-1 1 0 0 0 0.37 1)\nR1 in a 1\nD1 a out\nC1 out 0 1\nR2 out 0 3\n"
        ".save v(out) i(d1)\n.meas tran peak MAX v(in,a)\n.tran 0.01 4\n.options fill=none\n");
    ck_assert_int_eq(run_with(session, "auto", &rows), DALCS_OK);
    const size_t n_values = rows.n_values;
    static struct rows one_by_one;
    one_by_one = rows;
    rows.n_values = 0;
    const struct dalcs_run_options options = dalcs_run_options_default();
    const struct dalcs_sink sink = {
        .user = &rows, .begin = take_plot, .row = take_row, .rows = take_rows};
    ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
    ck_assert_uint_gt(n_together, 300);
    ck_assert_uint_lt(n_together, 400);
    ck_assert_uint_eq(rows.n_signals, 2);
    ck_assert_uint_eq(rows.n_values, n_values);
    ck_assert_mem_eq(rows.value, one_by_one.value, n_values * sizeof(double));
    dalcs_session_destroy(session);
}

END_TEST

static const char divider[] = "divider\nV1 in 0 1\nR1 in out 1\nC1 out 0 1\n.tran 0.1 1\n";

START_TEST(test_wrong_options) {
    struct dalcs_run_options usual = dalcs_run_options_default();
    usual.method = "euler";
    struct dalcs_run_options wrong[30];
    size_t n = 0;
    for (size_t k = 0; k < sizeof(wrong) / sizeof(*wrong); k++) {
        wrong[k] = usual;
    }
    static const double descending[] = {0.5, 0.25};
    static const double late[] = {1.0, 1.5};
    wrong[n++].method = "trapezoidal";
    wrong[n++].step = -1.0;
    wrong[n++].step = NAN;
    wrong[n++].step = 2.0;
    wrong[n++].step = 1e-14; /* 1e14 steps: edges could not be put between their times */
    wrong[n].at = descending;
    wrong[n++].n_at = 2;
    wrong[n].at = late;
    wrong[n++].n_at = 2;
    wrong[n++].tolerance = 0.9e-13;
    wrong[n++].tolerance = 0.11;
    wrong[n++].tolerance = -1e-6;
    wrong[n++].tolerance = NAN;
    wrong[n++].stages = 2;
    wrong[n++].stages = 11;
    wrong[n++].stages = -1;
    wrong[n++].compress = -1e-3;
    wrong[n++].compress = 1.0;
    wrong[n++].compress = NAN;
    wrong[n++].fill = -1e-3;
    wrong[n++].fill = 1.0;
    wrong[n++].fill = NAN;
    wrong[n++].curve = "spline";
    wrong[n].fill = 1e-3;
    wrong[n].at = late;
    wrong[n++].n_at = 1;
    wrong[n].compress = 1e-3;
    wrong[n].at = late;
    wrong[n++].n_at = 1;
    wrong[n].method = "auto"; /* whose step is the largest one */
    wrong[n++].step = 1e-14;
    wrong[n++].certificate_tolerance = NAN;
    wrong[n++].certificate_tolerance = INFINITY;
    wrong[n++].proximal_weight = 0.0;
    wrong[n++].proximal_weight = NAN;
    wrong[n++].rcond_min = NAN;
    wrong[n++].max_outer = 0;
    ck_assert_uint_eq(n, sizeof(wrong) / sizeof(*wrong));
    const struct dalcs_sink sink = {0};
    for (size_t k = 0; k < n; k++) {
        struct dalcs_session *session = read_good(divider);
        ck_assert_ptr_null(dalcs_session_report(session));
        ck_assert_int_eq(dalcs_session_run(session, &wrong[k], &sink), DALCS_E_OPTION);
        ck_assert_uint_eq(dalcs_session_n_messages(session), 1);
        ck_assert_ptr_nonnull(dalcs_session_report(session));
        /* The session is as good as new. */
        ck_assert_int_eq(dalcs_session_run(session, &usual, &sink), DALCS_OK);
        ck_assert_int_eq(dalcs_session_report(session)->work.steps, 10);
        dalcs_session_destroy(session);
    }
}

END_TEST

/* What is asked for wins over the netlist, the netlist over the default. */
START_TEST(test_method_and_tolerance) {
    static const struct {
        const char *card, *method;
        double tolerance;
        const char *used;
        double used_tolerance;
        size_t n_messages;
    } given[] = {
        {"", NULL, 0.0, "auto", 1e-6, 0},
        {".options method=radau reltol=1e-3 stages=3\n", NULL, 0.0, "radau", 1e-3, 0},
        {".options method=radau reltol=1e-3\n", "auto", 1e-5, "auto", 1e-5, 0},
        {".options method=magic\n", NULL, 0.0, "auto", 1e-6, 1},
        {".options method=magic\n", "radau", 0.0, "radau", 1e-6, 0},
        {".options reltol=1e-3\n", "euler", 0.0, "euler", 0.0, 1},
        {"", "euler", 1e-3, "euler", 0.0, 1},
        {".options method=euler stages=5\n", NULL, 0.0, "euler", 0.0, 0},
    };

    for (size_t k = 0; k < sizeof(given) / sizeof(*given); k++) {
        char text[200];
        snprintf(text, sizeof(text), "%s%s", divider, given[k].card);
        struct dalcs_session *session = read_good(text);
        struct dalcs_run_options options = dalcs_run_options_default();
        options.method = given[k].method;
        options.tolerance = given[k].tolerance;
        const struct dalcs_sink sink = {0};
        ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
        const struct dalcs_report *report = dalcs_session_report(session);
        ck_assert_str_eq(report->method, given[k].used);
        ck_assert_double_eq(report->tolerance, given[k].used_tolerance);
        ck_assert_uint_eq(report->n_components, 1);
        ck_assert_uint_eq(dalcs_session_n_messages(session), given[k].n_messages);
        dalcs_session_destroy(session);
    }
}

END_TEST

static long steps_of(const char *text) {
    struct dalcs_session *session = read_good(text);
    ck_assert_int_eq(run(session, &rows), DALCS_OK);
    long steps = dalcs_session_report(session)->work.steps;
    dalcs_session_destroy(session);
    return steps;
}

/* Without states only the times that are printed matter, but a step that is asked for is taken, and a
 * switch with hysteresis remembers. */
START_TEST(test_step_without_states) {
    ck_assert_int_eq(steps_of("a\nV1 a 0 SIN(0 1 1)\nR1 a 0 1\n.tran 0.1 1 0 1m\n"), 10);
    ck_assert_int_eq(
        steps_of("a\nV1 a 0 SIN(0 1 1)\nR1 a 0 1\n.options step=1m\n.tran 0.1 1 0 2m\n"), 1000);
    ck_assert_int_eq(steps_of("a\nV1 a 0 SIN(0 1 1)\nR1 a b 1\nS1 b 0 a 0 sw\n"
                              ".model sw SW(Vt=0.5 Vh=0.2)\n.tran 0.1 1 0 1m\n"),
                     1000);
}

END_TEST

/* .ic v(a,b) between two parts of a circuit that share only ground. */
START_TEST(test_initial_across_parts) {
    const double *v = first_row("parts\nR1 a 0 1k\nC1 a 0 1u\nR2 b 0 1k\nC2 b 0 1u\n"
                                ".ic v(a,b)=1\n.save v(a) v(b)\n.tran 10u 100u\n");
    ck_assert_double_eq_tol(v[0], 0.5, 1e-14);
    ck_assert_double_eq_tol(v[1], -0.5, 1e-14);
}

END_TEST

/* .ic names a node that a short makes one with another. */
START_TEST(test_initial_beside_short) {
    const double *v = first_row("short\nR0 a b 0\nC1 b 0 1u\nR2 b 0 1k\n.ic v(a)=5\n"
                                ".save v(a) v(b)\n.tran 10u 100u uic\n");
    ck_assert_double_eq(v[0], 5.0);
    ck_assert_double_eq(v[1], 5.0);
    v = first_row("ground\nR0 g 0 0\nV1 a 0 1\nR1 a b 1k\nC1 b g 1u\n.ic v(g,b)=-5\n"
                  ".save v(b)\n.tran 10u 100u\n");
    ck_assert_double_eq_tol(v[0], 5.0, 1e-12);
}

END_TEST

/* In a part that nothing ties to ground, .ic holds a voltage against the part's reference. */
START_TEST(test_initial_of_floating_part) {
    const double *v = first_row("secondary\nV1 p 0 SIN(0 10 50)\nR0 p q 1\nL1 q 0 1\nL2 s1 s2 1\n"
                                "K1 L1 L2 0.9\nD1 s1 out\nC1 out s2 10u\nR1 out s2 1k\n"
                                ".ic v(s2)=-5\n.save v(out,s2) v(s1,s2)\n.tran 1m 10m uic\n");
    ck_assert_double_eq_tol(v[0], 5.0, 1e-12);
    v = first_row("secondary\nV1 p 0 SIN(0 10 50)\nR0 p q 1\nL1 q 0 1\nL2 s1 s2 1\n"
                  "K1 L1 L2 0.9\nR2 s1 m 1\nC1 m s2 10u\nR1 m s2 1k\n"
                  ".ic v(m)=-5\n.save v(m,s2)\n.tran 1m 10m\n");
    ck_assert_double_eq_tol(v[0], -5.0, 1e-9);
}

END_TEST

/* The row whose residual is worst may be one that only the held operating point has. */
START_TEST(test_certificate_of_held_point) {
    struct dalcs_session *session =
        read_good("held\nR1 a 0 8.3\nR2 b a 1.9\nR3 b c 1\nC1 a 0 1e9\nC2 b 0 1e9\nC3 c 0 1e9\n"
                  ".ic v(a)=4.9 v(a,b)=3.6 v(c,b)=4.8\n.tran 1 1\n");
    ck_assert_int_eq(run(session, &rows), DALCS_OK);
    const char *where = dalcs_session_report(session)->certificate.where;
    ck_assert_msg(strncmp(where, "KCL at ", 7) == 0 || strcmp(where, "branch .ic") == 0, "%s",
                  where);
    dalcs_session_destroy(session);
}

END_TEST

static void check_loop(const char *text, const char *expected) {
    struct dalcs_session *session = read_good(text);
    ck_assert_int_eq(run(session, &rows), DALCS_INFEASIBLE);
    const struct dalcs_report *report = dalcs_session_report(session);
    ck_assert(report->infeasible.present);
    ck_assert_str_eq(report->infeasible.kind, "loop");
    char names[200] = "";
    for (size_t k = 0; k < report->infeasible.n_elements; k++) {
        strcat(strcat(names, " "), report->infeasible.element[k]);
    }
    ck_assert_str_eq(names, expected);
    dalcs_session_destroy(session);
}

/* Shorts have no equation, and close the loop all the same. */
START_TEST(test_shorts_in_a_loop) {
    check_loop("across a source\nV1 a 0 1\nD1 a b\nR1 b 0 0\n.save v(a)\n.op\n", " v1 d1 r1");
    check_loop("two sources\nV1 a 0 1\nV2 b 0 2\nL1 b c 0\nD1 c a\nR1 a 0 1\n.save v(a)\n.op\n",
               " v2 l1 d1 v1");
    /* Those beside the loop, dead ends and a second way round are not named. */
    check_loop("beside\nV1 a 0 1\nR1 a b 0\nR2 b c 0\nR3 b x 0\nR4 x y 0\nD1 c d\nL1 d e 0\n"
               "V2 e g 0\nR5 g 0 0\nR6 y 0 1\nR7 a c 0\n.save v(a)\n.op\n",
               " v1 r1 r2 d1 l1 v2 r5");
    /* A short whose current is asked for is named as the source beside it is. */
    check_loop("asked for\nV1 a 0 1\nD1 a b\nR1 b 0 0\n.save i(r1)\n.op\n", " v1 d1 r1");
}

END_TEST

START_TEST(test_dialect) {
    static const char text[] = "numbers\nV1 a 0 4k7\nR1 a 0 1x\n.op\n.end\n";
    struct dalcs_session *session;
    for (int k = 0; k < 4; k++) {
        const char *name = dalcs_dialect_name((size_t)k);
        ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
        ck_assert_int_eq(dalcs_session_set_dialect(session, "hspice"), DALCS_E_OPTION);
        ck_assert_ptr_nonnull(strstr(dalcs_session_message(session, 0, NULL), "ngspice ltspice"));
        ck_assert_int_eq(dalcs_session_set_dialect(session, name), DALCS_OK);
        const bool is_ltspice = name != NULL && strcmp(name, "ltspice") == 0;
        ck_assert_int_eq(dalcs_session_read_text(session, "t.cir", text, strlen(text)),
                         is_ltspice ? DALCS_OK : DALCS_E_NETLIST);
        ck_assert_int_eq(dalcs_session_set_dialect(session, "xyce"), DALCS_E_OPTION);
        if (is_ltspice) {
            ck_assert_int_eq(run(session, &rows), DALCS_OK);
            ck_assert_double_eq(rows.value[1], 4700);
        }
        dalcs_session_destroy(session);
    }
    ck_assert_ptr_null(dalcs_dialect_name(3));
}

END_TEST

RUN_TESTS("session", test_rows_together, test_wrong_options, test_method_and_tolerance,
          test_step_without_states, test_initial_across_parts, test_initial_beside_short,
          test_initial_of_floating_part, test_certificate_of_held_point, test_shorts_in_a_loop,
          test_dialect)
