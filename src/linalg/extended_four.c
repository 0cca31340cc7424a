/* extended_four.c - Gauss elimination of four systems at once: what is added and multiplied are vectors, and zeros
 * are skipped for all at once. */
#include "extended_four.h"

#include "extended_quad.h"
#include "wide_vectors.h"

#include <math.h>
#include <stddef.h>

struct complex_quad {
    struct dalcs_extended_quad re, im;
};

DALCS_INLINE void load(struct complex_quad *q, const struct dalcs_extended_four *from) {
    dalcs_quad_load(&q->re.high, from->re);
    dalcs_quad_load(&q->re.low, from->re_low);
    dalcs_quad_load(&q->im.high, from->im);
    dalcs_quad_load(&q->im.low, from->im_low);
}

DALCS_INLINE void store(struct dalcs_extended_four *to, struct complex_quad *q) {
    dalcs_settle(&q->re);
    dalcs_settle(&q->im);
    dalcs_quad_store(to->re, &q->re.high);
    dalcs_quad_store(to->re_low, &q->re.low);
    dalcs_quad_store(to->im, &q->im.high);
    dalcs_quad_store(to->im_low, &q->im.low);
}

DALCS_INLINE void negate(struct dalcs_extended_quad *to, const struct dalcs_extended_quad *a) {
    to->high = -a->high;
    to->low = -a->low;
}

/* sum += a * b */
DALCS_INLINE void add_complex(bool fused, struct complex_quad *sum, const struct complex_quad *a,
                              const struct complex_quad *b) {
    struct dalcs_extended_quad minus;
    negate(&minus, &a->im);
    dalcs_add_product(fused, &sum->re, &a->re, &b->re);
    dalcs_add_product(fused, &sum->re, &minus, &b->im);
    dalcs_add_product(fused, &sum->im, &a->re, &b->im);
    dalcs_add_product(fused, &sum->im, &a->im, &b->re);
}

/* 1 / d: in double precision, then by a step of Newton's, which doubles the digits. */
DALCS_INLINE void invert(bool fused, struct complex_quad *inverse, const struct complex_quad *d) {
    const dalcs_quad square = d->re.high * d->re.high + d->im.high * d->im.high;
    struct complex_quad minus = {{-d->re.high / square, {0.0}}, {d->im.high / square, {0.0}}};
    struct complex_quad error = {{{1.0, 1.0, 1.0, 1.0}, {0.0}}, {{0.0}, {0.0}}};
    add_complex(fused, &error, &minus, d);
    const dalcs_quad re = error.re.high + error.re.low;
    const dalcs_quad im = error.im.high + error.im.low;
    inverse->re.high = -minus.re.high;
    inverse->im.high = -minus.im.high;
    inverse->re.low = inverse->re.high * re - inverse->im.high * im;
    inverse->im.low = inverse->re.high * im + inverse->im.high * re;
}

/* Row `pivot` over what it has in column c, which the others then have nothing of: in columns behind c. */
DALCS_TWICE_FUSED(void, clear_column,
                  (DALCS_FUSED, int n, int width, int pivot, int c, struct dalcs_extended_four *a,
                   bool *filled),
                  (true, n, width, pivot, c, a, filled), (fused, n, width, pivot, c, a, filled)) {
    struct dalcs_extended_four *row = a + (size_t)pivot * (size_t)width;
    const bool *in_row = filled + (size_t)pivot * (size_t)width;
    struct complex_quad d;
    struct complex_quad inverse;
    load(&d, &row[c]);
    invert(fused, &inverse, &d);
    for (int j = c + 1; j < width; j++) {
        if (in_row[j]) {
            struct complex_quad element;
            struct complex_quad quotient = {0};
            load(&element, &row[j]);
            add_complex(fused, &quotient, &inverse, &element);
            store(&row[j], &quotient);
        }
    }
    for (int i = 0; i < n; i++) {
        struct dalcs_extended_four *other = a + (size_t)i * (size_t)width;
        bool *in_other = filled + (size_t)i * (size_t)width;
        if (i == pivot || !in_other[c]) {
            continue;
        }
        struct complex_quad factor;
        struct complex_quad minus;
        load(&factor, &other[c]);
        negate(&minus.re, &factor.re);
        negate(&minus.im, &factor.im);
        for (int j = c + 1; j < width; j++) {
            if (in_row[j]) {
                struct complex_quad element;
                struct complex_quad sum;
                load(&element, &row[j]);
                load(&sum, &other[j]);
                add_complex(fused, &sum, &minus, &element);
                store(&other[j], &sum);
                in_other[j] = true;
            }
        }
    }
}

/* Of the four, the smallest |re| + |im|. */
static double size_of(const struct dalcs_extended_four *a) {
    double least = INFINITY;
    for (int k = 0; k < DALCS_QUAD; k++) {
        double size = fabs(a->re[k]) + fabs(a->im[k]);
        least = size < least ? size : least;
    }
    return least;
}

static void swap_rows(int width, struct dalcs_extended_four *a, bool *filled, int i, int k) {
    for (int j = 0; j < width && i != k; j++) {
        size_t one = (size_t)i * (size_t)width + (size_t)j;
        size_t other = (size_t)k * (size_t)width + (size_t)j;
        struct dalcs_extended_four element = a[one];
        a[one] = a[other];
        a[other] = element;
        bool is_filled = filled[one];
        filled[one] = filled[other];
        filled[other] = is_filled;
    }
}

double dalcs_extended_solve_four(int n, int n_rhs, struct dalcs_extended_four *a, bool *filled) {
    const int width = n + n_rhs;
    double least = INFINITY;
    for (int k = 0; k < n; k++) {
        int pivot = k;
        double largest = 0.0;
        for (int i = k; i < n; i++) {
            size_t at = (size_t)i * (size_t)width + (size_t)k;
            double size = filled[at] ? size_of(&a[at]) : 0.0;
            if (size > largest) {
                largest = size;
                pivot = i;
            }
        }
        if (!(largest > 0.0)) {
            return 0.0;
        }
        least = largest < least ? largest : least;
        swap_rows(width, a, filled, k, pivot);
        clear_column(DALCS_FUSES, n, width, k, k, a, filled);
    }
    return least;
}
