/* affine.c - sums of a few products, in the order of the states. */
#include "affine.h"

#include "extremes.h"
#include "quads.h"
#include "wide_vectors.h"

#include <math.h>
#include <stdbool.h>

void dalcs_affine_compose(int n_x, const struct dalcs_affine_rows *of, const long double *inner,
                          long double *to) {
    for (int i = 0; i < of->n; i++) {
        const double *row = of->row + i * (n_x + 1);
        for (int j = 0; j <= n_x; j++) {
            long double sum = j == n_x ? row[n_x] : 0.0L;
            for (int k = 0; k < n_x; k++) {
                sum += row[k] * inner[k * (n_x + 1) + j];
            }
            to[i * (n_x + 1) + j] = sum;
        }
    }
}

void dalcs_affine_round(int n_x, int n, const long double *from, double *to) {
    for (int k = 0; k < n * (n_x + 1); k++) {
        to[k] = (double)from[k];
    }
}

void dalcs_affine_quads_put(int n_x, const long double *row, struct dalcs_affine_quads *all) {
    int i = all->n++;
    double *to = all->number + i / DALCS_QUAD * DALCS_QUAD * (n_x + 1) + i % DALCS_QUAD;
    *to = (double)row[n_x];
    for (int k = 0; k < n_x; k++) {
        to += DALCS_QUAD;
        *to = (double)row[k];
    }
}

void dalcs_affine_quads_fill_up(int n_x, struct dalcs_affine_quads *all) {
    int n_last = all->n % DALCS_QUAD;
    double *quad = all->number + all->n / DALCS_QUAD * DALCS_QUAD * (n_x + 1);
    for (int k = 0; k <= n_x && n_last > 0; k++, quad += DALCS_QUAD) {
        for (int i = n_last; i < DALCS_QUAD; i++) {
            quad[i] = quad[n_last - 1];
        }
    }
    all->n = dalcs_quads_of(all->n);
}

DALCS_TWICE(double, find_least, (int n_x, const struct dalcs_affine_quads *all, const double *x),
            (n_x, all, x)) {
    const double *number = all->number;
    dalcs_quad least = {INFINITY, INFINITY, INFINITY, INFINITY};
    for (int i = 0; i < all->n; i += DALCS_QUAD) {
        dalcs_quad value;
        dalcs_quad_load(&value, number);
        number += DALCS_QUAD;
        for (int k = 0; k < n_x; k++, number += DALCS_QUAD) {
            dalcs_quad factor;
            dalcs_quad_load(&factor, number);
            value += factor * x[k];
        }
        dalcs_quad_lower(&least, &value);
    }
    return dalcs_smaller(dalcs_smaller(least[0], least[1]), dalcs_smaller(least[2], least[3]));
}

double dalcs_affine_quads_least(int n_x, const struct dalcs_affine_quads *all, const double *x) {
    return find_least(n_x, all, x);
}

/* The states after one map; false: one of them is too far. n_x is known to the compiler where it matters. */
static inline __attribute__((always_inline)) bool pass_once(int n_x, const double *map,
                                                            const double *x, const double *near,
                                                            const double *most, double *later) {
    bool is_near = true;
#pragma GCC unroll 4
    for (int k = 0; k < n_x; k++, map += n_x + 1) {
        double value = map[n_x];
#pragma GCC unroll 4
        for (int i = 0; i < n_x; i++) {
            value += map[i] * x[i];
        }
        later[k] = value;
        is_near = is_near && fabs(value - near[k]) <= most[k];
    }
    return is_near;
}

static inline __attribute__((always_inline)) long pass(int n_x, const double *map,
                                                       const double *near, const double *most,
                                                       long times, double **states) {
    long n = 0;
    while (n < times && pass_once(n_x, map, states[0], near, most, states[1])) {
        dalcs_affine_swap(states);
        n++;
    }
    return n;
}

long dalcs_affine_pass(int n_x, const double *map, const double *near, const double *most,
                       long times, double **states) {
    switch (n_x) { /* a converter has one or two */
    case 1:
        return pass(1, map, near, most, times, states);
    case 2:
        return pass(2, map, near, most, times, states);
    default:
        return pass(n_x, map, near, most, times, states);
    }
}
