/* vector_along.c - functions that make a vector of another one, in which each value depends on those beside it. */
#include "vector_formula.h"

#include <math.h>
#include <string.h>

static const double TURN = 6.283185307179586;

struct dalcs_vector *dalcs_vector_alike(struct dalcs_vector_formula *f,
                                        const struct dalcs_vector *x, bool is_complex) {
    struct dalcs_vector *v = dalcs_vector_make(f, x->n, is_complex);
    if (v != NULL) {
        v->scale = x->scale;
    }
    return v;
}

static struct dalcs_vector *running_mean(struct dalcs_vector_formula *f,
                                         const struct dalcs_vector *x) {
    struct dalcs_vector *v = dalcs_vector_alike(f, x, x->is_complex);
    double complex sum = 0.0;
    for (size_t k = 0; v != NULL && k < x->n; k++) {
        sum += x->value[k];
        v->value[k] = sum / (double)(k + 1);
    }
    return v;
}

static struct dalcs_vector *normalised(struct dalcs_vector_formula *f,
                                       const struct dalcs_vector *x) {
    struct dalcs_vector *v = dalcs_vector_alike(f, x, x->is_complex);
    double largest = 0.0;
    for (size_t k = 0; k < x->n; k++) {
        largest = fmax(largest, cabs(x->value[k]));
    }
    for (size_t k = 0; v != NULL && k < x->n; k++) {
        v->value[k] = x->value[k] / (largest > 0.0 ? largest : 1.0);
    }
    return v;
}

static struct dalcs_vector *continuous_phase(struct dalcs_vector_formula *f,
                                             const struct dalcs_vector *x) {
    struct dalcs_vector *v = dalcs_vector_alike(f, x, false);
    for (size_t k = 0; v != NULL && k < x->n; k++) {
        v->value[k] = carg(x->value[k]);
    }
    if (v != NULL) {
        dalcs_calculus_unwrap(v->value, v->n);
    }
    return v;
}

/* Radians of what `set units` says. */
static double radians(const struct dalcs_vector_formula *f) {
    return f->vectors->in_degrees ? 3.141592653589793 / 180.0 : 1.0;
}

static struct dalcs_vector *continuous_angle(struct dalcs_vector_formula *f,
                                             const struct dalcs_vector *x) {
    struct dalcs_vector *v = continuous_phase(f, x);
    for (size_t k = 0; v != NULL && k < v->n; k++) {
        v->value[k] /= radians(f);
    }
    return v;
}

static struct dalcs_vector *unwrapped(struct dalcs_vector_formula *f,
                                      const struct dalcs_vector *x) {
    struct dalcs_vector *v = dalcs_vector_alike(f, x, false);
    if (v != NULL) {
        for (size_t k = 0; k < v->n; k++) {
            v->value[k] = radians(f) * x->value[k];
        }
        dalcs_calculus_unwrap(v->value, v->n);
        for (size_t k = 0; k < v->n; k++) {
            v->value[k] /= radians(f);
        }
    }
    return v;
}

/* The scale that it goes along; NULL: it has none. */
static const struct dalcs_vector *scale_of(struct dalcs_vector_formula *f, const char *name,
                                           const struct dalcs_vector *x) {
    if (x->scale == NULL || x->scale->n != x->n) {
        (void)dalcs_vector_fail(f, "%s() takes a vector of a run", name);
        return NULL;
    }
    return x->scale;
}

static struct dalcs_vector *derivative(struct dalcs_vector_formula *f,
                                       const struct dalcs_vector *x) {
    const struct dalcs_vector *scale = scale_of(f, "deriv", x);
    struct dalcs_vector *v = scale != NULL ? dalcs_vector_alike(f, x, x->is_complex) : NULL;
    if (v != NULL) {
        dalcs_calculus_derivative(v->value, x->value, scale->value, x->n);
    }
    return v;
}

static struct dalcs_vector *integral(struct dalcs_vector_formula *f, const struct dalcs_vector *x) {
    const struct dalcs_vector *scale = scale_of(f, "integ", x);
    struct dalcs_vector *v = scale != NULL ? dalcs_vector_alike(f, x, x->is_complex) : NULL;
    if (v != NULL) {
        dalcs_calculus_integral(v->value, x->value, scale->value, x->n);
    }
    return v;
}

static struct dalcs_vector *group_delay(struct dalcs_vector_formula *f,
                                        const struct dalcs_vector *x) {
    const struct dalcs_vector *scale = scale_of(f, "group_delay", x);
    const struct dalcs_vector *phase = scale != NULL ? continuous_phase(f, x) : NULL;
    struct dalcs_vector *v = phase != NULL ? dalcs_vector_alike(f, x, false) : NULL;
    if (v != NULL) {
        dalcs_calculus_derivative(v->value, phase->value, scale->value, x->n);
        for (size_t k = 0; k < v->n; k++) {
            v->value[k] /= -TURN;
        }
    }
    return v;
}

/* A vector of another plot on the scale of the current one. */
static struct dalcs_vector *interpolated(struct dalcs_vector_formula *f,
                                         const struct dalcs_vector *x) {
    const struct dalcs_vector *from = scale_of(f, "interpolate", x);
    const struct dalcs_vector *to = dalcs_vectors_scale(f->vectors);
    if (from == NULL || to == NULL) {
        return dalcs_vector_fail(f, "interpolate() needs a plot with a scale");
    }
    struct dalcs_vector *v = dalcs_vector_make(f, to->n, x->is_complex);
    for (size_t k = 0; v != NULL && k < to->n; k++) {
        v->value[k] = dalcs_calculus_interpolate(x->value, from->value, x->n, creal(to->value[k]));
    }
    if (v != NULL) {
        v->scale = to;
    }
    return v;
}

static struct dalcs_vector *counted(struct dalcs_vector_formula *f, const struct dalcs_vector *x,
                                    const char *name) {
    const double n = x->n == 1 ? creal(x->value[0]) : -1.0;
    if (!(n >= 1.0 && n <= 1e8)) {
        return dalcs_vector_fail(f, "%s() takes a length", name);
    }
    struct dalcs_vector *v = dalcs_vector_make(f, (size_t)n, false);
    for (size_t k = 0; v != NULL && k < v->n; k++) {
        v->value[k] = name[0] == 'u' ? 1.0 : (double)k;
    }
    return v;
}

static struct dalcs_vector *vector_of(struct dalcs_vector_formula *f,
                                      const struct dalcs_vector *x) {
    return counted(f, x, "vector");
}

static struct dalcs_vector *ones_of(struct dalcs_vector_formula *f, const struct dalcs_vector *x) {
    return counted(f, x, "unitvec");
}

static const struct {
    const char *name;
    dalcs_vector_function *of;
} ALONG[] = {
    {"avg", running_mean},        {"norm", normalised},         {"cph", continuous_angle},
    {"cphase", continuous_angle}, {"unwrap", unwrapped},        {"deriv", derivative},
    {"integ", integral},          {"group_delay", group_delay}, {"interpolate", interpolated},
    {"vector", vector_of},        {"unitvec", ones_of},
};

dalcs_vector_function *dalcs_vector_along(const char *name) {
    for (size_t i = 0; i < sizeof ALONG / sizeof ALONG[0]; i++) {
        if (strcmp(ALONG[i].name, name) == 0) {
            return ALONG[i].of;
        }
    }
    return NULL;
}
