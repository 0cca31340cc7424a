/* extended_eliminate.c - elimination in pairs of doubles, with about 100 bits. */
#include "extended_eliminate.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* What the product of two doubles lacks (T. J. Dekker, Numer. Math. 18, 1971): each is split into halves of 26 bits. */
static double lack_of_product(double a, double b, double product) {
    const double split = 0x1p27 + 1.0;
    const double a_high = split * a - (split * a - a);
    const double b_high = split * b - (split * b - b);
    const double a_low = a - a_high;
    const double b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

static struct dalcs_extended times(struct dalcs_extended a, struct dalcs_extended b) {
    const double product = a.high * b.high;
    const double low = lack_of_product(a.high, b.high, product) + (a.high * b.low + a.low * b.high);
    const double high = product + low;
    return (struct dalcs_extended){high, low - (high - product)};
}

static struct dalcs_extended minus_product(struct dalcs_extended a, struct dalcs_extended b,
                                           struct dalcs_extended c) {
    const struct dalcs_extended product = times(b, c);
    return dalcs_extended_plus(a, (struct dalcs_extended){-product.high, -product.low});
}

/* By Newton's method from the quotient of doubles. */
static struct dalcs_extended over(struct dalcs_extended a, struct dalcs_extended b) {
    const struct dalcs_extended first = {a.high / b.high, 0.0};
    const struct dalcs_extended rest = minus_product(a, first, b);
    return dalcs_extended_plus(first, (struct dalcs_extended){rest.high / b.high, 0.0});
}

static int find_pivot(int first, int n, int width, double least, const struct dalcs_extended *a,
                      const int *row_of, int c) {
    int pivot = -1;
    double largest = least;
    for (int i = first; i < n; i++) {
        const double size = fabs(a[(size_t)i * (size_t)width + (size_t)c].high);
        bool is_used = false;
        for (int k = first; k < c && size >= largest; k++) {
            is_used = is_used || row_of[k] == i;
        }
        if (size >= largest && !is_used) {
            largest = size;
            pivot = i;
        }
    }
    return pivot;
}

/* The row is divided by what it has in column c, then taken from all others. */
static void clear_column(int n, int width, int pivot, int c, struct dalcs_extended *a) {
    struct dalcs_extended *row = a + (size_t)pivot * (size_t)width;
    const struct dalcs_extended by = row[c];
    for (int j = 0; j < width; j++) {
        row[j] = row[j].high != 0.0 && j != c ? over(row[j], by) : (struct dalcs_extended){0};
    }
    for (int i = 0; i < n; i++) {
        struct dalcs_extended *other = a + (size_t)i * (size_t)width;
        const struct dalcs_extended factor = other[c];
        for (int j = 0; j < width && i != pivot && factor.high != 0.0; j++) {
            if (row[j].high != 0.0) {
                other[j] = minus_product(other[j], factor, row[j]);
            }
        }
        other[c] = (struct dalcs_extended){0};
    }
}

void dalcs_extended_eliminate_well(int first, int n, int width, double least,
                                   struct dalcs_extended *a, int *row_of) {
    for (int c = first; c < n; c++) {
        row_of[c] = find_pivot(first, n, width, least, a, row_of, c);
        if (row_of[c] >= 0) {
            clear_column(n, width, row_of[c], c, a);
        }
    }
}
