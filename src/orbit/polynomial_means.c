/* polynomial_means.c - integrals of polynomials times exp(-j kappa theta). */
#include "polynomial_means.h"

#include <math.h>

/* j[n] = spherical Bessel functions j_k(x), by Miller's recurrence downward where x is small against n, else upward
 * (Abramowitz and Stegun, 10.5). */
static void spherical_bessel(int n, double x, double *j) {
    enum { AHEAD = 40 };

    const double first = fabs(x) < 1e-8 ? 1.0 : sin(x) / x;
    if (x > n) {
        double before = cos(x) / x; /* j_-1 */
        j[0] = first;
        for (int k = 0; k + 1 < n; k++) {
            j[k + 1] = (2 * k + 1) / x * j[k] - before;
            before = j[k];
        }
        return;
    }
    if (x < 1e-30) {
        for (int k = 0; k < n; k++) {
            j[k] = k == 0 ? 1.0 : 0.0;
        }
        return;
    }
    double above = 0.0;
    double now = 1e-300;
    for (int k = n + AHEAD; k >= 0; k--) {
        if (k < n) {
            j[k] = now;
        }
        double below = (2 * k + 1) / x * now - above;
        above = now;
        now = below;
        if (fabs(now) > 1e200) { /* what is above then counts for nothing, unless it is asked for */
            now *= 1e-200;
            above *= 1e-200;
            for (int i = k < n ? k : n; i < n; i++) {
                j[i] *= 1e-200;
            }
        }
    }
    /* j_0 may be 0 where j_1 is not */
    double j1 = x < 1e-2 ? x / 3.0 * (1.0 - x * x / 10.0) : (sin(x) / x - cos(x)) / x;
    double scale = fabs(first) >= fabs(j1) || n < 2 ? first / j[0] : j1 / j[1];
    for (int k = 0; k < n; k++) {
        j[k] *= scale;
    }
}

void dalcs_mean_weights(const struct dalcs_periodic_flow *flow, double kappa,
                        double complex *weight) {
    static const double complex minus_j[4] = {1.0, -I, -1.0, I};
    const int n = flow->stages.layout.n_nodes;
    const double half = 0.5 * fabs(kappa);
    double j[DALCS_MAX_NODES];
    double complex moment[DALCS_MAX_NODES];
    spherical_bessel(n, half, j);
    for (int k = 0; k < n; k++) {
        moment[k] = minus_j[k % 4] * cexp(-I * half) * j[k];
        moment[k] = kappa < 0.0 ? conj(moment[k]) : moment[k];
    }
    for (int i = 0; i < n; i++) {
        weight[i] = 0.0;
        for (int k = 0; k < n; k++) {
            weight[i] += flow->legendre[k][i] * moment[k];
        }
    }
}
