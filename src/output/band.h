/* band.h - what is to be seen of a curve whose periods are too narrow to see: between which values it moves, and its
 * mean. */
#ifndef DALCS_BAND_H
#define DALCS_BAND_H

#include "curve.h"

struct dalcs_band_point {
    double time, low, high, mean;
};

/* Over windows as wide as `period`, on a linear axis; period is at most the curve's width. Returns how many points
 * there are. */
int dalcs_band_find(const struct dalcs_curve *curve, double period,
                    struct dalcs_band_point point[DALCS_CURVE_COLUMNS]);

#endif
