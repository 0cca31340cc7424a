/* collocation.c - the methods, as computed when dalcs was built, and their polynomials. */
#include "collocation.h"

#include "quads.h"
#include "wide_vectors.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Of C11, but glibc has them for gcc alone. */
#ifndef CMPLX
#define CMPLX(re, im)  __builtin_complex((double)(re), (double)(im))
#define CMPLXL(re, im) __builtin_complex((long double)(re), (long double)(im))
#endif

static const struct dalcs_collocation METHODS[] = {
#include "collocation_table.h"
};

const struct dalcs_collocation *dalcs_collocation_of(enum dalcs_family family, int n_stages) {
    const struct dalcs_collocation *found = NULL;
    for (size_t k = 0; k < sizeof(METHODS) / sizeof(METHODS[0]); k++) {
        bool is = METHODS[k].family == family && METHODS[k].n_stages == n_stages;
        found = is ? &METHODS[k] : found;
    }
    return found;
}

/* Barycentric weights over the distances from theta. */
DALCS_TWICE(void, divide_by_distances,
            (const struct dalcs_collocation *c, double theta, double *weight), (c, theta, weight)) {
    for (int k = 0; k <= c->s; k += DALCS_QUAD) {
        dalcs_quad node;
        dalcs_quad of;
        dalcs_quad_load(&node, c->node + k);
        dalcs_quad_load(&of, c->barycentric + k);
        of /= theta - node;
        dalcs_quad_store(weight + k, &of);
    }
}

DALCS_TWICE(void, divide_by_sum, (int n, double sum, double *weight), (n, sum, weight)) {
    for (int k = 0; k < n; k += DALCS_QUAD) {
        dalcs_quad of;
        dalcs_quad_load(&of, weight + k);
        of /= sum;
        dalcs_quad_store(weight + k, &of);
    }
}

/* At a node the quotients mean nothing. */
static void take_node(const struct dalcs_collocation *c, double theta, double *weight) {
    for (int k = 0; k <= c->s; k++) {
        weight[k] = theta == c->node[k] ? 1.0 : 0.0;
    }
}

void dalcs_collocation_parts(const struct dalcs_collocation *c, const double *at_stages,
                             struct dalcs_extended_row *part) {
    struct dalcs_extended factor[DALCS_MAX_STAGES];
    for (int i = 0; i < c->n_stages; i++) {
        factor[i] = (struct dalcs_extended){at_stages[i], 0.0};
    }
    dalcs_extended_combine(1 + 2 * c->n_pairs, c->n_stages, factor, c->exact.from, NULL, part);
}

void dalcs_collocation_weights(const struct dalcs_collocation *c, double theta, double *weight) {
    divide_by_distances(c, theta, weight);
    double sum = 0.0;
    for (int k = 0; k <= c->s; k++) {
        sum += weight[k];
    }
    if (fabs(sum) <= DBL_MAX) {
        divide_by_sum(c->s + 1, sum, weight);
    } else {
        take_node(c, theta, weight);
    }
}

/* Lagrange's form: the barycentric weights are those of all nodes. */
void dalcs_collocation_weights_from(const struct dalcs_collocation *c, int first, double theta,
                                    double *weight) {
    for (int i = 0; i <= c->s; i++) {
        weight[i] = i < first ? 0.0 : 1.0;
        for (int j = first; j <= c->s && i >= first; j++) {
            weight[i] *= j != i ? (theta - c->node[j]) / (c->node[i] - c->node[j]) : 1.0;
        }
    }
}
