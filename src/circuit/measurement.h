/* measurement.h - the contents of .meas and .four. */
#ifndef DALCS_MEASUREMENT_H
#define DALCS_MEASUREMENT_H

#include "diag.h"
#include "signal_formula.h"

enum dalcs_measured_analysis {
    DALCS_MEASURED_TRAN,
    DALCS_MEASURED_OP,
    DALCS_MEASURED_DC,
    DALCS_MEASURED_AC,
    DALCS_MEASURED_PSS /* the period of a steady state */
};

enum dalcs_measure_kind {
    DALCS_MEASURE_AVERAGE,
    DALCS_MEASURE_RMS,
    DALCS_MEASURE_INTEGRAL,
    DALCS_MEASURE_MIN,
    DALCS_MEASURE_MAX,
    DALCS_MEASURE_PEAK_TO_PEAK,
    DALCS_MEASURE_MIN_AT,
    DALCS_MEASURE_MAX_AT,
    DALCS_MEASURE_DERIVATIVE, /* at instant[0] */
    DALCS_MEASURE_FIND,       /* at instant[0] */
    DALCS_MEASURE_WHEN,       /* instant[0] itself */
    DALCS_MEASURE_DELAY,      /* from instant[0] to instant[1]: TRIG ... TARG */
    DALCS_MEASURE_PARAM
};

/* AT=, WHEN, TRIG or TARG. Times are in s, or in the unit of what is swept. */
struct dalcs_measure_instant {
    enum dalcs_instant_kind { DALCS_INSTANT_NONE, DALCS_INSTANT_AT, DALCS_INSTANT_CROSSING } kind;

    double at;
    struct dalcs_signal_formula at_formula; /* n > 0: `at` is computed from earlier measurements, */
    struct dalcs_signal_formula left,
        difference;   /* left = right: of the difference a zero is sought */
    const char *text; /* of the right side */

    enum dalcs_measure_edge { DALCS_EDGE_ANY, DALCS_EDGE_RISE, DALCS_EDGE_FALL } edge;

    int count;                                 /* which of them, from 1; 0: the last */
    double delay;                              /* td: those before do not count; -INFINITY: none */
    struct dalcs_signal_formula delay_formula; /* likewise */
};

struct dalcs_measure_card {
    const char *name;
    enum dalcs_measured_analysis analysis;
    enum dalcs_measure_kind kind;
    struct dalcs_signal_formula formula;
    double from, to; /* infinite: from the first to the last point */
    struct dalcs_signal_formula from_formula, to_formula; /* n > 0: from earlier measurements */
    struct dalcs_measure_instant instant[2];
    const char *mistake; /* in the card, which was told: the measurement fails; else NULL */
    bool is_late;        /* it needs the results of earlier ones, and so comes after the run */
    struct dalcs_location where;
};

struct dalcs_fourier_card {
    double frequency; /* Hz */
    int n_harmonics;  /* the constant not counted */
    int n_periods;    /* the last ones of the run */
    struct dalcs_signal_formula formula;
    struct dalcs_location where;
};

#endif
