/* samples.h - the signals of one run of dalcs at given times, and what the run cost. */
#ifndef DALCS_SAMPLES_H
#define DALCS_SAMPLES_H

#include "dalcs.h"

#include <signal.h>

struct dalcs_samples {
    const struct dalcs_plot *plot; /* borrowed from the session; NULL before any row */
    size_t n_times;
    double *value; /* [n_times * n_signals], a row for each time */
    size_t n_rows; /* received */
};

/* Runs with options->at set; only .tran counts. The session's messages say why it failed. */
enum dalcs_status dalcs_samples_run(struct dalcs_samples *samples, struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const volatile sig_atomic_t *interrupted) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_samples_finish(struct dalcs_samples *samples);

/* What a plain run costs: its rows, on the .tran grid, go to a file. */
struct dalcs_cost {
    double cpu_s; /* the least of up to three */
    size_t points;
    long steps, factorizations;
};

enum dalcs_status dalcs_cost_measure(struct dalcs_cost *cost, struct dalcs_session *session,
                                     const struct dalcs_run_options *options,
                                     const volatile sig_atomic_t *interrupted) DALCS_MUST_CHECK;

/* Times, ascending, where signals or their slopes may jump: both sides of events and edges appear there
 * as two rows. *time is the caller's to free. */
enum dalcs_status dalcs_breaks_find(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const volatile sig_atomic_t *interrupted, double **time,
                                    size_t *n) DALCS_MUST_CHECK;

#endif
