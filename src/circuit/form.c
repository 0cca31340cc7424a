/* form.c - sums of forms.
 *
 * A function of one affine quantity stays one function with its knots, however it is nested: only where
 * several such meet in another are pairs made for the inner ones (dalcs_behaviour_freeze), whose lambdas
 * are then quantities like others. */
#include "behaviour.h"

#include <math.h>

const struct dalcs_form *dalcs_form_keep(struct dalcs_compiler *c, struct dalcs_form value) {
    struct dalcs_form *kept = c->failed ? NULL : dalcs_arena_alloc(c->arena, 1, sizeof *kept);
    if (kept == NULL) {
        c->builder->out_of_memory = c->builder->out_of_memory || !c->failed;
        c->failed = true;
        return NULL;
    }
    *kept = value;
    return kept;
}

bool dalcs_form_check(struct dalcs_compiler *c, bool ok) {
    if (!ok) {
        c->builder->out_of_memory = true;
        c->failed = true;
    }
    return ok && !c->failed;
}

const struct dalcs_form *dalcs_form_affine(struct dalcs_compiler *c,
                                           const struct dalcs_affine *affine) {
    return dalcs_form_keep(c, (struct dalcs_form){.affine = *affine});
}

const struct dalcs_form *dalcs_form_number(struct dalcs_compiler *c, double number) {
    return dalcs_form_keep(c, (struct dalcs_form){.affine = dalcs_affine_constant(number)});
}

bool dalcs_form_is_number(const struct dalcs_form *v) {
    return v->n == 0 && dalcs_affine_is_constant(&v->affine);
}

bool dalcs_form_add_part(struct dalcs_compiler *c, struct dalcs_affine *affine,
                         struct dalcs_form_part *part, int *n, double factor,
                         const struct dalcs_form_part *other) {
    struct dalcs_piecewise scaled;
    double along;
    if (!dalcs_form_check(c, dalcs_piecewise_scale(c->arena, &other->f, factor, &scaled))) {
        return false;
    }
    int k = 0;
    while (k < *n &&
           !(dalcs_affine_is_along(&part[k].direction, &other->direction, &along) && along == 1)) {
        k++;
    }
    if (k < *n) {
        struct dalcs_piecewise sum;
        if (!dalcs_form_check(c, dalcs_piecewise_add(c->arena, &part[k].f, &scaled, &sum))) {
            return false;
        }
        scaled = sum;
    } else {
        part[(*n)++].direction = other->direction;
    }
    part[k].f = scaled;
    if (dalcs_piecewise_is_line(&scaled)) {
        *affine = dalcs_affine_add(c, affine, scaled.before, &other->direction);
        affine->constant += dalcs_piecewise_at(&scaled, 0, 1);
        part[k] = part[--*n];
    }
    return true;
}

bool dalcs_form_is_staircase(const struct dalcs_form *v) {
    return v->n == 1 && dalcs_affine_is_constant(&v->affine) &&
           dalcs_piecewise_is_stepped(&v->part[0].f);
}

/* The number becomes part of the staircase: so its least step is exact, however high the others are. */
static bool gather(struct dalcs_compiler *c, struct dalcs_form *v, struct dalcs_form_part *part) {
    struct dalcs_piecewise number;
    struct dalcs_piecewise sum;
    if (!dalcs_form_is_staircase(v) || v->affine.constant == 0) {
        return true;
    }
    if (!dalcs_form_check(c, dalcs_piecewise_line(c->arena, v->affine.constant, 0, &number)) ||
        !dalcs_form_check(c, dalcs_piecewise_add(c->arena, &part->f, &number, &sum))) {
        return false;
    }
    part->f = sum;
    v->affine.constant = 0;
    return true;
}

/* a + factor b, without its levels. */
static bool add(struct dalcs_compiler *c, const struct dalcs_form *a, double factor,
                const struct dalcs_form *b, struct dalcs_form *whole) {
    if (c->failed || a == NULL || b == NULL) {
        return false;
    }
    struct dalcs_form sum = {.affine = dalcs_affine_add(c, &a->affine, factor, &b->affine)};
    struct dalcs_form_part *part =
        dalcs_arena_alloc(c->arena, (size_t)a->n + (size_t)b->n, sizeof *part);
    if (!dalcs_form_check(c, part != NULL)) {
        return false;
    }
    for (int k = 0; k < a->n + b->n; k++) {
        const struct dalcs_form_part *other = k < a->n ? &a->part[k] : &b->part[k - a->n];
        if (!dalcs_form_add_part(c, &sum.affine, part, &sum.n, k < a->n ? 1 : factor, other)) {
            return false;
        }
    }
    sum.part = part;
    *whole = sum;
    return gather(c, whole, part);
}

const struct dalcs_form *dalcs_form_add(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        double factor, const struct dalcs_form *b) {
    struct dalcs_form sum;
    if (!add(c, a, factor, b, &sum)) {
        return NULL;
    }
    const bool shows = dalcs_form_is_number(&sum) || dalcs_form_is_staircase(&sum);
    sum.levels = shows ? NULL : dalcs_levels_add(c, a, factor, b);
    return dalcs_form_keep(c, sum);
}

const struct dalcs_form *dalcs_form_scale(struct dalcs_compiler *c, double factor,
                                          const struct dalcs_form *a) {
    const struct dalcs_form *zero = dalcs_form_number(c, 0);
    struct dalcs_form scaled;
    if (!add(c, zero, factor, a, &scaled)) {
        return NULL;
    }
    scaled.height = factor * a->height;
    scaled.levels = a->levels != NULL ? dalcs_levels_add(c, zero, factor, a) : NULL;
    return dalcs_form_keep(c, scaled);
}

const struct dalcs_form *dalcs_form_mark_logic(struct dalcs_compiler *c,
                                               const struct dalcs_form *v) {
    struct dalcs_form logic = v != NULL ? *v : (struct dalcs_form){0};
    logic.height = 1;
    return v != NULL ? dalcs_form_keep(c, logic) : NULL;
}

/* 1 - logic, itself 0 or 1. */
const struct dalcs_form *dalcs_form_negated(struct dalcs_compiler *c,
                                            const struct dalcs_form *logic) {
    return dalcs_form_mark_logic(c, dalcs_form_add(c, dalcs_form_number(c, 1), -1, logic));
}

static double larger(double a, double b) {
    return fmax(a, fabs(b));
}

double dalcs_form_largest(const struct dalcs_form *v) {
    double largest = fabs(v->affine.constant);
    for (int k = 0; k < v->affine.n; k++) {
        largest = larger(largest, v->affine.term[k].coefficient);
    }
    for (int k = 0; k < v->n; k++) {
        const struct dalcs_piecewise *f = &v->part[k].f;
        largest = larger(larger(largest, f->before), f->after);
        for (int i = 0; i < f->n; i++) {
            largest = larger(larger(largest, f->knot[i].left), f->knot[i].right);
        }
    }
    return largest;
}
