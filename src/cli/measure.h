/* measure.h - minimum, maximum, average and rms of every signal, over the streamed rows; of complex signals,
 * of their magnitude. */
#ifndef DALCS_MEASURE_H
#define DALCS_MEASURE_H

#include "dalcs.h"
#include "quads.h"

struct dalcs_measure_signal {
    double min, max, final;
    double integral, square_integral; /* of the straight lines between rows */
};

/* The same of four signals side by side: a row adds to all of them at once. */
struct dalcs_measure_four {
    double min[DALCS_QUAD], max[DALCS_QUAD], final[DALCS_QUAD];
    double integral[DALCS_QUAD], square_integral[DALCS_QUAD];
};

struct dalcs_measure {
    const struct dalcs_plot *plot;   /* borrowed; NULL before the first plot */
    struct dalcs_measure_four *four; /* [plot->n_signals / 4, rounded up] */
    double *row;                     /* work: the last row in whole fours, 0 behind its end */
    size_t n_rows;
    double first_time, last_time;
};

/* Starts anew for each plot. */
enum dalcs_status dalcs_measure_begin(struct dalcs_measure *measure, const struct dalcs_plot *plot);
void dalcs_measure_row(struct dalcs_measure *measure, double time, const double *value);

/* What is known of one signal so far. */
struct dalcs_measure_signal dalcs_measure_of(const struct dalcs_measure *measure, size_t signal);

double dalcs_measure_average(const struct dalcs_measure *measure, size_t signal);
double dalcs_measure_rms(const struct dalcs_measure *measure, size_t signal);
/* The average for a person: 0 if it cancels to less than lines between rows are exact to. */
double dalcs_measure_shown_average(const struct dalcs_measure *measure, size_t signal);

/* Accepts a zeroed one. */
void dalcs_measure_finish(struct dalcs_measure *measure);

#endif
