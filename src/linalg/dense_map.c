/* dense_map.c - the product, 32 rows at a time, then 16, then 8. */
#include "dense_map.h"

#include "quads.h"
#include "wide_vectors.h"

#include <stdlib.h>
#include <string.h>

double *dalcs_dense_map_alloc(int rows, int columns) {
    size_t bytes = (size_t)rows * (size_t)(columns > 0 ? columns : 1) * sizeof(double);
    bytes = (bytes + 63) / 64 * 64;
    double *map = aligned_alloc(64, bytes + DALCS_DENSE_MAP_SPARE * sizeof(*map));
    if (map != NULL) {
        memset(map + bytes / sizeof(*map), 0, DALCS_DENSE_MAP_SPARE * sizeof(*map));
    }
    return map;
}

enum { MOST_QUADS = 8 };

/* 4 n rows, n known to the compiler: unrolled, the sums stay in registers. */
static inline __attribute__((always_inline)) void multiply_rows(int n, int rows, int columns,
                                                                const double *restrict map,
                                                                const double *restrict x,
                                                                double *restrict y) {
    dalcs_quad sum[MOST_QUADS] = {{0.0}};
    for (int j = 0; j < columns; j++, map += rows) {
        const dalcs_quad *m = (const dalcs_quad *)map;
#pragma GCC unroll 8
        for (int k = 0; k < n; k++) {
            sum[k] += m[k] * x[j];
        }
    }
#pragma GCC unroll 8
    for (int k = 0; k < n; k++) {
        dalcs_quad_store(y + k * DALCS_QUAD, &sum[k]);
    }
}

DALCS_TWICE(void, multiply,
            (int rows, int columns, const double *restrict map, const double *restrict x,
             double *restrict y),
            (rows, columns, map, x, y)) {
    int i = 0;
    for (; i + 32 <= rows; i += 32) {
        multiply_rows(8, rows, columns, map + i, x, y + i);
    }
    if (i + 16 <= rows) {
        multiply_rows(4, rows, columns, map + i, x, y + i);
        i += 16;
    }
    if (i < rows) {
        multiply_rows(2, rows, columns, map + i, x, y + i);
    }
}

void dalcs_dense_map_apply(int rows, int columns, const double *map, const double *x, double *y) {
    multiply(rows, columns, map, x, y);
}
