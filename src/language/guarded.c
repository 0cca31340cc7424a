/* guarded.c - what a formula does not choose has no value to be found: IF(v(a) > 1, p/v(a), 0) divides by nothing.
 *
 * Where a branch is chosen only where a quantity x is above a positive number c, x counts there as max(x, c/2), where it
 * divides or is the argument of a root, a logarithm or a power: the same function where it is chosen, and one with a
 * value elsewhere. Below a negative c it is min(x, c/2). Any number between 0 and c would do. Where it is chosen where |x|
 * is above c, n/x is n x / max(x^2, c^2/4).
 *
 * What is divided by a choice of numbers is a product with the choice of what is 1 over them: a product with steps has an
 * exact value, a quotient of what jumps would be found by Newton's method. */
#include "language.h"

#include "formula.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A quantity, as a branch sees it. */
struct guard {
    const struct dalcs_formula *quantity;
    double bound;    /* above 0: it is larger; below 0: it is smaller */
    bool is_of_size; /* its magnitude is larger than the bound */
    const struct guard *outer;
};

struct guarding {
    struct dalcs_arena *arena;
    int n_parts;     /* the next number */
    size_t n_before; /* parts that have memo[] */
    bool failed;     /* out of memory */
};

static bool is_same_name(const struct dalcs_token *a, const struct dalcs_token *b) {
    return a == b || (a != NULL && b != NULL && strcmp(a->text, b->text) == 0);
}

static bool is_same(const struct dalcs_formula *a, const struct dalcs_formula *b) {
    bool is = a == b;
    if (!is && a->kind == b->kind && a->code == b->code && a->n == b->n &&
        (a->kind != DALCS_FORMULA_NUMBER || a->number == b->number) &&
        is_same_name(a->signal[0], b->signal[0]) && is_same_name(a->signal[1], b->signal[1]) &&
        (a->kind != DALCS_FORMULA_CALL || strcmp(a->function, b->function) == 0)) {
        is = true;
        for (int k = 0; k < a->n && is; k++) {
            is = is_same(a->argument[k], b->argument[k]);
        }
    }
    return is;
}

static const struct guard *add_guard_of_size(struct guarding *g, const struct guard *outer,
                                             const struct dalcs_formula *quantity, double bound) {
    struct guard *guard = dalcs_arena_alloc(g->arena, 1, sizeof *guard);
    if (guard == NULL) {
        g->failed = true;
        return outer;
    }
    *guard = (struct guard){quantity, bound, true, outer};
    return guard;
}

static const struct guard *add_guard(struct guarding *g, const struct guard *outer,
                                     const struct dalcs_formula *quantity, double limit,
                                     bool is_above) {
    if (quantity->kind == DALCS_FORMULA_NUMBER || !(is_above ? limit > 0 : limit < 0)) {
        return outer;
    }
    struct guard *guard = dalcs_arena_alloc(g->arena, 1, sizeof *guard);
    if (guard == NULL) {
        g->failed = true;
        return outer;
    }
    *guard = (struct guard){quantity, 0.5 * limit, false, outer};
    const bool is_size = is_above && quantity->kind == DALCS_FORMULA_CALL && quantity->n == 1 &&
                         strcmp(quantity->function, "abs") == 0;
    return is_size ? add_guard_of_size(g, guard, quantity->argument[0], 0.5 * limit) : guard;
}

/* Of two that are known each in its own case: what is known in both. */
static const struct guard *join_guards(struct guarding *g, const struct guard *outer,
                                       const struct guard *a, const struct guard *b) {
    if (a == outer || b == outer || a->is_of_size || b->is_of_size ||
        !is_same(a->quantity, b->quantity)) {
        return outer;
    }
    return add_guard_of_size(g, outer, a->quantity, fmin(fabs(a->bound), fabs(b->bound)));
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

/* A part as another one is, of other arguments; NULL: out of memory. */
static struct dalcs_formula *make_like(struct guarding *g, const struct dalcs_formula *f, int n,
                                       const struct dalcs_formula *const *argument) {
    struct dalcs_formula *made = dalcs_arena_alloc(g->arena, 1, sizeof *made);
    const struct dalcs_formula **list =
        dalcs_arena_alloc(g->arena, (size_t)n + 1, sizeof(const struct dalcs_formula *));
    if (made == NULL || list == NULL) {
        g->failed = true;
        return NULL;
    }
    for (int k = 0; k < n; k++) {
        list[k] = argument[k];
    }
    *made = *f;
    made->number_of = g->n_parts++;
    made->n = n;
    made->argument = list;
    return made;
}

/* max(x, bound) or min(x, bound). */
static const struct dalcs_formula *hold(struct guarding *g, const struct dalcs_formula *x,
                                        double bound) {
    struct dalcs_formula *number = make_like(g, x, 0, NULL);
    if (number == NULL) {
        return x;
    }
    number->kind = DALCS_FORMULA_NUMBER;
    number->number = bound;
    struct dalcs_formula *held = make_like(g, x, 2, (const struct dalcs_formula *[]){x, number});
    if (held == NULL) {
        return x;
    }
    held->kind = DALCS_FORMULA_CALL;
    held->function = bound > 0 ? "max" : "min";
    return held;
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
        g->failed = g->failed || own == NULL;
        const struct dalcs_formula *made = own != NULL ? rebuild(g, x, known, own) : x;
        free(own);
        return made;
    }
    const struct dalcs_formula *made = rebuild(g, x, guards, memo);
    for (const struct guard *at = guards; at != NULL && is_narrow(f, k); at = at->outer) {
        if (!at->is_of_size && is_same(at->quantity, x)) {
            return hold(g, made, at->bound);
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
        struct dalcs_formula *number = make_like(g, f, 0, NULL);
        if (number != NULL) {
            number->number = 1 / f->number;
        }
        return number;
    }
    const struct dalcs_formula *argument[3] = {f->argument[0], reciprocal(g, f->argument[1]),
                                               reciprocal(g, f->argument[2])};
    return g->failed ? NULL : make_like(g, f, 3, argument);
}

static const struct dalcs_formula *multiply(struct guarding *g, const struct dalcs_formula *f,
                                            const struct dalcs_formula *a,
                                            const struct dalcs_formula *b) {
    struct dalcs_formula *made = make_like(g, f, 2, (const struct dalcs_formula *[]){a, b});
    if (made != NULL) {
        made->code = DALCS_MULTIPLY;
    }
    return made != NULL ? made : a;
}

/* Does f divide by what is larger than a bound in magnitude? Then n/x becomes n x / max(x^2, bound^2). */
static bool divide_by_size(struct guarding *g, const struct dalcs_formula *f,
                           const struct guard *guards, const struct dalcs_formula **argument) {
    const bool divides = f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_DIVIDE;
    for (const struct guard *at = guards; at != NULL && divides; at = at->outer) {
        if (at->is_of_size && is_same(at->quantity, f->argument[1])) {
            const struct dalcs_formula *x = argument[1];
            argument[0] = multiply(g, f, argument[0], x);
            argument[1] = hold(g, multiply(g, f, x, x), at->bound * at->bound);
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
        (is_new || divides) && !g->failed ? make_like(g, f, f->n, argument) : NULL;
    if (made != NULL && divides) {
        made->code = DALCS_MULTIPLY;
    }
    return made != NULL ? made : f;
}

static const struct dalcs_formula *rebuild(struct guarding *g, const struct dalcs_formula *f,
                                           const struct guard *guards,
                                           const struct dalcs_formula **memo) {
    const struct dalcs_formula **known = &memo[f->number_of];
    if (f->n == 0 || *known != NULL || g->failed) {
        return *known != NULL ? *known : f;
    }
    const struct dalcs_formula **argument =
        dalcs_alloc((size_t)f->n, sizeof(const struct dalcs_formula *));
    bool is_new = false;
    g->failed = g->failed || argument == NULL;
    for (int k = 0; k < f->n && !g->failed; k++) {
        argument[k] = argument_of(g, f, k, guards, memo);
        is_new = is_new || argument[k] != f->argument[k];
    }
    is_new = (!g->failed && divide_by_size(g, f, guards, argument)) || is_new;
    *known = g->failed ? f : with_arguments(g, f, argument, is_new);
    free(argument);
    return *known;
}

const struct dalcs_formula *dalcs_formula_guard(struct dalcs_language *language,
                                                const struct dalcs_formula *formula, int n_parts) {
    struct guarding g = {
        .arena = language->arena, .n_parts = n_parts, .n_before = (size_t)formula->number_of + 1};
    const struct dalcs_formula **memo =
        dalcs_alloc(g.n_before, sizeof(const struct dalcs_formula *));
    g.failed = memo == NULL;
    const struct dalcs_formula *made = memo != NULL ? rebuild(&g, formula, NULL, memo) : formula;
    free(memo);
    language->out_of_memory = language->out_of_memory || g.failed;
    return made;
}
