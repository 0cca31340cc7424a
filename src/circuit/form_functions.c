/* form_functions.c - functions of one form, and products of two. */
#include "behaviour.h"

#include <math.h>

/* The value as a function of one affine quantity, if it is: the line of its affine part included. */
static bool is_of_one(struct dalcs_compiler *c, const struct dalcs_form *v,
                      struct dalcs_form_part *whole) {
    double factor;
    struct dalcs_piecewise line;
    if (v->n > 1 || c->failed) {
        return false;
    }
    if (v->n == 0) {
        factor = dalcs_affine_direction(c, &v->affine, &whole->direction);
        return dalcs_form_check(
            c, dalcs_piecewise_line(c->arena, v->affine.constant, factor, &whole->f));
    }
    whole->direction = v->part[0].direction;
    return dalcs_affine_is_along(&v->affine, &whole->direction, &factor) &&
           dalcs_form_check(c, dalcs_piecewise_line(c->arena, v->affine.constant, factor, &line)) &&
           dalcs_form_check(c, dalcs_piecewise_add(c->arena, &line, &v->part[0].f, &whole->f));
}

static const struct dalcs_form *from_one(struct dalcs_compiler *c,
                                         const struct dalcs_form_part *whole) {
    struct dalcs_form_part *part = dalcs_arena_alloc(c->arena, 1, sizeof *part);
    struct dalcs_form value = {.part = part};
    if (!dalcs_form_check(c, part != NULL) ||
        !dalcs_form_add_part(c, &value.affine, part, &value.n, 1, whole)) {
        return NULL;
    }
    return dalcs_form_keep(c, value);
}

/* 1 over each value of a staircase; NULL: one of them is 0. */
static const struct dalcs_form *over_staircase(struct dalcs_compiler *c,
                                               const struct dalcs_form_part *steps) {
    struct dalcs_form_part over = {.direction = steps->direction};
    bool has_zero = false;
    if (!dalcs_form_check(c, dalcs_piecewise_scale(c->arena, &steps->f, 1, &over.f))) {
        return NULL;
    }
    for (int k = 0; k < over.f.n; k++) {
        struct dalcs_knot *knot = &over.f.knot[k];
        has_zero = has_zero || knot->left == 0 || knot->right == 0;
        const double between =
            knot->left != knot->right ? (knot->value - knot->left) / (knot->right - knot->left) : 0;
        knot->left = 1 / knot->left;
        knot->right = 1 / knot->right;
        knot->value = knot->left + between * (knot->right - knot->left);
    }
    over.f.zero = 1 / over.f.zero;
    return has_zero ? NULL : from_one(c, &over);
}

const struct dalcs_form *dalcs_form_reciprocal(struct dalcs_compiler *c,
                                               const struct dalcs_form *a) {
    if (dalcs_form_is_staircase(a) && a->affine.constant == 0) {
        return over_staircase(c, &a->part[0]);
    }
    const struct dalcs_levels *levels = dalcs_levels_of(c, a);
    if (levels == NULL || levels->n != 1 || levels->base == 0 ||
        levels->base + levels->level[0].height == 0) {
        return NULL;
    }
    const double base = 1 / levels->base;
    const double other = 1 / (levels->base + levels->level[0].height);
    return dalcs_form_add(c, dalcs_form_number(c, base), other - base, levels->level[0].logic);
}

const struct dalcs_form *dalcs_form_apply(struct dalcs_compiler *c,
                                          const struct dalcs_piecewise *outer,
                                          const struct dalcs_form *a) {
    struct dalcs_form_part inner;
    struct dalcs_form_part whole;
    if (a == NULL) {
        return NULL;
    }
    if (!is_of_one(c, a, &inner)) {
        const struct dalcs_affine frozen = dalcs_behaviour_freeze(c, a);
        const struct dalcs_form *v = dalcs_form_affine(c, &frozen);
        if (v == NULL || !is_of_one(c, v, &inner)) {
            return NULL;
        }
    }
    whole.direction = inner.direction;
    if (!dalcs_form_check(c, dalcs_piecewise_compose(c->arena, outer, &inner.f, &whole.f))) {
        return NULL;
    }
    return from_one(c, &whole);
}

/* max(a, b), sign = 1, or min(a, b), sign = -1: b + max(a - b, 0), b - max(b - a, 0). With a number it is one
 * function of the other, exact on the number and around 0. */
static const struct dalcs_form *extreme(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        const struct dalcs_form *b, int sign) {
    if (a == NULL || b == NULL) {
        return NULL;
    }
    const bool swaps = dalcs_form_is_number(a);
    const struct dalcs_form *base = swaps ? a : b;
    const struct dalcs_form *other = swaps ? b : a;
    if (dalcs_form_is_number(base)) {
        const double x = base->affine.constant;
        struct dalcs_knot knot = {x, x, x, x};
        const struct dalcs_piecewise bound = {.n = 1,
                                              .knot = &knot,
                                              .before = sign > 0 ? 0 : 1,
                                              .after = sign > 0 ? 1 : 0,
                                              .has_zero = true,
                                              .zero = sign > 0 ? fmax(x, 0) : fmin(x, 0)};
        return dalcs_form_apply(c, &bound, other);
    }
    struct dalcs_knot knot = {0, 0, 0, 0};
    const struct dalcs_piecewise ramp = {.n = 1, .knot = &knot, .after = 1};
    const struct dalcs_form *excess =
        sign > 0 ? dalcs_form_add(c, other, -1, base) : dalcs_form_add(c, base, -1, other);
    return dalcs_form_add(c, base, sign, dalcs_form_apply(c, &ramp, excess));
}

const struct dalcs_form *dalcs_form_max(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        const struct dalcs_form *b) {
    return extreme(c, a, b, 1);
}

const struct dalcs_form *dalcs_form_min(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        const struct dalcs_form *b) {
    return extreme(c, a, b, -1);
}

const struct dalcs_form *dalcs_form_to_logic(struct dalcs_compiler *c, const struct dalcs_form *a) {
    struct dalcs_form_part whole;
    struct dalcs_form_part stepped;
    if (a == NULL) {
        return NULL;
    }
    if (a->height != 0) {
        return dalcs_form_scale(c, 1 / a->height, a);
    }
    if (!is_of_one(c, a, &whole) || !dalcs_piecewise_is_stepped(&whole.f) ||
        !dalcs_form_check(c, dalcs_piecewise_to_logic(c->arena, &whole.f, &stepped.f))) {
        return NULL;
    }
    stepped.direction = whole.direction;
    return dalcs_form_mark_logic(c, from_one(c, &stepped));
}

/* The waves of b, begun where the steps of time in `steps` go up, less what they were where they go
 * down, and a function of time beside them. */
static const struct dalcs_form *gate(struct dalcs_compiler *c, const struct dalcs_form_part *steps,
                                     const struct dalcs_form *b) {
    struct dalcs_form rest = *b;
    struct dalcs_affine waves = dalcs_affine_constant(0);
    bool has_waves = false;
    for (int i = 0; i < b->affine.n; i++) {
        const struct dalcs_affine_term *term = &b->affine.term[i];
        if (term->kind != DALCS_QUANTITY_WAVE) {
            continue;
        }
        has_waves = true;
        const struct dalcs_affine wave = dalcs_affine_of(c, DALCS_QUANTITY_WAVE, term->index);
        rest.affine = dalcs_affine_add(c, &rest.affine, -term->coefficient, &wave);
        waves = dalcs_affine_add(c, &waves, term->coefficient * dalcs_piecewise_at(&steps->f, 0, 1),
                                 &wave);
        for (int k = 0; k < steps->f.n && !c->failed; k++) {
            const struct dalcs_knot *knot = &steps->f.knot[k];
            if (knot->at > 0) {
                const int later = dalcs_wave_delayed(c, term->index, knot->at);
                if (later < 0) {
                    return NULL;
                }
                const struct dalcs_affine part = dalcs_affine_of(c, DALCS_QUANTITY_WAVE, later);
                waves = dalcs_affine_add(c, &waves, term->coefficient * (knot->right - knot->left),
                                         &part);
            }
        }
    }
    const struct dalcs_form *product = NULL;
    const struct dalcs_form *factor = from_one(c, steps);
    const struct dalcs_form *kept = dalcs_form_keep(c, rest);
    if (kept == NULL || factor == NULL || !has_waves ||
        dalcs_form_multiply(c, factor, kept, &product) != DALCS_PRODUCT_IS) {
        return NULL;
    }
    return dalcs_form_add(c, product, 1, dalcs_form_affine(c, &waves));
}

static bool is_of_time(const struct dalcs_form *v) {
    bool is = true;
    for (int k = 0; k < v->affine.n; k++) {
        const enum dalcs_quantity_kind kind = v->affine.term[k].kind;
        is = is && (kind == DALCS_QUANTITY_TIME || kind == DALCS_QUANTITY_WAVE);
    }
    for (int k = 0; k < v->n; k++) {
        is = is && dalcs_affine_is_time(&v->part[k].direction);
    }
    return is;
}

/* Sums of waves and a number: the product of two is one again. */
static bool multiply_waves(struct dalcs_compiler *c, const struct dalcs_form *a,
                           const struct dalcs_form *b, const struct dalcs_form **product) {
    if (a->n > 0 || b->n > 0) {
        return false;
    }
    struct dalcs_affine pure[2] = {a->affine, b->affine};
    pure[0].constant = pure[1].constant = 0;
    *product = dalcs_form_number(c, a->affine.constant * b->affine.constant);
    *product = dalcs_form_add(c, *product, b->affine.constant, dalcs_form_affine(c, &pure[0]));
    *product = dalcs_form_add(c, *product, a->affine.constant, dalcs_form_affine(c, &pure[1]));
    for (int i = 0; i < pure[0].n; i++) {
        for (int j = 0; j < pure[1].n; j++) {
            const struct dalcs_affine_term *s = &pure[0].term[i];
            const struct dalcs_affine_term *t = &pure[1].term[j];
            const struct dalcs_form *part;
            if (s->kind != DALCS_QUANTITY_WAVE || t->kind != DALCS_QUANTITY_WAVE ||
                !dalcs_wave_multiply(c, s->index, t->index, &part)) {
                return false;
            }
            *product = dalcs_form_add(c, *product, s->coefficient * t->coefficient, part);
        }
    }
    return true;
}

/* Products of 0 or 1 are the smaller of the two, whatever quantities they depend on. */
const struct dalcs_form *dalcs_form_either(struct dalcs_compiler *c, const struct dalcs_form *a,
                                           const struct dalcs_form *b) {
    return dalcs_form_mark_logic(c, dalcs_form_max(c, a, b));
}

static bool multiply_logic(struct dalcs_compiler *c, const struct dalcs_form *a,
                           const struct dalcs_form *b, const struct dalcs_form **product) {
    if (a->height == 0 || b->height == 0) {
        return false;
    }
    const struct dalcs_form *smaller = dalcs_form_min(c, dalcs_form_scale(c, 1 / a->height, a),
                                                      dalcs_form_scale(c, 1 / b->height, b));
    *product = dalcs_form_scale(c, a->height * b->height, dalcs_form_mark_logic(c, smaller));
    return true;
}

enum dalcs_product dalcs_form_multiply(struct dalcs_compiler *c, const struct dalcs_form *a,
                                       const struct dalcs_form *b,
                                       const struct dalcs_form **product) {
    struct dalcs_form_part x;
    struct dalcs_form_part y;
    *product = NULL;
    if (dalcs_form_is_number(a) || dalcs_form_is_number(b)) {
        const bool swaps = dalcs_form_is_number(a);
        *product = dalcs_form_scale(c, (swaps ? a : b)->affine.constant, swaps ? b : a);
        return DALCS_PRODUCT_IS;
    }
    if (multiply_logic(c, a, b, product)) {
        return DALCS_PRODUCT_IS;
    }
    const bool is_one = is_of_one(c, a, &x);
    const bool is_other = is_of_one(c, b, &y);
    const bool is_step = is_one && dalcs_piecewise_is_stepped(&x.f);
    const bool is_other_step = is_other && dalcs_piecewise_is_stepped(&y.f);
    double along;
    if (is_one && is_other && (is_step || is_other_step) &&
        dalcs_affine_is_along(&x.direction, &y.direction, &along) && along == 1) {
        struct dalcs_form_part whole = {.direction = x.direction};
        if (dalcs_form_check(c, dalcs_piecewise_multiply(c->arena, &x.f, &y.f, &whole.f))) {
            *product = from_one(c, &whole);
        }
        return DALCS_PRODUCT_IS;
    }
    if (is_of_time(a) && is_of_time(b)) {
        if (is_step && dalcs_affine_is_time(&x.direction)) {
            *product = gate(c, &x, b);
        } else if (is_other_step && dalcs_affine_is_time(&y.direction)) {
            *product = gate(c, &y, a);
        } else if (!multiply_waves(c, a, b, product)) {
            *product = NULL;
        }
        return *product != NULL || c->failed ? DALCS_PRODUCT_IS : DALCS_PRODUCT_IS_CURVED;
    }
    if (dalcs_levels_multiply(c, a, b, product)) {
        return DALCS_PRODUCT_IS;
    }
    return is_step || is_other_step || a->height != 0 || b->height != 0 ? DALCS_PRODUCT_HAS_JUMP
                                                                        : DALCS_PRODUCT_IS_CURVED;
}
