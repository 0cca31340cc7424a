/* make_nodes.c - polynomials and rules of quadrature, in extended precision. Runs while dalcs is built. */
#include "make_tables.h"

real dalcs_size_of(real x) {
    return x < 0 ? -x : x;
}

real dalcs_larger_real(real a, real b) {
    return a > b ? a : b;
}

real dalcs_real_power(real x, int n) {
    real product = 1;
    for (int k = 0; k < n; k++) {
        product *= x;
    }
    return product;
}

/* Legendre polynomials of degree n and n - 1 at t. */
static void legendre(int n, real t, real *p, real *before) {
    real a = 1.0L; /* degree 0 */
    real b = 0.0L;
    for (int k = 1; k <= n; k++) {
        real next = ((real)(2 * k - 1) * t * a - (real)(k - 1) * b) / (real)k;
        b = a;
        a = next;
    }
    *p = a;
    *before = b;
}

real dalcs_node_polynomial(int n, enum nodes nodes, real t) {
    real p;
    real before;
    legendre(n, t, &p, &before);
    return nodes == GAUSS ? p : nodes == RADAU ? p - before : t * before - p;
}

int dalcs_roots_in_unit_interval(int n, enum nodes nodes, real *root) {
    int found = 0;
    for (int k = 0; k < SCAN && found < n; k++) {
        real a = (real)k / SCAN;
        real b = (real)(k + 1) / SCAN;
        real at_a = dalcs_node_polynomial(n, nodes, 2 * a - 1);
        if (at_a == 0.0L) {
            if (a > 0.0L) {
                root[found++] = a;
            }
            continue;
        }
        if (k == SCAN - 1 || at_a * dalcs_node_polynomial(n, nodes, 2 * b - 1) >= 0.0L) {
            continue;
        }
        for (int round = 0; round < 130; round++) {
            real middle = 0.5L * (a + b);
            bool left = at_a * dalcs_node_polynomial(n, nodes, 2 * middle - 1) <= 0.0L;
            *(left ? &b : &a) = middle;
        }
        root[found++] = 0.5L * (a + b);
    }
    return found;
}

void dalcs_lagrange(int n, const real *node, real x, real *value) {
    for (int j = 0; j < n; j++) {
        value[j] = 1.0L;
        for (int k = 0; k < n; k++) {
            value[j] *= k != j ? (x - node[k]) / (node[j] - node[k]) : 1.0L;
        }
    }
}

void dalcs_gauss_rule(int n, real *node, real *weight) {
    (void)dalcs_roots_in_unit_interval(n, GAUSS, node);
    for (int g = 0; g < n; g++) {
        real p;
        real before;
        real t = 2 * node[g] - 1;
        legendre(n, t, &p, &before);
        real slope = (real)n * before / (1 - t * t); /* P_n(t) = 0 */
        weight[g] = 1 / ((1 - t * t) * slope * slope);
    }
}
