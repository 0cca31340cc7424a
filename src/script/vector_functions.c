/* vector_functions.c - what a name with parentheses gives: of each value, of a whole vector, of several. */
#include "vector_formula.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Of each value --------------------------------------------------------------------------------- */

static double complex db_of(double complex x) {
    return 20.0 * log10(cabs(x));
}

static double complex angle_of(double complex x) {
    return carg(x);
}

static double complex magnitude_of(double complex x) {
    return cabs(x);
}

static double complex real_of(double complex x) {
    return creal(x);
}

static double complex imaginary_of(double complex x) {
    return cimag(x);
}

static double complex log_of(double complex x) {
    return cimag(x) == 0.0 ? log(creal(x)) : clog(x);
}

static double complex log10_of(double complex x) {
    return cimag(x) == 0.0 ? log10(creal(x)) : clog(x) / log(10.0);
}

static double complex root_of(double complex x) {
    return cimag(x) == 0.0 && creal(x) >= 0.0 ? sqrt(creal(x)) : csqrt(x);
}

static double complex floor_of(double complex x) {
    return floor(creal(x));
}

static double complex ceiling_of(double complex x) {
    return ceil(creal(x));
}

static double complex nearest_of(double complex x) {
    return nearbyint(creal(x));
}

static double complex not_of(double complex x) {
    return x == 0.0;
}

static double complex is_positive(double complex x) {
    return creal(x) > 0.0;
}

static double complex times_j(double complex x) {
    return x * I;
}

/* A function of the C library that a table names is searched for whenever the program starts; one that is
 * called, when it is called first. */
#define CALL(f)                                                                                    \
    static double complex call_##f(double complex x) {                                             \
        return f(x);                                                                               \
    }
CALL(cexp)
CALL(csin)
CALL(ccos)
CALL(ctan)
CALL(catan)
CALL(csinh)
CALL(ccosh)
CALL(ctanh)
CALL(conj)

/* What `set units = degrees` makes of an argument and of a value. */
static double turned(const struct dalcs_vector_formula *f, const char *name, bool is_value) {
    static const char *const of_angles[] = {"sin", "cos", "tan"};
    static const char *const to_angles[] = {"ph", "phase", "atan"};
    const double degrees = 180.0 / 3.141592653589793;
    bool is = false;
    for (size_t k = 0; k < sizeof of_angles / sizeof of_angles[0]; k++) {
        is = is || strcmp(name, is_value ? to_angles[k] : of_angles[k]) == 0;
    }
    return !is || !f->vectors->in_degrees ? 1.0 : is_value ? degrees : 1.0 / degrees;
}

static const struct {
    const char *name;
    double complex (*of)(double complex x);
    bool gives_reals;
} EACH[] = {
    {"abs", magnitude_of, true}, {"mag", magnitude_of, true},  {"magnitude", magnitude_of, true},
    {"m", magnitude_of, true},   {"ph", angle_of, true},       {"phase", angle_of, true},
    {"db", db_of, true},         {"re", real_of, true},        {"real", real_of, true},
    {"im", imaginary_of, true},  {"imag", imaginary_of, true}, {"sqrt", root_of, false},
    {"exp", call_cexp, false},   {"ln", log_of, false},        {"log", log_of, false},
    {"log10", log10_of, false},  {"sin", call_csin, false},    {"cos", call_ccos, false},
    {"tan", call_ctan, false},   {"atan", call_catan, false},  {"sinh", call_csinh, false},
    {"cosh", call_ccosh, false}, {"tanh", call_ctanh, false},  {"floor", floor_of, true},
    {"ceil", ceiling_of, true},  {"nint", nearest_of, true},   {"not", not_of, true},
    {"pos", is_positive, true},  {"conj", call_conj, false},   {"j", times_j, false},
};

/* ---- Of a whole vector -------------------------------------------------------------------------------- */

static double complex mean_of(const struct dalcs_vector *v) {
    double complex sum = 0.0;
    for (size_t k = 0; k < v->n; k++) {
        sum += v->value[k];
    }
    return v->n > 0 ? sum / (double)v->n : NAN;
}

static double complex deviation_of(const struct dalcs_vector *v) {
    const double complex mean = mean_of(v);
    double sum = 0.0;
    for (size_t k = 0; k < v->n; k++) {
        const double off = cabs(v->value[k] - mean);
        sum += off * off;
    }
    return v->n > 1 ? sqrt(sum / (double)(v->n - 1)) : 0.0;
}

static double complex largest_of(const struct dalcs_vector *v) {
    double largest = v->n > 0 ? creal(v->value[0]) : NAN;
    for (size_t k = 1; k < v->n; k++) {
        largest = fmax(largest, creal(v->value[k]));
    }
    return largest;
}

static double complex smallest_of(const struct dalcs_vector *v) {
    double smallest = v->n > 0 ? creal(v->value[0]) : NAN;
    for (size_t k = 1; k < v->n; k++) {
        smallest = fmin(smallest, creal(v->value[k]));
    }
    return smallest;
}

static double complex length_of(const struct dalcs_vector *v) {
    return (double)v->n;
}

static const struct {
    const char *name;
    double complex (*of)(const struct dalcs_vector *v);
} WHOLE[] = {
    {"mean", mean_of},    {"vecmax", largest_of},  {"maximum", largest_of},
    {"max", largest_of},  {"vecmin", smallest_of}, {"minimum", smallest_of},
    {"min", smallest_of}, {"length", length_of},   {"stddev", deviation_of},
};

/* ---- Of several ------------------------------------------------------------------------------------------ */

/* The larger or smaller of two, value by value. */
static struct dalcs_vector *of_pair(struct dalcs_vector_formula *f, const char *name,
                                    const struct dalcs_vector *a, const struct dalcs_vector *b) {
    const bool is_max = strcmp(name, "max") == 0;
    if (!is_max && strcmp(name, "min") != 0) {
        return strcmp(name, "pow") == 0 || strcmp(name, "pwr") == 0
                   ? dalcs_vector_combine(f, DALCS_VECTOR_POWER, a, b)
                   : dalcs_vector_fail(f, "there is no function '%s' of two", name);
    }
    struct dalcs_vector *v = dalcs_vector_combine(f, DALCS_VECTOR_ADD, a, b);
    for (size_t k = 0; v != NULL && k < v->n; k++) {
        const double x = creal(a->value[a->n == 1 ? 0 : k]);
        const double y = creal(b->value[b->n == 1 ? 0 : k]);
        v->value[k] = is_max ? fmax(x, y) : fmin(x, y);
    }
    return v;
}

/* The body, in which the parameters are these values. */
static struct dalcs_vector *call_definition(struct dalcs_vector_formula *f,
                                            const struct dalcs_definition *definition,
                                            const struct dalcs_vector *const *argument) {
    struct dalcs_vector_formula inner = {.vectors = f->vectors,
                                         .definitions = f->definitions,
                                         .text = definition->body,
                                         .arena = f->arena,
                                         .definition = definition,
                                         .argument = argument,
                                         .depth = f->depth + 1};
    struct dalcs_vector *v = dalcs_vector_formula_next(&inner);
    if (v != NULL && !dalcs_vector_formula_at_end(&inner)) {
        v = dalcs_vector_fail(&inner, "did not expect '%.60s'", inner.text + inner.at);
    }
    if (v == NULL) {
        f->out_of_memory = inner.out_of_memory;
        snprintf(f->hint, sizeof f->hint, "%.150s", inner.hint);
        return dalcs_vector_fail(f, "in %.30s(): %.120s", definition->name, inner.message);
    }
    return v;
}

struct dalcs_vector *dalcs_vector_call(struct dalcs_vector_formula *f, const char *name,
                                       const struct dalcs_vector *const *argument, size_t n) {
    const struct dalcs_definition *defined = dalcs_definitions_find(f->definitions, name, n);
    const struct dalcs_vector *x = argument[0];
    if (defined != NULL) {
        return call_definition(f, defined, argument);
    }
    if (n == 2) {
        return of_pair(f, name, argument[0], argument[1]);
    }
    for (size_t i = 0; n == 1 && i < sizeof EACH / sizeof EACH[0]; i++) {
        if (strcmp(EACH[i].name, name) == 0) {
            struct dalcs_vector *v =
                dalcs_vector_alike(f, x, x->is_complex && !EACH[i].gives_reals);
            const double in = turned(f, name, false), out = turned(f, name, true);
            for (size_t k = 0; v != NULL && k < x->n; k++) {
                v->value[k] = out * EACH[i].of(in * x->value[k]);
                v->is_complex = v->is_complex || cimag(v->value[k]) != 0.0;
            }
            return v;
        }
    }
    for (size_t i = 0; n == 1 && i < sizeof WHOLE / sizeof WHOLE[0]; i++) {
        if (strcmp(WHOLE[i].name, name) == 0) {
            return dalcs_vector_number(f, WHOLE[i].of(x));
        }
    }
    dalcs_vector_function *along = n == 1 ? dalcs_vector_along(name) : NULL;
    if (along != NULL) {
        return along(f, x);
    }
    if (n == 1 && dalcs_vector_is_random(name)) {
        return dalcs_vector_random(f, name, x);
    }
    return dalcs_vector_fail(
        f, n == 1 ? "there is no function '%s'" : "there is no function '%s' of so many arguments",
        name);
}
