/* collocation.c - the methods, as computed when dalcs was built, and their polynomials. */
#include "collocation.h"

#include <string.h>

/* Of C11, but glibc has them for gcc alone. */
#ifndef CMPLX
#define CMPLX(re, im)  __builtin_complex((double)(re), (double)(im))
#define CMPLXL(re, im) __builtin_complex((long double)(re), (long double)(im))
#endif

static const struct dalcs_collocation METHODS[] = {
#include "collocation_table.h"
};

const struct dalcs_collocation *dalcs_collocation_of(int s) {
    return &METHODS[(s - 1) / 2];
}

void dalcs_collocation_weights(const struct dalcs_collocation *c, double theta, double *weight) {
    double sum = 0.0;
    for (int k = 0; k <= c->s; k++) {
        double distance = theta - c->node[k];
        if (distance == 0.0) {
            memset(weight, 0, (size_t)(c->s + 1) * sizeof(*weight));
            weight[k] = 1.0;
            return;
        }
        weight[k] = c->barycentric[k] / distance;
        sum += weight[k];
    }
    for (int k = 0; k <= c->s; k++) {
        weight[k] /= sum;
    }
}
