/* dense_solve.c - Gauss elimination with row pivoting. */
#include "dense_solve.h"

#include "wide_vectors.h"

#include <math.h>

static void swap_rows(int row, double *a, double *b) {
    for (int j = 0; j < row; j++) {
        double t = a[j];
        a[j] = b[j];
        b[j] = t;
    }
}

static int find_pivot(int n, int row, int k, const double *a) {
    int pivot = k;
    for (int i = k + 1; i < n; i++) {
        pivot = fabs(a[i * row + k]) > fabs(a[pivot * row + k]) ? i : pivot;
    }
    return pivot;
}

/* Row k over its pivot, then taken from all others, so that they have nothing in column k. Columns before it are 0 in
 * row k, and stay as they are. */
DALCS_TWICE(void, clear_column, (int n, int row, int k, double *a), (n, row, k, a)) {
    double *by = a + k * row;
    const int from = k - k % DALCS_QUAD;
    const double pivot = by[k];
    for (int j = from; j < row; j += DALCS_QUAD) {
        dalcs_quad quotient;
        dalcs_quad_load(&quotient, by + j);
        quotient /= pivot;
        dalcs_quad_store(by + j, &quotient);
    }
    for (int i = 0; i < n; i++) {
        double *other = a + i * row;
        const double factor = other[k];
        for (int j = from; j < row && i != k && factor != 0.0; j += DALCS_QUAD) {
            dalcs_quad term;
            dalcs_quad rest;
            dalcs_quad_load(&term, by + j);
            dalcs_quad_load(&rest, other + j);
            rest -= factor * term;
            dalcs_quad_store(other + j, &rest);
        }
    }
}

double dalcs_dense_solve(int n, int n_rhs, double *a) {
    const int row = dalcs_dense_row(n, n_rhs);
    double least = INFINITY;
    for (int k = 0; k < n; k++) {
        int pivot = find_pivot(n, row, k, a);
        double size = fabs(a[pivot * row + k]);
        if (!(size > 0.0)) {
            return 0.0;
        }
        least = size < least ? size : least;
        if (pivot != k) {
            swap_rows(row, a + k * row, a + pivot * row);
        }
        clear_column(n, row, k, a);
    }
    return least;
}
