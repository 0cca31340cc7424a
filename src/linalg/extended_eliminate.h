/* extended_eliminate.h - what dalcs_extended_eliminate() does, in pairs of doubles. */
#ifndef DALCS_EXTENDED_ELIMINATE_H
#define DALCS_EXTENDED_ELIMINATE_H

#include "extended_rows.h"

/* Solves rows [first, n) of a[n][width] for columns [first, n), as far as there are pivots of at least `least`, and takes them
 * out of all rows: row_of[c] says y_c = its last columns - its other columns * y, or is -1 where column c stays. Columns that
 * are gone are 0. */
void dalcs_extended_eliminate_well(int first, int n, int width, double least,
                                   struct dalcs_extended *a, int *row_of);

#endif
