/* excitation_function.c - the functions of theta that sources are sums of, and what polynomials miss of them. */
#include "excitation.h"

#include "rounding.h"

#include <math.h>

static double fading(const struct dalcs_excitation_function *f, double h, double theta) {
    return f->decay == 0.0 ? 1.0 : exp(-f->decay * h * theta);
}

/* P_degree(2 theta - 1), by the recurrence. */
static double legendre(int degree, double theta) {
    double before = 0.0;
    double now = 1.0;
    for (int k = 0; k < degree; k++) {
        double next = ((2 * k + 1) * (2.0 * theta - 1.0) * now - k * before) / (k + 1);
        before = now;
        now = next;
    }
    return now;
}

double dalcs_excitation_function_at(const struct dalcs_excitation_function *f, double h,
                                    double theta) {
    switch (f->shape) {
    case DALCS_EXCITATION_LEVEL:
        return 1.0;
    case DALCS_EXCITATION_RAMP:
        return theta;
    case DALCS_EXCITATION_COSINE:
        return fading(f, h, theta) * cos(f->omega * h * theta);
    case DALCS_EXCITATION_SINE:
        return fading(f, h, theta) * sin(f->omega * h * theta);
    case DALCS_EXCITATION_NODE: {
        double weight[DALCS_MAX_NODES];
        dalcs_collocation_weights(f->method, theta, weight);
        return weight[f->node];
    }
    case DALCS_EXCITATION_BETWEEN:
        return 0.0;
    case DALCS_EXCITATION_LEGENDRE:
        return legendre(f->degree, theta);
    }
    return 0.0;
}

/* What it adds at the test node. */
static double next_derivative(const struct dalcs_excitation_function *f,
                              const struct dalcs_collocation *method, double h) {
    double derivative = method->worst.size;
    double rate = hypot(f->decay, f->omega) * h;
    for (int k = 0; k <= method->s; k++) {
        derivative *= rate / (k + 1);
    }
    return derivative;
}

double dalcs_excitation_missed(const struct dalcs_excitation_function *f,
                               const struct dalcs_collocation *method, double h,
                               const double *value) {
    if (f->shape == DALCS_EXCITATION_LEVEL || f->shape == DALCS_EXCITATION_RAMP ||
        f->shape == DALCS_EXCITATION_NODE || f->shape == DALCS_EXCITATION_LEGENDRE) {
        return 0.0;
    }
    if (f->shape == DALCS_EXCITATION_BETWEEN) {
        return 1.0;
    }
    double missed = dalcs_excitation_function_at(f, h, method->worst.node);
    double size = fabs(missed);
    for (int k = 0; k <= method->s; k++) {
        missed -= method->worst.value[k] * value[k];
        size += fabs(method->worst.value[k] * value[k]);
    }
    return fabs(missed) > dalcs_rounded * size ? missed : next_derivative(f, method, h);
}
