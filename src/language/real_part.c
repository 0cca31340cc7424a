/* real_part.c - roots, powers and inverse functions beyond their domain, where LTspice and Xyce take the real part.
 *
 * Both compute with complex numbers and keep the real part: sqrt(x) is 0 below 0, x**1.5 too, asin(x) is pi/2 above 1,
 * acosh(x) is 0 below 1. That is the function of the argument held in the domain. x**y with a whole y has a value
 * anyway. The real part of x**y is |x|^y cos(pi y) below 0: that is 0 where 2 y is odd, and the powers of other
 * exponents stay as they are. */
#include "language.h"

#include "formula.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct real_part {
    struct dalcs_arena *arena;
    int n_parts; /* the next number */
    bool failed; /* out of memory */
};

static bool is_call(const struct dalcs_formula *f, const char *name) {
    return f->kind == DALCS_FORMULA_CALL && strcmp(f->function, name) == 0;
}

static bool is_operation(const struct dalcs_formula *f, enum dalcs_operation_code code) {
    return f->kind == DALCS_FORMULA_OPERATION && f->code == code;
}

static bool is_even_power(const struct dalcs_formula *f) {
    const bool is_power = is_operation(f, DALCS_POWER) || is_call(f, "pow");
    return is_power && f->argument[1]->kind == DALCS_FORMULA_NUMBER &&
           fmod(f->argument[1]->number, 2) == 0;
}

/* Is it above or at 0, whatever the signals are? Then it needs no bound, which would be a kink. */
static bool is_nonnegative(const struct dalcs_formula *f) {
    static const char *const names[] = {"abs", "sqr", "square", "sqrt", "exp", "hypot", "uramp"};
    bool is = f->kind == DALCS_FORMULA_NUMBER ? f->number >= 0 : is_even_power(f);
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !is; k++) {
        is = is_call(f, names[k]);
    }
    if (is_operation(f, DALCS_ADD) || is_operation(f, DALCS_DIVIDE)) {
        is = is_nonnegative(f->argument[0]) && is_nonnegative(f->argument[1]);
    } else if (is_operation(f, DALCS_MULTIPLY)) {
        is = f->argument[0] == f->argument[1] ||
             (is_nonnegative(f->argument[0]) && is_nonnegative(f->argument[1]));
    } else if (is_call(f, "max")) {
        is = f->n == 2 && (is_nonnegative(f->argument[0]) || is_nonnegative(f->argument[1]));
    }
    return is;
}

/* The domain of the first argument of a part; false: all numbers, or others than this file holds. */
static bool find_domain(const struct dalcs_formula *f, double *low, double *high) {
    const bool is_power = (is_operation(f, DALCS_POWER) || is_call(f, "pow")) &&
                          f->argument[1]->kind == DALCS_FORMULA_NUMBER;
    const bool is_root = is_call(f, "sqrt") || (is_power && f->argument[1]->number > 0 &&
                                                fmod(2 * f->argument[1]->number, 2) == 1);
    const bool is_arc =
        is_call(f, "asin") || is_call(f, "arcsin") || is_call(f, "acos") || is_call(f, "arccos");
    *low = is_arc ? -1 : is_root ? 0 : 1;
    *high = is_arc ? 1 : INFINITY;
    return is_arc || (is_root && !is_nonnegative(f->argument[0])) || is_call(f, "acosh");
}

/* A copy of a part with other arguments; NULL: out of memory. */
static struct dalcs_formula *copy(struct real_part *r, const struct dalcs_formula *f, int n,
                                  const struct dalcs_formula *const *argument) {
    struct dalcs_formula *made = dalcs_arena_alloc(r->arena, 1, sizeof *made);
    const struct dalcs_formula **list =
        dalcs_arena_alloc(r->arena, (size_t)n + 1, sizeof(const struct dalcs_formula *));
    if (made == NULL || list == NULL) {
        r->failed = true;
        return NULL;
    }
    for (int k = 0; k < n; k++) {
        list[k] = argument[k];
    }
    *made = *f;
    made->number_of = r->n_parts++;
    made->n = n;
    made->argument = list;
    return made;
}

/* max(x, bound) or min(x, bound); x itself where the bound is not finite. */
static const struct dalcs_formula *hold(struct real_part *r, const struct dalcs_formula *x,
                                        const char *function, double bound) {
    struct dalcs_formula *number = isfinite(bound) ? copy(r, x, 0, NULL) : NULL;
    struct dalcs_formula *held =
        number != NULL ? copy(r, x, 2, (const struct dalcs_formula *[]){x, number}) : NULL;
    if (held == NULL) {
        return x;
    }
    number->kind = DALCS_FORMULA_NUMBER;
    number->number = bound;
    held->kind = DALCS_FORMULA_CALL;
    held->function = function;
    return held;
}

static const struct dalcs_formula *rebuild(struct real_part *r, const struct dalcs_formula *f,
                                           const struct dalcs_formula **memo) {
    if (f->n == 0 || memo[f->number_of] != NULL || r->failed) {
        return f->n == 0 || r->failed ? f : memo[f->number_of];
    }
    const struct dalcs_formula **argument =
        dalcs_alloc((size_t)f->n, sizeof(const struct dalcs_formula *));
    bool is_new = false;
    double low;
    double high;
    r->failed = argument == NULL;
    for (int k = 0; k < f->n && !r->failed; k++) {
        argument[k] = rebuild(r, f->argument[k], memo);
        is_new = is_new || argument[k] != f->argument[k];
    }
    if (!r->failed && find_domain(f, &low, &high)) {
        argument[0] = hold(r, hold(r, argument[0], "max", low), "min", high);
        is_new = true;
    }
    const struct dalcs_formula *made = is_new && !r->failed ? copy(r, f, f->n, argument) : NULL;
    free(argument);
    memo[f->number_of] = made != NULL ? made : f;
    return memo[f->number_of];
}

const struct dalcs_formula *dalcs_formula_real_part(struct dalcs_language *language,
                                                    const struct dalcs_formula *formula) {
    struct real_part r = {.arena = language->arena, .n_parts = formula->number_of + 1};
    const struct dalcs_formula **memo =
        dalcs_alloc((size_t)r.n_parts, sizeof(const struct dalcs_formula *));
    r.failed = memo == NULL;
    const struct dalcs_formula *made = memo != NULL ? rebuild(&r, formula, memo) : formula;
    free(memo);
    language->out_of_memory = language->out_of_memory || r.failed;
    return made;
}
