/* extended.c - Gauss elimination that skips zeros. */
#include "extended.h"

#include <math.h>
#include <stddef.h>

static void swap_rows(int width, long double *a, long double *b) {
    for (int j = 0; j < width; j++) {
        long double t = a[j];
        a[j] = b[j];
        b[j] = t;
    }
}

/* target -= factor * source from column `from` on. */
static void subtract(int from, int width, long double *target, const long double *source,
                     long double factor) {
    for (int j = from; j < width; j++) {
        target[j] -= factor * source[j];
    }
}

static void subtract_complex(int from, int width, long double *target_re, long double *target_im,
                             const long double *source_re, const long double *source_im,
                             long double re, long double im) {
    for (int j = from; j < width; j++) {
        target_re[j] -= re * source_re[j] - im * source_im[j];
        target_im[j] -= re * source_im[j] + im * source_re[j];
    }
}

long double dalcs_extended_solve(int n, int n_rhs, long double *re, long double *im) {
    int width = n + n_rhs;
    long double least = INFINITY;
    for (int k = 0; k < n; k++) {
        int pivot = k;
        long double largest = -1.0L;
        for (int i = k; i < n; i++) {
            size_t at = (size_t)i * (size_t)width + (size_t)k;
            long double size = fabsl(re[at]) + (im != NULL ? fabsl(im[at]) : 0.0L);
            if (size > largest) {
                largest = size;
                pivot = i;
            }
        }
        if (!(largest > 0.0L)) {
            return 0.0L;
        }
        least = largest < least ? largest : least;
        long double *row_re = re + (size_t)k * (size_t)width;
        long double *row_im = im != NULL ? im + (size_t)k * (size_t)width : NULL;
        if (pivot != k) {
            swap_rows(width, row_re, re + (size_t)pivot * (size_t)width);
            if (im != NULL) {
                swap_rows(width, row_im, im + (size_t)pivot * (size_t)width);
            }
        }
        /* the pivot row is divided by its pivot, then eliminates the column above and below */
        long double d_re = row_re[k];
        long double d_im = im != NULL ? row_im[k] : 0.0L;
        long double square = d_re * d_re + d_im * d_im;
        for (int j = k; j < width; j++) {
            if (im == NULL) {
                row_re[j] /= d_re;
                continue;
            }
            long double a = row_re[j];
            long double b = row_im[j];
            if (a != 0.0L || b != 0.0L) {
                row_re[j] = (a * d_re + b * d_im) / square;
                row_im[j] = (b * d_re - a * d_im) / square;
            }
        }
        for (int i = 0; i < n; i++) {
            long double *other_re = re + (size_t)i * (size_t)width;
            long double *other_im = im != NULL ? im + (size_t)i * (size_t)width : NULL;
            long double f_re = other_re[k];
            long double f_im = im != NULL ? other_im[k] : 0.0L;
            if (i == k || (f_re == 0.0L && f_im == 0.0L)) {
                continue;
            }
            if (im == NULL) {
                subtract(k, width, other_re, row_re, f_re);
            } else {
                subtract_complex(k, width, other_re, other_im, row_re, row_im, f_re, f_im);
            }
        }
    }
    return least;
}
