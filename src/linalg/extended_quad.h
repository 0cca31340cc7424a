/* extended_quad.h - four sums of products with twice a double's digits: for extended_*.c alone.
 *
 * Each number is a double and what it lacks. Errors of sums and products are found exactly (Knuth; Dekker, Numer.
 * Math. 18, 1971), those of what is lacked are left, so that a sum of products has about 100 bits. */
#ifndef DALCS_EXTENDED_QUAD_H
#define DALCS_EXTENDED_QUAD_H

#include "quads.h"

#define DALCS_INLINE static inline __attribute__((always_inline))

struct dalcs_extended_quad {
    dalcs_quad high, low;
};

/* a + b, as a double and what it lacks. */
DALCS_INLINE void dalcs_add_exactly(const dalcs_quad *a, const dalcs_quad *b, dalcs_quad *sum,
                                    dalcs_quad *lack) {
    dalcs_quad s = *a + *b;
    dalcs_quad of_b = s - *a;
    *lack = (*a - (s - of_b)) + (*b - of_b);
    *sum = s;
}

DALCS_INLINE void dalcs_add_product(struct dalcs_extended_quad *sum,
                                    const struct dalcs_extended_quad *a,
                                    const struct dalcs_extended_quad *b) {
    dalcs_quad rest;
    dalcs_quad lack;
    dalcs_quad product = a->high * b->high;
    for (int k = 0; k < DALCS_QUAD; k++) {
        rest[k] = __builtin_fma(a->high[k], b->high[k], -product[k]);
    }
    rest += a->high * b->low + a->low * b->high;
    dalcs_add_exactly(&sum->high, &product, &sum->high, &lack);
    sum->low += rest + lack;
}

/* After sums: the high ones become the nearest doubles. */
DALCS_INLINE void dalcs_settle(struct dalcs_extended_quad *a) {
    dalcs_add_exactly(&a->high, &a->low, &a->high, &a->low);
}

#endif
