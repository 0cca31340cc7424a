/* formula_build.c - an operation on formulas rather than on numbers.
 *
 * Where all operands are numbers the same operation of evaluate.c makes them one, so that both say the
 * same about what is wrong. */
#include "formula_build.h"

#include <stdlib.h>

/* Functions that write themselves out again and again: no person wrote such a formula. */
enum { MOST_PARTS = 100000 };

static struct dalcs_location place_of(const struct dalcs_formula_work *w,
                                      const struct dalcs_formula_frame *f, int begin, int end) {
    struct dalcs_location where =
        dalcs_expression_place(&f->expression->text, begin, end > begin ? end - begin : 1);
    where.instance = w->scope->origin;
    return where;
}

void dalcs_formula_fail(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                        const struct dalcs_operation *o, const char *hint, const char *format,
                        const char *name) {
    dalcs_language_report_at(w->language, DALCS_ERROR, w->scope,
                             place_of(w, f, o->begin, o->begin + o->length), hint, format, name);
    w->failed = true;
}

void dalcs_formula_push(struct dalcs_formula_work *w, const struct dalcs_formula *formula) {
    if (formula == NULL || dalcs_grow(&w->stack, &w->capacity, w->n + 1,
                                      sizeof(const struct dalcs_formula *)) != DALCS_OK) {
        w->language->out_of_memory = true;
        w->failed = true;
        return;
    }
    w->stack[w->n++] = formula;
}

struct dalcs_formula *dalcs_formula_part(struct dalcs_formula_work *w,
                                         const struct dalcs_formula_frame *f,
                                         const struct dalcs_operation *o,
                                         enum dalcs_formula_kind kind) {
    struct dalcs_formula *made = dalcs_arena_alloc(w->language->arena, 1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    if (w->n_parts >= MOST_PARTS) {
        dalcs_formula_fail(w, f, o, NULL, "%s is written out in too many parts", "the formula");
        return NULL;
    }
    *made = (struct dalcs_formula){.kind = kind,
                                   .code = o->code,
                                   .number_of = w->n_parts++,
                                   .text = &f->expression->text,
                                   .begin = o->begin,
                                   .end = o->begin + o->length};
    made->where = place_of(w, f, made->begin, made->end);
    return made;
}

void dalcs_formula_push_over(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                             const struct dalcs_operation *o, enum dalcs_formula_kind kind, int n) {
    struct dalcs_formula *made = dalcs_formula_part(w, f, o, kind);
    const struct dalcs_formula **argument =
        dalcs_arena_alloc(w->language->arena, (size_t)n, sizeof(const struct dalcs_formula *));
    if (made == NULL || argument == NULL) {
        dalcs_formula_push(w, NULL);
        return;
    }
    w->n -= (size_t)n;
    for (int k = 0; k < n; k++) {
        argument[k] = w->stack[w->n + (size_t)k];
        if (argument[k]->text == made->text) {
            made->begin = argument[k]->begin < made->begin ? argument[k]->begin : made->begin;
            made->end = argument[k]->end > made->end ? argument[k]->end : made->end;
        }
    }
    made->n = n;
    made->argument = argument;
    made->function = kind == DALCS_FORMULA_CALL ? o->u.name : NULL;
    made->where = place_of(w, f, made->begin, made->end);
    dalcs_formula_push(w, made);
}

bool dalcs_formula_are_numbers(const struct dalcs_formula_work *w, int n) {
    for (int k = 1; k <= n; k++) {
        if (w->stack[w->n - (size_t)k]->kind != DALCS_FORMULA_NUMBER) {
            return false;
        }
    }
    return true;
}

void dalcs_formula_fold(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                        const struct dalcs_operation *o, int n) {
    struct dalcs_operation *operation =
        dalcs_alloc((size_t)n + 1, sizeof *operation); /* of a small expression of its own */
    if (operation == NULL) {
        dalcs_formula_push(w, NULL);
        return;
    }
    for (int k = 0; k < n; k++) {
        operation[k] = (struct dalcs_operation){
            .code = DALCS_PUSH_NUMBER, .u.number = w->stack[w->n - (size_t)(n - k)]->number};
    }
    operation[n] = *o;
    struct dalcs_expression expression = {f->expression->text, operation, n + 1, false};
    double value;
    const bool ok = dalcs_scope_evaluate(w->language, w->scope, &expression, &value);
    free(operation);
    struct dalcs_formula *number = ok ? dalcs_formula_part(w, f, o, DALCS_FORMULA_NUMBER) : NULL;
    if (number == NULL) {
        w->failed = true;
        return;
    }
    number->number = value;
    w->n -= (size_t)n;
    dalcs_formula_push(w, number);
}

/* Is it 1 or 0, whatever the signals are? */
static bool is_logic(const struct dalcs_formula *formula) {
    const enum dalcs_operation_code code = formula->code;
    if (formula->kind == DALCS_FORMULA_NUMBER) {
        return formula->number == 0 || formula->number == 1;
    }
    return formula->kind == DALCS_FORMULA_OPERATION &&
           ((code >= DALCS_LESS && code <= DALCS_TO_LOGIC) || code == DALCS_NOT ||
            code == DALCS_JUMP_AND || code == DALCS_JUMP_OR);
}

/* One operation more on the topmost n. */
static void apply_code(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                       const struct dalcs_operation *o, enum dalcs_operation_code code, int n) {
    const struct dalcs_operation operation = {.code = code, .begin = o->begin, .length = o->length};
    if (!w->failed) {
        dalcs_formula_push_over(w, f, &operation, DALCS_FORMULA_OPERATION, n);
    }
}

/* a != b of the two topmost, which are logic: an exclusive or, (a && !b) || (!a && b); a == b is its
 * opposite. Of a number only one of the two is left. */
static void differ(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                   const struct dalcs_operation *o) {
    const struct dalcs_formula *a = w->stack[w->n - 2];
    const struct dalcs_formula *b = w->stack[w->n - 1];
    const bool is_known = a->kind == DALCS_FORMULA_NUMBER || b->kind == DALCS_FORMULA_NUMBER;
    bool inverts = o->code == DALCS_EQUAL;
    w->n -= 2;
    if (is_known) {
        const bool first = a->kind == DALCS_FORMULA_NUMBER;
        inverts = inverts != ((first ? a : b)->number != 0);
        dalcs_formula_push(w, first ? b : a);
    } else {
        dalcs_formula_push(w, a);
        dalcs_formula_push(w, b);
        apply_code(w, f, o, DALCS_NOT, 1);
        apply_code(w, f, o, DALCS_JUMP_AND, 2);
        dalcs_formula_push(w, a);
        apply_code(w, f, o, DALCS_NOT, 1);
        dalcs_formula_push(w, b);
        apply_code(w, f, o, DALCS_JUMP_AND, 2);
        apply_code(w, f, o, DALCS_JUMP_OR, 2);
    }
    if (inverts) {
        apply_code(w, f, o, DALCS_NOT, 1);
    }
}

void dalcs_formula_apply(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                         const struct dalcs_operation *o, int n) {
    const bool compares = o->code == DALCS_EQUAL || o->code == DALCS_UNEQUAL;
    if (compares && !dalcs_formula_are_numbers(w, n) && is_logic(w->stack[w->n - 2]) &&
        is_logic(w->stack[w->n - 1])) {
        differ(w, f, o);
    } else if (dalcs_formula_are_numbers(w, n)) {
        dalcs_formula_fold(w, f, o, n);
    } else {
        dalcs_formula_push_over(w, f, o, DALCS_FORMULA_OPERATION, n);
    }
}
