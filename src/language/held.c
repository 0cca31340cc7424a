/* held.c - a function that rises or falls, held at a number: min(exp(x), 5) is exp(min(x, ln(5))).
 *
 * As written the kink is where exp(x) passes 5. A run that takes x to 30 has 1e13 there, and where 5 is passed is known to
 * the rounding of that alone. The kink of the argument is of the size of x, and what is beyond it has no value at all.
 *
 * exp(x) > 5 is x > ln(5).
 *
 * With f(b) = c, where f rises, max(f(x), c) is f(max(x, b)), and abs(f(x)) is f(max(x, b)) - f(min(x, b)) where c is 0.
 * Where f falls up to a centre and rises from there it is c at b1 and b2, and
 *
 *     min(f(x), c) = f(limit(x, b1, b2)),     max(f(x), c) = f(min(x, b1)) + f(max(x, b2)) - c. */
#include "rewriting.h"
#include "shapes.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* What is held: a function of a quantity, between numbers. */
struct holding {
    struct dalcs_rewriting *r;
    const struct dalcs_formula *at; /* as written */
    const struct dalcs_formula *of; /* the function */
    struct dalcs_kinks kinks;
    struct dalcs_shape shape;
    double floor, ceiling; /* of its values; infinite: none */
};

/* ---- What is written ----------------------------------------------------------------------------- */

static const struct dalcs_formula *put_in(const struct holding *h, const struct dalcs_formula *f,
                                          const struct dalcs_formula *quantity) {
    if (f->kind == DALCS_FORMULA_NUMBER || h->r->failed ||
        dalcs_formula_is_same(f, h->kinks.quantity)) {
        return f->kind == DALCS_FORMULA_NUMBER ? f : quantity;
    }
    const struct dalcs_formula *argument[2] = {NULL, NULL}; /* shapes have no more */
    for (int k = 0; k < f->n && k < 2; k++) {
        argument[k] = put_in(h, f->argument[k], quantity);
        h->r->failed = h->r->failed || argument[k] == NULL;
    }
    return h->r->failed ? NULL : dalcs_rewriting_like(h->r, f, f->n, argument);
}

/* The function of what is at least low and at most high, where these are finite. */
static const struct dalcs_formula *hold_argument(const struct holding *h, double low, double high) {
    const struct dalcs_formula *x = h->kinks.quantity;
    if (isfinite(low)) {
        x = dalcs_rewriting_call(h->r, h->at, "max", x, dalcs_rewriting_number(h->r, h->at, low));
    }
    if (isfinite(high) && x != NULL) {
        x = dalcs_rewriting_call(h->r, h->at, "min", x, dalcs_rewriting_number(h->r, h->at, high));
    }
    return x != NULL ? put_in(h, h->of, x) : NULL;
}

static double value_at(const struct holding *h, double x) {
    return dalcs_shape_value(&h->kinks, h->of, x);
}

static const struct dalcs_formula *add_number(const struct holding *h,
                                              const struct dalcs_formula *f, double number) {
    return dalcs_rewriting_combine(h->r, h->at, DALCS_ADD, f,
                                   dalcs_rewriting_number(h->r, h->at, number));
}

/* What makes it 0 where it is held at 0: a reader may take the sign of what rounding leaves. */
static double find_rest(const struct holding *h, double at_floor, double at_ceiling) {
    const bool has_floor = h->floor == 0 && isfinite(at_floor);
    const bool has_ceiling = h->ceiling == 0 && isfinite(at_ceiling);
    return has_floor ? -value_at(h, at_floor) : has_ceiling ? -value_at(h, at_ceiling) : 0;
}

/* ---- Where it is held ---------------------------------------------------------------------------- */

/* A bound of the quantity between low and high; `beyond`: the function does not pass the value there. */
static double bound_of(const struct holding *h, double low, double high, double value,
                       double beyond) {
    const double at = dalcs_shape_reach(&h->kinks, h->of, low, high, value);
    return isnan(at) ? beyond : at;
}

static const struct dalcs_formula *hold_slope(const struct holding *h) {
    const bool rises = h->shape.kind == DALCS_SHAPE_RISING;
    const double low = bound_of(h, -DBL_MAX, DBL_MAX, rises ? h->floor : h->ceiling, -INFINITY);
    const double high = bound_of(h, -DBL_MAX, DBL_MAX, rises ? h->ceiling : h->floor, INFINITY);
    const struct dalcs_formula *made = hold_argument(h, low, high);
    return made != NULL ? add_number(h, made, find_rest(h, rises ? low : high, rises ? high : low))
                        : NULL;
}

/* A valley with a floor, or a peak with a ceiling, is the sum of both of its sides. */
static const struct dalcs_formula *hold_centre(const struct holding *h) {
    const bool is_valley = h->shape.kind == DALCS_SHAPE_VALLEY;
    const double inner = is_valley ? h->floor : h->ceiling;
    const double outer = is_valley ? h->ceiling : h->floor;
    const double centre = h->shape.centre;
    const double low = bound_of(h, -DBL_MAX, centre, outer, -INFINITY);
    const double high = bound_of(h, centre, DBL_MAX, outer, INFINITY);
    const double before = bound_of(h, -DBL_MAX, centre, inner, NAN);
    const double after = bound_of(h, centre, DBL_MAX, inner, NAN);
    if (isnan(before) && isnan(after)) {
        return hold_argument(h, low, high);
    }
    if (isnan(before) || isnan(after)) {
        return h->at;
    }
    const struct dalcs_formula *first = hold_argument(h, low, before);
    const struct dalcs_formula *second = hold_argument(h, after, high);
    const struct dalcs_formula *sum =
        dalcs_rewriting_combine(h->r, h->at, DALCS_ADD, first, second);
    return sum != NULL ? add_number(h, sum, inner - (value_at(h, before) + value_at(h, after)))
                       : NULL;
}

static const struct dalcs_formula *negate(const struct holding *h, const struct dalcs_formula *f) {
    return dalcs_rewriting_times(h->r, f, -1);
}

static const struct dalcs_formula *hold_magnitude(const struct holding *h) {
    const bool rises = h->shape.kind == DALCS_SHAPE_RISING;
    if (h->shape.low >= 0 || h->shape.high <= 0) {
        return h->shape.low >= 0 ? h->of : negate(h, h->of);
    }
    if (!rises && h->shape.kind != DALCS_SHAPE_FALLING) {
        return h->at;
    }
    const double zero = bound_of(h, -DBL_MAX, DBL_MAX, 0, NAN);
    const struct dalcs_formula *low = hold_argument(h, -INFINITY, zero);
    const struct dalcs_formula *high = hold_argument(h, zero, INFINITY);
    return dalcs_rewriting_combine(h->r, h->at, DALCS_ADD, rises ? high : negate(h, high),
                                   rises ? negate(h, low) : low);
}

/* ---- What is of one quantity --------------------------------------------------------------------- */

/* The innermost quantity that the function is one of, which may be a difference or another call. false: there is none. */
static bool find_quantity(struct holding *h, const struct dalcs_formula *part) {
    const struct dalcs_formula *x = dalcs_formula_read_line(part).of;
    const bool is_first = x->n > 0 && x->argument[0]->kind != DALCS_FORMULA_NUMBER;
    const int inner = is_first ? 0 : 1;
    if (x->kind != DALCS_FORMULA_CHOICE && x->n > inner && find_quantity(h, x->argument[inner])) {
        return true;
    }
    h->kinks.quantity = x;
    h->shape = dalcs_shape_read(&h->kinks, h->of);
    return h->shape.kind > DALCS_SHAPE_NUMBER && x->kind != DALCS_FORMULA_TIME;
}

/* The numbers that a part is held at; false: it is none that holds. */
static bool read_bounds(struct holding *h) {
    const struct dalcs_formula *f = h->at;
    const bool is_max = dalcs_formula_is_call(f, "max");
    const bool is_limit = dalcs_formula_is_call(f, "limit") && f->n == 3;
    const bool is_of_two = (is_max || dalcs_formula_is_call(f, "min")) && f->n == 2;
    const bool is_of_one =
        (dalcs_formula_is_call(f, "uramp") || dalcs_formula_is_call(f, "abs")) && f->n == 1;
    const int of = is_of_two && f->argument[0]->kind == DALCS_FORMULA_NUMBER ? 1 : 0;
    bool is = is_of_one || is_of_two || is_limit;
    for (int k = 0; k < f->n && is; k++) {
        is = (f->argument[k]->kind == DALCS_FORMULA_NUMBER) == (k != of);
    }
    if (!is) {
        return false;
    }
    h->of = f->argument[of];
    h->floor = is_of_one ? 0 : is_max ? f->argument[1 - of]->number : -INFINITY;
    h->ceiling = is_of_two && !is_max ? f->argument[1 - of]->number : INFINITY;
    if (is_limit) {
        h->floor = f->argument[1]->number;
        h->ceiling = f->argument[2]->number;
    }
    return h->floor < h->ceiling;
}

/* ---- Comparisons --------------------------------------------------------------------------------- */

/* f(x) > c as x > b where f rises, as b > x where it falls; f itself: it has no such place, or a line has it. */
static const struct dalcs_formula *change_comparison(struct holding *h) {
    const struct dalcs_formula *f = h->at;
    const int number = f->n > 1 && f->argument[1]->kind == DALCS_FORMULA_NUMBER ? 1 : 0;
    const double value = f->n > 1 ? f->argument[number]->number : 0;
    h->of = f->argument[f->n > 1 ? 1 - number : 0];
    if (h->of->kind == DALCS_FORMULA_NUMBER || !find_quantity(h, h->of) || !h->shape.is_curved ||
        h->shape.kind > DALCS_SHAPE_FALLING) {
        return f;
    }
    const double at = bound_of(h, -DBL_MAX, DBL_MAX, value, NAN);
    const bool rises = h->shape.kind == DALCS_SHAPE_RISING;
    if (isnan(at)) {
        return f;
    }
    const struct dalcs_formula *x = dalcs_rewriting_times(h->r, h->kinks.quantity, rises ? 1 : -1);
    const struct dalcs_formula *bound = dalcs_rewriting_number(h->r, f, rises ? at : -at);
    if (f->n == 1) {
        const struct dalcs_formula *rest = x != NULL ? add_number(h, x, rises ? -at : at) : NULL;
        return rest != NULL ? dalcs_rewriting_like(h->r, f, 1, &rest) : NULL;
    }
    const struct dalcs_formula *pair[2] = {number == 1 ? x : bound, number == 1 ? bound : x};
    return x != NULL && bound != NULL ? dalcs_rewriting_like(h->r, f, 2, pair) : NULL;
}

/* Is it a step, or a comparison with a number? */
static bool compares(const struct dalcs_formula *f) {
    const bool is_of_two = f->kind == DALCS_FORMULA_OPERATION && f->n == 2 &&
                           (f->code == DALCS_LESS || f->code == DALCS_LESS_EQUAL ||
                            f->code == DALCS_GREATER || f->code == DALCS_GREATER_EQUAL);
    return (dalcs_kinks_is_step_call(f) && f->n == 1) ||
           (is_of_two && (f->argument[0]->kind == DALCS_FORMULA_NUMBER ||
                          f->argument[1]->kind == DALCS_FORMULA_NUMBER));
}

static const struct dalcs_formula *change(struct dalcs_rewriting *r,
                                          const struct dalcs_formula *f) {
    struct holding h = {.r = r, .at = f, .kinks = {.dialect = r->dialect}};
    if (!read_bounds(&h)) {
        return compares(f) ? change_comparison(&h) : f;
    }
    /* What touches 0 beneath a root is a pair with a root of its own (circuit/root_parts.c). */
    const bool is_root = r->is_beneath_root && (h.floor == 0 || h.ceiling == 0);
    if (is_root || !find_quantity(&h, h.of) || !h.shape.is_curved || h.floor >= h.shape.high ||
        h.ceiling <= h.shape.low) {
        return f;
    }
    if (dalcs_formula_is_call(f, "abs")) {
        return hold_magnitude(&h);
    }
    return h.shape.kind == DALCS_SHAPE_VALLEY || h.shape.kind == DALCS_SHAPE_PEAK ? hold_centre(&h)
                                                                                  : hold_slope(&h);
}

const struct dalcs_formula *dalcs_formula_held(struct dalcs_arena *arena,
                                               const struct dalcs_formula *formula,
                                               enum dalcs_dialect_name dialect) {
    return dalcs_formula_rewrite_in(arena, formula, dialect, change);
}
