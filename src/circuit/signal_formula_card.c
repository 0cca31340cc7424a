/* signal_formula_card.c - formulas of signals on cards: v(...), i(...) and names to what they mean.
 *
 * The parser of expressions knows no signals. Each is masked by a name of the same length that no
 * netlist can have, so that all places stay what they are. */
#include "builder.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = "signals are: v(node) v(a,b) i(element)";

enum { MASK = 0xff, DIGITS = 36, MOST_SIGNALS = DIGITS * DIGITS * DIGITS };

/* A formula on its way to be compiled. */
struct compilation {
    struct dalcs_builder *builder;
    const struct dalcs_signal_formula_rules *rules;
    struct dalcs_expression_text text;
    char *masked;
    int n_signals; /* masked so far */
    int *signal;   /* [n_signals] of the builder's measured ones */
    enum dalcs_signal_part *part;
    bool failed;
};

static void report(struct compilation *c, int begin, int length, const char *hint,
                   const char *format, ...) __attribute__((format(printf, 5, 6)));

static void report(struct compilation *c, int begin, int length, const char *hint,
                   const char *format, ...) {
    const struct dalcs_location where = dalcs_expression_place(&c->text, begin, length);
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(c->builder->diag, DALCS_ERROR, &where, hint, format, arguments);
    va_end(arguments);
    c->builder->failed = true;
    c->failed = true;
}

/* ---- Signals --------------------------------------------------------------------------------- */

/* "v(", "im(", ...: the bytes before the parenthesis, 0 when no signal starts here. */
static int signal_prefix(const char *t, enum dalcs_signal_part *part) {
    static const struct {
        const char *letters;
        enum dalcs_signal_part part;
    } parts[] = {{"", DALCS_PART_PLAIN},     {"m", DALCS_PART_MAGNITUDE},
                 {"db", DALCS_PART_DECIBEL}, {"p", DALCS_PART_PHASE},
                 {"ph", DALCS_PART_PHASE},   {"r", DALCS_PART_REAL},
                 {"i", DALCS_PART_IMAGINARY}};

    for (size_t k = 0; (*t == 'v' || *t == 'i') && k < sizeof parts / sizeof parts[0]; k++) {
        const size_t n = strlen(parts[k].letters);
        const size_t blanks = strncmp(t + 1, parts[k].letters, n) == 0 ? strspn(t + 1 + n, " ") : 0;
        if (strncmp(t + 1, parts[k].letters, n) == 0 && t[1 + n + blanks] == '(') {
            *part = parts[k].part;
            return (int)(1 + n + blanks);
        }
    }
    return 0;
}

static bool is_name_byte(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '#' ||
           c == '$' || c == '@' || (unsigned char)c >= 0x80;
}

/* The word text[begin..end-1] as a token of its line. */
static bool make_token(struct compilation *c, int begin, int end, struct dalcs_token *token) {
    const char *text = c->text.text;
    while (begin < end && text[begin] == ' ') {
        begin++;
    }
    while (end > begin && text[end - 1] == ' ') {
        end--;
    }
    int k = c->text.n_pieces - 1;
    while (k > 0 && c->text.piece[k].begin > begin) {
        k--;
    }
    const struct dalcs_piece *piece = &c->text.piece[k];
    *token = (struct dalcs_token){
        .line = piece->line,
        .text = dalcs_arena_copy(&c->builder->scratch, text + begin, (size_t)(end - begin)),
        .offset = piece->offset + begin - piece->begin,
        .length = end > begin ? end - begin : 1,
        .kind = DALCS_TOKEN_WORD};
    c->builder->out_of_memory = c->builder->out_of_memory || token->text == NULL;
    if (token->text != NULL && end <= begin) {
        report(c, begin, 1, USAGE, "a name is missing");
    }
    return token->text != NULL && !c->failed;
}

/* The signal whose names stand in text[begin..end-1]; -1 when an error was reported. */
static int find_signal(struct compilation *c, bool is_current, int begin, int end) {
    struct dalcs_builder *builder = c->builder;
    const char *text = c->text.text;
    const char *comma = memchr(text + begin, ',', (size_t)(end - begin));
    const int first_end = comma != NULL ? (int)(comma - text) : end;
    struct dalcs_token name[2];
    struct dalcs_signal signal = {.kind = DALCS_SIGNAL_VOLTAGE, .device = -1};
    if (!make_token(c, begin, first_end, &name[0]) ||
        (comma != NULL && !make_token(c, first_end + 1, end, &name[1]))) {
        return -1;
    }
    if (is_current && comma != NULL) {
        report(c, begin, end - begin, USAGE, "a current is that of one element");
        return -1;
    }
    if (is_current) {
        const int device = dalcs_builder_find_device(builder, &name[0]);
        if (device < 0) {
            return -1;
        }
        signal.kind = DALCS_SIGNAL_CURRENT;
        signal.device = builder->current_of[device];
    } else {
        signal.node[0] = dalcs_builder_find_node(builder, &name[0]);
        signal.node[1] = comma != NULL ? dalcs_builder_find_node(builder, &name[1]) : 0;
        if (signal.node[0] < 0 || signal.node[1] < 0) {
            return -1;
        }
    }
    signal.name = dalcs_arena_printf(&builder->circuit->arena, "%c(%.*s)", is_current ? 'i' : 'v',
                                     end - begin, text + begin);
    return dalcs_signals_measure(builder, signal);
}

/* Writes over v(...) a name that says which of this formula's signals it is. */
static void mask(struct compilation *c, int begin, int end) {
    int number = c->n_signals;
    c->masked[begin] = (char)MASK;
    for (int k = begin + 1; k < end; k++) {
        const int digit = number % DIGITS;
        c->masked[k] = (char)(digit < 26 ? 'a' + digit : '0' + digit - 26);
        number /= DIGITS;
    }
}

static int unmask(const char *name) {
    int number = 0;
    for (int k = 3; k >= 1; k--) {
        const int digit = name[k] >= 'a' ? name[k] - 'a' : name[k] - '0' + 26;
        number = DIGITS * number + digit;
    }
    return number;
}

static int previous_byte(const char *text, int k) {
    while (k > 0 && text[k - 1] == ' ') {
        k--;
    }
    return k > 0 ? (unsigned char)text[k - 1] : 0;
}

static void mask_signals(struct compilation *c) {
    const char *text = c->text.text;
    for (int k = 0; k < c->text.length && !c->failed; k++) {
        enum dalcs_signal_part part = DALCS_PART_PLAIN;
        const int open = k > 0 && is_name_byte(text[k - 1]) ? 0 : signal_prefix(text + k, &part);
        if (open == 0) {
            continue;
        }
        /* KiCad's names have a pair of parentheses of their own */
        int end = k + open + 1;
        for (int depth = 1; end < c->text.length && depth > 0; end++) {
            depth += (text[end] == '(') - (text[end] == ')');
        }
        if (text[end - 1] != ')') {
            report(c, k + open, 1, NULL, "this parenthesis is never closed");
            return;
        }
        if (is_name_byte((char)previous_byte(text, k)) || previous_byte(text, k) == ')') {
            report(c, k, end - k, NULL, "an operator is missing before '%.*s'", end - k, text + k);
            return;
        }
        if (c->rules->no_signals != NULL) {
            report(c, k, end - k, NULL, "%s", c->rules->no_signals);
            return;
        }
        if (c->n_signals == MOST_SIGNALS) {
            report(c, k, end - k, NULL, "more than %d signals in one formula", MOST_SIGNALS);
            return;
        }
        const int signal = find_signal(c, text[k] == 'i', k + open + 1, end - 1);
        if (signal < 0) {
            c->failed = true;
            return;
        }
        mask(c, k, end);
        c->signal[c->n_signals] = signal;
        c->part[c->n_signals++] = part;
        k = end - 1;
    }
}

/* ---- Steps ----------------------------------------------------------------------------------- */

static void take_name(struct compilation *c, const struct dalcs_operation *o,
                      struct dalcs_signal_formula_step *step) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_signal_formula_rules *rules = c->rules;
    if ((unsigned char)o->u.name[0] == MASK) {
        const int k = unmask(o->u.name);
        step->push = DALCS_PUT_SIGNAL;
        step->index = c->signal[k];
        step->part = c->part[k];
        return;
    }
    step->push = DALCS_PUT_VALUE;
    const int result = rules->results != NULL ? dalcs_names_find(rules->results, o->u.name) : -1;
    if (result >= 0) {
        step->push = DALCS_PUT_RESULT;
        step->index = result;
        return;
    }
    if (strcmp(o->u.name, rules->variable) == 0 && rules->no_signals == NULL) {
        step->push = DALCS_PUT_TIME;
        return;
    }
    if (dalcs_deck_parameter(builder->deck, o->u.name, &step->number) ||
        dalcs_constant_find(o->u.name, &step->number)) {
        return;
    }
    const char *hint = NULL;
    const char *nearest =
        rules->results != NULL ? dalcs_names_nearest(rules->results, o->u.name) : NULL;
    if (nearest != NULL) {
        hint = dalcs_builder_hint(builder, "did you mean '%s'?", nearest);
    } else if (dalcs_names_find(&builder->nodes, o->u.name) >= 0) {
        hint = dalcs_builder_hint(builder, "write v(%s)", o->u.name);
    } else if (dalcs_names_find(&builder->devices, o->u.name) >= 0) {
        hint = dalcs_builder_hint(builder, "write i(%s)", o->u.name);
    }
    report(c, o->begin, o->length, hint,
           rules->results != NULL ? "there is no parameter and no earlier measurement '%s'"
                                  : "there is no parameter '%s'",
           o->u.name);
}

static void take_call(struct compilation *c, const struct dalcs_operation *o,
                      struct dalcs_signal_formula_step *step) {
    step->function = dalcs_function_find(o->u.name);
    if (step->function == NULL) {
        const char *nearest = dalcs_function_nearest(o->u.name);
        report(c, o->begin, o->length,
               nearest != NULL ? dalcs_builder_hint(c->builder, "did you mean '%s'?", nearest)
                               : NULL,
               "there is no function '%s' for measurements", o->u.name);
    } else if (o->count < step->function->least || o->count > step->function->most) {
        const bool too_few = o->count < step->function->least;
        report(c, o->begin, o->length, NULL, "'%s' takes %s%d argument%s, not %d", o->u.name,
               step->function->least == step->function->most ? ""
               : too_few                                     ? "at least "
                                                             : "at most ",
               too_few ? step->function->least : step->function->most,
               (too_few ? step->function->least : step->function->most) == 1 ? "" : "s", o->count);
    }
}

/* Degree in signals and time of what the steps leave on the stack: 0, 1, or 2 for anything else. */
static int degree_of(const struct dalcs_signal_formula_step *step, int n) {
    unsigned char degree[DALCS_SIGNAL_FORMULA_DEEPEST];
    int top = 0;
    for (int k = 0; k < n; k++) {
        const enum dalcs_operation_code code = step[k].code;
        if (step[k].push != DALCS_PUT_NOTHING) {
            const bool varies = step[k].push == DALCS_PUT_TIME || step[k].push == DALCS_PUT_SIGNAL;
            degree[top++] = varies ? (step[k].part == DALCS_PART_PLAIN ? 1 : 2) : 0;
        } else if (code == DALCS_CALL) {
            unsigned char most = 0;
            for (int i = 0; i < step[k].count; i++) {
                most = degree[--top] > most ? degree[top] : most;
            }
            degree[top++] = most > 0 ? 2 : 0;
        } else if (code >= DALCS_JUMP && code <= DALCS_JUMP_OR) {
            return 2;
        } else if (code >= DALCS_ADD && code <= DALCS_GREATER_EQUAL) {
            const unsigned char b = degree[--top];
            unsigned char *a = &degree[top - 1];
            const unsigned char most = *a > b ? *a : b;
            const bool is_sum = code == DALCS_ADD || code == DALCS_SUBTRACT;
            const bool is_scaled =
                (code == DALCS_MULTIPLY && (*a == 0 || b == 0)) || (code == DALCS_DIVIDE && b == 0);
            *a = most == 0 || is_sum || is_scaled ? most : 2;
        } else if (code != DALCS_NEGATE && degree[top - 1] > 0) {
            degree[top - 1] = 2;
        }
    }
    return top > 0 ? degree[0] : 0;
}

/* The deepest that the stack can get; every choice is counted twice, which is more than it takes. */
static int depth_of(const struct dalcs_signal_formula_step *step, int n) {
    int depth = 0;
    int most = 0;
    for (int k = 0; k < n; k++) {
        const enum dalcs_operation_code code = step[k].code;
        const bool is_binary = code >= DALCS_ADD && code <= DALCS_GREATER_EQUAL;
        if (step[k].push != DALCS_PUT_NOTHING) {
            depth++;
        } else if (code == DALCS_CALL) {
            depth += 1 - step[k].count;
        } else if (is_binary || code == DALCS_JUMP_IF_ZERO || code == DALCS_JUMP_AND ||
                   code == DALCS_JUMP_OR) {
            depth--;
        }
        most = depth > most ? depth : most;
    }
    return most;
}

static void set_steps(struct compilation *c, const struct dalcs_expression *e,
                      struct dalcs_signal_formula *formula) {
    struct dalcs_signal_formula_step *step =
        dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)e->n, sizeof *step);
    if (step == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return;
    }
    for (int k = 0; k < e->n && !c->failed; k++) {
        const struct dalcs_operation *o = &e->operation[k];
        step[k].code = o->code;
        step[k].count = o->count;
        if (o->code == DALCS_PUSH_NUMBER) {
            step[k].push = DALCS_PUT_VALUE;
            step[k].number = o->u.number;
        } else if (o->code == DALCS_PUSH_NAME) {
            take_name(c, o, &step[k]);
            formula->has_results = formula->has_results || step[k].push == DALCS_PUT_RESULT;
        } else if (o->code == DALCS_CALL) {
            take_call(c, o, &step[k]);
        } else if (o->code == DALCS_CHECK_CALL) {
            report(c, o->begin, o->length, NULL, "there is no function '%s' for measurements",
                   o->u.name);
        }
    }
    if (c->failed) {
        return;
    }
    if (depth_of(step, e->n) > DALCS_SIGNAL_FORMULA_DEEPEST) {
        report(c, 0, 1, NULL, "the formula is too long");
        return;
    }
    const int degree = degree_of(step, e->n);
    formula->step = step;
    formula->n = e->n;
    formula->is_affine = degree <= 1;
    formula->is_constant = degree == 0 && !formula->has_results;
}

bool dalcs_signal_formula_compile(struct dalcs_builder *builder, const struct dalcs_token *token,
                                  int n, const struct dalcs_signal_formula_rules *rules,
                                  struct dalcs_signal_formula *formula) {
    struct compilation c = {.builder = builder, .rules = rules};
    struct dalcs_arena *scratch = &builder->scratch;
    *formula = (struct dalcs_signal_formula){0};
    if (!dalcs_expression_text(scratch, token, n, &c.text)) {
        builder->out_of_memory = true;
        return false;
    }
    const size_t length = (size_t)c.text.length;
    c.masked = dalcs_arena_copy(scratch, c.text.text, length);
    c.signal = dalcs_arena_alloc(scratch, length / 4 + 1, sizeof *c.signal);
    c.part = dalcs_arena_alloc(scratch, length / 4 + 1, sizeof *c.part);
    formula->text = dalcs_arena_copy(&builder->circuit->arena, c.text.text, length);
    if (c.masked == NULL || c.signal == NULL || c.part == NULL || formula->text == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    mask_signals(&c);
    if (c.failed) {
        return false;
    }
    const struct dalcs_expression_context context = {.arena = scratch,
                                                     .diag = builder->diag,
                                                     .noted_caret = &builder->noted_caret,
                                                     .noted_log = &builder->noted_log};
    struct dalcs_expression_text masked = c.text;
    masked.text = c.masked;
    const struct dalcs_expression *e = dalcs_expression_parse(&context, &masked);
    if (e == NULL || e->is_wrong) {
        builder->out_of_memory = builder->out_of_memory || e == NULL;
        builder->failed = true;
        return false;
    }
    set_steps(&c, e, formula);
    return !c.failed;
}

bool dalcs_signal_formula_difference(struct dalcs_builder *builder,
                                     const struct dalcs_signal_formula *left,
                                     const struct dalcs_signal_formula *right,
                                     struct dalcs_signal_formula *difference) {
    const int n = left->n + right->n + 1;
    struct dalcs_signal_formula_step *step =
        dalcs_arena_alloc(&builder->circuit->arena, (size_t)n, sizeof *step);
    if (step == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    memcpy(step, left->step, (size_t)left->n * sizeof *step);
    memcpy(step + left->n, right->step, (size_t)right->n * sizeof *step);
    step[n - 1].code = DALCS_SUBTRACT;
    *difference = (struct dalcs_signal_formula){
        .n = n, .step = step, .text = left->text, .is_affine = left->is_affine && right->is_affine};
    return depth_of(step, n) <= DALCS_SIGNAL_FORMULA_DEEPEST;
}
