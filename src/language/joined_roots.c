/* joined_roots.c - the roots of both sides of 0, sqrt(max(x, 0)) - sqrt(max(-x, 0)), are one with a sign, which has no
 * kink. */
#include "rewriting.h"

/* The exponent of a root with a sign; 0: it is none. */
static double exponent_of(const struct dalcs_formula *f) {
    const bool is_power = dalcs_formula_is_call(f, "pwrs") && f->n == 2 &&
                          f->argument[1]->kind == DALCS_FORMULA_NUMBER;
    const double exponent = is_power                           ? f->argument[1]->number
                            : dalcs_formula_is_call(f, "cbrt") ? 1.0 / 3.0
                                                               : 0.0;
    return exponent > 0 && exponent < 1 ? exponent : 0;
}

/* x, of max(x, 0) or uramp(x); NULL: it is neither. */
static const struct dalcs_formula *find_held(const struct dalcs_formula *f) {
    if (dalcs_formula_is_call(f, "uramp") && f->n == 1) {
        return f->argument[0];
    }
    for (int k = 0; k < 2 && dalcs_formula_is_call(f, "max") && f->n == 2; k++) {
        if (f->argument[k]->kind == DALCS_FORMULA_NUMBER && f->argument[k]->number == 0) {
            return f->argument[1 - k];
        }
    }
    return NULL;
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
    *of = exponent > 0 ? find_held(f->argument[0]) : NULL;
    return *of != NULL ? exponent : 0;
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

const struct dalcs_formula *dalcs_formula_joined_roots(struct dalcs_arena *arena,
                                                       const struct dalcs_formula *formula) {
    return dalcs_formula_rewrite(arena, formula, join_sides);
}
