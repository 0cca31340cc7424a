/* staircase.c - int, floor, ceil, round and remainders of quantities that vary, within bounds that are known.
 *
 * Each is a staircase with a jump at every whole number, or half way between two: as a piecewise-linear function it has
 * two pairs for each, as a function of sources alone a time for each. */
#include "behaviour.h"

#include <math.h>
#include <string.h>

/* Those of a converter of ten bits. */
enum { MOST_JUMPS = 1024 };

static bool is_named(const char *name, const char *other) {
    return strcmp(name, other) == 0;
}

/* A quantity that rests on a jump, such as limit(x, 0, 15) at 0, has no side there but by rounding. The function has:
 * int(0) is 0. So a jump is before its number by this part of a step, which is what signals are held to (1e-9 of their
 * largest, and they have a step at least): voltages of a circuit are rounded less, and no event is later than others. */
static const double before = 1e-9;

/* The jump at k, or half a step before it. */
static struct dalcs_knot knot_at(const char *name, double k) {
    if (is_named(name, "ceil") || (is_named(name, "int") && k < 0)) {
        return (struct dalcs_knot){k + before, k, k, k + 1};
    }
    if (is_named(name, "round") || is_named(name, "nint")) { /* away from 0 */
        const double at = k > 0 ? k - 0.5 - before : k - 0.5 + before;
        return (struct dalcs_knot){at, k - 1, k > 0 ? k : k - 1, k};
    }
    return (struct dalcs_knot){k - before, k - 1, k, k};
}

static const struct dalcs_form *refuse(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                       const struct dalcs_range *x) {
    static const char hint[] = "limit(x, 0, 15) in the place of x bounds it";
    const char *what =
        f->n > 1 ? "a remainder" : dalcs_builder_hint(c->builder, "%s(...)", f->function);
    what = what != NULL ? what : f->function;
    if (c->failed || c->is_silent) {
        c->failed = true;
        return NULL;
    }
    if (isfinite(x->low) && isfinite(x->high)) {
        dalcs_builder_error_at(c->builder, &f->where, hint,
                               "%s of what is between %.4g and %.4g has more than %d steps", what,
                               x->low, x->high, MOST_JUMPS);
    } else {
        dalcs_builder_error_at(c->builder, &f->where, hint,
                               "%s of what may have any value has steps without end", what);
    }
    c->failed = true;
    return NULL;
}

/* name(a), where a is in `x`. */
static const struct dalcs_form *staircase(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                          const char *name, const struct dalcs_form *a,
                                          struct dalcs_range x) {
    /* one more at each end: rounding may pass it */
    const double first = floor(x.low) - 1;
    const double last = ceil(x.high) + 1;
    if (!(last - first < MOST_JUMPS)) {
        return refuse(c, f, &x);
    }
    struct dalcs_knot *knot = dalcs_arena_alloc(c->arena, (size_t)(last - first) + 1, sizeof *knot);
    if (knot == NULL) {
        c->builder->out_of_memory = c->failed = true;
        return NULL;
    }
    struct dalcs_piecewise steps = {.knot = knot};
    for (double k = first; k <= last; k++) {
        if (!(is_named(name, "int") && k == 0)) {
            knot[steps.n++] = knot_at(name, k);
        }
    }
    return dalcs_form_apply(c, &steps, a);
}

bool dalcs_staircase_is(const struct dalcs_formula *f) {
    static const char *const names[] = {"int", "floor", "ceil", "nint", "round", "fmod", "mod"};
    return (f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_REMAINDER) ||
           (f->kind == DALCS_FORMULA_CALL &&
            dalcs_builder_is_one_of(f->function, names, sizeof names / sizeof names[0]));
}

const struct dalcs_form *dalcs_staircase_form(struct dalcs_compiler *c,
                                              const struct dalcs_formula *f,
                                              const struct dalcs_form **argument) {
    const struct dalcs_form *a = argument[0];
    const struct dalcs_range x = dalcs_formula_range(c, f->argument[0]);
    if (f->n == 1) {
        return staircase(c, f, f->function, a, x);
    }
    if (!dalcs_form_is_number(argument[1]) || argument[1]->affine.constant == 0) {
        if (!c->failed && !c->is_silent) {
            dalcs_builder_error_at(c->builder, &f->where, "write v(a) % 360, or fmod(v(a), 360)",
                                   "what a remainder is by must be a number, and not 0");
        }
        c->failed = true;
        return NULL;
    }
    /* x - y int(x / y) */
    const double y = fabs(argument[1]->affine.constant);
    const struct dalcs_form *whole = staircase(c, f, "int", dalcs_form_scale(c, 1 / y, a),
                                               (struct dalcs_range){x.low / y, x.high / y});
    return whole != NULL ? dalcs_form_add(c, a, -y, whole) : NULL;
}
