/* lu_solve.c - the two triangles of a factored matrix, solved block by block. */
#include "lu.h"

void dalcs_lu_solve_ordered(const struct dalcs_lu *lu) {
    double *restrict x = lu->work;
    const int *restrict lower_p = lu->lower_p;
    const int *restrict lower_j = lu->lower_j;
    const double *restrict lower_x = lu->lower_x;
    const int *restrict upper_p = lu->upper_p;
    const int *restrict upper_j = lu->upper_j;
    const double *restrict upper_x = lu->upper_x;
    for (int block = lu->n_blocks - 1; block >= 0; block--) {
        int begin = lu->block[block];
        int end = lu->block[block + 1];
        /* Forward: what later blocks contribute through F, then L. */
        for (int i = begin; i < end; i++) {
            double sum = x[i];
            for (int k = lower_p[i]; k < lower_p[i + 1]; k++) {
                sum -= lower_x[k] * x[lower_j[k]];
            }
            x[i] = sum;
        }
        for (int i = end - 1; i >= begin; i--) {
            double sum = x[i];
            for (int k = upper_p[i]; k < upper_p[i + 1]; k++) {
                sum -= upper_x[k] * x[upper_j[k]];
            }
            x[i] = sum * lu->pivot_inverse[i];
        }
    }
}

void dalcs_lu_solve_ordered_complex(const struct dalcs_lu *lu) {
    double *restrict x = lu->work;
    const int *restrict lower_p = lu->lower_p;
    const int *restrict lower_j = lu->lower_j;
    const double *restrict lower_x = lu->lower_x;
    const int *restrict upper_p = lu->upper_p;
    const int *restrict upper_j = lu->upper_j;
    const double *restrict upper_x = lu->upper_x;
    const double *restrict inverse = lu->pivot_inverse;
    for (int block = lu->n_blocks - 1; block >= 0; block--) {
        int begin = lu->block[block];
        int end = lu->block[block + 1];
        for (int i = begin; i < end; i++) {
            double re = x[2 * i];
            double im = x[2 * i + 1];
            for (int k = lower_p[i]; k < lower_p[i + 1]; k++) {
                const double *a = lower_x + 2 * k;
                const double *b = x + 2 * lower_j[k];
                re -= a[0] * b[0] - a[1] * b[1];
                im -= a[0] * b[1] + a[1] * b[0];
            }
            x[2 * i] = re;
            x[2 * i + 1] = im;
        }
        for (int i = end - 1; i >= begin; i--) {
            double re = x[2 * i];
            double im = x[2 * i + 1];
            for (int k = upper_p[i]; k < upper_p[i + 1]; k++) {
                const double *a = upper_x + 2 * k;
                const double *b = x + 2 * upper_j[k];
                re -= a[0] * b[0] - a[1] * b[1];
                im -= a[0] * b[1] + a[1] * b[0];
            }
            x[2 * i] = re * inverse[2 * i] - im * inverse[2 * i + 1];
            x[2 * i + 1] = re * inverse[2 * i + 1] + im * inverse[2 * i];
        }
    }
}

void dalcs_lu_solve(const struct dalcs_lu *lu, double *b) {
    for (int i = 0; i < lu->n; i++) {
        lu->work[i] = b[lu->from[i]];
    }
    dalcs_lu_solve_ordered(lu);
    for (int i = 0; i < lu->n; i++) {
        b[lu->to[i]] = lu->work[i];
    }
}
