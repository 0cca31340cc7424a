/* formula_call.c - names, signals and calls of an expression as parts of its formula. */
#include "formula_build.h"

#include <string.h>

/* Functions that write themselves out again and again: no person wrote such a formula. */
enum { DEEPEST_CALL = 100 };

const char dalcs_formula_time_beside[] = "time";

void dalcs_formula_push_name(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                             const struct dalcs_operation *o) {
    const bool is_variable =
        w->variable != NULL
            ? strcmp(o->u.name, w->variable) == 0
            : strcmp(o->u.name, "time") == 0 && dalcs_scope_find_value(w->scope, "time") == NULL;
    const bool is_time_beside = w->variable != NULL && strcmp(w->variable, "x") == 0 &&
                                strcmp(o->u.name, dalcs_formula_time_beside) == 0 &&
                                dalcs_scope_find_value(w->scope, o->u.name) == NULL;
    if (is_variable) {
        dalcs_formula_push(w, dalcs_formula_part(w, f, o, DALCS_FORMULA_TIME));
    } else if (is_time_beside) {
        dalcs_formula_push_over(w, f, o, DALCS_FORMULA_CALL, 0);
    } else {
        dalcs_formula_fold(w, f, o, 0);
    }
}

/* The name of a node or an element in the flat netlist, at its place; NULL: out of memory. */
static const struct dalcs_token *name_token(struct dalcs_formula_work *w,
                                            const struct dalcs_formula_frame *f,
                                            const struct dalcs_operation *o, bool is_node) {
    const struct dalcs_expression_text *text = &f->expression->text;
    struct dalcs_arena *arena = w->language->arena;
    struct dalcs_token *token = dalcs_arena_alloc(arena, 1, sizeof *token);
    struct dalcs_source_line *line = dalcs_arena_alloc(arena, 1, sizeof *line);
    if (token == NULL || line == NULL) {
        return NULL;
    }
    const struct dalcs_piece *piece = dalcs_expression_piece(text, o->begin);
    *line = *piece->line;
    line->instance = w->scope->origin;
    token->line = line;
    token->offset = piece->offset + o->begin - piece->begin;
    token->length = o->length;
    token->text = dalcs_scope_flat_name(w->language, w->scope, is_node, o->u.name);
    return token->text != NULL ? token : NULL;
}

void dalcs_formula_push_signal(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                               const struct dalcs_operation *o) {
    const bool is_voltage = *o->u.name == 'v';
    struct dalcs_formula *made =
        dalcs_formula_part(w, f, o, is_voltage ? DALCS_FORMULA_VOLTAGE : DALCS_FORMULA_CURRENT);
    for (int k = 0; made != NULL && k < o->count; k++) {
        made->signal[k] = name_token(w, f, &o[1 + k], is_voltage);
        made = made->signal[k] != NULL ? made : NULL;
    }
    dalcs_formula_push(w, made);
}

void dalcs_formula_check_call(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                              const struct dalcs_operation *o) {
    int least;
    int most;
    if (dalcs_language_function(w->language, w->scope, o->u.name) != NULL ||
        dalcs_function_is_noise(o->u.name) || dalcs_function_is_delay(o->u.name) ||
        dalcs_function_remembers(o->u.name, &least, &most)) {
        return;
    }
    const char *hint = dalcs_function_refusal(o->u.name);
    dalcs_formula_fail(w, f, o, hint, "'%s(...)' is not a function of the values at one time",
                       o->u.name);
}

static void call_user(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                      const struct dalcs_operation *o, struct dalcs_user_function *function) {
    if (o->count != function->n_arguments || function->is_active) {
        dalcs_formula_fold(w, f, o, o->count); /* which says what is wrong */
        return;
    }
    if (w->depth >= DEEPEST_CALL) {
        dalcs_formula_fail(w, f, o, NULL, "functions call each other too deep, here '%s'",
                           o->u.name);
        return;
    }
    if (!dalcs_scope_compile(w->language, NULL, function->body, function->n_tokens,
                             &function->arguments, &function->expression)) {
        w->failed = true;
        return;
    }
    const struct dalcs_formula_frame inner = {function->expression, w->n - (size_t)o->count};
    function->is_active = true;
    w->depth++;
    dalcs_formula_run(w, &inner, 0, function->expression->n);
    w->depth--;
    function->is_active = false;
    if (!w->failed) {
        /* The result takes the place of the arguments. */
        w->stack[inner.arguments] = w->stack[w->n - 1];
        w->n = inner.arguments + 1;
    }
}

/* ddt, idt, sdt, idtmod: of numbers, too, they are functions of time. */
static void call_memory(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                        const struct dalcs_operation *o, int least, int most) {
    if (w->variable != NULL) {
        dalcs_formula_fail(w, f, o, "derivatives and integrals are for B, E and G",
                           "'%s(...)' is not for a formula of this kind", o->u.name);
    } else if (o->count < least || o->count > most) {
        dalcs_formula_fail(
            w, f, o,
            "ddt(x), idt(x), idt(x, first), idt(x, first, reset), idtmod(x, first, modulus, "
            "offset)",
            "'%s' with another number of arguments", o->u.name);
    } else {
        dalcs_formula_push_over(w, f, o, DALCS_FORMULA_CALL, o->count);
    }
}

/* A table some of whose points are no numbers. */
static bool is_varying_table(const struct dalcs_formula_work *w, const struct dalcs_operation *o) {
    return (strcmp(o->u.name, "table") == 0 || strcmp(o->u.name, "tbl") == 0) && o->count >= 5 &&
           o->count % 2 == 1 && !dalcs_formula_are_numbers(w, o->count - 1);
}

void dalcs_formula_push_call(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                             const struct dalcs_operation *o) {
    struct dalcs_user_function *user = dalcs_language_function(w->language, w->scope, o->u.name);
    int least;
    int most;
    user = user == NULL && is_varying_table(w, o)
               ? dalcs_language_table(w->language, (o->count - 1) / 2)
               : user;
    if (user != NULL) {
        call_user(w, f, o, user);
        return;
    }
    if (dalcs_function_remembers(o->u.name, &least, &most)) {
        call_memory(w, f, o, least, most);
        return;
    }
    const bool is_noise = dalcs_function_is_noise(o->u.name) && o->count == 1;
    const bool is_delay = dalcs_function_is_delay(o->u.name) && (o->count == 2 || o->count == 3);
    if ((is_noise || is_delay) && w->variable == NULL) {
        dalcs_formula_push_over(w, f, o, DALCS_FORMULA_CALL, o->count);
        return;
    }
    const struct dalcs_function *function =
        dalcs_function_find(o->u.name, w->language->netlist->dialect.name);
    const bool is_wrong =
        function == NULL || o->count < function->least || o->count > function->most;
    bool is_random;
    const bool draws = dalcs_draw_find(o->u.name, o->count, &is_random) != NULL;
    if (draws && !dalcs_formula_are_numbers(w, o->count)) {
        dalcs_formula_fail(
            w, f, o, "a random value is drawn once, before the run: its arguments are numbers",
            "'%s' of a voltage, a current or the time", o->u.name);
    } else if (is_wrong || dalcs_formula_are_numbers(w, o->count)) {
        dalcs_formula_fold(w, f, o, o->count);
    } else {
        dalcs_formula_push_over(w, f, o, DALCS_FORMULA_CALL, o->count);
    }
}
