/* vector_values.c - values of formulas: all are vectors, a number one of length 1. */
#include "vector_formula.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct dalcs_vector *dalcs_vector_fail(struct dalcs_vector_formula *f, const char *format, ...) {
    if (!f->failed) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(f->message, sizeof f->message, format, arguments);
        va_end(arguments);
    }
    f->failed = true;
    return NULL;
}

struct dalcs_vector *dalcs_vector_make(struct dalcs_vector_formula *f, size_t n, bool is_complex) {
    struct dalcs_vector *v = dalcs_arena_alloc(f->arena, 1, sizeof *v);
    double complex *value = dalcs_arena_alloc(f->arena, n, sizeof *value);
    if (v == NULL || value == NULL) {
        f->out_of_memory = true;
        return dalcs_vector_fail(f, "out of memory");
    }
    *v = (struct dalcs_vector){
        .name = "", .unit = DALCS_UNIT_NONE, .n = n, .is_complex = is_complex, .value = value};
    return v;
}

struct dalcs_vector *dalcs_vector_number(struct dalcs_vector_formula *f, double complex value) {
    struct dalcs_vector *v = dalcs_vector_make(f, 1, cimag(value) != 0.0);
    if (v != NULL) {
        v->value[0] = value;
    }
    return v;
}

struct dalcs_vector *dalcs_vector_copy(struct dalcs_vector_formula *f,
                                       const struct dalcs_vector *v) {
    struct dalcs_vector *copy = dalcs_vector_make(f, v->n, v->is_complex);
    if (copy != NULL) {
        memcpy(copy->value, v->value, v->n * sizeof *v->value);
        copy->unit = v->unit;
        copy->scale = v->scale;
    }
    return copy;
}

static double complex apply(enum dalcs_vector_operation operation, double complex a,
                            double complex b) {
    const double x = creal(a);
    const double y = creal(b);
    const bool is_real = cimag(a) == 0.0 && cimag(b) == 0.0;
    switch (operation) {
    case DALCS_VECTOR_ADD:
        return a + b;
    case DALCS_VECTOR_SUBTRACT:
        return a - b;
    case DALCS_VECTOR_MULTIPLY:
        return is_real ? x * y : a * b;
    case DALCS_VECTOR_DIVIDE:
        return is_real ? x / y : a / b;
    case DALCS_VECTOR_REMAINDER:
        return fmod(x, y);
    case DALCS_VECTOR_POWER:
        return is_real ? pow(x, y) : cpow(a, b);
    case DALCS_VECTOR_LESS:
        return x < y;
    case DALCS_VECTOR_LESS_EQUAL:
        return x <= y;
    case DALCS_VECTOR_GREATER:
        return x > y;
    case DALCS_VECTOR_GREATER_EQUAL:
        return x >= y;
    case DALCS_VECTOR_EQUAL:
        return a == b;
    case DALCS_VECTOR_UNEQUAL:
        return a != b;
    case DALCS_VECTOR_AND:
        return a != 0.0 && b != 0.0;
    case DALCS_VECTOR_OR:
        return a != 0.0 || b != 0.0;
    }
    return NAN;
}

struct dalcs_vector *dalcs_vector_combine(struct dalcs_vector_formula *f,
                                          enum dalcs_vector_operation operation,
                                          const struct dalcs_vector *a,
                                          const struct dalcs_vector *b) {
    if (a == NULL || b == NULL) {
        return NULL;
    }
    if (a->n != b->n && a->n != 1 && b->n != 1) {
        return dalcs_vector_fail(f, "vectors of different lengths, %zu and %zu", a->n, b->n);
    }
    const struct dalcs_vector *longer = a->n == 1 ? b : a;
    struct dalcs_vector *v = dalcs_vector_make(f, longer->n, a->is_complex || b->is_complex);
    for (size_t k = 0; v != NULL && k < v->n; k++) {
        v->value[k] = apply(operation, a->value[a->n == 1 ? 0 : k], b->value[b->n == 1 ? 0 : k]);
    }
    if (v != NULL) {
        const bool is_sum = operation == DALCS_VECTOR_ADD || operation == DALCS_VECTOR_SUBTRACT;
        v->unit = is_sum && a->unit == b->unit ? a->unit : DALCS_UNIT_NONE;
        v->scale = longer->scale;
    }
    return v;
}
