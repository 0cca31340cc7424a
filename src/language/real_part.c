/* real_part.c - roots, powers and inverse functions beyond their domain, where LTspice and Xyce take the real part.
 *
 * Both compute with complex numbers and keep the real part: sqrt(x) is 0 below 0, x**1.5 too, asin(x) is pi/2 above 1,
 * acosh(x) is 0 below 1. That is the function of the argument held in the domain. x**y with a whole y has a value
 * anyway. The real part of x**y is |x|^y cos(pi y) below 0: that is 0 where 2 y is odd, and the powers of other
 * exponents stay as they are. */
#include "rewriting.h"

#include <math.h>

static bool is_even_power(const struct dalcs_formula *f) {
    const bool is_power =
        dalcs_formula_is_operation(f, DALCS_POWER) || dalcs_formula_is_call(f, "pow");
    return is_power && f->argument[1]->kind == DALCS_FORMULA_NUMBER &&
           fmod(f->argument[1]->number, 2) == 0;
}

/* Is it above or at 0, whatever the signals are? Then it needs no bound, which would be a kink. */
static bool is_nonnegative(const struct dalcs_formula *f) {
    static const char *const names[] = {"abs", "sqr", "square", "sqrt", "exp", "hypot", "uramp"};
    bool is = f->kind == DALCS_FORMULA_NUMBER ? f->number >= 0 : is_even_power(f);
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !is; k++) {
        is = dalcs_formula_is_call(f, names[k]);
    }
    if (dalcs_formula_is_operation(f, DALCS_ADD) || dalcs_formula_is_operation(f, DALCS_DIVIDE)) {
        is = is_nonnegative(f->argument[0]) && is_nonnegative(f->argument[1]);
    } else if (dalcs_formula_is_operation(f, DALCS_MULTIPLY)) {
        is = f->argument[0] == f->argument[1] ||
             (is_nonnegative(f->argument[0]) && is_nonnegative(f->argument[1]));
    } else if (dalcs_formula_is_call(f, "max")) {
        is = f->n == 2 && (is_nonnegative(f->argument[0]) || is_nonnegative(f->argument[1]));
    }
    return is;
}

/* Is its magnitude at most 1, whatever the signals are? Products of such parts stay so with rounding, sums may not.
 * asin(sin(x)) must stay as it is written: a bound in between would hide the triangle that it is. */
static bool is_within_1(const struct dalcs_formula *f) {
    static const char *const names[] = {"sin", "cos", "tanh", "sgn", "u", "u2", "buf", "inv"};
    const struct dalcs_formula_line line = dalcs_formula_read_line(f);
    bool is = false;
    if (f->kind == DALCS_FORMULA_NUMBER) {
        return fabs(f->number) <= 1;
    }
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !is; k++) {
        is = dalcs_formula_is_call(line.of, names[k]);
    }
    if (dalcs_formula_is_operation(line.of, DALCS_MULTIPLY)) {
        is = is_within_1(line.of->argument[0]) && is_within_1(line.of->argument[1]);
    } else if (dalcs_formula_is_call(line.of, "limit")) {
        is = line.of->n == 3 && is_within_1(line.of->argument[1]) &&
             is_within_1(line.of->argument[2]);
    }
    return is && line.constant == 0 && fabs(line.slope) <= 1;
}

/* The domain of the first argument of a part; false: all numbers, or others than this file holds. */
static bool find_domain(const struct dalcs_formula *f, double *low, double *high) {
    const bool is_power =
        (dalcs_formula_is_operation(f, DALCS_POWER) || dalcs_formula_is_call(f, "pow")) &&
        f->argument[1]->kind == DALCS_FORMULA_NUMBER;
    const bool is_root =
        dalcs_formula_is_call(f, "sqrt") ||
        (is_power && f->argument[1]->number > 0 && fmod(2 * f->argument[1]->number, 2) == 1);
    const bool is_arc = dalcs_formula_is_call(f, "asin") || dalcs_formula_is_call(f, "arcsin") ||
                        dalcs_formula_is_call(f, "acos") || dalcs_formula_is_call(f, "arccos");
    *low = is_arc ? -1 : is_root ? 0 : 1;
    *high = is_arc ? 1 : INFINITY;
    return (is_arc && !is_within_1(f->argument[0])) ||
           (is_root && !is_nonnegative(f->argument[0])) || dalcs_formula_is_call(f, "acosh");
}

/* max(x, bound) or min(x, bound); x itself where the bound is not finite. */
static const struct dalcs_formula *hold(struct dalcs_rewriting *r, const struct dalcs_formula *x,
                                        const char *function, double bound) {
    return isfinite(bound)
               ? dalcs_rewriting_call(r, x, function, x, dalcs_rewriting_number(r, x, bound))
               : x;
}

static const struct dalcs_formula *change(struct dalcs_rewriting *r,
                                          const struct dalcs_formula *f) {
    double low;
    double high;
    if (!find_domain(f, &low, &high)) {
        return f;
    }
    const struct dalcs_formula *above = hold(r, f->argument[0], "max", low);
    const struct dalcs_formula *held = above != NULL ? hold(r, above, "min", high) : NULL;
    return held == NULL ? NULL
                        : dalcs_rewriting_like(r, f, f->n,
                                               (const struct dalcs_formula *[]){
                                                   held, f->n > 1 ? f->argument[1] : NULL});
}

const struct dalcs_formula *dalcs_formula_real_part(struct dalcs_arena *arena,
                                                    const struct dalcs_formula *formula) {
    return dalcs_formula_rewrite(arena, formula, change);
}
