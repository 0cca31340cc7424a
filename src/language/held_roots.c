/* held_roots.c - a root with the sign of its argument, held on one side of a number: max(pwrs(x, p), c) is
 * pwrs(max(x, b), p), where b has the root c.
 *
 * Such a root rises everywhere. As its argument is held so is its value, and the kink is where x passes b. The root as
 * written goes on beyond the kink, where nobody reads it, and is steep at 0 there.
 *
 * And the roots of both sides of 0, sqrt(max(x, 0)) - sqrt(max(-x, 0)), are one with a sign, which has no kink. */
#include "rewriting.h"

#include <math.h>

/* The exponent of a root with a sign; 0: it is none. */
static double exponent_of(const struct dalcs_formula *f) {
    const bool is_power = dalcs_formula_is_call(f, "pwrs") && f->n == 2 &&
                          f->argument[1]->kind == DALCS_FORMULA_NUMBER;
    const double exponent = is_power                           ? f->argument[1]->number
                            : dalcs_formula_is_call(f, "cbrt") ? 1.0 / 3.0
                                                               : 0.0;
    return exponent > 0 && exponent < 1 ? exponent : 0;
}

/* Is it max or min of a line of such a root and a number, or uramp of one? *bound: the number. */
static const struct dalcs_formula *find_held(const struct dalcs_formula *f, bool *is_max,
                                             double *bound) {
    const bool is_ramp = dalcs_formula_is_call(f, "uramp") && f->n == 1;
    const bool is_call =
        (dalcs_formula_is_call(f, "max") || dalcs_formula_is_call(f, "min")) && f->n == 2;
    const int number = is_call && f->argument[0]->kind == DALCS_FORMULA_NUMBER ? 0 : 1;
    *is_max = is_ramp || (is_call && dalcs_formula_is_call(f, "max"));
    *bound = 0;
    if (is_ramp) {
        return f->argument[0];
    }
    if (!is_call || f->argument[number]->kind != DALCS_FORMULA_NUMBER) {
        return NULL;
    }
    *bound = f->argument[number]->number;
    return f->argument[1 - number];
}

/* The exponent of a root of max(x, 0) and x, *of; 0: it is none. */
static double exponent_above(const struct dalcs_formula *f, const struct dalcs_formula **of) {
    const bool is_power = (dalcs_formula_is_operation(f, DALCS_POWER) ||
                           dalcs_formula_is_call(f, "pow") || dalcs_formula_is_call(f, "pwr")) &&
                          f->argument[1]->kind == DALCS_FORMULA_NUMBER &&
                          f->argument[1]->number > 0 && f->argument[1]->number < 1;
    const double exponent = is_power                           ? f->argument[1]->number
                            : dalcs_formula_is_call(f, "sqrt") ? 0.5
                                                               : exponent_of(f);
    bool is_max = false;
    double bound = 0;
    *of = exponent > 0 ? find_held(f->argument[0], &is_max, &bound) : NULL;
    return *of != NULL && is_max && bound == 0 ? exponent : 0;
}

/* The root with a sign that the roots of both sides are; f itself: it is no difference of such. */
static const struct dalcs_formula *join_sides(struct dalcs_rewriting *r,
                                              const struct dalcs_formula *f) {
    const struct dalcs_formula *above;
    const struct dalcs_formula *below;
    if (!dalcs_formula_is_operation(f, DALCS_SUBTRACT)) {
        return f;
    }
    const double exponent = exponent_above(f->argument[0], &above);
    if (exponent == 0 || exponent_above(f->argument[1], &below) != exponent) {
        return f;
    }
    const struct dalcs_formula_line a = dalcs_formula_read_line(above);
    const struct dalcs_formula_line b = dalcs_formula_read_line(below);
    const bool are_sides =
        a.slope == -b.slope && a.constant == -b.constant && dalcs_formula_is_same(a.of, b.of);
    return are_sides
               ? dalcs_rewriting_call(r, f, "pwrs", above, dalcs_rewriting_number(r, f, exponent))
               : f;
}

static const struct dalcs_formula *change(struct dalcs_rewriting *r,
                                          const struct dalcs_formula *f) {
    bool is_max;
    double bound;
    const struct dalcs_formula *of = find_held(f, &is_max, &bound);
    if (of == NULL) {
        return join_sides(r, f);
    }
    const struct dalcs_formula_line line = dalcs_formula_read_line(of);
    const double exponent = exponent_of(line.of);
    const double root = (bound - line.constant) / line.slope;
    const double at = copysign(pow(fabs(root), 1 / exponent), root);
    if (exponent == 0 || !isfinite(at)) {
        return f;
    }
    const bool holds_above = is_max == (line.slope > 0);
    const struct dalcs_formula *held = dalcs_rewriting_call(
        r, f, holds_above ? "max" : "min", line.of->argument[0], dalcs_rewriting_number(r, f, at));
    const struct dalcs_formula *argument[2] = {held, line.of->n > 1 ? line.of->argument[1] : NULL};
    const struct dalcs_formula *made =
        held != NULL ? dalcs_rewriting_like(r, line.of, line.of->n, argument) : NULL;
    made = made != NULL ? dalcs_rewriting_times(r, made, line.slope) : NULL;
    return made == NULL || line.constant == 0
               ? made
               : dalcs_rewriting_combine(r, f, DALCS_ADD, made,
                                         dalcs_rewriting_number(r, f, line.constant));
}

const struct dalcs_formula *dalcs_formula_held_roots(struct dalcs_arena *arena,
                                                     const struct dalcs_formula *formula) {
    return dalcs_formula_rewrite(arena, formula, change);
}
