/* extended_rows.c - see extended_rows.h. */
#include "extended_rows.h"

#include "extended_quad.h"
#include "wide_vectors.h"

enum { MOST_QUADS = 3 };

/* Some quads at once: each waits for its own sums, not for those of the others. */
DALCS_INLINE void combine_quads(bool fused, int n_quads, size_t room, int n,
                                const struct dalcs_extended *factor, const double *high,
                                const int *of, double *to) {
    struct dalcs_extended_quad sum[MOST_QUADS];
#pragma GCC unroll 3
    for (int q = 0; q < n_quads; q++) {
        sum[q] = (struct dalcs_extended_quad){{0.0}, {0.0}};
    }
    for (int k = 0; k < n; k++) {
        const double *row = high + 2 * room * (size_t)(of != NULL ? of[k] : k);
        struct dalcs_extended_quad times;
        dalcs_quad_fill(&times.high, factor[k].high);
        dalcs_quad_fill(&times.low, factor[k].low);
#pragma GCC unroll 3
        for (int q = 0; q < n_quads; q++) {
            struct dalcs_extended_quad element;
            dalcs_quad_load(&element.high, row + q * DALCS_QUAD);
            dalcs_quad_load(&element.low, row + room + q * DALCS_QUAD);
            dalcs_add_product(fused, &sum[q], &times, &element);
        }
    }
#pragma GCC unroll 3
    for (int q = 0; q < n_quads; q++) {
        dalcs_settle(&sum[q]);
        dalcs_quad_store(to + q * DALCS_QUAD, &sum[q].high);
        dalcs_quad_store(to + room + q * DALCS_QUAD, &sum[q].low);
    }
}

DALCS_TWICE_FUSED(void, combine,
                  (DALCS_FUSED, size_t room, int width, int n, const struct dalcs_extended *factor,
                   const double *high, const int *of, double *sum),
                  (true, room, width, n, factor, high, of, sum),
                  (fused, room, width, n, factor, high, of, sum)) {
    for (; width > 2 * DALCS_QUAD; width -= 3 * DALCS_QUAD) {
        combine_quads(fused, 3, room, n, factor, high, of, sum);
        high += 3 * DALCS_QUAD;
        sum += 3 * DALCS_QUAD;
    }
    if (width > DALCS_QUAD) {
        combine_quads(fused, 2, room, n, factor, high, of, sum);
    } else if (width > 0) {
        combine_quads(fused, 1, room, n, factor, high, of, sum);
    }
}

void dalcs_extended_combine_long(size_t room, int width, int n, const struct dalcs_extended *factor,
                                 const double *high, const int *of, double *sum) {
    combine(DALCS_FUSES, room, width, n, factor, high, of, sum);
}

DALCS_TWICE(void, round_row,
            (int width, const struct dalcs_extended_row *row, double scale, double shift,
             double *to),
            (width, row, scale, shift, to)) {
    const dalcs_quad shifts = {shift, shift, shift, shift};
    for (int i = 0; i < width; i += DALCS_QUAD) {
        dalcs_quad high;
        dalcs_quad low;
        dalcs_quad lack;
        dalcs_quad_load(&high, row->high + i);
        dalcs_quad_load(&low, row->low + i);
        high *= scale;
        dalcs_add_exactly(&high, &shifts, &high, &lack);
        high += lack + low * scale;
        dalcs_quad_store(to + i, &high);
    }
}

void dalcs_extended_round(int width, const struct dalcs_extended_row *row, double scale,
                          double shift, double *to) {
    round_row(width, row, scale, shift, to);
}
