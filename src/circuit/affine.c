/* affine.c - sums of quantities with coefficients. */
#include "behaviour.h"
#include "rounding.h"

#include <float.h>
#include <math.h>

struct dalcs_affine dalcs_affine_constant(double constant) {
    return (struct dalcs_affine){.constant = constant};
}

bool dalcs_affine_is_constant(const struct dalcs_affine *a) {
    return a->n == 0;
}

bool dalcs_affine_is_time(const struct dalcs_affine *a) {
    return a->n == 1 && a->term[0].kind == DALCS_QUANTITY_TIME;
}

static struct dalcs_affine_term *allocate(struct dalcs_compiler *c, int n) {
    struct dalcs_affine_term *term = dalcs_arena_alloc(c->arena, (size_t)n, sizeof *term);
    if (term == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
    }
    return term;
}

struct dalcs_affine dalcs_affine_of(struct dalcs_compiler *c, enum dalcs_quantity_kind kind,
                                    int index) {
    struct dalcs_affine_term *term = allocate(c, 1);
    if (term == NULL) {
        return dalcs_affine_constant(0);
    }
    *term = (struct dalcs_affine_term){kind, index, 1};
    return (struct dalcs_affine){.n = 1, .term = term};
}

/* < 0: a comes first */
static int order(const struct dalcs_affine_term *a, const struct dalcs_affine_term *b) {
    return a->kind != b->kind ? (int)a->kind - (int)b->kind : a->index - b->index;
}

struct dalcs_affine dalcs_affine_add(struct dalcs_compiler *c, const struct dalcs_affine *a,
                                     double factor, const struct dalcs_affine *b) {
    struct dalcs_affine sum = {.constant = a->constant + factor * b->constant};
    struct dalcs_affine_term *term = allocate(c, a->n + b->n);
    int i = 0;
    int j = 0;
    while (term != NULL && (i < a->n || j < b->n)) {
        const int side = i == a->n ? 1 : j == b->n ? -1 : order(&a->term[i], &b->term[j]);
        struct dalcs_affine_term t = side <= 0 ? a->term[i] : b->term[j];
        const double x = side <= 0 ? t.coefficient : 0;
        const double y = side >= 0 ? factor * b->term[j].coefficient : 0;
        t.coefficient = x + y;
        /* A difference of equal terms is rounding. */
        if (fabs(t.coefficient) > dalcs_rounded * fmax(fabs(x), fabs(y))) {
            term[sum.n++] = t;
        }
        i += side <= 0;
        j += side >= 0;
    }
    sum.term = term;
    return sum;
}

double dalcs_affine_direction(struct dalcs_compiler *c, const struct dalcs_affine *a,
                              struct dalcs_affine *direction) {
    *direction = dalcs_affine_constant(0);
    if (a->n == 0) {
        return 0;
    }
    const double factor = a->term[0].coefficient;
    struct dalcs_affine_term *term = allocate(c, a->n);
    if (term == NULL) {
        return 0;
    }
    for (int k = 0; k < a->n; k++) {
        term[k] = a->term[k];
        term[k].coefficient = k == 0 ? 1 : a->term[k].coefficient / factor;
    }
    *direction = (struct dalcs_affine){.n = a->n, .term = term};
    return factor;
}

bool dalcs_affine_is_along(const struct dalcs_affine *a, const struct dalcs_affine *direction,
                           double *factor) {
    *factor = 0;
    if (a->n == 0) {
        return true;
    }
    if (a->n != direction->n) {
        return false;
    }
    *factor = a->term[0].coefficient;
    for (int k = 0; k < a->n; k++) {
        const double wanted = *factor * direction->term[k].coefficient;
        const double found = a->term[k].coefficient;
        if (order(&a->term[k], &direction->term[k]) != 0 ||
            fabs(found - wanted) > dalcs_sum_rounded * fabs(found)) {
            return false;
        }
    }
    return true;
}
