/* levels.c - values that are a number plus heights of steps, and their products.
 *
 *     c + h1 L1 + h2 L2 + ...    each L is 0 or 1, or between the two where it jumps
 *
 * So are nested choices between numbers, whatever their conditions depend on: a product of two such
 * sums is one again, because the product of two steps is the smaller of them. */
#include "behaviour.h"

#include <math.h>

enum { MOST_LEVELS = 32 };

/* Room for all levels; NULL when out of memory. */
static struct dalcs_levels *make(struct dalcs_compiler *c, double base) {
    struct dalcs_levels *levels = dalcs_arena_alloc(c->arena, 1, sizeof *levels);
    struct dalcs_height *level = dalcs_arena_alloc(c->arena, MOST_LEVELS, sizeof *level);
    if (levels == NULL || level == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return NULL;
    }
    *levels = (struct dalcs_levels){.base = base, .level = level};
    return levels;
}

static bool add(struct dalcs_levels *levels, double height, const struct dalcs_form *logic) {
    if (levels->n == MOST_LEVELS || logic == NULL) {
        return false;
    }
    levels->level[levels->n++] = (struct dalcs_height){height, logic};
    return true;
}

static double value_of(const struct dalcs_piecewise *f, int piece) {
    return piece < f->n ? f->knot[piece].left : f->knot[f->n - 1].right;
}

/* The steps of a function that is constant between its jumps, outwards from its least value: that is exact, however high
 * the others are. */
static bool add_steps(struct dalcs_compiler *c, struct dalcs_levels *levels,
                      const struct dalcs_form_part *part) {
    const struct dalcs_form *direction = dalcs_form_affine(c, &part->direction);
    const struct dalcs_piecewise *f = &part->f;
    int base = 0;
    if (!dalcs_piecewise_is_stepped(f)) {
        return false;
    }
    for (int k = 1; k <= f->n; k++) {
        base = fabs(value_of(f, k)) < fabs(value_of(f, base)) ? k : base;
    }
    levels->base += value_of(f, base);
    for (int k = 0; k < f->n; k++) {
        const struct dalcs_knot *from = &f->knot[k];
        const bool goes_left = k < base;
        const double rise = from->right - from->left;
        const double part_up = rise != 0 ? (from->value - from->left) / rise : 0;
        struct dalcs_knot knot = goes_left ? (struct dalcs_knot){from->at, 1, 1 - part_up, 0}
                                           : (struct dalcs_knot){from->at, 0, part_up, 1};
        const struct dalcs_piecewise step = {.n = 1, .knot = &knot};
        if (rise != 0 && !add(levels, goes_left ? -rise : rise,
                              dalcs_form_to_logic(c, dalcs_form_apply(c, &step, direction)))) {
            return false;
        }
    }
    return true;
}

const struct dalcs_levels *dalcs_levels_of(struct dalcs_compiler *c, const struct dalcs_form *v) {
    if (v == NULL || v->levels != NULL) {
        return v != NULL ? v->levels : NULL;
    }
    struct dalcs_levels *levels = make(c, v->height != 0 ? 0 : v->affine.constant);
    bool ok = levels != NULL;
    if (ok && v->height != 0) {
        ok = add(levels, v->height, dalcs_form_scale(c, 1 / v->height, v));
    } else if (ok) {
        ok = dalcs_affine_is_constant(&v->affine);
        for (int k = 0; k < v->n && ok; k++) {
            ok = add_steps(c, levels, &v->part[k]);
        }
    }
    return ok && !c->failed ? levels : NULL;
}

const struct dalcs_levels *dalcs_levels_add(struct dalcs_compiler *c, const struct dalcs_form *a,
                                            double factor, const struct dalcs_form *b) {
    const bool is_needed =
        a->levels != NULL || b->levels != NULL || a->height != 0 || b->height != 0;
    const struct dalcs_levels *x = is_needed ? dalcs_levels_of(c, a) : NULL;
    const struct dalcs_levels *y = x != NULL ? dalcs_levels_of(c, b) : NULL;
    struct dalcs_levels *sum = y != NULL ? make(c, x->base + factor * y->base) : NULL;
    bool ok = sum != NULL;
    for (int k = 0; ok && k < x->n; k++) {
        ok = add(sum, x->level[k].height, x->level[k].logic);
    }
    for (int k = 0; ok && k < y->n; k++) {
        ok = add(sum, factor * y->level[k].height, y->level[k].logic);
    }
    return ok ? sum : NULL;
}

bool dalcs_levels_multiply(struct dalcs_compiler *c, const struct dalcs_form *a,
                           const struct dalcs_form *b, const struct dalcs_form **product) {
    const struct dalcs_levels *x = dalcs_levels_of(c, a);
    const struct dalcs_levels *y = x != NULL ? dalcs_levels_of(c, b) : NULL;
    if (y == NULL || x->n + y->n + x->n * y->n > MOST_LEVELS) {
        return false;
    }
    const struct dalcs_form *sum = dalcs_form_number(c, x->base * y->base);
    for (int k = 0; k < x->n; k++) {
        sum = dalcs_form_add(c, sum, x->level[k].height * y->base, x->level[k].logic);
    }
    for (int k = 0; k < y->n; k++) {
        sum = dalcs_form_add(c, sum, y->level[k].height * x->base, y->level[k].logic);
    }
    for (int k = 0; k < x->n * y->n && !c->failed; k++) {
        const struct dalcs_height *s = &x->level[k / y->n];
        const struct dalcs_height *t = &y->level[k % y->n];
        const struct dalcs_form *both;
        if (dalcs_form_multiply(c, s->logic, t->logic, &both) != DALCS_PRODUCT_IS) {
            return false;
        }
        sum = dalcs_form_add(c, sum, s->height * t->height, both);
    }
    *product = sum;
    return true;
}
