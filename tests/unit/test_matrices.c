/* test_matrices.c - a session from a program's own matrices, and its equations as text. */
#include "dalcs.h"

#include "run_tests.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double MINUS_ONE[] = {-1.0};
static const double ONE[] = {1.0};
static const double HALF[] = {0.5};
static const double START[] = {1.5};

/* x' = -x + 0.5 + lambda, lambda in -Sgn(x): slides from t = ln 4. */
static struct dalcs_matrices relay(void) {
    return (struct dalcs_matrices){.title = "relay",
                                   .cards = ".tran 10m 3",
                                   .n_x = 1,
                                   .n_lambda = 1,
                                   .x0 = START,
                                   .low = MINUS_ONE,
                                   .high = ONE,
                                   .A_I = MINUS_ONE,
                                   .Bbar_I = ONE,
                                   .constant_I = HALF,
                                   .C_I = ONE};
}

struct last {
    const struct dalcs_plot *plot;
    double at_one, value[12];
};

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct last *last = user;
    last->plot = plot;
    return DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct last *last = user;
    ck_assert_uint_le(last->plot->n_signals, 12);
    memcpy(last->value, value, last->plot->n_signals * sizeof(*value));
    last->at_one = fabs(time - 1.0) < 1e-9 ? value[0] : last->at_one;
    return DALCS_OK;
}

START_TEST(test_relay) {
    const struct dalcs_matrices m = relay();
    struct dalcs_session *session;
    struct last last = {0};
    const struct dalcs_sink sink = {.user = &last, .begin = begin, .row = row};
    const struct dalcs_run_options options = dalcs_run_options_default();
    ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_read_matrices(session, "relay", &m), DALCS_OK);
    ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
    ck_assert_uint_eq(last.plot->n_signals, 3);
    ck_assert_str_eq(last.plot->name[1], "lambda(lambda1)");
    ck_assert_double_eq_tol(last.at_one, 2.0 * exp(-1.0) - 0.5, 1e-6);
    ck_assert_double_eq_tol(last.value[0], 0.0, 1e-9);
    ck_assert_double_eq_tol(last.value[1], -0.5, 1e-9);
    dalcs_session_destroy(session);
}

END_TEST

START_TEST(test_wrong_matrices) {
    struct dalcs_matrices m = relay();
    struct dalcs_session *session;
    m.high = MINUS_ONE; /* an empty box */
    ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_read_matrices(session, "relay", &m), DALCS_E_NETLIST);
    ck_assert_ptr_nonnull(strstr(dalcs_session_message(session, 0, NULL), "upper bound"));
    dalcs_session_destroy(session);
}

END_TEST

/* A ball of 2 kg falls from 1 m and stays on the floor; a block of 1 kg with 3 N of friction slides 2 m/s. */
START_TEST(test_mechanics) {
    static const double mass[] = {2.0, 0.0, 0.0, 1.0};
    static const double weight[] = {-19.62, 0.0};
    static const double G[] = {1.0, 0.0, 0.0, 1.0};
    static const double limit[] = {3.0};
    static const double q0[] = {1.0, 0.0};
    static const double v0[] = {0.0, 2.0};
    static const char *const names[] = {"ball", "block"};
    const struct dalcs_mechanics m = {.cards = ".tran 10m 1",
                                      .n_q = 2,
                                      .n_contacts = 1,
                                      .n_frictions = 1,
                                      .q_name = names,
                                      .q0 = q0,
                                      .v0 = v0,
                                      .mass = mass,
                                      .constant_force = weight,
                                      .G = G,
                                      .friction_limit = limit};
    struct dalcs_session *session;
    struct last last = {0};
    const struct dalcs_sink sink = {.user = &last, .begin = begin, .row = row};
    const struct dalcs_run_options options = dalcs_run_options_default();
    ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_read_mechanics(session, "ball", &m), DALCS_OK);
    ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
    ck_assert_str_eq(last.plot->name[0], "ball");
    ck_assert_str_eq(last.plot->name[1], "block");
    ck_assert_str_eq(last.plot->name[2], "d(ball)");
    ck_assert_double_eq_tol(last.value[0], 0.0, 1e-9);
    ck_assert_double_eq_tol(last.value[1], 2.0 / 3.0, 1e-5); /* v^2 / (2 a) */
    ck_assert_double_eq_tol(last.value[3], 0.0, 1e-9);
    dalcs_session_destroy(session);
}

END_TEST

static enum dalcs_status keep(void *user, const char *suffix, const char *text, size_t length) {
    char **kept = user;
    ck_assert_str_eq(suffix, "");
    *kept = malloc(length + 1);
    ck_assert_ptr_nonnull(*kept);
    memcpy(*kept, text, length);
    (*kept)[length] = '\0';
    return DALCS_OK;
}

START_TEST(test_equations) {
    const struct dalcs_matrices m = relay();
    struct dalcs_session *session;
    char *text = NULL;
    const struct dalcs_equations_options options = {.user = (void *)&text, .file = keep};
    ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_read_matrices(session, "relay", &m), DALCS_OK);
    ck_assert_int_eq(dalcs_session_equations(session, &options), DALCS_OK);
    ck_assert_ptr_nonnull(strstr(text, "dx1/dt = -x1 + lambda1 + 0.5"));
    free(text);
    dalcs_session_destroy(session);
}

END_TEST

RUN_TESTS("matrices", test_relay, test_wrong_matrices, test_mechanics, test_equations)
