/* measuring_extremes.h - the largest and the least value of a span. */
#ifndef DALCS_MEASURING_EXTREMES_H
#define DALCS_MEASURING_EXTREMES_H

#include "measuring.h"

struct dalcs_climb {
    const struct dalcs_stretch_rule *rule;
    double sign;
    double scale; /* largest magnitude so far */
    double *best, *where;
};

/* To one value. Extremes that differ by rounding alone, as those of periods do, have the place of the first one. */
void dalcs_climb_to(const struct dalcs_climb *c, double value, double time);

/* Raises best and where to what the span has: with sign -1 its least. */
void dalcs_climb(const struct dalcs_climb *c, const struct dalcs_span *span);

#endif
