/* worst_case.h - what the files of .wcase share. */
#ifndef DALCS_WORST_CASE_H
#define DALCS_WORST_CASE_H

#include "pipeline.h"

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
    size_t capacity, n_expected;                  /* runs that there will be */
};

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
