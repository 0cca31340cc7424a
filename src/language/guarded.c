/* guarded.c - what a formula does not choose has no value to be found: IF(v(a) > 1, p/v(a), 0) divides by nothing.
 *
 * Where a branch is chosen only where a quantity x is above a positive number c, x counts there as max(x, c/2), where it
 * divides or is the argument of a root, a logarithm or a power: the same function where it is chosen, and one with a
 * value elsewhere. Below a negative c it is min(x, c/2). Any number between 0 and c would do. A root and a power of what is
 * above 0 begin there. Where it is chosen where |x| is above c, n/x is n x / max(x^2, c^2/4).
 *
 * In a branch that is chosen below c, exp(x) counts as exp(min(x, c + 1)): elsewhere it would grow without end, and a sum
 * with it, of which it is taken away again, keeps no digit of the branch that is chosen.
 *
 * What is divided by a choice of numbers is a product with the choice of what is 1 over them: a product with steps has an
 * exact value, a quotient of what jumps would be found by Newton's method. */
#include "rewriting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A quantity, as a branch sees it. */
struct guard {
    const struct dalcs_formula *quantity; /* no sum or product with a number */
    double limit;
    bool is_above;   /* it is above the limit, else below */
    bool is_of_size; /* its magnitude is above the limit, which is positive */
    const struct guard *outer;
};

struct guarding {
    struct dalcs_rewriting r;
    size_t n_before; /* parts that have memo[] */
};

static const struct guard *add(struct guarding *g, struct guard what) {
    struct guard *guard = dalcs_arena_alloc(g->r.arena, 1, sizeof *guard);
    if (guard == NULL) {
        g->r.failed = true;
        return what.outer;
    }
    *guard = what;
    return guard;
}

/* Does its limit keep it away from 0? */
static bool is_clear_of_0(const struct guard *guard) {
    return guard->is_above ? guard->limit > 0 : guard->limit < 0;
}

static const struct guard *add_guard(struct guarding *g, const struct guard *outer,
                                     const struct dalcs_formula *quantity, double limit,
                                     bool is_above) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(quantity);
    struct guard what = {line.of, (limit - line.constant) / line.slope,
                         is_above == (line.slope > 0), false, outer};
    if (line.of->kind == DALCS_FORMULA_NUMBER || !isfinite(what.limit)) {
        return outer;
    }
    const struct guard *guard = add(g, what);
    if (is_clear_of_0(&what) && what.is_above && dalcs_formula_is_call(line.of, "abs")) {
        what = (struct guard){line.of->argument[0], what.limit, true, true, guard};
        guard = add(g, what);
    }
    return guard;
}

/* Of two that are known each in its own case: what is known in both. */
static const struct guard *join_guards(struct guarding *g, const struct guard *outer,
                                       const struct guard *a, const struct guard *b) {
    if (a == outer || b == outer || a->is_of_size || b->is_of_size || !is_clear_of_0(a) ||
        !is_clear_of_0(b) || !dalcs_formula_is_same(a->quantity, b->quantity)) {
        return outer;
    }
    return add(
        g, (struct guard){a->quantity, fmin(fabs(a->limit), fabs(b->limit)), true, true, outer});
}

/* What is known where a condition is true, or where it is not. */
static const struct guard *read_condition(struct guarding *g, const struct dalcs_formula *f,
                                          bool is_true, const struct guard *guards) {
    if (f->kind != DALCS_FORMULA_OPERATION) {
        return guards;
    }
    const struct dalcs_formula *a = f->argument[0];
    const struct dalcs_formula *b = f->n > 1 ? f->argument[1] : NULL;
    const bool is_less = f->code == DALCS_LESS || f->code == DALCS_LESS_EQUAL;
    switch (f->code) {
    case DALCS_TO_LOGIC:
        return read_condition(g, a, is_true, guards);
    case DALCS_NOT:
        return read_condition(g, a, !is_true, guards);
    case DALCS_JUMP_AND:
    case DALCS_JUMP_OR:
        return (f->code == DALCS_JUMP_AND) == is_true
                   ? read_condition(g, b, is_true, read_condition(g, a, is_true, guards))
                   : join_guards(g, guards, read_condition(g, a, is_true, guards),
                                 read_condition(g, b, is_true, guards));
    case DALCS_LESS:
    case DALCS_LESS_EQUAL:
    case DALCS_GREATER:
    case DALCS_GREATER_EQUAL:
        return b->kind == DALCS_FORMULA_NUMBER
                   ? add_guard(g, guards, a, b->number, is_less != is_true)
               : a->kind == DALCS_FORMULA_NUMBER
                   ? add_guard(g, guards, b, a->number, is_less == is_true)
                   : guards;
    default:
        return guards;
    }
}

/* Has a part no value for some values of its argument k? */
static bool is_narrow(const struct dalcs_formula *f, int k) {
    static const char *const names[] = {"sqrt", "ln", "log", "log10", "pow", "pwr", "pwrs"};
    bool is = f->kind == DALCS_FORMULA_OPERATION &&
              ((f->code == DALCS_DIVIDE && k == 1) || (f->code == DALCS_POWER && k == 0));
    for (size_t j = 0; j < sizeof names / sizeof names[0] && !is; j++) {
        is = f->kind == DALCS_FORMULA_CALL && k == 0 && strcmp(f->function, names[j]) == 0;
    }
    return is;
}

/* Has a part a value at 0 of the argument that it has none below? */
static bool begins_at_0(const struct dalcs_formula *f) {
    const bool is_power =
        dalcs_formula_is_operation(f, DALCS_POWER) || dalcs_formula_is_call(f, "pow");
    return dalcs_formula_is_call(f, "sqrt") ||
           (is_power && f->argument[1]->kind == DALCS_FORMULA_NUMBER && f->argument[1]->number > 0);
}

/* max(x, bound) or min(x, bound). */
static const struct dalcs_formula *hold(struct guarding *g, const struct dalcs_formula *x,
                                        double bound, bool is_above) {
    const struct dalcs_formula *number = dalcs_rewriting_number(&g->r, x, bound);
    const struct dalcs_formula *held =
        dalcs_rewriting_call(&g->r, x, is_above ? "max" : "min", x, number);
    return held != NULL ? held : x;
}

/* Argument k of a part, which is above or below a number in the branch where the part is: as it counts there. */
static const struct dalcs_formula *held_argument(struct guarding *g, const struct dalcs_formula *f,
                                                 int k, const struct dalcs_formula *x, double end,
                                                 bool is_above) {
    const bool is_narrow_there = is_narrow(f, k);
    if (is_narrow_there && (is_above ? end > 0 : end < 0)) {
        return hold(g, x, 0.5 * end, is_above);
    }
    if (is_narrow_there && is_above && end == 0 && begins_at_0(f)) {
        return hold(g, x, 0, true);
    }
    const bool grows_up = !is_above && dalcs_formula_is_call(f, "exp");
    const bool grows = dalcs_formula_is_call(f, "sinh") || dalcs_formula_is_call(f, "cosh");
    return grows_up || grows ? hold(g, x, is_above ? end - 1 : end + 1, is_above) : x;
}

static const struct dalcs_formula *rebuild(struct guarding *g, const struct dalcs_formula *f,
                                           const struct guard *guards,
                                           const struct dalcs_formula **memo);

/* An argument of a part, which a condition may guard. */
static const struct dalcs_formula *argument_of(struct guarding *g, const struct dalcs_formula *f,
                                               int k, const struct guard *guards,
                                               const struct dalcs_formula **memo) {
    const struct dalcs_formula *x = f->argument[k];
    const struct guard *known = f->kind == DALCS_FORMULA_CHOICE && k > 0
                                    ? read_condition(g, f->argument[0], k == 1, guards)
                                    : guards;
    if (known != guards) { /* in this branch parts have other values */
        const struct dalcs_formula **own =
            dalcs_alloc(g->n_before, sizeof(const struct dalcs_formula *));
        g->r.failed = g->r.failed || own == NULL;
        const struct dalcs_formula *made = own != NULL ? rebuild(g, x, known, own) : x;
        free(own);
        return made;
    }
    const struct dalcs_formula *made = rebuild(g, x, guards, memo);
    const struct dalcs_formula_line line = dalcs_formula_read_line(x);
    for (const struct guard *at = guards; at != NULL; at = at->outer) {
        if (!at->is_of_size && dalcs_formula_is_same(at->quantity, line.of)) {
            const struct dalcs_formula *held =
                held_argument(g, f, k, made, line.slope * at->limit + line.constant,
                              at->is_above == (line.slope > 0));
            if (held != made) {
                return held;
            }
        }
    }
    return made;
}

/* Are all that it chooses between numbers other than 0? */
static bool is_choice_of_numbers(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_NUMBER
               ? f->number != 0
               : f->kind == DALCS_FORMULA_CHOICE && is_choice_of_numbers(f->argument[1]) &&
                     is_choice_of_numbers(f->argument[2]);
}

/* 1 over such a choice; NULL: out of memory. */
static const struct dalcs_formula *reciprocal(struct guarding *g, const struct dalcs_formula *f) {
    if (f->kind == DALCS_FORMULA_NUMBER) {
        return dalcs_rewriting_number(&g->r, f, 1 / f->number);
    }
    const struct dalcs_formula *argument[3] = {f->argument[0], reciprocal(g, f->argument[1]),
                                               reciprocal(g, f->argument[2])};
    return g->r.failed ? NULL : dalcs_rewriting_like(&g->r, f, 3, argument);
}

static const struct dalcs_formula *multiply(struct guarding *g, const struct dalcs_formula *f,
                                            const struct dalcs_formula *a,
                                            const struct dalcs_formula *b) {
    const struct dalcs_formula *made = dalcs_rewriting_product(&g->r, f, a, b);
    return made != NULL ? made : a;
}

/* Does f divide by what is larger than a bound in magnitude? Then n/x becomes n x / max(x^2, bound^2). */
static bool divide_by_size(struct guarding *g, const struct dalcs_formula *f,
                           const struct guard *guards, const struct dalcs_formula **argument) {
    const bool divides = f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_DIVIDE;
    for (const struct guard *at = guards; at != NULL && divides; at = at->outer) {
        if (at->is_of_size && dalcs_formula_is_same(at->quantity, f->argument[1])) {
            const struct dalcs_formula *x = argument[1];
            argument[0] = multiply(g, f, argument[0], x);
            argument[1] = hold(g, multiply(g, f, x, x), 0.25 * at->limit * at->limit, true);
            return true;
        }
    }
    return false;
}

/* A part as f is, of these arguments; f itself where they are its own. */
static const struct dalcs_formula *with_arguments(struct guarding *g, const struct dalcs_formula *f,
                                                  const struct dalcs_formula **argument,
                                                  bool is_new) {
    const bool divides = f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_DIVIDE &&
                         argument[0]->kind != DALCS_FORMULA_NUMBER &&
                         argument[1]->kind == DALCS_FORMULA_CHOICE &&
                         is_choice_of_numbers(argument[1]);
    if (divides) {
        argument[1] = reciprocal(g, argument[1]);
    }
    struct dalcs_formula *made =
        (is_new || divides) && !g->r.failed ? dalcs_rewriting_like(&g->r, f, f->n, argument) : NULL;
    if (made != NULL && divides) {
        made->code = DALCS_MULTIPLY;
    }
    return made != NULL ? made : f;
}

static const struct dalcs_formula *rebuild(struct guarding *g, const struct dalcs_formula *f,
                                           const struct guard *guards,
                                           const struct dalcs_formula **memo) {
    const struct dalcs_formula **known = &memo[f->number_of];
    if (f->n == 0 || *known != NULL || g->r.failed) {
        return *known != NULL ? *known : f;
    }
    const struct dalcs_formula **argument =
        dalcs_alloc((size_t)f->n, sizeof(const struct dalcs_formula *));
    bool is_new = false;
    g->r.failed = g->r.failed || argument == NULL;
    for (int k = 0; k < f->n && !g->r.failed; k++) {
        argument[k] = argument_of(g, f, k, guards, memo);
        is_new = is_new || argument[k] != f->argument[k];
    }
    is_new = (!g->r.failed && divide_by_size(g, f, guards, argument)) || is_new;
    *known = g->r.failed ? f : with_arguments(g, f, argument, is_new);
    free(argument);
    return *known;
}

const struct dalcs_formula *dalcs_formula_guard(struct dalcs_arena *arena,
                                                const struct dalcs_formula *formula) {
    struct guarding g = {.r = {.arena = arena, .n_parts = formula->number_of + 1},
                         .n_before = (size_t)formula->number_of + 1};
    const struct dalcs_formula **memo =
        dalcs_alloc(g.n_before, sizeof(const struct dalcs_formula *));
    g.r.failed = memo == NULL;
    const struct dalcs_formula *made = memo != NULL ? rebuild(&g, formula, NULL, memo) : formula;
    free(memo);
    return g.r.failed ? NULL : made;
}
