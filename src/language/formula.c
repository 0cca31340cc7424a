/* formula.c - the formula of a card, and what is not evaluated from left to right: a choice, && and ||.
 *
 * A condition that is a number chooses its branch, and the other is not looked at. */
#include "formula_build.h"

#include <stdlib.h>
#include <string.h>

/* condition ? a : b from the jump at k on; the operation after it. */
static int choose(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f, int k) {
    const struct dalcs_operation *o = &f->expression->operation[k];
    const int otherwise = k + o->count;
    const int end = otherwise - 1 + f->expression->operation[otherwise - 1].count;
    const struct dalcs_formula *condition = w->stack[w->n - 1];
    if (condition->kind == DALCS_FORMULA_NUMBER) {
        w->n--;
        dalcs_formula_run(w, f, condition->number != 0 ? k + 1 : otherwise,
                          condition->number != 0 ? otherwise - 1 : end);
        return end;
    }
    dalcs_formula_run(w, f, k + 1, otherwise - 1);
    if (!w->failed) {
        dalcs_formula_run(w, f, otherwise, end);
    }
    if (!w->failed) {
        w->has_choices = true;
        dalcs_formula_push_over(w, f, o, DALCS_FORMULA_CHOICE, 3);
    }
    return end;
}

/* a && b, a || b from the jump at k on; the operation after it. */
static int join(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f, int k) {
    const struct dalcs_operation *o = &f->expression->operation[k];
    const int end = k + o->count;
    const struct dalcs_formula *first = w->stack[w->n - 1];
    const struct dalcs_operation to_logic = {
        .code = DALCS_TO_LOGIC, .begin = o->begin, .length = o->length};
    if (first->kind != DALCS_FORMULA_NUMBER) {
        dalcs_formula_run(w, f, k + 1, end);
        if (!w->failed) {
            dalcs_formula_push_over(w, f, o, DALCS_FORMULA_OPERATION, 2);
        }
    } else if ((first->number != 0) == (o->code == DALCS_JUMP_OR)) {
        dalcs_formula_apply(w, f, &to_logic, 1); /* the second does not count */
    } else {
        w->n--;
        dalcs_formula_run(w, f, k + 1, end);
    }
    return end;
}

void dalcs_formula_run(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f, int begin,
                       int end) {
    for (int k = begin; k < end && !w->failed;) {
        const struct dalcs_operation *o = &f->expression->operation[k++];
        struct dalcs_formula *number;
        switch (o->code) {
        case DALCS_PUSH_NUMBER:
            number = dalcs_formula_part(w, f, o, DALCS_FORMULA_NUMBER);
            if (number != NULL) {
                number->number = o->u.number;
            }
            dalcs_formula_push(w, number);
            break;
        case DALCS_PUSH_NAME:
            dalcs_formula_push_name(w, f, o);
            break;
        case DALCS_PUSH_ARGUMENT:
            dalcs_formula_push(w, w->stack[f->arguments + (size_t)o->count]);
            break;
        case DALCS_PUSH_SIGNAL:
            dalcs_formula_push_signal(w, f, o);
            break;
        case DALCS_SIGNAL_NAME:
            break; /* push_signal has taken it */
        case DALCS_NEGATE:
        case DALCS_NOT:
        case DALCS_TO_LOGIC:
            dalcs_formula_apply(w, f, o, 1);
            break;
        case DALCS_JUMP_IF_ZERO:
            k = choose(w, f, k - 1);
            break;
        case DALCS_JUMP_AND:
        case DALCS_JUMP_OR:
            k = join(w, f, k - 1);
            break;
        case DALCS_CHECK_CALL:
            dalcs_formula_check_call(w, f, o);
            break;
        case DALCS_CALL:
            dalcs_formula_push_call(w, f, o);
            break;
        default:
            dalcs_formula_apply(w, f, o, 2);
            break;
        }
    }
}

/* As it is solved. A flux or a charge, of a variable, is integrated first where it is written by its slope. */
static const struct dalcs_formula *rewrite(struct dalcs_formula_work *w,
                                           const struct dalcs_formula *formula, bool is_transfer) {
    struct dalcs_arena *arena = w->language->arena;
    const enum dalcs_dialect_name dialect = w->language->netlist->dialect.name;
    const bool takes_real_part = dialect == DALCS_DIALECT_LTSPICE || dialect == DALCS_DIALECT_XYCE;
    const struct dalcs_formula *made =
        is_transfer ? formula : dalcs_formula_signed_powers(arena, formula);
    if (made != NULL && w->variable == NULL) {
        made = dalcs_formula_joined_roots(arena, made);
    }
    if (made != NULL && w->variable == NULL) {
        made = dalcs_formula_held(arena, made, dialect);
    }
    if (made != NULL && w->variable == NULL) {
        made = dalcs_formula_pieces(arena, made, dialect);
    }
    if (made != NULL && w->has_choices && w->variable == NULL) {
        made = dalcs_formula_guard(arena, made);
    }
    if (made != NULL && w->variable == NULL && takes_real_part) {
        made = dalcs_formula_real_part(arena, made);
    }
    if (made != NULL && w->variable == NULL) {
        made = dalcs_formula_exponentials(arena, made, dialect);
    }
    w->language->out_of_memory = w->language->out_of_memory || made == NULL;
    return made;
}

const struct dalcs_formula *dalcs_formula_make_of(struct dalcs_language *language,
                                                  struct dalcs_scope *scope,
                                                  const struct dalcs_token *token, int n,
                                                  const char *variable) {
    const struct dalcs_expression_context context = {.arena = language->arena,
                                                     .diag = language->diag,
                                                     .instance = scope->origin,
                                                     .has_signals = true,
                                                     .is_transfer = variable != NULL &&
                                                                    strcmp(variable, "s") == 0,
                                                     .dialect = language->netlist->dialect,
                                                     .noted_caret = &language->noted.caret,
                                                     .noted_log = &language->noted.log,
                                                     .noted_pwr = &language->noted.pwr};
    struct dalcs_expression_text text;
    struct dalcs_expression *expression = NULL;
    if (dalcs_expression_text(language->arena, token, n, &text)) {
        expression = dalcs_expression_parse(&context, &text);
    }
    if (expression == NULL) {
        language->out_of_memory = true;
        return NULL;
    }
    struct dalcs_formula_work w = {
        .language = language, .scope = scope, .variable = variable, .failed = expression->is_wrong};
    const struct dalcs_formula_frame f = {expression, 0};
    dalcs_formula_run(&w, &f, 0, expression->n);
    const struct dalcs_formula *formula = w.failed ? NULL : w.stack[0];
    formula = formula != NULL ? rewrite(&w, formula, context.is_transfer) : NULL;
    free(w.stack);
    language->deck->has_errors = language->deck->has_errors || formula == NULL;
    return formula;
}

const struct dalcs_formula *dalcs_formula_make(struct dalcs_language *language,
                                               struct dalcs_scope *scope,
                                               const struct dalcs_token *token, int n) {
    return dalcs_formula_make_of(language, scope, token, n, NULL);
}

bool dalcs_formula_is_call_of(const struct dalcs_formula *f, const char *const *names) {
    bool is = false;
    for (int k = 0; names[k] != NULL && f->kind == DALCS_FORMULA_CALL; k++) {
        is = is || strcmp(f->function, names[k]) == 0;
    }
    return is;
}
