/* dense_map.h - y = M x for a small dense matrix kept for many products.
 *
 * M is stored by columns with its rows padded to a multiple of 8. Every element of y is summed in the
 * same order whatever the vector width, so the same input gives the same bits on every machine. */
#ifndef DALCS_DENSE_MAP_H
#define DALCS_DENSE_MAP_H

#include "memory.h"

static inline int dalcs_dense_map_rows(int n) {
    return (n + 7) / 8 * 8;
}

/* Zeros behind the last column, so that any elements of it may be read four at a time. */
enum { DALCS_DENSE_MAP_SPARE = 8 };

/* For dalcs_dense_map_rows(n) x columns elements, not zeroed, and the spare ones; NULL when out of memory; free() it. */
double *dalcs_dense_map_alloc(int rows, int columns);

/* y[rows] = map x[columns]; rows is a multiple of 8. */
void dalcs_dense_map_apply(int rows, int columns, const double *map, const double *x, double *y);

#endif
