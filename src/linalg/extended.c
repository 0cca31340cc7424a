/* extended.c - Gauss elimination that skips zeros. */
#include "extended.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static void swap_rows(int width, long double *a, long double *b) {
    for (int j = 0; j < width; j++) {
        long double t = a[j];
        a[j] = b[j];
        b[j] = t;
    }
}

/* Columns of a pivot row that are looked at together. */
enum { COLUMNS = 64 };

/* The columns in [from, to) but c where the row has something. Rows of circuits are mostly empty. */
static int list_nonzeros(int from, int to, int c, const long double *re, const long double *im,
                         int *column) {
    int n = 0;
    for (int j = from; j < to; j++) {
        column[n] = j;
        n += j != c && (re[j] != 0.0L || (im != NULL && im[j] != 0.0L)) ? 1 : 0;
    }
    return n;
}

static void divide(int n, const int *column, long double *re, long double *im, long double d_re,
                   long double d_im) {
    long double square = d_re * d_re + d_im * d_im;
    for (int k = 0; k < n; k++) {
        int j = column[k];
        if (im == NULL) {
            re[j] /= d_re;
            continue;
        }
        long double a = re[j];
        long double b = im[j];
        re[j] = (a * d_re + b * d_im) / square;
        im[j] = (b * d_re - a * d_im) / square;
    }
}

/* target -= factor * source */
static void subtract(int n, const int *column, long double *target, const long double *source,
                     long double factor) {
    for (int k = 0; k < n; k++) {
        target[column[k]] -= factor * source[column[k]];
    }
}

static void subtract_complex(int n, const int *column, long double *target_re,
                             long double *target_im, const long double *source_re,
                             const long double *source_im, long double re, long double im) {
    for (int k = 0; k < n; k++) {
        int j = column[k];
        target_re[j] -= re * source_re[j] - im * source_im[j];
        target_im[j] -= re * source_im[j] + im * source_re[j];
    }
}

/* Row k is divided by what it has in column c, then taken from all other rows, so that they have nothing
 * there; in columns [from, width) but c. What column c holds afterwards means nothing. */
static void clear_column(int n, int from, int width, int k, int c, long double *re,
                         long double *im) {
    long double *row_re = re + (size_t)k * (size_t)width;
    long double *row_im = im != NULL ? im + (size_t)k * (size_t)width : NULL;
    long double d_re = row_re[c];
    long double d_im = im != NULL ? row_im[c] : 0.0L;
    for (; from < width; from += COLUMNS) {
        int column[COLUMNS];
        int to = from + COLUMNS < width ? from + COLUMNS : width;
        int n_columns = list_nonzeros(from, to, c, row_re, row_im, column);
        divide(n_columns, column, row_re, row_im, d_re, d_im);
        for (int i = 0; i < n; i++) {
            long double *other_re = re + (size_t)i * (size_t)width;
            long double *other_im = im != NULL ? im + (size_t)i * (size_t)width : NULL;
            if (i == k || (other_re[c] == 0.0L && (im == NULL || other_im[c] == 0.0L))) {
                continue;
            }
            if (im == NULL) {
                subtract(n_columns, column, other_re, row_re, other_re[c]);
            } else {
                subtract_complex(n_columns, column, other_re, other_im, row_re, row_im, other_re[c],
                                 other_im[c]);
            }
        }
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
        if (pivot != k) {
            size_t from = (size_t)k * (size_t)width;
            size_t with = (size_t)pivot * (size_t)width;
            swap_rows(width, re + from, re + with);
            if (im != NULL) {
                swap_rows(width, im + from, im + with);
            }
        }
        clear_column(n, k + 1, width, k, k, re, im);
    }
    return least;
}

void dalcs_extended_eliminate(int first, int n, int width, long double least, long double *a,
                              int *row_of) {
    for (int c = first; c < n; c++) {
        int pivot = -1;
        long double largest = least;
        for (int i = first; i < n; i++) {
            long double size = fabsl(a[(size_t)i * (size_t)width + (size_t)c]);
            bool is_used = false;
            for (int k = first; k < c && size >= largest; k++) {
                is_used = is_used || row_of[k] == i;
            }
            if (size >= largest && !is_used) {
                largest = size;
                pivot = i;
            }
        }
        row_of[c] = pivot;
        if (pivot < 0) {
            continue;
        }
        clear_column(n, 0, width, pivot, c, a, NULL);
        for (int i = 0; i < n; i++) {
            a[(size_t)i * (size_t)width + (size_t)c] = 0.0L;
        }
    }
}
