/* calculus.c - what looks along a vector and its scale. */
#include "vector_formula.h"

#include <math.h>

static const double TURN = 6.283185307179586;

void dalcs_calculus_unwrap(double complex *value, size_t n) {
    double turns = 0.0;
    double before = n > 0 ? creal(value[0]) : 0.0;
    for (size_t k = 1; k < n; k++) {
        const double now = creal(value[k]);
        turns -= round((now - before) / TURN) * TURN;
        before = now;
        value[k] = now + turns;
    }
}

/* The derivative at x of the parabola through three values, by Newton's divided differences. */
static double complex slope(const double complex *y, const double complex *s, double x) {
    const double a = creal(s[0]), b = creal(s[1]), c = creal(s[2]);
    const double complex first = (y[1] - y[0]) / (b - a);
    const double complex second = ((y[2] - y[1]) / (c - b) - first) / (c - a);
    return first + second * (2.0 * x - a - b);
}

/* Of rows begin to end - 1, between which the scale does not stand still. */
static void derive_stretch(double complex *to, const double complex *value,
                           const double complex *scale, size_t begin, size_t end) {
    for (size_t k = begin; k < end; k++) {
        if (end - begin == 1) {
            to[k] = 0.0;
        } else if (end - begin == 2) {
            to[k] = (value[end - 1] - value[begin]) / creal(scale[end - 1] - scale[begin]);
        } else {
            size_t first = k > begin ? k - 1 : begin;
            first = first + 3 > end ? end - 3 : first;
            to[k] = slope(&value[first], &scale[first], creal(scale[k]));
        }
    }
}

void dalcs_calculus_derivative(double complex *to, const double complex *value,
                               const double complex *scale, size_t n) {
    for (size_t begin = 0, end; begin < n; begin = end) {
        end = begin + 1;
        while (end < n && creal(scale[end]) != creal(scale[end - 1])) {
            end++;
        }
        derive_stretch(to, value, scale, begin, end);
    }
}

void dalcs_calculus_integral(double complex *to, const double complex *value,
                             const double complex *scale, size_t n) {
    double complex sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        if (k > 0) {
            sum += 0.5 * (value[k] + value[k - 1]) * creal(scale[k] - scale[k - 1]);
        }
        to[k] = sum;
    }
}

double complex dalcs_calculus_interpolate(const double complex *value, const double complex *scale,
                                          size_t n, double at) {
    size_t low = 0, high = n; /* the last row that is not behind it is in low..high-1 */
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (creal(scale[middle]) <= at) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const double from = creal(scale[low]);
    if (low + 1 == n || at <= from) {
        return value[low];
    }
    const double part = (at - from) / (creal(scale[low + 1]) - from);
    return value[low] + part * (value[low + 1] - value[low]);
}
