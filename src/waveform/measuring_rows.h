/* measuring_rows.h - stretches between the rows of a sweep. Private to this folder. */
#ifndef DALCS_MEASURING_ROWS_H
#define DALCS_MEASURING_ROWS_H

#include "measuring.h"

/* The stretch from m->stretch.from to m->stretch.to between the row before and the one at `at`. */
void dalcs_measuring_fill_stretch(struct dalcs_measuring *m, double at, const double *re,
                                  const double *im);

#endif
