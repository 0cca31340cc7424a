/* extended_rows.h - rows of numbers with twice a double's digits.
 *
 * Each number is the unevaluated sum of two doubles: what is done with rows of them is done to vectors, where a
 * long double is loaded, used and stored alone, in several steps each. */
#ifndef DALCS_EXTENDED_ROWS_H
#define DALCS_EXTENDED_ROWS_H

#include <stddef.h>

struct dalcs_extended {
    double high, low;
};

static inline struct dalcs_extended dalcs_extended_of(long double x) {
    double high = (double)x;
    return (struct dalcs_extended){high, (double)(x - high)};
}

static inline long double dalcs_extended_value(struct dalcs_extended x) {
    return (long double)x.high + x.low;
}

/* To about 100 bits of the larger of both. */
static inline struct dalcs_extended dalcs_extended_plus(struct dalcs_extended a,
                                                        struct dalcs_extended b) {
    double high = a.high + b.high;
    double of_b = high - a.high;
    double low = (a.high - (high - of_b)) + (b.high - of_b) + (a.low + b.low);
    double sum = high + low;
    return (struct dalcs_extended){sum, low - (sum - high)};
}

/* The scale is a power of 2. */
static inline struct dalcs_extended dalcs_extended_scaled(double high, double low, double scale) {
    return (struct dalcs_extended){high * scale, low * scale};
}

/* A short row. */
enum { DALCS_EXTENDED_ROW = 12 };

struct dalcs_extended_row {
    double high[DALCS_EXTENDED_ROW], low[DALCS_EXTENDED_ROW];
};

static inline long double dalcs_extended_at(const struct dalcs_extended_row *row, int i) {
    return (long double)row->high[i] + row->low[i];
}

static inline void dalcs_extended_put(struct dalcs_extended_row *row, int i, long double x) {
    struct dalcs_extended pair = dalcs_extended_of(x);
    row->high[i] = pair.high;
    row->low[i] = pair.low;
}

/* sum = factor[0] * row[of[0]] + ... + factor[n - 1] * row[of[n - 1]] in the first `width` places, rounded up to
 * whole quads; of == NULL: of the first n rows. Row k is high[2 k room], its low ones follow `room` behind; so
 * with the sum, which is none of them. */
void dalcs_extended_combine_long(size_t room, int width, int n, const struct dalcs_extended *factor,
                                 const double *high, const int *of, double *sum);

static inline void dalcs_extended_combine(int width, int n, const struct dalcs_extended *factor,
                                          const struct dalcs_extended_row *row, const int *of,
                                          struct dalcs_extended_row *sum) {
    dalcs_extended_combine_long(DALCS_EXTENDED_ROW, width, n, factor, (const double *)row, of,
                                (double *)sum);
}

/* to[i] = row[i] * scale + shift, rounded once, likewise. The scale is a power of 2. */
void dalcs_extended_round(int width, const struct dalcs_extended_row *row, double scale,
                          double shift, double *to);

#endif
