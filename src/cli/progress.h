/* progress.h - one line on a terminal that says how far a long run is. */
#ifndef DALCS_PROGRESS_H
#define DALCS_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct dalcs_progress {
    FILE *stream;       /* borrowed; NULL: show nothing */
    double start, last; /* s on a monotonic clock */
    bool shown;
    bool counts; /* points are reported, not times */
};

/* stream NULL shows nothing. */
void dalcs_progress_init(struct dalcs_progress *progress, FILE *stream);

/* Simulated time of stop, in s, or points of all; events of diodes and switches so far. Redraws at most
 * five times a second. */
void dalcs_progress_update(struct dalcs_progress *progress, double time, double stop,
                           size_t n_events);

/* Erases the line. */
void dalcs_progress_finish(struct dalcs_progress *progress);

#endif
