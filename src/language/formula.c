/* formula.c - runs the operations of an expression on a stack of formulas rather than of numbers.
 *
 * Where all operands are numbers the same operation of evaluate.c makes them one, so that both say the
 * same about what is wrong. A condition that is a number chooses its branch, and the other is not looked
 * at. */
#include "formula.h"

#include "language.h"

#include <stdlib.h>
#include <string.h>

/* Functions that write themselves out again and again: no person wrote such a formula. */
enum { DEEPEST_CALL = 100, MOST_PARTS = 100000 };

struct work {
    struct dalcs_language *language;
    struct dalcs_scope *scope;
    const struct dalcs_formula **stack; /* heap */
    size_t n, capacity;
    int n_parts;
    int depth;
    const char
        *variable; /* a name that stands for a variable rather than a parameter; NULL: none */
    bool has_choices;
    bool failed;
};

/* An expression with its arguments, which stay where they are on the stack. */
struct frame {
    struct dalcs_expression *expression;
    size_t arguments;
};

static void run(struct work *w, const struct frame *f, int begin, int end);

static struct dalcs_location place_of(const struct work *w, const struct frame *f, int begin,
                                      int end) {
    struct dalcs_location where =
        dalcs_expression_place(&f->expression->text, begin, end > begin ? end - begin : 1);
    where.instance = w->scope->origin;
    return where;
}

static void fail(struct work *w, const struct frame *f, const struct dalcs_operation *o,
                 const char *hint, const char *format, const char *name) {
    dalcs_language_report_at(w->language, DALCS_ERROR, w->scope,
                             place_of(w, f, o->begin, o->begin + o->length), hint, format, name);
    w->failed = true;
}

static void push(struct work *w, const struct dalcs_formula *formula) {
    if (formula == NULL || dalcs_grow(&w->stack, &w->capacity, w->n + 1,
                                      sizeof(const struct dalcs_formula *)) != DALCS_OK) {
        w->language->out_of_memory = true;
        w->failed = true;
        return;
    }
    w->stack[w->n++] = formula;
}

/* A new part at the place of an operation. */
static struct dalcs_formula *make(struct work *w, const struct frame *f,
                                  const struct dalcs_operation *o, enum dalcs_formula_kind kind) {
    struct dalcs_formula *made = dalcs_arena_alloc(w->language->arena, 1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    if (w->n_parts >= MOST_PARTS) {
        fail(w, f, o, NULL, "%s is written out in too many parts", "the formula");
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

/* Puts a part with the topmost n of the stack as its arguments in their place. */
static void push_over(struct work *w, const struct frame *f, const struct dalcs_operation *o,
                      enum dalcs_formula_kind kind, int n) {
    struct dalcs_formula *made = make(w, f, o, kind);
    const struct dalcs_formula **argument =
        dalcs_arena_alloc(w->language->arena, (size_t)n, sizeof(const struct dalcs_formula *));
    if (made == NULL || argument == NULL) {
        push(w, NULL);
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
    push(w, made);
}

static bool are_numbers(const struct work *w, int n) {
    for (int k = 1; k <= n; k++) {
        if (w->stack[w->n - (size_t)k]->kind != DALCS_FORMULA_NUMBER) {
            return false;
        }
    }
    return true;
}

/* The operation on the topmost n of the stack, which are numbers or, for the sake of the message that
 * will come of it, taken for 0. */
static void fold(struct work *w, const struct frame *f, const struct dalcs_operation *o, int n) {
    struct dalcs_operation *operation =
        dalcs_alloc((size_t)n + 1, sizeof *operation); /* of a small expression of its own */
    if (operation == NULL) {
        push(w, NULL);
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
    struct dalcs_formula *number = ok ? make(w, f, o, DALCS_FORMULA_NUMBER) : NULL;
    if (number == NULL) {
        w->failed = true;
        return;
    }
    number->number = value;
    w->n -= (size_t)n;
    push(w, number);
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
static void apply_code(struct work *w, const struct frame *f, const struct dalcs_operation *o,
                       enum dalcs_operation_code code, int n) {
    const struct dalcs_operation operation = {.code = code, .begin = o->begin, .length = o->length};
    if (!w->failed) {
        push_over(w, f, &operation, DALCS_FORMULA_OPERATION, n);
    }
}

/* a != b of the two topmost, which are logic: an exclusive or, (a && !b) || (!a && b); a == b is its
 * opposite. Of a number only one of the two is left. */
static void differ(struct work *w, const struct frame *f, const struct dalcs_operation *o) {
    const struct dalcs_formula *a = w->stack[w->n - 2];
    const struct dalcs_formula *b = w->stack[w->n - 1];
    const bool is_known = a->kind == DALCS_FORMULA_NUMBER || b->kind == DALCS_FORMULA_NUMBER;
    bool inverts = o->code == DALCS_EQUAL;
    w->n -= 2;
    if (is_known) {
        const bool first = a->kind == DALCS_FORMULA_NUMBER;
        inverts = inverts != ((first ? a : b)->number != 0);
        push(w, first ? b : a);
    } else {
        push(w, a);
        push(w, b);
        apply_code(w, f, o, DALCS_NOT, 1);
        apply_code(w, f, o, DALCS_JUMP_AND, 2);
        push(w, a);
        apply_code(w, f, o, DALCS_NOT, 1);
        push(w, b);
        apply_code(w, f, o, DALCS_JUMP_AND, 2);
        apply_code(w, f, o, DALCS_JUMP_OR, 2);
    }
    if (inverts) {
        apply_code(w, f, o, DALCS_NOT, 1);
    }
}

static void apply(struct work *w, const struct frame *f, const struct dalcs_operation *o, int n) {
    const bool compares = o->code == DALCS_EQUAL || o->code == DALCS_UNEQUAL;
    if (compares && !are_numbers(w, n) && is_logic(w->stack[w->n - 2]) &&
        is_logic(w->stack[w->n - 1])) {
        differ(w, f, o);
    } else if (are_numbers(w, n)) {
        fold(w, f, o, n);
    } else {
        push_over(w, f, o, DALCS_FORMULA_OPERATION, n);
    }
}

const char dalcs_formula_time_beside[] = "time";

/* ---- Names and signals ----------------------------------------------------------------------- */

static void push_name(struct work *w, const struct frame *f, const struct dalcs_operation *o) {
    const bool is_variable =
        w->variable != NULL
            ? strcmp(o->u.name, w->variable) == 0
            : strcmp(o->u.name, "time") == 0 && dalcs_scope_find_value(w->scope, "time") == NULL;
    const bool is_time_beside = w->variable != NULL && strcmp(w->variable, "x") == 0 &&
                                strcmp(o->u.name, dalcs_formula_time_beside) == 0 &&
                                dalcs_scope_find_value(w->scope, o->u.name) == NULL;
    if (is_variable) {
        push(w, make(w, f, o, DALCS_FORMULA_TIME));
    } else if (is_time_beside) {
        push_over(w, f, o, DALCS_FORMULA_CALL, 0);
    } else {
        fold(w, f, o, 0);
    }
}

/* The name of a node or an element in the flat netlist, at its place; NULL: out of memory. */
static const struct dalcs_token *name_token(struct work *w, const struct frame *f,
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

static void push_signal(struct work *w, const struct frame *f, const struct dalcs_operation *o) {
    const bool is_voltage = *o->u.name == 'v';
    struct dalcs_formula *made =
        make(w, f, o, is_voltage ? DALCS_FORMULA_VOLTAGE : DALCS_FORMULA_CURRENT);
    for (int k = 0; made != NULL && k < o->count; k++) {
        made->signal[k] = name_token(w, f, &o[1 + k], is_voltage);
        made = made->signal[k] != NULL ? made : NULL;
    }
    push(w, made);
}

/* ---- Calls ----------------------------------------------------------------------------------- */

static void check_call(struct work *w, const struct frame *f, const struct dalcs_operation *o) {
    int least;
    int most;
    if (dalcs_language_function(w->language, w->scope, o->u.name) != NULL ||
        dalcs_function_is_noise(o->u.name) || dalcs_function_is_delay(o->u.name) ||
        dalcs_function_remembers(o->u.name, &least, &most)) {
        return;
    }
    const char *hint = dalcs_function_refusal(o->u.name);
    fail(w, f, o, hint, "'%s(...)' is not a function of the values at one time", o->u.name);
}

static void call_user(struct work *w, const struct frame *f, const struct dalcs_operation *o,
                      struct dalcs_user_function *function) {
    if (o->count != function->n_arguments || function->is_active) {
        fold(w, f, o, o->count); /* which says what is wrong */
        return;
    }
    if (w->depth >= DEEPEST_CALL) {
        fail(w, f, o, NULL, "functions call each other too deep, here '%s'", o->u.name);
        return;
    }
    if (!dalcs_scope_compile(w->language, NULL, function->body, function->n_tokens,
                             &function->arguments, &function->expression)) {
        w->failed = true;
        return;
    }
    const struct frame inner = {function->expression, w->n - (size_t)o->count};
    function->is_active = true;
    w->depth++;
    run(w, &inner, 0, function->expression->n);
    w->depth--;
    function->is_active = false;
    if (!w->failed) {
        /* The result takes the place of the arguments. */
        w->stack[inner.arguments] = w->stack[w->n - 1];
        w->n = inner.arguments + 1;
    }
}

/* ddt, idt, sdt, idtmod: of numbers, too, they are functions of time. */
static void call_memory(struct work *w, const struct frame *f, const struct dalcs_operation *o,
                        int least, int most) {
    if (w->variable != NULL) {
        fail(w, f, o, "derivatives and integrals are for B, E and G",
             "'%s(...)' is not for a formula of this kind", o->u.name);
    } else if (o->count < least || o->count > most) {
        fail(w, f, o,
             "ddt(x), idt(x), idt(x, first), idt(x, first, reset), idtmod(x, first, modulus, "
             "offset)",
             "'%s' with another number of arguments", o->u.name);
    } else {
        push_over(w, f, o, DALCS_FORMULA_CALL, o->count);
    }
}

static void call(struct work *w, const struct frame *f, const struct dalcs_operation *o) {
    struct dalcs_user_function *user = dalcs_language_function(w->language, w->scope, o->u.name);
    int least;
    int most;
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
        push_over(w, f, o, DALCS_FORMULA_CALL, o->count);
        return;
    }
    const struct dalcs_function *function =
        dalcs_function_find(o->u.name, w->language->netlist->dialect.name);
    const bool is_wrong =
        function == NULL || o->count < function->least || o->count > function->most;
    bool is_random;
    const bool draws = dalcs_draw_find(o->u.name, o->count, &is_random) != NULL;
    if (draws && !are_numbers(w, o->count)) {
        fail(w, f, o, "a random value is drawn once, before the run: its arguments are numbers",
             "'%s' of a voltage, a current or the time", o->u.name);
    } else if (is_wrong || are_numbers(w, o->count)) {
        fold(w, f, o, o->count);
    } else {
        push_over(w, f, o, DALCS_FORMULA_CALL, o->count);
    }
}

/* ---- Operations ------------------------------------------------------------------------------ */

/* condition ? a : b from the jump at k on; the operation after it. */
static int choose(struct work *w, const struct frame *f, int k) {
    const struct dalcs_operation *o = &f->expression->operation[k];
    const int otherwise = k + o->count;
    const int end = otherwise - 1 + f->expression->operation[otherwise - 1].count;
    const struct dalcs_formula *condition = w->stack[w->n - 1];
    if (condition->kind == DALCS_FORMULA_NUMBER) {
        w->n--;
        run(w, f, condition->number != 0 ? k + 1 : otherwise,
            condition->number != 0 ? otherwise - 1 : end);
        return end;
    }
    run(w, f, k + 1, otherwise - 1);
    if (!w->failed) {
        run(w, f, otherwise, end);
    }
    if (!w->failed) {
        w->has_choices = true;
        push_over(w, f, o, DALCS_FORMULA_CHOICE, 3);
    }
    return end;
}

/* a && b, a || b from the jump at k on; the operation after it. */
static int join(struct work *w, const struct frame *f, int k) {
    const struct dalcs_operation *o = &f->expression->operation[k];
    const int end = k + o->count;
    const struct dalcs_formula *first = w->stack[w->n - 1];
    const struct dalcs_operation to_logic = {
        .code = DALCS_TO_LOGIC, .begin = o->begin, .length = o->length};
    if (first->kind != DALCS_FORMULA_NUMBER) {
        run(w, f, k + 1, end);
        if (!w->failed) {
            push_over(w, f, o, DALCS_FORMULA_OPERATION, 2);
        }
    } else if ((first->number != 0) == (o->code == DALCS_JUMP_OR)) {
        apply(w, f, &to_logic, 1); /* the second does not count */
    } else {
        w->n--;
        run(w, f, k + 1, end);
    }
    return end;
}

static void run(struct work *w, const struct frame *f, int begin, int end) {
    for (int k = begin; k < end && !w->failed;) {
        const struct dalcs_operation *o = &f->expression->operation[k++];
        struct dalcs_formula *number;
        switch (o->code) {
        case DALCS_PUSH_NUMBER:
            number = make(w, f, o, DALCS_FORMULA_NUMBER);
            if (number != NULL) {
                number->number = o->u.number;
            }
            push(w, number);
            break;
        case DALCS_PUSH_NAME:
            push_name(w, f, o);
            break;
        case DALCS_PUSH_ARGUMENT:
            push(w, w->stack[f->arguments + (size_t)o->count]);
            break;
        case DALCS_PUSH_SIGNAL:
            push_signal(w, f, o);
            break;
        case DALCS_SIGNAL_NAME:
            break; /* push_signal has taken it */
        case DALCS_NEGATE:
        case DALCS_NOT:
        case DALCS_TO_LOGIC:
            apply(w, f, o, 1);
            break;
        case DALCS_JUMP_IF_ZERO:
            k = choose(w, f, k - 1);
            break;
        case DALCS_JUMP_AND:
        case DALCS_JUMP_OR:
            k = join(w, f, k - 1);
            break;
        case DALCS_CHECK_CALL:
            check_call(w, f, o);
            break;
        case DALCS_CALL:
            call(w, f, o);
            break;
        default:
            apply(w, f, o, 2);
            break;
        }
    }
}

/* ---- Of a card --------------------------------------------------------------------------------- */

static const struct dalcs_formula *make_formula(struct dalcs_language *language,
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
                                                     .noted_caret = &language->noted_caret,
                                                     .noted_log = &language->noted_log};
    struct dalcs_expression_text text;
    struct dalcs_expression *expression = NULL;
    if (dalcs_expression_text(language->arena, token, n, &text)) {
        expression = dalcs_expression_parse(&context, &text);
    }
    if (expression == NULL) {
        language->out_of_memory = true;
        return NULL;
    }
    struct work w = {
        .language = language, .scope = scope, .variable = variable, .failed = expression->is_wrong};
    const struct frame f = {expression, 0};
    run(&w, &f, 0, expression->n);
    const struct dalcs_formula *formula = w.failed ? NULL : w.stack[0];
    if (formula != NULL && w.has_choices && variable == NULL) {
        formula = dalcs_formula_guard(language, formula, w.n_parts);
    }
    free(w.stack);
    language->deck->has_errors = language->deck->has_errors || formula == NULL;
    return formula;
}

const struct dalcs_formula *dalcs_formula_make(struct dalcs_language *language,
                                               struct dalcs_scope *scope,
                                               const struct dalcs_token *token, int n) {
    return make_formula(language, scope, token, n, NULL);
}

const struct dalcs_formula *dalcs_formula_make_of(struct dalcs_language *language,
                                                  struct dalcs_scope *scope,
                                                  const struct dalcs_token *token, int n,
                                                  const char *variable) {
    return make_formula(language, scope, token, n, variable);
}

static bool is_word(const struct dalcs_token *token, const char *const *list, size_t n) {
    bool found = false;
    for (size_t k = 0; k < n; k++) {
        found = found || (token->kind == DALCS_TOKEN_WORD && strcmp(token->text, list[k]) == 0);
    }
    return found;
}

static bool is_kind(const struct dalcs_card *card, int k, enum dalcs_token_kind kind) {
    return k < card->n && card->token[k].kind == kind;
}

/* B p n V=formula: its first token, card->n when there is none. */
static int start_of_source(const struct dalcs_card *card) {
    static const char *const quantities[] = {"v", "i", "r", "p"};
    int k = 2;
    while (k < card->n &&
           !(is_word(&card->token[k], quantities, sizeof quantities / sizeof quantities[0]) &&
             is_kind(card, k + 1, DALCS_TOKEN_EQUAL))) {
        k++;
    }
    return k < card->n ? k + 2 : k;
}

/* E p n VALUE={formula}, E p n TABLE {formula} = points: the same. */
static int start_of_controlled(const struct dalcs_card *card, bool *is_table) {
    static const char *const forms[] = {"value", "vol", "cur", "table", "laplace"};
    int k = 1;
    for (int n_nodes = 0; n_nodes < 2 && k < card->n; k++) {
        n_nodes += card->token[k].kind == DALCS_TOKEN_WORD;
    }
    k += is_kind(card, k, DALCS_TOKEN_CLOSE);
    if (k >= card->n || !is_word(&card->token[k], forms, sizeof forms / sizeof forms[0])) {
        return card->n;
    }
    const bool is_transfer = strcmp(card->token[k].text, "laplace") == 0;
    *is_table = is_transfer || strcmp(card->token[k].text, "table") == 0;
    k++;
    return is_kind(card, k, DALCS_TOKEN_EQUAL) ? k + 1 : k;
}

int dalcs_formula_find_control(const struct dalcs_card *card) {
    static const char *const control[] = {"control"};
    int k = 1;
    while (k < card->n &&
           !(is_word(&card->token[k], control, 1) && is_kind(card, k + 1, DALCS_TOKEN_EQUAL))) {
        k++;
    }
    return k;
}

static bool is_of_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
           (c != '\0' && strchr("_.$#@", c) != NULL);
}

/* Does a text read the time, a voltage or a current? opens: a parenthesis follows it. */
static bool text_has_signal(const char *text, bool opens) {
    for (const char *p = text; *p != '\0';) {
        const char *end = p;
        while (is_of_name(*end)) {
            end++;
        }
        const size_t n = (size_t)(end - p);
        const char *next = end + strspn(end, " \t");
        const bool is_call = *next == '(' || (*next == '\0' && opens);
        if ((n == 4 && strncmp(p, "time", 4) == 0) ||
            (n == 1 && is_call && (*p == 'v' || *p == 'i'))) {
            return true;
        }
        p = n > 0 ? end : p + 1;
    }
    return false;
}

static bool has_signal(const struct dalcs_card *card, int first, int n) {
    bool has = false;
    for (int k = first; k < first + n && !has; k++) {
        const struct dalcs_token *token = &card->token[k];
        has = (token->kind == DALCS_TOKEN_WORD || token->kind == DALCS_TOKEN_EXPRESSION) &&
              text_has_signal(token->text, is_kind(card, k + 1, DALCS_TOKEN_OPEN));
    }
    return has;
}

/* L p n FLUX=formula, C p n Q=formula; also {formula} in the place of a value, where it has signals. */
static int start_of_storage(const struct dalcs_card *card) {
    static const char *const coil[] = {"flux"};
    static const char *const capacitor[] = {"q"};
    int k = 3;
    while (k < card->n) {
        const bool is_assigned = card->token[k - 1].kind == DALCS_TOKEN_EQUAL;
        if (is_assigned &&
            is_word(&card->token[k - 2], card->letter == 'l' ? coil : capacitor, 1)) {
            return k;
        }
        if (card->token[k].kind == DALCS_TOKEN_EXPRESSION && (is_assigned || k == 3) &&
            has_signal(card, k, 1)) {
            return k;
        }
        k++;
    }
    return k;
}

bool dalcs_formula_reads_value(const char *text) {
    int depth = 0;
    bool reads = false;
    for (const char *p = text; *p != '\0' && !reads; p++) {
        depth += (*p == '(') - (*p == ')');
        reads = depth == 0 && *p == ':' && p > text && is_of_name(p[-1]) && is_of_name(p[1]);
    }
    return reads && strchr(text, '?') == NULL;
}

/* Does a formula go on here, as in {a}*exp({b}*v(x))? */
static bool goes_on(const struct dalcs_card *card, int k) {
    return is_kind(card, k, DALCS_TOKEN_WORD) &&
           strchr("*/+-<>&|?", card->token[k].text[0]) != NULL;
}

/* Rname a b R=formula, Rname a b {formula}: one of voltages and currents. A number is not for here. */
static bool find_resistance(const struct dalcs_card *card, int *first, int *n) {
    static const char *const names[] = {"r", "resistance"};
    const bool has_name =
        card->n > 5 && is_word(&card->token[3], names, 2) && is_kind(card, 4, DALCS_TOKEN_EQUAL);
    *first = has_name ? 5 : 3;
    *n = 1;
    if (card->n <= 3 || !(has_name || is_kind(card, 3, DALCS_TOKEN_EXPRESSION))) {
        return false;
    }
    const bool is_braced = is_kind(card, 5, DALCS_TOKEN_EXPRESSION) && !goes_on(card, 6);
    while (has_name && !is_braced && *first + *n < card->n &&
           !dalcs_assignment_starts(card, *first + *n)) {
        ++*n;
    }
    return has_signal(card, *first, *n);
}

bool dalcs_formula_find(const struct dalcs_card *card, int *first, int *n) {
    static const char *const behind[] = {"laplace", "nojacob"};
    bool is_table = false;
    if (card->letter == 'r') {
        return find_resistance(card, first, n);
    }
    if (card->letter == 'l' || card->letter == 'c') {
        *first = start_of_storage(card);
    } else if (card->letter == 'b') {
        *first = start_of_source(card);
    } else if (card->letter == 'e' || card->letter == 'g') {
        *first = start_of_controlled(card, &is_table);
    } else if (card->letter == 's') {
        *first = dalcs_formula_find_control(card) + 2;
        if (is_kind(card, *first, DALCS_TOKEN_EXPRESSION)) {
            *n = 1;
            return true;
        }
    } else {
        return false;
    }
    int end = *first;
    int depth = 0;
    while (end < card->n) {
        const enum dalcs_token_kind kind = card->token[end].kind;
        depth += (kind == DALCS_TOKEN_OPEN) - (kind == DALCS_TOKEN_CLOSE);
        /* LTspice needs no equal sign behind LAPLACE, nor a blank before its parenthesis; NoJacob is a word of its own */
        const bool is_behind = card->letter == 'b' && is_word(&card->token[end], behind, 2);
        const bool is_next =
            end > *first && depth == 0 && (is_behind || dalcs_assignment_starts(card, end));
        const bool ends_here = is_table && (kind == DALCS_TOKEN_EQUAL ||
                                            (end > *first && *first < card->n &&
                                             card->token[*first].kind == DALCS_TOKEN_EXPRESSION));
        if (kind == DALCS_TOKEN_BAD) {
            return false;
        }
        if (is_next || ends_here) {
            break;
        }
        end++;
    }
    *n = end - *first;
    return *n > 0;
}

/* Where the transfer function of a card begins: behind the formula of LAPLACE {formula} = {expression}, and behind the
 * word of LAPLACE=expression, which a formula may stand before but never holds. card->n when there is none. */
static int start_of_transfer(const struct dalcs_card *card) {
    static const char *const word[] = {"laplace"};
    int formula;
    int n_formula;
    int k = 3;
    if (dalcs_formula_find(card, &formula, &n_formula)) {
        const int before = formula - (is_kind(card, formula - 1, DALCS_TOKEN_EQUAL) ? 2 : 1);
        k = formula + n_formula;
        if (is_word(&card->token[before], word, 1)) {
            return k;
        }
    }
    while (k < card->n && !is_word(&card->token[k], word, 1)) {
        k++;
    }
    return k < card->n ? k + 1 : k;
}

bool dalcs_transfer_find(const struct dalcs_card *card, int *first, int *n) {
    if (strchr("beg", card->letter) == NULL || card->letter == '\0') {
        return false;
    }
    int k = start_of_transfer(card);
    k += is_kind(card, k, DALCS_TOKEN_EQUAL);
    *first = k;
    while (k < card->n && !(k > *first && dalcs_assignment_starts(card, k))) {
        if (card->token[k].kind == DALCS_TOKEN_BAD) {
            return false;
        }
        k++;
    }
    *n = k - *first;
    return *n > 0;
}
