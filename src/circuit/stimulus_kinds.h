/* stimulus_kinds.h - the kinds of stimuli, as stimulus.c asks them. Private to this folder. */
#ifndef DALCS_STIMULUS_KINDS_H
#define DALCS_STIMULUS_KINDS_H

#include "rounding.h"
#include "stimulus.h"

#include <math.h>

/* How far from an edge a time may be and still mean it. An edge is computed with three roundings and
 * a caller's time grid with about as many. */
static inline double dalcs_stimulus_tolerance(double t, double delay) {
    return dalcs_rounded * fmax(fabs(t), fabs(delay));
}

/* sin(2 pi cycles). */
double dalcs_sine_of_cycles(double x);

/* Where a tone is at t. */
double dalcs_sine_cycles_at(double frequency, double since, double phase);

double dalcs_sine_cycles(const struct dalcs_stimulus *s, double since);

/* How long the cycles last, INFINITY when there is no end. */
double dalcs_sine_length(const struct dalcs_stimulus *s);

double dalcs_sine_value(const struct dalcs_stimulus *s, double t);

/* Is t behind the delay of the tones? */
bool dalcs_tones_have_begun(const struct dalcs_stimulus *s, double t, enum dalcs_side side);

double dalcs_pulse_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side);

double dalcs_pulse_next_edge(const struct dalcs_stimulus *s, double t);

/* The next edge, the value after t and that just before the edge, of one look. */
double dalcs_pulse_line(const struct dalcs_stimulus *s, double t, double *level, double *last);

double dalcs_pwl_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side);

double dalcs_pwl_next_edge(const struct dalcs_stimulus *s, double t);

#endif
