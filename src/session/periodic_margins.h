/* periodic_margins.h - where a loop gain has the magnitude 1, and where it is real and negative. */
#ifndef DALCS_PERIODIC_MARGINS_H
#define DALCS_PERIODIC_MARGINS_H

#include "memory.h"

#include <complex.h>
#include <stdbool.h>

/* gain of the loop at a frequency (Hz); user is its. */
typedef enum dalcs_status dalcs_gain_at(void *user, double frequency, double complex *gain);

struct dalcs_margin;

struct dalcs_margins {
    void *user;
    dalcs_gain_at *at;
    bool has_last;
    double last; /* Hz */
    double complex last_gain;
    size_t n_crossovers, crossover_capacity, n_reversals, reversal_capacity;
    struct dalcs_margin *crossover, *reversal; /* heap */
};

/* The next frequency of a sweep and the gain there: what lies between it and the one before is found by bisection. */
enum dalcs_status dalcs_margins_reach(struct dalcs_margins *margins, double frequency,
                                      double complex gain) DALCS_MUST_CHECK;
void dalcs_margins_finish(struct dalcs_margins *margins);

#endif
