/* test_rows.c - outputs at many times have the bits that they have at one, which are but for rounding those
 * of the solution that dalcs_radau_evaluate gives. */
#include "rows.h"

#include "build_network.h"
#include "recorder.h"

#include <limits.h>
#include <math.h>

static struct text_network t;
static struct dalcs_euler e;
static struct dalcs_radau r;
static struct dalcs_rows rows;

/* A rectifier; a gate driver, of which no state knows anything, with its switch; a voltage between two
 * parts, one of them constant. */
static const char STEPPED[] =
    "three parts\n"
    "V1 a 0 SIN(0 10 50)\n"
    "D1 a b\n"
    "R1 b 0 10\n"
    "C1 b c 100u\n"
    "R2 c 0 2\n"
    "V2 g 0 SIN(0 1 170)\n"
    "R3 g h 1\n"
    "R4 h 0 3\n"
    "V3 p 0 5\n"
    "S1 p q g 0 sw\n"
    "L1 q 0 10m\n"
    "R5 q 0 7\n"
    "I5 0 q SIN(0 0.1 30)\n"
    "V4 z 0 2\n"
    "R6 z 0 1\n"
    ".model sw sw(vt=0.3)\n"
    ".tran 1m 40m\n"
    ".save v(a) v(b) v(b,c) v(q) v(h) v(b,z) v(z) v(a,q) i(d1) i(v1) i(v2) "
    "i(s1) i(l1) i(c1) i(i5)\n";

/* Beside it a part that is solved for each row. */
static const char SOLVED[] = "two parts\n"
                             "V1 a 0 SIN(0 10 50)\n"
                             "R1 a b 10\n"
                             "C1 b 0 100u\n"
                             "I2 0 y SIN(0 1 80)\n"
                             "R2 y 0 4\n"
                             ".tran 1m 40m\n"
                             ".save v(b) v(y) v(b,y)\n";

static void start(const char *text, int stages, const int *output, int n_outputs) {
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    const struct dalcs_radau_options o = {.tolerance = 1e-6, .stages = stages, .stop = 40e-3};
    build_good_network(&t, text);
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, o.stop, o.stop),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_euler_operating_point(&e, true), DALCS_OK);
    ck_assert_int_eq(dalcs_radau_setup(&r, &e, &o, &options), DALCS_OK);
    dalcs_radau_start(&r, NULL);
    ck_assert_int_eq(dalcs_radau_begin(&r), DALCS_OK);
    ck_assert_int_eq(dalcs_rows_setup(&rows, &r, output, n_outputs), DALCS_OK);
}

static void finish(void) {
    dalcs_rows_finish(&rows);
    dalcs_radau_finish(&r);
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

/* value[n_outputs] against the whole solution. */
static void check_outputs(const int *output, double time, enum dalcs_side side, int place) {
    ck_assert_int_eq(dalcs_radau_evaluate(&r, time, side), DALCS_OK);
    for (int i = 0; i < rows.n_outputs; i++) {
        int which = output != NULL ? output[i] : i;
        double expected = dalcs_recorder_signal(&t.network, &e, which);
        /* ten nodes, no weight larger than a few, no signal above 20 V or A */
        ck_assert_msg(fabs(rows.value[i].at[place] - expected) <= 1e-13,
                      "%s at %.17g is %.17g instead of %.17g", t.network.output[which].name, time,
                      rows.value[i].at[place], expected);
    }
}

/* All that lies between two stops, with these themselves. */
static void check_between(const int *output, double from, double to, int n) {
    double time[DALCS_MOST_ROWS];
    double together[DALCS_MOST_ROWS][15];
    for (int i = 0; i < n; i++) {
        time[i] = i + 1 < n ? from + (to - from) * i / (n - 1) : to;
    }
    int n_done;
    for (int first = 0; first < n; first += n_done) {
        ck_assert_int_eq(dalcs_rows_fill(&rows, time + first, n - first, DALCS_LEFT, &n_done),
                         DALCS_OK);
        ck_assert_int_eq(n_done, rows.one_by_one ? 1 : n);
        for (int i = 0; i < n_done; i++) {
            check_outputs(output, time[first + i], DALCS_LEFT, i);
            for (int k = 0; k < rows.n_outputs; k++) {
                together[first + i][k] = rows.value[k].at[i];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        ck_assert_int_eq(dalcs_rows_fill(&rows, &time[i], 1, DALCS_LEFT, &n_done), DALCS_OK);
        for (int k = 0; k < rows.n_outputs; k++) {
            ck_assert_mem_eq(&rows.value[k].at[0], &together[i][k], sizeof(double));
        }
    }
}

static int walk(const int *output) {
    const int most_stops = of_cases(INT_MAX, 12);
    int n_stops = 0;
    bool happens;
    double from = 0.0;
    for (double to; n_stops < most_stops && (to = dalcs_radau_next_stop(&r, &happens)) < 40e-3;
         from = to) {
        check_between(output, from, to, n_stops % 3 == 0 ? DALCS_MOST_ROWS : 2 + n_stops % 7);
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
        n_stops++;
    }
    return n_stops;
}

static int count_sources(bool bystanders) {
    int n = 0;
    for (int k = 0; k < r.n_parts; k++) {
        for (int i = 0; i < rows.part[k].n_sources; i++) {
            n += rows.part[k].source[i].is_bystander == bystanders ? 1 : 0;
        }
    }
    return n;
}

START_TEST(test_all_outputs) {
    static const int STAGES[] = {3, 5, 7, 9};
    for (int k = 0; k < 4; k++) {
        start(STEPPED, STAGES[k], NULL, 15);
        ck_assert(!rows.one_by_one);
        ck_assert_int_gt(count_sources(true), 0);
        ck_assert_int_gt(count_sources(false), 0);
        ck_assert_int_gt(walk(NULL), 10);
        finish();
    }
}

END_TEST

START_TEST(test_some_outputs) {
    static const int OUTPUT[] = {5, 1, 4};
    start(STEPPED, 7, OUTPUT, 3);
    ck_assert_int_gt(walk(OUTPUT), 10);
    finish();
}

END_TEST

/* Rows of all outputs solve such a part, rows of the other outputs do not. */
START_TEST(test_solved_part) {
    static const int OUTPUT[] = {0};
    start(SOLVED, 7, NULL, 3);
    ck_assert(rows.one_by_one);
    ck_assert_int_gt(walk(NULL), 3);
    finish();
    start(SOLVED, 7, OUTPUT, 1);
    ck_assert(!rows.one_by_one);
    ck_assert_int_gt(walk(OUTPUT), 3);
    finish();
}

END_TEST

RUN_TESTS("rows", test_all_outputs, test_some_outputs, test_solved_part)
