/* rewriting.c - parts of formulas that stand for others. */
#include "rewriting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_same_name(const struct dalcs_token *a, const struct dalcs_token *b) {
    return a == b || (a != NULL && b != NULL && strcmp(a->text, b->text) == 0);
}

bool dalcs_formula_is_same(const struct dalcs_formula *a, const struct dalcs_formula *b) {
    bool is = a == b;
    if (!is && a->kind == b->kind && a->code == b->code && a->n == b->n &&
        (a->kind != DALCS_FORMULA_NUMBER || a->number == b->number) &&
        is_same_name(a->signal[0], b->signal[0]) && is_same_name(a->signal[1], b->signal[1]) &&
        (a->kind != DALCS_FORMULA_CALL || strcmp(a->function, b->function) == 0)) {
        is = true;
        for (int k = 0; k < a->n && is; k++) {
            is = dalcs_formula_is_same(a->argument[k], b->argument[k]);
        }
    }
    return is;
}

bool dalcs_formula_is_call(const struct dalcs_formula *f, const char *name) {
    return f->kind == DALCS_FORMULA_CALL && strcmp(f->function, name) == 0;
}

bool dalcs_formula_is_operation(const struct dalcs_formula *f, enum dalcs_operation_code code) {
    return f->kind == DALCS_FORMULA_OPERATION && f->code == code;
}

static bool is_number(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_NUMBER;
}

/* One operation with a number, taken off the outside; false: there is none. */
static bool take_off(struct dalcs_formula_line *line) {
    const struct dalcs_formula *f = line->of;
    const struct dalcs_formula *a = f->n > 0 ? f->argument[0] : NULL;
    const struct dalcs_formula *b = f->n > 1 ? f->argument[1] : NULL;
    const bool is_sum = dalcs_formula_is_operation(f, DALCS_ADD);
    const bool is_product = dalcs_formula_is_operation(f, DALCS_MULTIPLY);
    double factor = 1.0;
    double shift = 0.0;
    if (dalcs_formula_is_operation(f, DALCS_NEGATE)) {
        factor = -1.0;
        line->of = a;
    } else if ((is_sum || is_product) && (is_number(a) || is_number(b))) {
        const double number = is_number(b) ? b->number : a->number;
        factor = is_product ? number : 1.0;
        shift = is_sum ? number : 0.0;
        line->of = is_number(b) ? a : b;
    } else if (dalcs_formula_is_operation(f, DALCS_SUBTRACT) && (is_number(a) || is_number(b))) {
        factor = is_number(b) ? 1.0 : -1.0;
        shift = is_number(b) ? -b->number : a->number;
        line->of = is_number(b) ? a : b;
    } else if (dalcs_formula_is_operation(f, DALCS_DIVIDE) && is_number(b)) {
        factor = 1.0 / b->number;
        line->of = a;
    }
    if (factor == 0.0 || !isfinite(factor)) {
        line->of = f;
    }
    if (line->of != f) {
        line->constant += line->slope * shift;
        line->slope *= factor;
    }
    return line->of != f;
}

struct dalcs_formula_line dalcs_formula_read_line(const struct dalcs_formula *f) {
    struct dalcs_formula_line line = {f, 1.0, 0.0};
    while (take_off(&line)) {
    }
    return line;
}

struct dalcs_formula *dalcs_rewriting_like(struct dalcs_rewriting *r, const struct dalcs_formula *f,
                                           int n, const struct dalcs_formula *const *argument) {
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

struct dalcs_formula *dalcs_rewriting_number(struct dalcs_rewriting *r,
                                             const struct dalcs_formula *f, double value) {
    struct dalcs_formula *number = dalcs_rewriting_like(r, f, 0, NULL);
    if (number != NULL) {
        number->kind = DALCS_FORMULA_NUMBER;
        number->number = value;
    }
    return number;
}

static struct dalcs_formula *of_two(struct dalcs_rewriting *r, const struct dalcs_formula *f,
                                    enum dalcs_formula_kind kind, const struct dalcs_formula *a,
                                    const struct dalcs_formula *b) {
    struct dalcs_formula *made =
        a != NULL && b != NULL
            ? dalcs_rewriting_like(r, f, 2, (const struct dalcs_formula *[]){a, b})
            : NULL;
    if (made != NULL) {
        made->kind = kind;
    }
    return made;
}

struct dalcs_formula *dalcs_rewriting_call(struct dalcs_rewriting *r, const struct dalcs_formula *f,
                                           const char *function, const struct dalcs_formula *a,
                                           const struct dalcs_formula *b) {
    struct dalcs_formula *call = of_two(r, f, DALCS_FORMULA_CALL, a, b);
    if (call != NULL) {
        call->function = function;
    }
    return call;
}

struct dalcs_formula *dalcs_rewriting_product(struct dalcs_rewriting *r,
                                              const struct dalcs_formula *f,
                                              const struct dalcs_formula *a,
                                              const struct dalcs_formula *b) {
    struct dalcs_formula *product = of_two(r, f, DALCS_FORMULA_OPERATION, a, b);
    if (product != NULL) {
        product->code = DALCS_MULTIPLY;
    }
    return product;
}

static bool is_number_of(const struct dalcs_formula *f, double number) {
    return f != NULL && f->kind == DALCS_FORMULA_NUMBER && f->number == number;
}

const struct dalcs_formula *dalcs_rewriting_combine(struct dalcs_rewriting *r,
                                                    const struct dalcs_formula *at,
                                                    enum dalcs_operation_code code,
                                                    const struct dalcs_formula *a,
                                                    const struct dalcs_formula *b) {
    const double none = code == DALCS_ADD ? 0 : 1;
    if (a == NULL || b == NULL || is_number_of(a, none) || is_number_of(b, none)) {
        return a == NULL || b == NULL ? NULL : is_number_of(a, none) ? b : a;
    }
    if (code == DALCS_MULTIPLY && (is_number_of(a, 0) || is_number_of(b, 0))) {
        return is_number_of(a, 0) ? a : b;
    }
    struct dalcs_formula *made = dalcs_rewriting_product(r, at, a, b);
    if (made != NULL) {
        made->code = code;
    }
    return made;
}

const struct dalcs_formula *dalcs_rewriting_times(struct dalcs_rewriting *r,
                                                  const struct dalcs_formula *f, double factor) {
    return f == NULL || factor == 1
               ? f
               : dalcs_rewriting_combine(r, f, DALCS_MULTIPLY, dalcs_rewriting_number(r, f, factor),
                                         f);
}

/* Does it have no slope where its argument is 0, or no value beyond? */
static bool is_root(const struct dalcs_formula *f) {
    static const char *const roots[] = {"sqrt", "cbrt", "ln", "log", "log10", NULL};
    static const char *const powers[] = {"pow", "pwr", "pwrs", NULL};
    const bool is_power =
        dalcs_formula_is_operation(f, DALCS_POWER) || dalcs_formula_is_call_of(f, powers);
    return dalcs_formula_is_call_of(f, roots) ||
           (is_power && (!is_number(f->argument[1]) ||
                         f->argument[1]->number != floor(f->argument[1]->number)));
}

static bool is_root_beneath(const struct dalcs_formula *f, bool is_beneath) {
    const bool is_factor = dalcs_formula_is_operation(f, DALCS_MULTIPLY) ||
                           dalcs_formula_is_operation(f, DALCS_DIVIDE) ||
                           dalcs_formula_is_operation(f, DALCS_NEGATE);
    return is_root(f) || (is_beneath && is_factor);
}

static const struct dalcs_formula *rebuild(struct dalcs_rewriting *r, const struct dalcs_formula *f,
                                           const struct dalcs_formula **memo,
                                           dalcs_rewriting_change *change) {
    if (f->n == 0 || memo[f->number_of] != NULL || r->failed) {
        return f->n == 0 || r->failed ? f : memo[f->number_of];
    }
    const struct dalcs_formula **argument =
        dalcs_alloc((size_t)f->n, sizeof(const struct dalcs_formula *));
    bool is_new = false;
    const bool is_beneath_root = r->is_beneath_root;
    r->failed = argument == NULL;
    r->is_beneath_root = is_root_beneath(f, is_beneath_root);
    for (int k = 0; k < f->n && !r->failed; k++) {
        argument[k] = rebuild(r, f->argument[k], memo, change);
        is_new = is_new || argument[k] != f->argument[k];
    }
    r->is_beneath_root = is_beneath_root;
    const struct dalcs_formula *made =
        is_new && !r->failed ? dalcs_rewriting_like(r, f, f->n, argument) : f;
    free(argument);
    const struct dalcs_formula *changed = made != NULL && !r->failed ? change(r, made) : NULL;
    memo[f->number_of] = changed != NULL ? changed : f;
    return memo[f->number_of];
}

const struct dalcs_formula *dalcs_formula_rewrite(struct dalcs_arena *arena,
                                                  const struct dalcs_formula *formula,
                                                  dalcs_rewriting_change *change) {
    return dalcs_formula_rewrite_in(arena, formula, DALCS_DIALECT_UNKNOWN, change);
}

const struct dalcs_formula *dalcs_formula_rewrite_in(struct dalcs_arena *arena,
                                                     const struct dalcs_formula *formula,
                                                     enum dalcs_dialect_name dialect,
                                                     dalcs_rewriting_change *change) {
    struct dalcs_rewriting r = {
        .arena = arena, .dialect = dialect, .n_parts = formula->number_of + 1};
    const struct dalcs_formula **memo =
        dalcs_alloc((size_t)r.n_parts, sizeof(const struct dalcs_formula *));
    r.failed = memo == NULL;
    const struct dalcs_formula *made = memo != NULL ? rebuild(&r, formula, memo, change) : formula;
    free(memo);
    return r.failed ? NULL : made;
}
