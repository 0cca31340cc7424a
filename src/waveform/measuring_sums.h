/* measuring_sums.h - sums and extremes over stretches. Private to this folder. */
#ifndef DALCS_MEASURING_SUMS_H
#define DALCS_MEASURING_SUMS_H

#include "measuring.h"

/* Of the present stretch, as far as it lies in the window of the item. */
void dalcs_measuring_add(const struct dalcs_measuring *m, struct dalcs_measured *item);

#endif
