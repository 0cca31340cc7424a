/* test_bindings.c - what other languages use: values and options by name, rows in memory, JSON, a run that
 * another thread ends. */
#include "dalcs.h"

#include "run_tests.h"

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <string.h>

static const char DIVIDER[] =
    "Divider\n.param upper=1\n.param lower = 3 gain={2*lower}\nV1 in 0 8\n"
    "R1 in out {upper}\nR2 out 0 {lower}\nX1 out part\n.op\n"
    ".subckt part a\n.param inner=1\nR1 a 0 1meg\nD1 0 a steep\n.ends\n"
    ".model steep D(vfwd=0)\n";

static struct dalcs_session *read_kept(const char *text) {
    struct dalcs_session *session;
    ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_keep_netlist(session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_read_text(session, "test.cir", text, strlen(text)), DALCS_OK);
    return session;
}

static struct dalcs_tables *run_tables(struct dalcs_session *session) {
    const struct dalcs_run_options options = dalcs_run_options_default();
    struct dalcs_tables *tables;
    ck_assert_int_eq(dalcs_session_run_tables(session, &options, NULL, NULL, &tables), DALCS_OK);
    return tables;
}

/* v(out) of the first plot's first row. */
static double output_of(struct dalcs_session *session) {
    struct dalcs_tables *tables = run_tables(session);
    const struct dalcs_row_table *t = dalcs_tables_get(tables, 0);
    double value = NAN;
    for (size_t k = 0; k < t->plot.n_signals; k++) {
        value = strcmp(t->plot.name[k], "v(out)") == 0 ? t->value[k] : value;
    }
    dalcs_tables_destroy(tables);
    return value;
}

/* ---- Values ---------------------------------------------------------------------------------- */

START_TEST(test_values) {
    struct dalcs_session *s = read_kept(DIVIDER);
    ck_assert_double_eq_tol(output_of(s), 6.0, 1e-4);
    ck_assert_int_eq(dalcs_session_set_value(s, "Upper", 3.0), DALCS_OK);
    ck_assert_double_eq_tol(output_of(s), 4.0, 1e-4);
    ck_assert_int_eq(dalcs_session_set_value(s, "R2", 1.0), DALCS_OK);
    ck_assert_double_eq_tol(output_of(s), 2.0, 1e-4);
    ck_assert_int_eq(dalcs_session_set_value(s, "V1", -8.0), DALCS_OK);
    ck_assert_int_eq(dalcs_session_set_value(s, "steep(VFWD)", 0.5), DALCS_OK);
    ck_assert_double_eq_tol(output_of(s), -0.5, 1e-9);
    dalcs_session_destroy(s);
}

END_TEST

/* After each a run gives what it gave before. */
START_TEST(test_wrong_values) {
    static const struct {
        const char *name;
        double value;
        const char *says;
    } wrong[] = {{"uper", 1.0, "did you mean 'upper'?"},
                 {"r9", 1.0, "no parameter or element 'r9'"},
                 {"inner", 1.0, "element 'inner'"},
                 {"steep(", 1.0, "no parameter or element"},
                 {"flat(vfwd)", 1.0, "no parameter"},
                 {"upper", NAN, "'upper' cannot be nan"},
                 {"upper", -INFINITY, "cannot be -inf"},
                 {"", 1.0, "no parameter or element ''"},
                 {"x1", 1.0, "element 'x1'"},
                 {".op", 1.0, "element '.op'"},
                 {"d1", 1.0, "element 'd1'"}};

    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        struct dalcs_session *s = read_kept(DIVIDER);
        const enum dalcs_status status = dalcs_session_set_value(s, wrong[k].name, wrong[k].value);
        const size_t n = dalcs_session_n_messages(s);
        ck_assert_int_eq(status, DALCS_E_OPTION);
        ck_assert_uint_gt(n, 0);
        ck_assert_ptr_nonnull(strstr(dalcs_session_message(s, n - 1, NULL), wrong[k].says));
        ck_assert_double_eq_tol(output_of(s), 6.0, 1e-4);
        dalcs_session_destroy(s);
    }
    struct dalcs_session *s;
    ck_assert_int_eq(dalcs_session_create(&s), DALCS_OK);
    ck_assert_int_eq(dalcs_session_set_value(s, "r1", 1.0), DALCS_E_OPTION);
    ck_assert_int_eq(dalcs_session_read_text(s, "a", DIVIDER, strlen(DIVIDER)), DALCS_OK);
    ck_assert_int_eq(dalcs_session_set_value(s, "r1", 1.0), DALCS_E_OPTION);
    ck_assert_int_eq(dalcs_session_keep_netlist(s), DALCS_E_OPTION);
    dalcs_session_destroy(s);
}

END_TEST

/* A value that makes no circuit fails its run alone. */
START_TEST(test_a_bad_value_between_good_ones) {
    const struct dalcs_run_options options = dalcs_run_options_default();
    const struct dalcs_sink sink = {0};
    struct dalcs_session *s = read_kept("C\n.param c=1u\nV1 a 0 1\nR1 a b 1\nC1 b 0 {c}\n.op\n");
    ck_assert_int_eq(dalcs_session_set_value(s, "c", -1e-6), DALCS_OK);
    ck_assert_int_eq(dalcs_session_run(s, &options, &sink), DALCS_E_NETLIST);
    ck_assert_ptr_null(dalcs_session_report(s));
    ck_assert_int_eq(dalcs_session_set_value(s, "c", 2e-6), DALCS_OK);
    ck_assert_int_eq(dalcs_session_run(s, &options, &sink), DALCS_OK);
    dalcs_session_destroy(s);
}

END_TEST

START_TEST(test_names) {
    static const char *const parameter[] = {"upper", "lower", "gain"};
    static const char *const element[] = {"v1", "r1", "r2", "x1.r1", "x1.d1"};
    struct dalcs_session *s = read_kept(DIVIDER);
    for (size_t k = 0; k < 3; k++) {
        ck_assert_str_eq(dalcs_session_parameter_name(s, k), parameter[k]);
    }
    ck_assert_ptr_null(dalcs_session_parameter_name(s, 3));
    for (size_t k = 0; k < 5; k++) {
        ck_assert_str_eq(dalcs_session_element_name(s, k), element[k]);
    }
    ck_assert_ptr_null(dalcs_session_element_name(s, 5));
    double value = 0.0;
    ck_assert_int_eq(dalcs_session_parameter(s, "gain", &value), DALCS_OK);
    ck_assert_double_eq(value, 6.0);
    dalcs_session_destroy(s);
}

END_TEST

/* ---- Options --------------------------------------------------------------------------------- */

START_TEST(test_options) {
    struct dalcs_run_options *o;
    ck_assert_int_eq(dalcs_run_options_create(&o), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "method", "radau"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "tol", "1e-9"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "stages", "5"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "step", "2u"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "fill", "inf"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "curve", "lines"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "audit", "off"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "record", "yes"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "bode", "yes"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "bode_loop", "vx"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "bode_injection", "both"), DALCS_OK);
    ck_assert_int_eq(dalcs_run_options_set(o, "bode_sideband", "-2"), DALCS_OK);
    static const double at[] = {1.0, 2.0};
    dalcs_run_options_set_frequencies(o, at, 2);
    static const char *const wrong[][2] = {{"tolerance", "1"},
                                           {"method", "gear"},
                                           {"stages", "2.5"},
                                           {"stages", "inf"},
                                           {"tol", "x"},
                                           {"curve", "splines"},
                                           {"audit", "maybe"},
                                           {"record", "1"},
                                           {"bode_injection", "current"},
                                           {"", ""}};

    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        ck_assert_int_eq(dalcs_run_options_set(o, wrong[k][0], wrong[k][1]), DALCS_E_OPTION);
    }
    ck_assert_str_eq(o->method, "radau");
    ck_assert_double_eq(o->tolerance, 1e-9);
    ck_assert_int_eq(o->stages, 5);
    ck_assert_double_eq(o->step, 2e-6);
    ck_assert(isinf(o->fill));
    ck_assert_str_eq(o->curve, "lines");
    ck_assert_int_eq(o->audit, DALCS_AUDIT_OFF);
    ck_assert(o->record && !o->energy);
    ck_assert(o->bode && o->loop_is_loaded && o->sideband == -2);
    ck_assert_str_eq(o->loop, "vx");
    ck_assert(o->bode_at == at && o->n_bode_at == 2);
    for (size_t k = 0; dalcs_run_option_name(k) != NULL; k++) {
        const char *name = dalcs_run_option_name(k);
        const bool is_name = strcmp(name, "bode_loop") == 0; /* of which the run judges */
        ck_assert_int_eq(dalcs_run_options_set(o, name, "no such value"),
                         is_name ? DALCS_OK : DALCS_E_OPTION);
    }
    dalcs_run_options_destroy(o);
}

END_TEST

/* ---- Rows ------------------------------------------------------------------------------------ */

static const char LOW_PASS[] = "Low pass\nV1 in 0 DC 1 AC 1\nR1 in out {r}\nC1 out 0 1u ic=0\n"
                               ".param r=1k\n.step param r list 1k 2k\n.ac dec 1 1 100\n"
                               ".tran 1u 1m uic\n";

START_TEST(test_tables) {
    struct dalcs_session *s = read_kept(LOW_PASS);
    struct dalcs_tables *tables = run_tables(s);
    dalcs_session_destroy(s); /* they outlive it */
    ck_assert_uint_eq(dalcs_tables_count(tables), 4);
    ck_assert_ptr_null(dalcs_tables_get(tables, 4));
    for (size_t k = 0; k < 4; k++) {
        const struct dalcs_row_table *t = dalcs_tables_get(tables, k);
        const double r = k % 2 == 0 ? 1e3 : 2e3;
        ck_assert_str_eq(t->plot.title, "Low pass");
        ck_assert_str_eq(t->plot.parameter[0], "r");
        ck_assert_double_eq(t->plot.parameter_value[0], r);
        ck_assert_str_eq(t->plot.name[1], "v(out)");
        ck_assert_int_eq(t->plot.is_complex, k < 2);
        const size_t width = t->plot.n_signals * (k < 2 ? 2 : 1);
        for (size_t row = 0; row < t->n_rows; row++) {
            const double x = t->scale[row], *value = t->value + row * width;
            const double w = 2.0 * acos(-1.0) * x * r * 1e-6;
            if (k < 2) {
                ck_assert_double_eq_tol(value[2], 1.0 / (1.0 + w * w), 1e-12);
                ck_assert_double_eq_tol(value[3], -w / (1.0 + w * w), 1e-12);
            } else {
                ck_assert_double_eq_tol(value[1], -expm1(-x / (r * 1e-6)), 1e-8);
            }
        }
        ck_assert_uint_ge(t->n_rows, k < 2 ? 3 : 1001);
    }
    dalcs_tables_destroy(tables);
    dalcs_tables_destroy(NULL);
}

END_TEST

/* No rows of .tran, and the measurements all the same. */
START_TEST(test_no_times) {
    struct dalcs_session *s = read_kept("RC\nV1 in 0 1\nR1 in out 1k\nC1 out 0 1u ic=0\n"
                                        ".tran 1u 1m uic\n.meas tran last find v(out) at=1m\n");
    struct dalcs_run_options options = dalcs_run_options_default();
    struct dalcs_tables *tables;
    dalcs_run_options_set_times(&options, NULL, 0);
    ck_assert_int_eq(dalcs_session_run_tables(s, &options, NULL, NULL, &tables), DALCS_OK);
    ck_assert_uint_eq(dalcs_tables_get(tables, 0)->n_rows, 0);
    ck_assert_double_eq_tol(dalcs_session_measurement(s, 0)->value, -expm1(-1.0), 1e-9);
    ck_assert_ptr_null(dalcs_session_measurement(s, 1));
    dalcs_tables_destroy(tables);
    dalcs_session_destroy(s);
}

END_TEST

/* ---- JSON ------------------------------------------------------------------------------------ */

START_TEST(test_json) {
    const char *json;
    struct dalcs_session *s = read_kept(DIVIDER);
    ck_assert_int_eq(dalcs_session_report_json(s, &json), DALCS_E_OPTION);
    ck_assert_ptr_null(json);
    dalcs_tables_destroy(run_tables(s));
    ck_assert_int_eq(dalcs_session_report_json(s, &json), DALCS_OK);
    ck_assert_ptr_nonnull(strstr(json, "\"status\": \"ok\""));
    ck_assert_int_eq(dalcs_session_check_json(s, 0.0, &json), DALCS_OK);
    ck_assert_ptr_nonnull(strstr(json, "\"verdicts\""));
    ck_assert_int_eq(dalcs_session_equations_json(s, DALCS_FORM_LCS, 0.0, &json), DALCS_OK);
    ck_assert_ptr_nonnull(strstr(json, "\"dalcs-system\": 2"));
    ck_assert_int_eq(dalcs_session_equations_json(s, DALCS_FORM_ONE_STEP, 0.0, &json),
                     DALCS_E_OPTION);
    ck_assert_ptr_null(json);
    dalcs_session_destroy(s);
}

END_TEST

/* ---- Cancelling ------------------------------------------------------------------------------ */

struct endless {
    struct dalcs_session *session;
    struct dalcs_tables *tables;
    enum dalcs_status status;
    atomic_bool runs;
};

static enum dalcs_status tell(void *user, double time, double stop) {
    struct endless *e = user;
    ck_assert(time < stop);
    atomic_store(&e->runs, true);
    return DALCS_OK;
}

static void *run_endlessly(void *user) {
    struct endless *e = user;
    const struct dalcs_run_options options = dalcs_run_options_default();
    e->status = dalcs_session_run_tables(e->session, &options, tell, e, &e->tables);
    return NULL;
}

START_TEST(test_cancel) {
    struct endless e = {.session =
                            read_kept("R\nV1 a 0 SIN(0 1 50k)\nD1 a b\nC1 b 0 1u\nR1 b 0 {r}\n"
                                      ".param r=1k\n.tran 1u 1e6\n")};
    const char *json;
    pthread_t thread;
    ck_assert_int_eq(pthread_create(&thread, NULL, run_endlessly, &e), 0);
    while (!atomic_load(&e.runs)) {
        sched_yield();
    }
    dalcs_session_cancel(e.session);
    ck_assert_int_eq(pthread_join(thread, NULL), 0);
    ck_assert_int_eq(e.status, DALCS_E_CANCELLED);
    ck_assert_uint_gt(dalcs_tables_get(e.tables, 0)->n_rows, 100);
    ck_assert_int_eq(dalcs_session_report_json(e.session, &json), DALCS_OK);
    ck_assert_ptr_nonnull(strstr(json, "\"status\": \"cancelled\""));
    dalcs_tables_destroy(e.tables);
    /* before a run it ends that run as it begins, and no other */
    atomic_store(&e.runs, false);
    dalcs_session_cancel(e.session);
    run_endlessly(&e);
    ck_assert_int_eq(e.status, DALCS_E_CANCELLED);
    ck_assert(!atomic_load(&e.runs));
    dalcs_tables_destroy(e.tables);
    dalcs_session_destroy(e.session);
    struct dalcs_session *s = read_kept(DIVIDER);
    dalcs_session_cancel(s);
    const struct dalcs_run_options options = dalcs_run_options_default();
    const struct dalcs_sink sink = {0};
    ck_assert_int_eq(dalcs_session_run(s, &options, &sink), DALCS_E_CANCELLED);
    ck_assert_int_eq(dalcs_session_run(s, &options, &sink), DALCS_OK);
    dalcs_session_destroy(s);
}

END_TEST

RUN_TESTS("bindings", test_values, test_wrong_values, test_a_bad_value_between_good_ones,
          test_names, test_options, test_tables, test_no_times, test_json, test_cancel)
