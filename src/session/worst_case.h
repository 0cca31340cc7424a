/* worst_case.h - what the files of .wcase share. */
#ifndef DALCS_WORST_CASE_H
#define DALCS_WORST_CASE_H

#include "pipeline.h"

#include <pthread.h>
#include <stdatomic.h>

/* Corners are tried one by one where there are no more tolerances than these: 4096 runs. */
enum { DALCS_MOST_OF_CORNERS = 12 };

struct dalcs_worst_case {
    struct dalcs_session *session;
    const struct dalcs_run_options *options;
    const struct dalcs_sink *sink;
    const struct dalcs_tolerance_place *place; /* [n] */
    size_t n, n_results, n_runs, n_failed;
    struct dalcs_worst_case_parameter *parameter; /* [n] */
    struct dalcs_worst_case_result *result;       /* [n_results] */
    struct dalcs_worst_case_run *run;             /* [n_runs] so far */
    double **value;                               /* [n_runs] of them, [n_results] */
    size_t capacity, value_capacity, n_done;
    size_t n_expected; /* runs that there will be */

    pthread_mutex_t lock;       /* of the arena, n_failed and status */
    enum dalcs_status status;   /* of the first run that ended all */
    atomic_bool ended;          /* by it */
    atomic_size_t next, n_over; /* the run that is begun next; those that are over */
};

/* ---- worst_case_runs.c ------------------------------------------------------------------------- */

/* One more run, with the tolerances [n] there. */
enum dalcs_status dalcs_worst_case_add(struct dalcs_worst_case *w,
                                       const signed char *at) DALCS_MUST_CHECK;

/* Those that were added and have not run, in as many threads as the options say. */
enum dalcs_status dalcs_worst_case_run_added(struct dalcs_worst_case *w) DALCS_MUST_CHECK;

/* What tolerances are in this circuit, of all (only = n) or of one: at its low end (place < 0), high end or nominal. */
void dalcs_worst_case_read(struct dalcs_worst_case *w, const struct dalcs_circuit *circuit,
                           int place, size_t only);

/* What was measured, by name: a run that failed may have less. */
void dalcs_worst_case_take(struct dalcs_worst_case *w, const struct dalcs_report *report,
                           size_t run);

/* ---- worst_case_choice.c ----------------------------------------------------------------------- */

/* Of a measurement, by the runs with one tolerance at an end: where each of them should be so that it is largest
 * (largest) or smallest. */
void dalcs_worst_case_choose(const struct dalcs_worst_case *w, size_t result, bool largest,
                             signed char *place);

/* The runs with the smallest and the largest value of each measurement, and whether corners had others than the single
 * tolerances tell. */
void dalcs_worst_case_judge(struct dalcs_worst_case *w);

/* Run k of one tolerance at its end: 1 + 2 p at its low one, 2 + 2 p at its high one. */
static inline size_t dalcs_worst_case_alone(size_t p, bool high) {
    return 1 + 2 * p + (high ? 1 : 0);
}

/* The run where these say that a measurement is smallest or largest. */
static inline size_t dalcs_worst_case_told(const struct dalcs_worst_case *w, size_t result,
                                           bool largest) {
    return 1 + 2 * w->n + 2 * result + (largest ? 1 : 0);
}

#endif
