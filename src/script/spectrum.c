/* spectrum.c - windows and transforms. */
#include "spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double TURN = 6.283185307179586;

/* ---- Windows --------------------------------------------------------------------------------------- */

/* Sums of cosines: 1 + a1 cos(u) + a2 cos(2 u) + ..., which have a mean of 1 (Harris 1978). */
static const struct {
    const char *name;
    double a[4];
} COSINES[] = {
    {"none", {0}},
    {"rectangular", {0}},
    {"hanning", {-1.0}},
    {"hann", {-1.0}},
    {"cosine", {-1.0}},
    {"hamming", {-0.46 / 0.54}},
    {"blackman", {-0.50 / 0.42, 0.08 / 0.42}},
    {"blackmanharris", {-0.48829 / 0.35875, 0.14128 / 0.35875, -0.01168 / 0.35875}},
    {"flattop", {-1.93, 1.29, -0.388, 0.032}},
};

static void fill_cosines(const double a[4], double *weight, size_t n) {
    for (size_t k = 0; k < n; k++) {
        const double u = TURN * (double)(k + 1) / (double)n; /* the last row is at a full turn */
        weight[k] = 1.0;
        for (int i = 0; i < 4; i++) {
            weight[k] += a[i] * cos((i + 1) * u);
        }
    }
}

/* Divided by its mean. */
static void fill_shape(bool is_gaussian, int order, double *weight, size_t n) {
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        const double x = 2.0 * (double)(k + 1) / (double)n - 1.0; /* -1 to 1 */
        weight[k] = is_gaussian ? exp(-0.5 * pow(order * x, 2.0)) : 1.0 - fabs(x);
        sum += weight[k];
    }
    for (size_t k = 0; k < n && sum > 0.0; k++) {
        weight[k] *= (double)n / sum;
    }
}

bool dalcs_spectrum_window(const char *name, int order, double *weight, size_t n) {
    for (size_t k = 0; k < sizeof COSINES / sizeof COSINES[0]; k++) {
        if (strcmp(COSINES[k].name, name) == 0) {
            fill_cosines(COSINES[k].a, weight, n);
            return true;
        }
    }
    const bool is_gaussian = strcmp(name, "gaussian") == 0;
    if (!is_gaussian && strcmp(name, "triangle") != 0 && strcmp(name, "bartlett") != 0 &&
        strcmp(name, "bartlet") != 0) {
        return false;
    }
    fill_shape(is_gaussian, order, weight, n);
    return true;
}

/* ---- Transforms ------------------------------------------------------------------------------------- */

/* In place, n a power of 2, root[k] = exp(-2 pi i k/n) for k < n/2 (Cooley and Tukey 1965). */
static void transform_power_of_2(double complex *x, const double complex *root, size_t n) {
    for (size_t k = 1, reversed = 0; k < n; k++) {
        size_t bit = n >> 1;
        for (; (reversed & bit) != 0; bit >>= 1) {
            reversed ^= bit;
        }
        reversed |= bit;
        if (k < reversed) {
            const double complex other = x[k];
            x[k] = x[reversed];
            x[reversed] = other;
        }
    }
    for (size_t half = 1; half < n; half *= 2) {
        for (size_t begin = 0; begin < n; begin += 2 * half) {
            for (size_t k = 0; k < half; k++) {
                const double complex a = x[begin + k];
                const double complex b = x[begin + k + half] * root[k * (n / (2 * half))];
                x[begin + k] = a + b;
                x[begin + k + half] = a - b;
            }
        }
    }
}

static double complex *roots_of(size_t n) {
    double complex *root = dalcs_alloc(n / 2 + 1, sizeof *root);
    for (size_t k = 0; root != NULL && k <= n / 2; k++) {
        root[k] = cexp(-TURN * I * ((double)k / (double)n));
    }
    return root;
}

/* exp(-pi i k k/n), k k taken modulo 2 n, so that no digits are lost. */
static double complex chirp(size_t k, size_t n) {
    const size_t square = (k % (2 * n)) * (k % (2 * n)) % (2 * n);
    return cexp(-0.5 * TURN * I * ((double)square / (double)n));
}

/* j k = (j j + k k - (k - j)(k - j))/2 makes the sum a convolution with a chirp (Bluestein 1970). */
static enum dalcs_status transform_any(double complex *to, const double *x, size_t n) {
    size_t m = 1;
    while (m < 2 * n - 1) {
        m *= 2;
    }
    double complex *root = roots_of(m);
    double complex *a = dalcs_alloc(m, sizeof *a);
    double complex *b = dalcs_alloc(m, sizeof *b);
    enum dalcs_status status = DALCS_E_NOMEM;
    if (root != NULL && a != NULL && b != NULL) {
        for (size_t k = 0; k < n; k++) {
            const double complex c = chirp(k, n);
            a[k] = x[k] * c;
            b[k] = conj(c);
            b[k > 0 ? m - k : 0] = conj(c);
        }
        transform_power_of_2(a, root, m);
        transform_power_of_2(b, root, m);
        for (size_t k = 0; k < m; k++) {
            a[k] = conj(a[k] * b[k]); /* the inverse transform is that of the conjugates */
        }
        transform_power_of_2(a, root, m);
        for (size_t k = 0; k < n; k++) {
            to[k] = conj(a[k]) / (double)m * chirp(k, n);
        }
        status = DALCS_OK;
    }
    free(root);
    free(a);
    free(b);
    return status;
}

enum dalcs_status dalcs_spectrum_transform(double complex *to, const double *x, size_t n) {
    if (n == 0 || (n & (n - 1)) != 0) {
        return n == 0 ? DALCS_OK : transform_any(to, x, n);
    }
    double complex *root = roots_of(n);
    if (root == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        to[k] = x[k];
    }
    transform_power_of_2(to, root, n);
    free(root);
    return DALCS_OK;
}
