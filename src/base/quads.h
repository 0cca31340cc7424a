/* quads.h - four numbers side by side: loops over short rows that compare as they go, which compilers
 * do not turn into vectors by themselves.
 *
 * By address, as how vectors are passed depends on the machine. In each element the result is that of
 * the plain operation, whatever the machine. */
#ifndef DALCS_QUADS_H
#define DALCS_QUADS_H

#include <stdint.h>
#include <string.h>

enum { DALCS_QUAD = 4 };

typedef double dalcs_quad __attribute__((vector_size(32)));
typedef int64_t dalcs_quad_bits __attribute__((vector_size(32)));

/* How many of them are as good as n numbers, all in whole quads. */
static inline int dalcs_quads_of(int n) {
    return (n + DALCS_QUAD - 1) / DALCS_QUAD * DALCS_QUAD;
}

static inline void dalcs_quad_load(dalcs_quad *q, const double *from) {
    memcpy(q, from, sizeof(*q));
}

/* By way of memory: of four equal elements gcc 14 says at -O3 that they may have no value. */
static inline void dalcs_quad_fill(dalcs_quad *q, double with) {
    const double all[DALCS_QUAD] = {with, with, with, with};
    dalcs_quad_load(q, all);
}

static inline void dalcs_quad_store(double *to, const dalcs_quad *q) {
    memcpy(to, q, sizeof(*q));
}

/* Where `with` is smaller: that; so with larger. NaN in `with` changes nothing. */
static inline void dalcs_quad_lower(dalcs_quad *q, const dalcs_quad *with) {
    dalcs_quad least = *q;
    for (int i = 0; i < DALCS_QUAD; i++) {
        least[i] = (*with)[i] < least[i] ? (*with)[i] : least[i];
    }
    *q = least;
}

static inline void dalcs_quad_raise(dalcs_quad *q, const dalcs_quad *with) {
    dalcs_quad largest = *q;
    for (int i = 0; i < DALCS_QUAD; i++) {
        largest[i] = (*with)[i] > largest[i] ? (*with)[i] : largest[i];
    }
    *q = largest;
}

/* Its absolute values. */
static inline void dalcs_quad_unsign(dalcs_quad *q) {
    const dalcs_quad_bits all_but_sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
    *q = (dalcs_quad)((dalcs_quad_bits)*q & all_but_sign);
}

/* The first n as they are, 0 beyond. */
static inline void dalcs_quad_keep(dalcs_quad *q, int n) {
    const dalcs_quad_bits index = {0, 1, 2, 3};
    *q = (dalcs_quad)((dalcs_quad_bits)*q & (index < (int64_t)n));
}

/* The bits that mask[] has. */
static inline void dalcs_quad_mask(dalcs_quad *q, const uint64_t *mask) {
    dalcs_quad_bits bits;
    memcpy(&bits, mask, sizeof(bits));
    *q = (dalcs_quad)((dalcs_quad_bits)*q & bits);
}

static inline double dalcs_quad_largest(const dalcs_quad *q) {
    double a = (*q)[0] > (*q)[1] ? (*q)[0] : (*q)[1];
    double b = (*q)[2] > (*q)[3] ? (*q)[2] : (*q)[3];
    return a > b ? a : b;
}

#endif
