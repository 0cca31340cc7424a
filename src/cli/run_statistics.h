/* run_statistics.h - mean, standard deviation and range of measurements over runs, as they come. */
#ifndef DALCS_RUN_STATISTICS_H
#define DALCS_RUN_STATISTICS_H

#include "dalcs.h"

#include <stdio.h>

/* Zero-initialise; finish frees. */
struct dalcs_run_statistics {
    size_t n_runs;
    size_t n; /* measurements */

    struct dalcs_run_moments {
        size_t n;             /* runs that have it */
        double mean, squares; /* squares: of the differences to the mean, summed */
        double least, largest;
    } * of; /* [n] heap */
};

enum dalcs_status dalcs_run_statistics_begin(struct dalcs_run_statistics *statistics,
                                             size_t n) DALCS_MUST_CHECK;

/* One more run; NAN: not measured. */
void dalcs_run_statistics_add(struct dalcs_run_statistics *statistics,
                              const double *value /* [n] */);

/* A line for each measurement of the session. */
void dalcs_run_statistics_write(FILE *out, const struct dalcs_run_statistics *statistics,
                                const struct dalcs_session *session);

void dalcs_run_statistics_finish(struct dalcs_run_statistics *statistics);

#endif
