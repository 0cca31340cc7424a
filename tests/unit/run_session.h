/* run_session.h - a session that reads a text and runs it. */
#ifndef RUN_SESSION_H
#define RUN_SESSION_H

#include "dalcs.h"
#include "run_tests.h"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <string.h>

enum { MAX_VALUES = 1 << 16 };

/* What a run handed out. */
struct rows {
    size_t n_signals, n_values, n_progress;
    double value[MAX_VALUES]; /* time, then the signals, row by row */
};

static inline enum dalcs_status take_plot(void *user, const struct dalcs_plot *plot) {
    struct rows *rows = user;
    rows->n_signals = plot->n_signals;
    return DALCS_OK;
}

static inline enum dalcs_status take_row(void *user, double time, const double *value) {
    struct rows *rows = user;
    ck_assert_uint_le(rows->n_values + rows->n_signals + 1, MAX_VALUES);
    rows->value[rows->n_values++] = time;
    memcpy(rows->value + rows->n_values, value, rows->n_signals * sizeof(*value));
    rows->n_values += rows->n_signals;
    return DALCS_OK;
}

static inline struct dalcs_session *read_good(const char *text) {
    struct dalcs_session *session;
    ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
    ck_assert_int_eq(dalcs_session_read_text(session, "test.cir", text, strlen(text)), DALCS_OK);
    return session;
}

static inline enum dalcs_status run_with(struct dalcs_session *session, const char *method,
                                         struct rows *rows) {
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = method;
    const struct dalcs_sink sink = {.user = rows, .begin = take_plot, .row = take_row};
    rows->n_values = 0;
    return dalcs_session_run(session, &options, &sink);
}

static inline enum dalcs_status run(struct dalcs_session *session, struct rows *rows) {
    return run_with(session, "euler", rows);
}

static struct rows rows;

static size_t n_together; /* rows that came with others */

static inline enum dalcs_status take_rows(void *user, size_t n, const double *time,
                                          const double *value) {
    const size_t n_signals = ((const struct rows *)user)->n_signals;
    n_together += n > 1 ? n : 0;
    for (size_t k = 0; k < n; k++) {
        ck_assert_int_eq(take_row(user, time[k], value + k * n_signals), DALCS_OK);
    }
    return DALCS_OK;
}

static inline enum dalcs_status cancel(void *user, double time, double stop) {
    long *n_calls = user;
    ck_assert_double_lt(time, stop);
    return ++*n_calls == 3 ? DALCS_E_CANCELLED : DALCS_OK;
}

/* What a thread and the one that stops it share. */
struct endless {
    atomic_bool stop;
    atomic_size_t n_asked, n_events; /* so far */
    struct dalcs_session *session;
    enum dalcs_status status;
};

static inline enum dalcs_status ask(void *user, double time, double stop) {
    struct endless *e = user;
    ck_assert(time > 0.0 && time < stop);
    atomic_store(&e->n_events, dalcs_session_n_events(e->session));
    atomic_fetch_add(&e->n_asked, 1);
    return atomic_load(&e->stop) ? DALCS_E_CANCELLED : DALCS_OK;
}

#endif
