/* dense_map.c - the product, 32 rows at a time, then 16, then 8. */
#include "dense_map.h"

#include "wide_vectors.h"

#include <stdlib.h>
#include <string.h>

double *dalcs_dense_map_alloc(int rows, int columns) {
    size_t bytes = (size_t)rows * (size_t)(columns > 0 ? columns : 1) * sizeof(double);
    bytes = (bytes + 63) / 64 * 64;
    return aligned_alloc(64, bytes > 0 ? bytes : 64);
}

typedef double vector4 __attribute__((vector_size(32), aligned(32)));

DALCS_TWICE(void, multiply,
            (int rows, int columns, const double *restrict map, const double *restrict x,
             double *restrict y),
            (rows, columns, map, x, y)) {
    int i = 0;
    for (; i + 32 <= rows; i += 32) {
        vector4 a = {0.0};
        vector4 b = {0.0};
        vector4 c = {0.0};
        vector4 d = {0.0};
        vector4 e = {0.0};
        vector4 f = {0.0};
        vector4 g = {0.0};
        vector4 h = {0.0};
        const double *column = map + i;
        for (int j = 0; j < columns; j++, column += rows) {
            const vector4 *m = (const vector4 *)column;
            vector4 v = {x[j], x[j], x[j], x[j]};
            a += m[0] * v;
            b += m[1] * v;
            c += m[2] * v;
            d += m[3] * v;
            e += m[4] * v;
            f += m[5] * v;
            g += m[6] * v;
            h += m[7] * v;
        }
        memcpy(y + i, &a, sizeof(a));
        memcpy(y + i + 4, &b, sizeof(b));
        memcpy(y + i + 8, &c, sizeof(c));
        memcpy(y + i + 12, &d, sizeof(d));
        memcpy(y + i + 16, &e, sizeof(e));
        memcpy(y + i + 20, &f, sizeof(f));
        memcpy(y + i + 24, &g, sizeof(g));
        memcpy(y + i + 28, &h, sizeof(h));
    }
    if (i + 16 <= rows) {
        vector4 a = {0.0};
        vector4 b = {0.0};
        vector4 c = {0.0};
        vector4 d = {0.0};
        const double *column = map + i;
        for (int j = 0; j < columns; j++, column += rows) {
            const vector4 *m = (const vector4 *)column;
            vector4 v = {x[j], x[j], x[j], x[j]};
            a += m[0] * v;
            b += m[1] * v;
            c += m[2] * v;
            d += m[3] * v;
        }
        memcpy(y + i, &a, sizeof(a));
        memcpy(y + i + 4, &b, sizeof(b));
        memcpy(y + i + 8, &c, sizeof(c));
        memcpy(y + i + 12, &d, sizeof(d));
        i += 16;
    }
    if (i < rows) {
        vector4 a = {0.0};
        vector4 b = {0.0};
        const double *column = map + i;
        for (int j = 0; j < columns; j++, column += rows) {
            const vector4 *m = (const vector4 *)column;
            vector4 v = {x[j], x[j], x[j], x[j]};
            a += m[0] * v;
            b += m[1] * v;
        }
        memcpy(y + i, &a, sizeof(a));
        memcpy(y + i + 4, &b, sizeof(b));
    }
}

void dalcs_dense_map_apply(int rows, int columns, const double *map, const double *x, double *y) {
    multiply(rows, columns, map, x, y);
}
