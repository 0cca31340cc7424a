/* test_session_runs.c - runs that are ended, memory that they give back, and threads. */
#include "run_session.h"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>

/* A large circuit calls progress more often, for its steps take longer. */
START_TEST(test_cancel) {
    char text[1 << 17];
    int length = sprintf(text, "ladder\nV1 n0 0 SIN(0 1 50)\n");
    for (int k = 0; k < 1000; k++) {
        length += sprintf(text + length, "R%d n%d n%d 1\nC%d n%d 0 1u\n", k, k, k + 1, k, k + 1);
    }
    sprintf(text + length, ".save v(n1)\n.tran 1u 1\n");
    struct dalcs_session *session = read_good(text);
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = "euler";
    long n_calls = 0;
    const struct dalcs_sink sink = {.user = &n_calls, .progress = cancel};
    ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_E_CANCELLED);
    ck_assert_int_eq(n_calls, 3);
    ck_assert_int_lt(dalcs_session_report(session)->work.steps, 3 * 1000);
    dalcs_session_destroy(session);
}

END_TEST

static size_t bytes_in_use(void) {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

/* Factors of hundreds of modes, several for each, go with the session. */
START_TEST(test_memory_given_back) {
    char text[1 << 13];
    int length = sprintf(text, "multiplier\nV1 a0 0 SIN(0 100 50k)\nV2 b0 0 0\n");
    for (int k = 0; k < 40; k++) {
        length +=
            sprintf(text + length, "CA%d a%d a%d 1u\nDA%d b%d a%d\nCB%d b%d b%d 1u\nDB%d a%d b%d\n",
                    k, k, k + 1, k, k, k + 1, k, k, k + 1, k, k + 1, k + 1);
    }
    sprintf(text + length, "RL b40 0 10meg\n.save v(b1)\n.tran 1u 60u uic\n");
    const struct dalcs_run_options options = dalcs_run_options_default();
    const struct dalcs_sink sink = {0};
    size_t before = 0;
    for (int run = 0; run < 2; run++) { /* the first one may leave what C libraries keep */
        before = bytes_in_use();
        struct dalcs_session *session = read_good(text);
        ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
        ck_assert_int_gt(dalcs_session_report(session)->work.factorizations, 20);
        dalcs_session_destroy(session);
    }
    ck_assert_uint_lt(bytes_in_use(), before + (1 << 16)); /* malloc counts what it has at hand */
}

END_TEST

/* A jump is kept with the states that jump, however many there are. */
START_TEST(test_memory_of_jumps) {
    static char text[1 << 17];
    int length = sprintf(text, "one of many\nV1 a 0 PULSE(0 1 1u 0 0 1u 2u)\nD1 a b\nC0 b 0 1u\n"
                               "R0 b 0 0.1\n");
    for (int k = 1; k < of_cases(2000, 200); k++) {
        length += sprintf(text + length, "C%d n%d 0 1u\nR%d n%d 0 1\n", k, k, k, k);
    }
    sprintf(text + length, ".save v(b)\n.tran 0.5u 1m\n");
    struct dalcs_session *session = read_good(text);
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = "euler";
    options.record = true;
    const struct dalcs_sink sink = {0};
    size_t before = bytes_in_use();
    ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
    ck_assert_uint_gt(dalcs_session_report(session)->n_jumps, 400);
    ck_assert_uint_lt(bytes_in_use() - before, 2 << 20);
    dalcs_session_destroy(session);
}

END_TEST

/* Events of the default method: no more than asked for, the others counted. */
START_TEST(test_bounded_events) {
    struct dalcs_session *session =
        read_good("chopper\nV1 a 0 1\nVg g 0 PULSE(0 1 0.5u 0 0 0.5u 1u)\nS1 a b g 0 sm\n"
                  ".model sm SW(Vt=0.5)\nR1 b c 1\nC1 c 0 1u\n.tran 1u 100u\n");
    struct dalcs_run_options options = dalcs_run_options_default();
    options.record = true;
    options.max_events = 10;
    const struct dalcs_sink sink = {0};
    ck_assert_int_eq(dalcs_session_run(session, &options, &sink), DALCS_OK);
    const struct dalcs_report *report = dalcs_session_report(session);
    ck_assert_uint_eq(report->n_events, 10);
    ck_assert_uint_eq(report->n_events_dropped, 189);
    for (size_t k = 0; k < report->n_events; k++) {
        ck_assert_double_eq_tol(report->event[k].time, 0.5e-6 * (double)(k + 1), 1e-18);
        ck_assert(report->event[k].on == (k % 2 == 0));
    }
    dalcs_session_destroy(session);
}

END_TEST

static const char *const circuit[] = {
    "bridge\nV1 a b SIN(0 10 50)\nD1 a p\nD2 b p\nD3 n a\nD4 n b\nR1 p n 100\nC1 p n 100u\n"
    ".tran 0.1m 40m\n",
    "buck\nV1 in 0 12\nVg g 0 PULSE(0 1 0 0 0 4u 10u)\nS1 in sw g 0 sm\n.model sm SW(Vt=0.5)\n"
    "D1 0 sw\nL1 sw out 47u\nC1 out 0 10u\nR1 out 0 4\n"
    ".tran 1u 400u\n"};

struct task {
    const char *text, *method;
    struct rows rows;
};

static struct task task[8];

static void *work(void *user) {
    struct task *t = user;
    struct dalcs_session *session = read_good(t->text);
    enum dalcs_status status = run_with(session, t->method, &t->rows);
    dalcs_session_destroy(session);
    return status == DALCS_OK ? t : NULL;
}

/* Nothing is shared: circuits in threads at once give the bits that they give alone. */
START_TEST(test_threads) {
    enum { N_TASKS = sizeof(task) / sizeof(*task) };

    pthread_t thread[N_TASKS];
    for (int k = 0; k < N_TASKS; k++) {
        task[k].text = circuit[k % 2];
        task[k].method = k % 4 < 2 ? "auto" : "euler";
        ck_assert_int_eq(pthread_create(&thread[k], NULL, work, &task[k]), 0);
    }
    for (int k = 0; k < N_TASKS; k++) {
        void *result;
        ck_assert_int_eq(pthread_join(thread[k], &result), 0);
        ck_assert_ptr_nonnull(result);
    }
    for (int k = 0; k < N_TASKS; k++) {
        struct dalcs_session *alone = read_good(circuit[k % 2]);
        ck_assert_int_eq(run_with(alone, task[k].method, &rows), DALCS_OK);
        dalcs_session_destroy(alone);
        ck_assert_uint_gt(rows.n_values, 1000);
        ck_assert_uint_eq(task[k].rows.n_values, rows.n_values);
        ck_assert_mem_eq(task[k].rows.value, rows.value, rows.n_values * sizeof(double));
    }
}

END_TEST

static void *run_endlessly(void *user) {
    struct endless *e = user;
    struct dalcs_run_options options = dalcs_run_options_default();
    options.record = true;
    options.max_events = 10;
    const struct dalcs_sink sink = {.user = e, .progress = ask};
    e->status = dalcs_session_run(e->session, &options, &sink);
    return NULL;
}

/* Two runs that would take years, stopped one after the other; neither is stopped by the other's flag. */
START_TEST(test_cancel_from_another_thread) {
    struct endless e[2] = {{.status = DALCS_OK}, {.status = DALCS_OK}};
    pthread_t thread[2];
    for (int k = 0; k < 2; k++) {
        e[k].session = read_good("rectifier\nV1 a 0 SIN(0 1 50k)\nD1 a b\nC1 b 0 1u\nR1 b 0 1k\n"
                                 ".tran 1u 1e6\n");
        ck_assert_int_eq(pthread_create(&thread[k], NULL, run_endlessly, &e[k]), 0);
    }
    for (int k = 0; k < 2; k++) {
        while (atomic_load(&e[k].n_asked) < 2) {
            sched_yield();
        }
        ck_assert_uint_gt(atomic_load(&e[k].n_events), 100);
        ck_assert(!atomic_load(&e[k].stop));
        atomic_store(&e[k].stop, true);
        ck_assert_int_eq(pthread_join(thread[k], NULL), 0);
        ck_assert_int_eq(e[k].status, DALCS_E_CANCELLED);
        ck_assert_int_eq(dalcs_session_report(e[k].session)->n_events, 10);
        dalcs_session_destroy(e[k].session);
    }
}

END_TEST

RUN_TESTS("session runs", test_cancel, test_memory_given_back, test_memory_of_jumps,
          test_bounded_events, test_threads, test_cancel_from_another_thread)
