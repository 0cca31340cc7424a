/* curve.h - one curve of a figure: a bounded number of points whatever the length of the run. */
#ifndef DALCS_CURVE_H
#define DALCS_CURVE_H

#include "dalcs.h"

enum {
    DALCS_CURVE_COLUMNS = 1000, /* about the width of a figure in pixels */
    DALCS_CURVE_PLACES =
        4 * DALCS_CURVE_COLUMNS /* where its integral is known: edges lie between them */
};

struct dalcs_curve_point {
    long row;
    double time, value;
};

/* What of a pixel column's points can be seen. */
struct dalcs_curve_column {
    bool used;
    bool follows_gap; /* no line leads to it */
    struct dalcs_curve_point first, lowest, highest, last;
};

/* Counts how often a signal turns back by more than a given swing. */
struct dalcs_turns {
    long n;
    bool rising;
    double extreme; /* since the last turn */
};

void dalcs_turns_add(struct dalcs_turns *turns, double value, double swing);

struct dalcs_curve {
    double start, stop;
    bool logarithmic; /* columns are as wide as each other on a logarithmic axis */
    long n_rows;
    double lowest, highest; /* of the finite values; lowest > highest when there are none */
    struct dalcs_turns turns;
    double turns_range; /* of the values, when turns were first counted */
    double integral;    /* over time, of what came so far; gaps are 0 */
    double time, value; /* of the point before; not a number where there is none */
    int n_integrals;
    double *integral_at; /* [DALCS_CURVE_PLACES + 1] the first n_integrals, on a linear axis */
    struct dalcs_curve_column *column; /* [DALCS_CURVE_COLUMNS] */
};

enum dalcs_status dalcs_curve_init(struct dalcs_curve *curve, double start,
                                   double stop) DALCS_MUST_CHECK;

/* Times ascend. Values that are not finite leave a gap of one point. */
void dalcs_curve_add(struct dalcs_curve *curve, double time, double value);

/* The pixel column of a time; times beyond the ends belong to the outermost columns. */
int dalcs_curve_find_column(const struct dalcs_curve *curve, double time);

/* Widens *low and *high by the columns that are not skipped. skip is [DALCS_CURVE_COLUMNS]. */
void dalcs_curve_widen_range(const struct dalcs_curve *curve, const bool *skip, double *low,
                             double *high);

/* The part of the columns, 0 to 1, where both curves are drawn in the same place away from 0. */
double dalcs_curve_overlap(const struct dalcs_curve *a, const struct dalcs_curve *b,
                           double tolerance);

/* The points of a column in their order; returns how many, 0 to 4. */
int dalcs_curve_column_points(const struct dalcs_curve_column *column,
                              struct dalcs_curve_point point[4]);

void dalcs_curve_finish(struct dalcs_curve *curve);

#endif
