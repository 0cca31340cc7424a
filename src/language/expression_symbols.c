/* expression_symbols.c - the text of an expression as numbers, names and operators, one after the other. */
#include "expression_parser.h"

#include "foreign.h"
#include "number.h"

#include <stdarg.h>
#include <string.h>

void dalcs_parser_report(struct dalcs_parser *p, enum dalcs_severity severity, int begin,
                         int length, const char *hint, const char *format, ...) {
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

void dalcs_parser_unexpected(struct dalcs_parser *p) {
    if (p->symbol == DALCS_SYMBOL_END) {
        dalcs_parser_report(p, DALCS_ERROR, p->last_end, 1, NULL, "a value is missing");
    } else {
        dalcs_parser_report(
            p, DALCS_ERROR, p->begin, p->length, operator_hint(p->text->text + p->begin, p->length),
            "did not expect '%.*s' in the expression", p->length, p->text->text + p->begin);
    }
}

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
static void warn_of_capital(struct dalcs_parser *p, const struct dalcs_number *number) {
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
        dalcs_parser_report(p, DALCS_WARNING, p->begin, p->length,
                            "write m for milli, Meg for mega", "M is milli: this is %g",
                            number->value);
    } else {
        dalcs_parser_report(p, DALCS_WARNING, p->begin, p->length,
                            "write f for femto, no letter for farad", "F is femto: this is %g",
                            number->value);
    }
}

/* A number that only one other simulator reads so; silent where the netlist is told to be its. */
static void warn_of_dialect(struct dalcs_parser *p, const char *text,
                            const struct dalcs_number *number) {
    const struct dalcs_dialect *dialect = &p->context->dialect;
    if (number->is_special && !dialect->is_told) {
        dalcs_parser_report(p, DALCS_WARNING, p->begin, p->length, NULL,
                            "'%s' is %g, as %s reads it", text, number->value,
                            dalcs_dialect_simulator(dialect->name));
    }
}

static void read_number(struct dalcs_parser *p) {
    const char *t = p->text->text + p->begin;
    p->length = number_length(t);
    p->symbol = DALCS_SYMBOL_NUMBER;
    const char *copy = dalcs_arena_copy(p->context->arena, t, (size_t)p->length);
    struct dalcs_number number;
    if (copy == NULL) {
        p->out_of_memory = true;
        p->symbol = DALCS_SYMBOL_WRONG;
        return;
    }
    switch (dalcs_number_parse_as(copy, p->context->dialect.name, &number)) {
    case DALCS_NUMBER_OK:
        p->number = number.value;
        warn_of_dialect(p, copy, &number);
        warn_of_capital(p, &number);
        if (number.suffix == 'i') {
            dalcs_parser_report(p, DALCS_WARNING, p->begin, p->length, "write m for milli",
                                "mil is 25.4e-6: this is %g", number.value);
        }
        return;
    case DALCS_NUMBER_OVERFLOW:
        dalcs_parser_report(p, DALCS_ERROR, p->begin, p->length, NULL,
                            "'%s' is larger than any number here", copy);
        break;
    case DALCS_NUMBER_UNDERFLOW:
        dalcs_parser_report(p, DALCS_ERROR, p->begin, p->length, "write 0 if it is meant to be 0",
                            "'%s' is too small: it would be rounded to 0", copy);
        break;
    case DALCS_NUMBER_RKM:
    case DALCS_NUMBER_MALFORMED:
        dalcs_parser_report(p, DALCS_ERROR, p->begin, p->length,
                            "a number is one like 0.5, 10u, 1Meg or 2e-3", "'%s' is not a number",
                            copy);
        break;
    }
    p->symbol = DALCS_SYMBOL_WRONG;
}

static const struct {
    const char *text;
    enum dalcs_symbol symbol;
    enum dalcs_operation_code code;
    int level;
} operators[] = {
    /* The longer ones first. */
    {"**", DALCS_SYMBOL_OPERATOR, DALCS_POWER, 8},
    {"||", DALCS_SYMBOL_OR, DALCS_JUMP_OR, 1},
    {"&&", DALCS_SYMBOL_AND, DALCS_JUMP_AND, 2},
    {"==", DALCS_SYMBOL_OPERATOR, DALCS_EQUAL, 3},
    {"!=", DALCS_SYMBOL_OPERATOR, DALCS_UNEQUAL, 3},
    {"<>", DALCS_SYMBOL_OPERATOR, DALCS_UNEQUAL, 3},
    {"<=", DALCS_SYMBOL_OPERATOR, DALCS_LESS_EQUAL, 4},
    {">=", DALCS_SYMBOL_OPERATOR, DALCS_GREATER_EQUAL, 4},
    {"<", DALCS_SYMBOL_OPERATOR, DALCS_LESS, 4},
    {">", DALCS_SYMBOL_OPERATOR, DALCS_GREATER, 4},
    {"+", DALCS_SYMBOL_OPERATOR, DALCS_ADD, 5},
    {"-", DALCS_SYMBOL_OPERATOR, DALCS_SUBTRACT, 5},
    {"*", DALCS_SYMBOL_OPERATOR, DALCS_MULTIPLY, 6},
    {"/", DALCS_SYMBOL_OPERATOR, DALCS_DIVIDE, 6},
    {"%", DALCS_SYMBOL_OPERATOR, DALCS_REMAINDER, 6},
    {"\\", DALCS_SYMBOL_OPERATOR, DALCS_QUOTIENT, 6},
    {"^", DALCS_SYMBOL_OPERATOR, DALCS_POWER, 8},
    {"|", DALCS_SYMBOL_OR, DALCS_JUMP_OR, 1},
    {"&", DALCS_SYMBOL_AND, DALCS_JUMP_AND, 2},
    {"=", DALCS_SYMBOL_OPERATOR, DALCS_EQUAL, 3}, /* in a condition */
    {"!", DALCS_SYMBOL_BANG, DALCS_NOT, 0},
    {"~", DALCS_SYMBOL_BANG, DALCS_NOT, 0},
    {"(", DALCS_SYMBOL_OPEN, 0, 0},
    {"{", DALCS_SYMBOL_OPEN, 0, 0},
    {")", DALCS_SYMBOL_CLOSE, 0, 0},
    {"}", DALCS_SYMBOL_CLOSE, 0, 0},
    {",", DALCS_SYMBOL_COMMA, 0, 0},
    {"?", DALCS_SYMBOL_QUESTION, 0, 0},
    {":", DALCS_SYMBOL_COLON, 0, 0},
};

/* An operator of one or two bytes. */
static bool read_operator(struct dalcs_parser *p, const char *t) {
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
static void read_quote(struct dalcs_parser *p, enum dalcs_symbol before) {
    p->symbol =
        before == DALCS_SYMBOL_NUMBER || before == DALCS_SYMBOL_NAME || before == DALCS_SYMBOL_CLOSE
            ? DALCS_SYMBOL_CLOSE
            : DALCS_SYMBOL_OPEN;
    p->length = 1;
}

void dalcs_parser_next(struct dalcs_parser *p) {
    const char *text = p->text->text;
    const enum dalcs_symbol before = p->symbol;
    p->last_end = p->begin + p->length;
    p->begin += p->length;
    while (text[p->begin] == ' ' || text[p->begin] == '\t') {
        p->begin++;
    }
    const char *t = text + p->begin;
    p->length = 0;
    p->level = 0;
    if (*t == '\0') {
        p->symbol = DALCS_SYMBOL_END;
    } else if (is_digit(*t) || (*t == '.' && is_digit(t[1]))) {
        read_number(p);
    } else if (starts_name(*t)) {
        p->symbol = DALCS_SYMBOL_NAME;
        while (continues_name(t[p->length])) {
            p->length++;
        }
    } else if (*t == '\'') {
        read_quote(p, before);
    } else if (!read_operator(p, t)) {
        p->symbol = DALCS_SYMBOL_WRONG;
        p->length = 1;
        dalcs_parser_report(
            p, DALCS_ERROR, p->begin, 1,
            *t == '='   ? "a comparison is written =="
            : *t == '"' ? "points over time from a file are a source, PWL FILE=\"name\", and "
                          "its v(node) stands in the formula"
                        : NULL,
            "'%c' is not a character of expressions", *t);
    }
}
