/* exponentials.h - functions of exponentials that do not overflow, and keep their digits on both sides. */
#ifndef DALCS_EXPONENTIALS_H
#define DALCS_EXPONENTIALS_H

#include <math.h>

/* 1/(1 + exp(-x)) */
static inline double dalcs_logistic(double x) {
    const double small = exp(-fabs(x));
    return (x < 0 ? small : 1.0) / (1.0 + small);
}

/* ln(1 + exp(x)) */
static inline double dalcs_softplus(double x) {
    return (x > 0 ? x : 0.0) + log1p(exp(-fabs(x)));
}

/* x/(exp(x) - 1), 1 at 0 */
static inline double dalcs_bernoulli(double x) {
    return x == 0 ? 1.0 : x / expm1(x);
}

/* Its derivative; near 0, where that is a difference of nearly equal numbers, by its series. */
static inline double dalcs_bernoulli_slope(double x) {
    return fabs(x) < 0.01 ? -0.5 + x / 6.0 - x * x * x / 180.0
                          : dalcs_bernoulli(x) * (1.0 - dalcs_bernoulli(-x)) / x;
}

#endif
