/* extended_quad.h - four sums of products with twice a double's digits: for extended_*.c alone.
 *
 * Each number is a double and what it lacks. Errors of sums and products are found exactly (Knuth; Dekker, Numer.
 * Math. 18, 1971), those of what is lacked are left, so that a sum of products has about 100 bits. */
#ifndef DALCS_EXTENDED_QUAD_H
#define DALCS_EXTENDED_QUAD_H

#include "quads.h"

#include <stdbool.h>

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

/* In two halves that have no more than 26 bits each (Veltkamp). */
DALCS_INLINE void dalcs_halve(const dalcs_quad *a, dalcs_quad *high, dalcs_quad *low) {
    dalcs_quad large = *a * 0x8000001p0;
    *high = large - (large - *a);
    *low = *a - *high;
}

/* What the product lacks of a * b, exactly, as long as nothing overflows. */
DALCS_INLINE void dalcs_find_lack(bool fused, const dalcs_quad *a, const dalcs_quad *b,
                                  const dalcs_quad *product, dalcs_quad *lack) {
    if (fused) {
        dalcs_quad exact = {0.0};
        for (int k = 0; k < DALCS_QUAD; k++) {
            exact[k] = __builtin_fma((*a)[k], (*b)[k], -(*product)[k]);
        }
        *lack = exact;
        return;
    }
    dalcs_quad a_high;
    dalcs_quad a_low;
    dalcs_quad b_high;
    dalcs_quad b_low;
    dalcs_halve(a, &a_high, &a_low);
    dalcs_halve(b, &b_high, &b_low);
    *lack = ((a_high * b_high - *product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

DALCS_INLINE void dalcs_add_product(bool fused, struct dalcs_extended_quad *sum,
                                    const struct dalcs_extended_quad *a,
                                    const struct dalcs_extended_quad *b) {
    dalcs_quad rest;
    dalcs_quad lack;
    dalcs_quad product = a->high * b->high;
    dalcs_find_lack(fused, &a->high, &b->high, &product, &rest);
    rest += a->high * b->low + a->low * b->high;
    dalcs_add_exactly(&sum->high, &product, &sum->high, &lack);
    sum->low += rest + lack;
}

/* After sums: the high ones become the nearest doubles. */
DALCS_INLINE void dalcs_settle(struct dalcs_extended_quad *a) {
    dalcs_add_exactly(&a->high, &a->low, &a->high, &a->low);
}

#endif
