/* measure.h - minimum, maximum, average and rms of every signal, over the streamed rows; of complex signals,
 * of their magnitude. */
#ifndef DALCS_MEASURE_H
#define DALCS_MEASURE_H

#include "dalcs.h"

struct dalcs_measure_signal {
    double min, max, final;
    double integral, square_integral; /* of the straight lines between rows */
};

struct dalcs_measure {
    const struct dalcs_plot *plot;       /* borrowed; NULL before the first plot */
    struct dalcs_measure_signal *signal; /* [plot->n_signals] */
    size_t n_rows;
    double first_time, last_time;
};

/* Starts anew for each plot. */
enum dalcs_status dalcs_measure_begin(struct dalcs_measure *measure, const struct dalcs_plot *plot);
void dalcs_measure_row(struct dalcs_measure *measure, double time, const double *value);

double dalcs_measure_average(const struct dalcs_measure *measure, size_t signal);
double dalcs_measure_rms(const struct dalcs_measure *measure, size_t signal);
/* The average for a person: 0 if it cancels to less than lines between rows are exact to. */
double dalcs_measure_shown_average(const struct dalcs_measure *measure, size_t signal);

/* Accepts a zeroed one. */
void dalcs_measure_finish(struct dalcs_measure *measure);

#endif
