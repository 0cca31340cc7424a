/* make_tables.c - nodes, eigenvectors and polynomial bases of a method, in extended precision. Runs while dalcs is
 * built, as a part of make_collocation.c. */
#include "make_tables.h"

#include <math.h>

enum { INVERSE_ROUNDS = 4 };

static void put(struct dalcs_extended_row *row, int i, real x) {
    row->high[i] = (double)x;
    row->low[i] = (double)(x - (real)row->high[i]);
}

/* Of a complex number, up to a factor of sqrt(2). */
static real extent(complex_real x) {
    return dalcs_larger_real(dalcs_size_of(__real__ x), dalcs_size_of(__imag__ x));
}

/* A_ij = integral of the j-th Lagrange polynomial from 0 to c_i, by Gauss' rule, which is exact. */
static void butcher_matrix(int s, const real *c, const real *gauss, const real *weight,
                           real A[MAX][MAX]) {
    for (int i = 0; i < s; i++) {
        for (int j = 0; j < s; j++) {
            A[i][j] = 0.0L;
        }
        for (int g = 0; g < s; g++) {
            real value[MAX];
            dalcs_lagrange(s, c, c[i] * gauss[g], value);
            for (int j = 0; j < s; j++) {
                A[i][j] += c[i] * weight[g] * value[j];
            }
        }
    }
}

/* Of Lobatto IIIC, from that of IIIA, whose stages are the same but for a multiple of what all polynomials
 * of a degree below s - 1 have none of, their last divided difference: A_ij = b_j at the start, stage s - 1. */
static void start_freely(int s, const real *c, real A[MAX][MAX]) {
    real difference[MAX];
    for (int j = 0; j < s; j++) {
        difference[j] = 1.0L;
        for (int k = 0; k < s; k++) {
            difference[j] /= k != j ? c[j] - c[k] : 1.0L;
        }
    }
    real at_start = A[s - 2][s - 1];
    for (int i = 0; i < s; i++) {
        real multiple = (at_start - A[i][s - 1]) / difference[s - 1];
        for (int j = 0; j < s; j++) {
            A[i][j] += multiple * difference[j];
        }
    }
}

/* The eigenvalues of A^-1 are the poles of the stability function, the (k, s) Pade approximant of
 * exp, k = s - 1 for Radau IIA and s - 2 for Lobatto IIIC (Hairer and Wanner, sec. IV.3, eq. (3.29)): all
 * at once by Weierstrass' iteration. */
static void eigenvalues(int k_and_s, int s, complex_real *mu) {
    real coefficient[MAX + 1];
    coefficient[0] = 1.0L;
    for (int j = 1; j <= s; j++) {
        coefficient[j] = -coefficient[j - 1] * (real)(s - j + 1) / (real)((k_and_s + 1 - j) * j);
    }
    complex_real start = 0.4L + 0.9L * I;
    for (int i = 0; i < s; i++) {
        mu[i] = i > 0 ? mu[i - 1] * start : (real)s;
    }
    for (int round = 0; round < 500; round++) {
        for (int i = 0; i < s; i++) {
            complex_real value = coefficient[s];
            for (int j = s - 1; j >= 0; j--) {
                value = value * mu[i] + coefficient[j];
            }
            complex_real others = coefficient[s];
            for (int k = 0; k < s; k++) {
                others *= k != i ? mu[i] - mu[k] : 1.0L;
            }
            mu[i] -= value / others;
        }
    }
}

/* Solves a v = b, overwriting both, by elimination with row exchanges; a pivot of 0 counts as a
 * rounding, as inverse iteration needs it. */
static void solve_small(int n, complex_real a[MAX][MAX], complex_real *b) {
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++) {
            pivot = extent(a[i][k]) > extent(a[pivot][k]) ? i : pivot;
        }
        for (int j = 0; j < n; j++) {
            complex_real swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        complex_real swap = b[k];
        b[k] = b[pivot];
        b[pivot] = swap;
        if (extent(a[k][k]) < (real)1e-40L) {
            a[k][k] = (real)1e-40L;
        }
        for (int i = k + 1; i < n; i++) {
            complex_real factor = a[i][k] / a[k][k];
            for (int j = k; j < n; j++) {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) {
            b[i] -= a[i][j] * b[j];
        }
        b[i] /= a[i][i];
    }
}

/* v with (I - mu A) v = 0, or its transpose, by inverse iteration. */
static void eigenvector(int s, real A[MAX][MAX], complex_real mu, bool transposed,
                        complex_real *v) {
    for (int i = 0; i < s; i++) {
        v[i] = 1.0L + 0.1L * (real)i;
    }
    for (int round = 0; round < INVERSE_ROUNDS; round++) {
        complex_real a[MAX][MAX];
        for (int i = 0; i < s; i++) {
            for (int j = 0; j < s; j++) {
                a[i][j] = (i == j ? 1.0L : 0.0L) - mu * (transposed ? A[j][i] : A[i][j]);
            }
        }
        solve_small(s, a, v);
        real largest = 0.0L;
        for (int i = 0; i < s; i++) {
            largest = dalcs_larger_real(largest, extent(v[i]));
        }
        for (int i = 0; i < s; i++) {
            v[i] /= largest;
        }
    }
}

static void diagonalise(struct dalcs_collocation *c, real A[MAX][MAX]) {
    int s = c->n_stages;
    complex_real mu[MAX];
    eigenvalues(c->s + s - 1, s, mu);
    for (int k = 0; k < s; k++) {
        if (__imag__(mu[k]) < -1e-9L) {
            continue; /* the conjugate of another */
        }
        complex_real right[MAX];
        complex_real left[MAX];
        eigenvector(s, A, mu[k], false, right);
        eigenvector(s, A, mu[k], true, left);
        complex_real of_one = 0.0L;
        complex_real product = 0.0L;
        for (int i = 0; i < s; i++) {
            of_one += left[i];
            product += left[i] * right[i];
        }
        bool is_real = __imag__(mu[k]) <= 1e-9L;
        for (int i = 0; i < s; i++) {
            complex_real back = left[i] / of_one;
            complex_real forth = right[i] * of_one / product;
            if (is_real) {
                put(&c->exact.from[i], 0, __real__(back));
                put(&c->exact.to[0], i, __real__(forth));
            } else {
                int part = 1 + 2 * c->n_pairs;
                put(&c->exact.from[i], part, __real__(back));
                put(&c->exact.from[i], part + 1, __imag__(back));
                put(&c->exact.to[part], i, 2 * __real__(forth)); /* 2 Re(to W) */
                put(&c->exact.to[part + 1], i, -2 * __imag__(forth));
            }
        }
        if (is_real) {
            c->exact.lambda = __real__(mu[k]);
            c->lambda = (double)__real__(mu[k]);
        } else {
            c->exact.mu[c->n_pairs] = mu[k];
            c->mu[c->n_pairs++] = (double complex)mu[k];
        }
    }
}

static real product_of_differences(int n, const real *node, real x) {
    real product = 1.0L;
    for (int k = 0; k < n; k++) {
        product *= x - node[k];
    }
    return product;
}

static void choose_test_node(struct dalcs_collocation *c, const real *node) {
    int n = c->s + 1;
    real worst = 0.0L;
    for (int k = 1; k < SCAN; k++) {
        real x = (real)k / SCAN;
        real size = dalcs_size_of(product_of_differences(n, node, x));
        if (size > worst) {
            worst = size;
            c->worst.size = (double)size;
            c->worst.node = (double)x;
        }
    }
    real value[MAX];
    dalcs_lagrange(n, node, c->worst.node, value);
    real steepest = 0.0L;
    for (int i = 0; i < n; i++) {
        c->worst.value[i] = (double)value[i];
        real slope = 1.0L;
        for (int k = 0; k < n; k++) {
            slope *= k != i ? node[i] - node[k] : 1.0L;
        }
        steepest = i > 0 ? dalcs_larger_real(steepest, dalcs_size_of(slope)) : 0.0L;
    }
    c->worst.factor = fmax(1.0, (double)(steepest / worst) / c->lambda);
}

/* Values at the nodes to coefficients of Bernstein's polynomials, between whose least and largest
 * the polynomial stays. */
static void bernstein_matrix(struct dalcs_collocation *c, const real *node) {
    int n = c->s + 1;
    real spread = 0.0L;
    for (int k = 0; k < n; k++) {
        complex_real a[MAX][MAX];
        complex_real b[MAX];
        for (int i = 0; i < n; i++) {
            real binomial = 1.0L;
            for (int j = 0; j < n; j++) {
                a[i][j] = binomial * dalcs_real_power(node[i], j) *
                          dalcs_real_power(1 - node[i], n - 1 - j);
                binomial = binomial * (real)(n - 1 - j) / (real)(j + 1);
            }
            b[i] = i == k ? 1.0L : 0.0L;
        }
        solve_small(n, a, b);
        for (int j = 0; j < n; j++) {
            c->bernstein.from_nodes[k][j] = (double)__real__(b[j]);
        }
    }
    for (int j = 0; j < n; j++) {
        real sum = 0.0L;
        for (int k = 0; k < n; k++) {
            sum += dalcs_size_of(c->bernstein.from_nodes[k][j]);
        }
        spread = dalcs_larger_real(spread, 0.5L * (sum - 1.0L));
    }
    c->bernstein.spread = (double)spread;
    c->bernstein.binomial[0] = 1.0;
    for (int j = 0; j < c->s; j++) {
        c->bernstein.binomial[j + 1] = c->bernstein.binomial[j] * (c->s - j) / (j + 1);
    }
}

/* How far a polynomial leaves the range of its values at the nodes, by Lebesgue's constant, which the
 * scan may miss by a little. */
static void find_spread(struct dalcs_collocation *c, const real *node) {
    real largest = 1.0L;
    for (int i = 0; i <= SCAN; i++) {
        real value[MAX];
        real sum = 0.0L;
        dalcs_lagrange(c->s + 1, node, (real)i / SCAN, value);
        for (int k = 0; k <= c->s; k++) {
            sum += dalcs_size_of(value[k]);
        }
        largest = dalcs_larger_real(largest, sum);
    }
    c->spread = (double)(0.5L * (1.001L * largest - 1.0L));
}

/* Each next node is the one for which the product of its distances to those before is largest (L. Reichel, BIT 30,
 * 1990): values of a polynomial in Newton's form are then as exact as its values at the nodes, but for a factor
 * of about 20 with ten nodes, and of 1e5 with the same in ascending order. */
static void order_nodes(struct dalcs_collocation *c, const real *node) {
    bool used[MAX] = {false};
    for (int k = 0; k <= c->s; k++) {
        real largest = -1.0L;
        for (int i = 0; i <= c->s; i++) {
            real product = 1.0L;
            for (int j = 0; j < k; j++) {
                product *= dalcs_size_of(node[i] - node[c->differences.order[j]]);
            }
            if (!used[i] && product > largest) {
                largest = product;
                c->differences.order[k] = i;
            }
        }
        used[c->differences.order[k]] = true;
        c->differences.node[k] = (double)node[c->differences.order[k]];
    }
    for (int k = 1; k <= c->s; k++) {
        real inverse = 1.0L;
        for (int coefficient = 1; coefficient <= c->s; coefficient++) {
            int other = coefficient <= k ? coefficient - 1 : coefficient;
            inverse /= node[c->differences.order[k]] - node[c->differences.order[other]];
            c->differences.coefficient[k][coefficient] = coefficient >= k ? (double)inverse : 0.0;
        }
    }
}

void dalcs_make_tables(struct dalcs_collocation *c, enum dalcs_family family, int n_stages) {
    bool starts = family == DALCS_LOBATTO_IIIC; /* with a stage there, behind the others */
    int s = starts ? n_stages - 1 : n_stages;
    *c = (struct dalcs_collocation){.family = family, .s = s, .n_stages = n_stages};
    real node[MAX] = {0.0L};
    (void)dalcs_roots_in_unit_interval(n_stages, starts ? LOBATTO : RADAU, node + 1);
    node[s] = 1.0L;
    for (int i = 0; i <= s; i++) {
        c->node[i] = (double)node[i];
        real weight = 1.0L;
        for (int k = 0; k <= s; k++) {
            weight *= k != i ? node[i] - node[k] : 1.0L;
        }
        c->barycentric[i] = (double)(1.0L / weight);
    }
    order_nodes(c, node);
    real A[MAX][MAX];
    real gauss[MAX];
    real gauss_weight[MAX];
    dalcs_gauss_rule(n_stages, gauss, gauss_weight);
    butcher_matrix(n_stages, node + 1, gauss, gauss_weight, A);
    if (starts) {
        start_freely(n_stages, node + 1, A);
    }
    for (int i = 0; i < n_stages; i++) {
        c->weight[i] = (double)A[s - 1][i];
    }
    for (int i = 0; i < MAX; i++) {
        c->quadrature.node[i] = i < n_stages ? (double)gauss[i] : 1.0;
        c->quadrature.weight[i] = i < n_stages ? (double)gauss_weight[i] : 0.0;
    }
    diagonalise(c, A);
    real value[MAX];
    dalcs_lagrange(n_stages, node + 1, 0.0L, value);
    for (int i = 0; i < n_stages; i++) {
        c->exact.back[i] = value[i];
        c->back[i] = (double)value[i];
    }
    for (int part = 0; part < 1 + 2 * c->n_pairs && !starts; part++) {
        real at_0 = 0;
        for (int i = 0; i < s; i++) {
            at_0 += value[i] * ((real)c->exact.to[part].high[i] + c->exact.to[part].low[i]);
        }
        put(&c->exact.to[part], s, at_0);
    }
    choose_test_node(c, node);
    bernstein_matrix(c, node);
    find_spread(c, node);
}
