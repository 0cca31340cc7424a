/* expression_parse.c - the text of an expression to operations: precedence climbing.
 *
 * From loose to tight: ?:, ||, &&, == != <>, < <= > >=, + -, * / % \, unary - + !, ** ^. Where
 * ngspice's reading of a formula is not that of mathematics and other simulators, there is no safe
 * one, and it is an error: a**b**c, and a*-b**c. */
#include "expression.h"
#include "foreign.h"
#include "number.h"

#include <stdlib.h>
#include <string.h>

/* Deeper formulas are no formulas that a person wrote; the stack of this program has an end. */
enum { DEEPEST = 200 };

enum symbol {
    END,
    NUMBER,
    NAME,
    OPEN,
    CLOSE,
    COMMA,
    QUESTION,
    COLON,
    OPERATOR, /* `code` says which; AND, OR and NOT besides */
    AND,
    OR,
    BANG,
    WRONG
};

struct parser {
    const struct dalcs_expression_context *context;
    const struct dalcs_expression_text *text;
    struct dalcs_operation *operation; /* heap */
    size_t n;
    size_t capacity;
    int depth;
    bool failed;
    bool out_of_memory;

    enum symbol symbol; /* the next one, */
    enum dalcs_operation_code code;
    int level;         /* of a binary operator: higher binds tighter */
    int begin, length; /* its place */
    int last_end;      /* where the one before it ended */
    double number;
};

/* ---- Messages -------------------------------------------------------------------------------- */

static void report(struct parser *p, enum dalcs_severity severity, int begin, int length,
                   const char *hint, const char *format, ...) __attribute__((format(printf, 6, 7)));

static void report(struct parser *p, enum dalcs_severity severity, int begin, int length,
                   const char *hint, const char *format, ...) {
    struct dalcs_location where = dalcs_expression_place(p->text, begin, length);
    va_list arguments;
    if (severity == DALCS_ERROR && p->failed) {
        return; /* the first error of a formula explains the others */
    }
    where.instance = p->context->instance;
    va_start(arguments, format);
    dalcs_diag_add_list(p->context->diag, severity, &where, hint, format, arguments);
    va_end(arguments);
    p->failed = p->failed || severity == DALCS_ERROR;
}

/* What other languages write for an operator; NULL: nothing known. */
static const char *operator_hint(const char *text, int length) {
    static const struct {
        const char *word, *hint;
    } WORDS[] = {{"and", "write &&"}, {"or", "write ||"}, {"not", "write !"}};

    const char *hint = dalcs_foreign_sign(text, (size_t)length);
    for (size_t k = 0; k < sizeof WORDS / sizeof WORDS[0]; k++) {
        if ((int)strlen(WORDS[k].word) == length && memcmp(WORDS[k].word, text, length) == 0) {
            hint = WORDS[k].hint;
        }
    }
    return hint;
}

static void unexpected(struct parser *p) {
    if (p->symbol == END) {
        report(p, DALCS_ERROR, p->last_end, 1, NULL, "a value is missing");
    } else {
        report(p, DALCS_ERROR, p->begin, p->length,
               operator_hint(p->text->text + p->begin, p->length),
               "did not expect '%.*s' in the expression", p->length, p->text->text + p->begin);
    }
}

/* ---- Symbols --------------------------------------------------------------------------------- */

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static bool starts_name(char c) {
    return (c >= 'a' && c <= 'z') || c == '_' || (unsigned char)c >= 0x80;
}

static bool continues_name(char c) {
    return starts_name(c) || is_digit(c) || c == '.' || c == '$' || c == '#' || c == '@';
}

/* The end of the number at t: digits, a point, an exponent, letters. */
static int number_length(const char *t) {
    int n = 0;
    while (is_digit(t[n]) || t[n] == '.') {
        n++;
    }
    if (t[n] == 'e' &&
        (is_digit(t[n + 1]) || ((t[n + 1] == '+' || t[n + 1] == '-') && is_digit(t[n + 2])))) {
        n += 2;
    }
    while (is_digit(t[n]) || t[n] == '.' || starts_name(t[n])) {
        n++;
    }
    return n;
}

/* 1M and 1F, where the line is not written in capitals anyway: what the number is for is not known
 * here, but whoever writes them so seldom means milli and femto. */
static void warn_of_capital(struct parser *p, const struct dalcs_number *number) {
    const bool is_last = number->tail == p->length;
    if (!is_last || (number->suffix != 'm' && number->suffix != 'f')) {
        return; /* before the place is counted, in all of a long line */
    }
    const struct dalcs_location where = dalcs_expression_place(p->text, p->begin, p->length);
    const struct dalcs_piece *piece = p->text->piece;
    while (piece + 1 < p->text->piece + p->text->n_pieces && piece[1].begin <= p->begin) {
        piece++;
    }
    const char *raw = where.source_line + piece->offset + p->begin - piece->begin;
    const char *capital = raw + number->digits;
    if ((*capital != 'M' && *capital != 'F') ||
        strpbrk(where.source_line, "abcdefghijklmnopqrstuvwxyz") == NULL) {
        return;
    }
    if (*capital == 'M') {
        report(p, DALCS_WARNING, p->begin, p->length, "write m for milli, Meg for mega",
               "M is milli: this is %g", number->value);
    } else {
        report(p, DALCS_WARNING, p->begin, p->length, "write f for femto, no letter for farad",
               "F is femto: this is %g", number->value);
    }
}

/* A number that only one other simulator reads so; silent where the netlist is told to be its. */
static void warn_of_dialect(struct parser *p, const char *text, const struct dalcs_number *number) {
    const struct dalcs_dialect *dialect = &p->context->dialect;
    if (number->is_special && !dialect->is_told) {
        report(p, DALCS_WARNING, p->begin, p->length, NULL, "'%s' is %g, as %s reads it", text,
               number->value, dalcs_dialect_simulator(dialect->name));
    }
}

static void read_number(struct parser *p) {
    const char *t = p->text->text + p->begin;
    p->length = number_length(t);
    p->symbol = NUMBER;
    const char *copy = dalcs_arena_copy(p->context->arena, t, (size_t)p->length);
    struct dalcs_number number;
    if (copy == NULL) {
        p->out_of_memory = true;
        p->symbol = WRONG;
        return;
    }
    switch (dalcs_number_parse_as(copy, p->context->dialect.name, &number)) {
    case DALCS_NUMBER_OK:
        p->number = number.value;
        warn_of_dialect(p, copy, &number);
        warn_of_capital(p, &number);
        if (number.suffix == 'i') {
            report(p, DALCS_WARNING, p->begin, p->length, "write m for milli",
                   "mil is 25.4e-6: this is %g", number.value);
        }
        return;
    case DALCS_NUMBER_OVERFLOW:
        report(p, DALCS_ERROR, p->begin, p->length, NULL, "'%s' is larger than any number here",
               copy);
        break;
    case DALCS_NUMBER_UNDERFLOW:
        report(p, DALCS_ERROR, p->begin, p->length, "write 0 if it is meant to be 0",
               "'%s' is too small: it would be rounded to 0", copy);
        break;
    case DALCS_NUMBER_RKM:
    case DALCS_NUMBER_MALFORMED:
        report(p, DALCS_ERROR, p->begin, p->length, "a number is one like 0.5, 10u, 1Meg or 2e-3",
               "'%s' is not a number", copy);
        break;
    }
    p->symbol = WRONG;
}

/* An operator of one or two bytes. */
static bool read_operator(struct parser *p, const char *t) {
    static const struct {
        const char *text;
        enum symbol symbol;
        enum dalcs_operation_code code;
        int level;
    } operators[] = {
        /* The longer ones first. */
        {"**", OPERATOR, DALCS_POWER, 8},
        {"||", OR, DALCS_JUMP_OR, 1},
        {"&&", AND, DALCS_JUMP_AND, 2},
        {"==", OPERATOR, DALCS_EQUAL, 3},
        {"!=", OPERATOR, DALCS_UNEQUAL, 3},
        {"<>", OPERATOR, DALCS_UNEQUAL, 3},
        {"<=", OPERATOR, DALCS_LESS_EQUAL, 4},
        {">=", OPERATOR, DALCS_GREATER_EQUAL, 4},
        {"<", OPERATOR, DALCS_LESS, 4},
        {">", OPERATOR, DALCS_GREATER, 4},
        {"+", OPERATOR, DALCS_ADD, 5},
        {"-", OPERATOR, DALCS_SUBTRACT, 5},
        {"*", OPERATOR, DALCS_MULTIPLY, 6},
        {"/", OPERATOR, DALCS_DIVIDE, 6},
        {"%", OPERATOR, DALCS_REMAINDER, 6},
        {"\\", OPERATOR, DALCS_QUOTIENT, 6},
        {"^", OPERATOR, DALCS_POWER, 8},
        {"|", OR, DALCS_JUMP_OR, 1},
        {"&", AND, DALCS_JUMP_AND, 2},
        {"=", OPERATOR, DALCS_EQUAL, 3}, /* in a condition */
        {"!", BANG, DALCS_NOT, 0},
        {"~", BANG, DALCS_NOT, 0},
        {"(", OPEN, 0, 0},
        {"{", OPEN, 0, 0},
        {")", CLOSE, 0, 0},
        {"}", CLOSE, 0, 0},
        {",", COMMA, 0, 0},
        {"?", QUESTION, 0, 0},
        {":", COLON, 0, 0},
    };

    for (size_t k = 0; k < sizeof operators / sizeof operators[0]; k++) {
        const size_t n = strlen(operators[k].text);
        const bool is_known = p->context->is_condition || strcmp(operators[k].text, "=") != 0;
        if (is_known && strncmp(t, operators[k].text, n) == 0) {
            p->symbol = operators[k].symbol;
            p->code = operators[k].code;
            p->level = operators[k].level;
            p->length = (int)n;
            return true;
        }
    }
    return false;
}

/* 'vref'*(v(a)/2): quotes inside of a formula are parentheses. One that follows a value closes. */
static void read_quote(struct parser *p, enum symbol before) {
    p->symbol = before == NUMBER || before == NAME || before == CLOSE ? CLOSE : OPEN;
    p->length = 1;
}

static void next(struct parser *p) {
    const char *text = p->text->text;
    const enum symbol before = p->symbol;
    p->last_end = p->begin + p->length;
    p->begin += p->length;
    while (text[p->begin] == ' ' || text[p->begin] == '\t') {
        p->begin++;
    }
    const char *t = text + p->begin;
    p->length = 0;
    p->level = 0;
    if (*t == '\0') {
        p->symbol = END;
    } else if (is_digit(*t) || (*t == '.' && is_digit(t[1]))) {
        read_number(p);
    } else if (starts_name(*t)) {
        p->symbol = NAME;
        while (continues_name(t[p->length])) {
            p->length++;
        }
    } else if (*t == '\'') {
        read_quote(p, before);
    } else if (!read_operator(p, t)) {
        p->symbol = WRONG;
        p->length = 1;
        report(p, DALCS_ERROR, p->begin, 1, *t == '=' ? "a comparison is written ==" : NULL,
               "'%c' is not a character of expressions", *t);
    }
}

/* ---- Operations ------------------------------------------------------------------------------ */

/* Appends an operation; its index, which a jump needs to be completed. */
static size_t emit(struct parser *p, struct dalcs_operation operation) {
    if (p->out_of_memory ||
        dalcs_grow(&p->operation, &p->capacity, p->n + 1, sizeof *p->operation) != DALCS_OK) {
        p->out_of_memory = true;
        p->failed = true;
        return 0;
    }
    p->operation[p->n] = operation;
    return p->n++;
}

static size_t emit_code(struct parser *p, enum dalcs_operation_code code, int begin, int length) {
    return emit(p, (struct dalcs_operation){.code = code, .begin = begin, .length = length});
}

/* Lets the jump at `place` go to what is emitted next. */
static void land(struct parser *p, size_t place) {
    if (!p->failed) {
        p->operation[place].count = (int)(p->n - place);
    }
}

static void parse_choice(struct parser *p);
static void parse_binary(struct parser *p, int least_level);

static bool enter(struct parser *p) {
    if (++p->depth > DEEPEST) {
        report(p, DALCS_ERROR, p->begin, p->length, "give a part of it a name with .param",
               "the expression is nested more than %d deep", DEEPEST);
    }
    return !p->failed;
}

static void close_parenthesis(struct parser *p, int open) {
    if (p->symbol == END) {
        report(p, DALCS_ERROR, open, 1, NULL, "this parenthesis is never closed");
    } else if (p->symbol != CLOSE) {
        unexpected(p);
    } else {
        next(p);
    }
}

static void expect_comma(struct parser *p, int begin, int length) {
    if (p->symbol == COMMA) {
        next(p);
    } else {
        report(p, DALCS_ERROR, begin, length, "if(condition, value, otherwise)",
               "'%.*s' takes 3 arguments", length, p->text->text + begin);
    }
}

/* if(condition, a, b): like condition ? a : b. */
static void parse_if(struct parser *p, int begin, int length) {
    parse_choice(p);
    const size_t skip_first = emit_code(p, DALCS_JUMP_IF_ZERO, begin, length);
    expect_comma(p, begin, length);
    parse_choice(p);
    const size_t skip_second = emit_code(p, DALCS_JUMP, begin, length);
    land(p, skip_first);
    expect_comma(p, begin, length);
    parse_choice(p);
    land(p, skip_second);
}

static void note_log(struct parser *p, int begin, int length, const char *name) {
    if (strcmp(name, "log") == 0 && !*p->context->noted_log && !p->context->dialect.is_told) {
        *p->context->noted_log = true;
        report(p, DALCS_WARNING, begin, length, "write ln or log10",
               p->context->dialect.name == DALCS_DIALECT_XYCE
                   ? "log is log10, as in Xyce and PSpice; elsewhere it is the natural logarithm"
                   : "log is the natural logarithm, as in ngspice and LTspice; elsewhere it is "
                     "log10");
    }
}

/* ^, which is a power everywhere but in LTspice, where most people who write it mean one too. */
static void note_caret(struct parser *p, int begin) {
    if (p->context->is_transfer) {
        return;
    }
    if (p->context->dialect.name == DALCS_DIALECT_LTSPICE) {
        report(p, DALCS_ERROR, begin, 1, "write ** or pow(x, y) for a power",
               "^ is exclusive or in LTspice, not a power");
    } else if (!*p->context->noted_caret && !p->context->dialect.is_told) {
        *p->context->noted_caret = true;
        report(p, DALCS_WARNING, begin, 1, "write ** or pow(x, y)",
               "^ is a power, as in ngspice; in LTspice it is exclusive or");
    }
}

/* The name of a node or an element, which may hold any byte but these, and what follows it. */
static void parse_signal_name(struct parser *p) {
    const char *text = p->text->text;
    int end = p->begin;
    while (text[end] != '\0' && text[end] != ',' && text[end] != '(' && text[end] != ')') {
        end++;
    }
    int stop = end;
    while (stop > p->begin && (text[stop - 1] == ' ' || text[stop - 1] == '\t')) {
        stop--;
    }
    if (stop == p->begin) {
        report(p, DALCS_ERROR, p->begin, 1, NULL, "a name is missing");
        return;
    }
    const char *name =
        dalcs_arena_copy(p->context->arena, text + p->begin, (size_t)(stop - p->begin));
    p->out_of_memory = p->out_of_memory || name == NULL;
    p->failed = p->failed || name == NULL;
    if (name != NULL && p->context->arguments != NULL &&
        dalcs_names_find(p->context->arguments, name) >= 0) {
        report(p, DALCS_ERROR, p->begin, stop - p->begin, "give the function the voltage itself",
               "an argument is a value, not the name of a node or an element");
    }
    emit(p, (struct dalcs_operation){.code = DALCS_SIGNAL_NAME,
                                     .begin = p->begin,
                                     .length = stop - p->begin,
                                     .u.name = name});
    p->begin = end;
    p->length = 0;
    next(p);
}

/* v(a), v(a,b), i(x): the parser stands at the parenthesis, not yet read beyond it. */
static void parse_signal(struct parser *p, int begin, const char *name) {
    const int open = p->begin;
    const size_t place = emit(
        p, (struct dalcs_operation){.code = DALCS_PUSH_SIGNAL, .begin = begin, .u.name = name});
    int n = 0;
    do {
        p->begin += p->length;
        p->length = 0;
        while (p->text->text[p->begin] == ' ' || p->text->text[p->begin] == '\t') {
            p->begin++;
        }
        parse_signal_name(p);
        n++;
    } while (p->symbol == COMMA && !p->failed);
    const int end = p->begin + p->length;
    close_parenthesis(p, open);
    if (n > (*name == 'v' ? 2 : 1)) {
        report(p, DALCS_ERROR, begin, end - begin, NULL,
               *name == 'v' ? "a voltage is that of one node, or between two"
                            : "a current is that of one element");
    }
    if (!p->failed) {
        p->operation[place].count = n;
        p->operation[place].length = end - begin;
    }
}

/* Does a point of a table stand here, as in table(x, (0, 1), (2, 5))? */
static bool is_point(const struct parser *p, const char *function) {
    const char *text = p->text->text + p->begin;
    bool is = false;
    if (p->symbol != OPEN || *text != '(' ||
        (strcmp(function, "table") != 0 && strcmp(function, "tbl") != 0)) {
        return false;
    }
    int depth = 0;
    do {
        depth += (*text == '(') - (*text == ')');
        is = is || (depth == 1 && *text == ',');
        text++;
    } while (depth > 0 && *text != '\0');
    return is && depth == 0;
}

static void parse_point(struct parser *p) {
    const int open = p->begin;
    next(p);
    parse_choice(p);
    if (p->symbol == COMMA) {
        next(p);
        parse_choice(p);
    }
    close_parenthesis(p, open);
}

static void parse_call(struct parser *p, int begin, int length, const char *name) {
    const int open = p->begin;
    const struct dalcs_function *function = dalcs_function_find(name, p->context->dialect.name);
    if (p->context->has_signals && (strcmp(name, "v") == 0 || strcmp(name, "i") == 0)) {
        parse_signal(p, begin, name);
        return;
    }
    next(p);
    if (function != NULL && function->one == NULL && function->two == NULL &&
        function->many == NULL) {
        parse_if(p, begin, length);
        close_parenthesis(p, open);
        return;
    }
    if (dalcs_function_refusal(name) != NULL) {
        emit(p, (struct dalcs_operation){
                    .code = DALCS_CHECK_CALL, .begin = begin, .length = length, .u.name = name});
    }
    int n = 0;
    if (p->symbol != CLOSE) {
        do {
            if (n > 0) {
                next(p);
            }
            const bool has_two = n > 0 && is_point(p, name);
            if (has_two) {
                parse_point(p);
            } else {
                parse_choice(p);
            }
            n += has_two ? 2 : 1;
        } while (p->symbol == COMMA && !p->failed);
    }
    close_parenthesis(p, open);
    note_log(p, begin, length, name);
    emit(p, (struct dalcs_operation){
                .code = DALCS_CALL, .count = n, .begin = begin, .length = length, .u.name = name});
}

static void parse_name(struct parser *p) {
    const int begin = p->begin;
    const int length = p->length;
    const char *name = dalcs_arena_copy(p->context->arena, p->text->text + begin, (size_t)length);
    if (name == NULL) {
        p->out_of_memory = true;
        p->failed = true;
        return;
    }
    next(p);
    if (p->symbol == OPEN && p->text->text[p->begin] == '(') {
        parse_call(p, begin, length, name);
        return;
    }
    const int argument =
        p->context->arguments != NULL ? dalcs_names_find(p->context->arguments, name) : -1;
    emit(p, (struct dalcs_operation){.code = argument >= 0 ? DALCS_PUSH_ARGUMENT : DALCS_PUSH_NAME,
                                     .count = argument,
                                     .begin = begin,
                                     .length = length,
                                     .u.name = name});
}

/* A number, a name, a call, something in parentheses. */
static void parse_primary(struct parser *p) {
    if (p->symbol == NUMBER) {
        emit(p, (struct dalcs_operation){.code = DALCS_PUSH_NUMBER,
                                         .begin = p->begin,
                                         .length = p->length,
                                         .u.number = p->number});
        next(p);
    } else if (p->symbol == NAME) {
        parse_name(p);
    } else if (p->symbol == OPEN) {
        const int open = p->begin;
        next(p);
        parse_choice(p);
        close_parenthesis(p, open);
    } else {
        unexpected(p);
    }
}

/* base ** exponent. */
static void parse_power(struct parser *p, int minus) {
    parse_primary(p);
    if (p->failed || p->symbol != OPERATOR || p->code != DALCS_POWER) {
        return;
    }
    const int begin = p->begin;
    const int length = p->length;
    if (length == 1) {
        note_caret(p, begin);
    }
    if (minus >= 0) {
        report(p, DALCS_ERROR, minus, begin - minus, "write parentheses",
               "ngspice applies this minus before the power, mathematics after it");
        return;
    }
    next(p);
    if (p->symbol == BANG) {
        unexpected(p);
        return;
    }
    bool negative = false;
    while (p->symbol == OPERATOR && (p->code == DALCS_SUBTRACT || p->code == DALCS_ADD)) {
        negative = negative != (p->code == DALCS_SUBTRACT);
        next(p);
    }
    parse_primary(p);
    if (negative) {
        emit_code(p, DALCS_NEGATE, begin, length);
    }
    emit_code(p, DALCS_POWER, begin, length);
    if (!p->failed && p->symbol == OPERATOR && p->code == DALCS_POWER) {
        report(p, DALCS_ERROR, p->begin, p->length, "write parentheses",
               "a power of a power: ngspice starts at the left, mathematics at the right");
    }
}

static void parse_unary(struct parser *p, bool after_operator) {
    const int begin = p->begin;
    const int length = p->length;
    if (!enter(p)) {
        return;
    }
    if (p->symbol == BANG) {
        next(p);
        parse_unary(p, true);
        emit_code(p, DALCS_NOT, begin, length);
    } else if (p->symbol == OPERATOR && (p->code == DALCS_SUBTRACT || p->code == DALCS_ADD)) {
        const bool negative = p->code == DALCS_SUBTRACT;
        next(p);
        if (p->symbol == BANG ||
            (p->symbol == OPERATOR && (p->code == DALCS_SUBTRACT || p->code == DALCS_ADD))) {
            parse_unary(p, after_operator);
        } else {
            parse_power(p, after_operator && negative ? begin : -1);
        }
        if (negative) {
            emit_code(p, DALCS_NEGATE, begin, length);
        }
    } else {
        parse_power(p, -1);
    }
    p->depth--;
}

/* Binary operators of at least this level, from the left. */
static void parse_binary(struct parser *p, int least_level) {
    parse_unary(p, least_level > 1);
    while (!p->failed && (p->symbol == OPERATOR || p->symbol == AND || p->symbol == OR) &&
           p->level >= least_level) {
        const enum dalcs_operation_code code = p->code;
        const int level = p->level;
        const int begin = p->begin;
        const int length = p->length;
        const bool jumps = p->symbol != OPERATOR;
        const size_t jump = jumps ? emit_code(p, code, begin, length) : 0;
        next(p);
        parse_binary(p, level + 1);
        if (jumps) {
            emit_code(p, DALCS_TO_LOGIC, begin, length);
            land(p, jump);
        } else {
            emit_code(p, code, begin, length);
        }
    }
}

/* condition ? a : b, from the right. */
static void parse_choice(struct parser *p) {
    if (!enter(p)) {
        return;
    }
    parse_binary(p, 1);
    if (!p->failed && p->symbol == QUESTION) {
        const int begin = p->begin;
        next(p);
        const size_t skip_first = emit_code(p, DALCS_JUMP_IF_ZERO, begin, 1);
        parse_choice(p);
        const size_t skip_second = emit_code(p, DALCS_JUMP, begin, 1);
        land(p, skip_first);
        if (p->symbol != COLON) {
            report(p, DALCS_ERROR, begin, 1, "condition ? value : otherwise",
                   "this '?' has no ':'");
            return;
        }
        next(p);
        parse_choice(p);
        land(p, skip_second);
    }
    p->depth--;
}

struct dalcs_expression *dalcs_expression_parse(const struct dalcs_expression_context *context,
                                                const struct dalcs_expression_text *text) {
    struct parser p = {.context = context, .text = text};
    next(&p);
    if (p.symbol == END) {
        report(&p, DALCS_ERROR, 0, 1, NULL, "the expression is empty");
    } else {
        parse_choice(&p);
    }
    if (!p.failed && p.symbol != END) {
        unexpected(&p);
    }
    struct dalcs_arena *arena = context->arena;
    struct dalcs_expression *expression = dalcs_arena_alloc(arena, 1, sizeof *expression);
    struct dalcs_operation *operation = dalcs_arena_alloc(arena, p.n, sizeof *operation);
    const bool ok = expression != NULL && operation != NULL && !p.out_of_memory;
    if (ok) {
        if (p.n > 0) {
            memcpy(operation, p.operation, p.n * sizeof *operation);
        }
        *expression = (struct dalcs_expression){*text, operation, (int)p.n, p.failed};
    }
    free(p.operation);
    return ok ? expression : NULL;
}
