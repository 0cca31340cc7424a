/* expression_parse.c - the text of an expression to operations: precedence climbing.
 *
 * From loose to tight: ?:, ||, &&, == != <>, < <= > >=, + -, * / % \, unary - + !, ** ^. Where
 * ngspice's reading of a formula is not that of mathematics and other simulators, there is no safe
 * one, and it is an error: a**b**c, and a*-b**c. */
#include "expression_parser.h"

#include <stdlib.h>
#include <string.h>

/* Deeper formulas are no formulas that a person wrote; the stack of this program has an end. */
enum { DEEPEST = 200 };

size_t dalcs_parser_emit(struct dalcs_parser *p, struct dalcs_operation operation) {
    if (p->out_of_memory ||
        dalcs_grow(&p->operation, &p->capacity, p->n + 1, sizeof *p->operation) != DALCS_OK) {
        p->out_of_memory = true;
        p->failed = true;
        return 0;
    }
    p->operation[p->n] = operation;
    return p->n++;
}

size_t dalcs_parser_emit_code(struct dalcs_parser *p, enum dalcs_operation_code code, int begin,
                              int length) {
    return dalcs_parser_emit(
        p, (struct dalcs_operation){.code = code, .begin = begin, .length = length});
}

void dalcs_parser_land(struct dalcs_parser *p, size_t place) {
    if (!p->failed) {
        p->operation[place].count = (int)(p->n - place);
    }
}

static void parse_binary(struct dalcs_parser *p, int least_level);

static bool enter(struct dalcs_parser *p) {
    if (++p->depth > DEEPEST) {
        dalcs_parser_report(p, DALCS_ERROR, p->begin, p->length,
                            "give a part of it a name with .param",
                            "the expression is nested more than %d deep", DEEPEST);
    }
    return !p->failed;
}

void dalcs_parser_close(struct dalcs_parser *p, int open) {
    if (p->symbol == DALCS_SYMBOL_END) {
        dalcs_parser_report(p, DALCS_ERROR, open, 1, NULL, "this parenthesis is never closed");
    } else if (p->symbol != DALCS_SYMBOL_CLOSE) {
        dalcs_parser_unexpected(p);
    } else {
        dalcs_parser_next(p);
    }
}

/* ^, which is a power everywhere but in LTspice, where most people who write it mean one too. */
static void note_caret(struct dalcs_parser *p, int begin) {
    if (p->context->is_transfer) {
        return;
    }
    if (p->context->dialect.name == DALCS_DIALECT_LTSPICE) {
        dalcs_parser_report(p, DALCS_ERROR, begin, 1, "write ** or pow(x, y) for a power",
                            "^ is exclusive or in LTspice, not a power");
    } else if (!*p->context->noted_caret && !p->context->dialect.is_told) {
        *p->context->noted_caret = true;
        dalcs_parser_report(p, DALCS_WARNING, begin, 1, "write ** or pow(x, y)",
                            "^ is a power, as in ngspice; in LTspice it is exclusive or");
    }
}

/* A number, a name, a call, something in parentheses. */
static void parse_primary(struct dalcs_parser *p) {
    if (p->symbol == DALCS_SYMBOL_NUMBER) {
        dalcs_parser_emit(p, (struct dalcs_operation){.code = DALCS_PUSH_NUMBER,
                                                      .begin = p->begin,
                                                      .length = p->length,
                                                      .u.number = p->number});
        dalcs_parser_next(p);
    } else if (p->symbol == DALCS_SYMBOL_NAME) {
        dalcs_parser_name(p);
    } else if (p->symbol == DALCS_SYMBOL_OPEN) {
        const int open = p->begin;
        dalcs_parser_next(p);
        dalcs_parser_choice(p);
        dalcs_parser_close(p, open);
    } else {
        dalcs_parser_unexpected(p);
    }
}

/* base ** exponent. */
static void parse_power(struct dalcs_parser *p, int minus) {
    const size_t first = p->n;
    parse_primary(p);
    const size_t end = p->n;
    if (p->failed || p->symbol != DALCS_SYMBOL_OPERATOR || p->code != DALCS_POWER) {
        return;
    }
    const int begin = p->begin;
    const int length = p->length;
    if (length == 1) {
        note_caret(p, begin);
    }
    if (minus >= 0) {
        dalcs_parser_report(p, DALCS_ERROR, minus, begin - minus, "write parentheses",
                            "ngspice applies this minus before the power, mathematics after it");
        return;
    }
    dalcs_parser_next(p);
    if (p->symbol == DALCS_SYMBOL_BANG) {
        dalcs_parser_unexpected(p);
        return;
    }
    bool negative = false;
    while (p->symbol == DALCS_SYMBOL_OPERATOR &&
           (p->code == DALCS_SUBTRACT || p->code == DALCS_ADD)) {
        negative = negative != (p->code == DALCS_SUBTRACT);
        dalcs_parser_next(p);
    }
    parse_primary(p);
    if (negative) {
        dalcs_parser_emit_code(p, DALCS_NEGATE, begin, length);
    }
    if (dalcs_parser_takes_magnitude(p, begin, length, first, end)) {
        dalcs_parser_emit(
            p,
            (struct dalcs_operation){
                .code = DALCS_CALL, .count = 2, .begin = begin, .length = length, .u.name = "pwr"});
    } else {
        dalcs_parser_emit_code(p, DALCS_POWER, begin, length);
    }
    if (!p->failed && p->symbol == DALCS_SYMBOL_OPERATOR && p->code == DALCS_POWER) {
        dalcs_parser_report(
            p, DALCS_ERROR, p->begin, p->length, "write parentheses",
            "a power of a power: ngspice starts at the left, mathematics at the right");
    }
}

static void parse_unary(struct dalcs_parser *p, bool after_operator) {
    const int begin = p->begin;
    const int length = p->length;
    if (!enter(p)) {
        return;
    }
    if (p->symbol == DALCS_SYMBOL_BANG) {
        dalcs_parser_next(p);
        parse_unary(p, true);
        dalcs_parser_emit_code(p, DALCS_NOT, begin, length);
    } else if (p->symbol == DALCS_SYMBOL_OPERATOR &&
               (p->code == DALCS_SUBTRACT || p->code == DALCS_ADD)) {
        const bool negative = p->code == DALCS_SUBTRACT;
        dalcs_parser_next(p);
        if (p->symbol == DALCS_SYMBOL_BANG ||
            (p->symbol == DALCS_SYMBOL_OPERATOR &&
             (p->code == DALCS_SUBTRACT || p->code == DALCS_ADD))) {
            parse_unary(p, after_operator);
        } else {
            parse_power(p, after_operator && negative ? begin : -1);
        }
        if (negative) {
            dalcs_parser_emit_code(p, DALCS_NEGATE, begin, length);
        }
    } else {
        parse_power(p, -1);
    }
    p->depth--;
}

/* Binary operators of at least this level, from the left. */
static void parse_binary(struct dalcs_parser *p, int least_level) {
    parse_unary(p, least_level > 1);
    while (!p->failed &&
           (p->symbol == DALCS_SYMBOL_OPERATOR || p->symbol == DALCS_SYMBOL_AND ||
            p->symbol == DALCS_SYMBOL_OR) &&
           p->level >= least_level) {
        const enum dalcs_operation_code code = p->code;
        const int level = p->level;
        const int begin = p->begin;
        const int length = p->length;
        const bool jumps = p->symbol != DALCS_SYMBOL_OPERATOR;
        const size_t jump = jumps ? dalcs_parser_emit_code(p, code, begin, length) : 0;
        dalcs_parser_next(p);
        parse_binary(p, level + 1);
        if (jumps) {
            dalcs_parser_emit_code(p, DALCS_TO_LOGIC, begin, length);
            dalcs_parser_land(p, jump);
        } else {
            dalcs_parser_emit_code(p, code, begin, length);
        }
    }
}

void dalcs_parser_choice(struct dalcs_parser *p) {
    if (!enter(p)) {
        return;
    }
    parse_binary(p, 1);
    if (!p->failed && p->symbol == DALCS_SYMBOL_QUESTION) {
        const int begin = p->begin;
        dalcs_parser_next(p);
        const size_t skip_first = dalcs_parser_emit_code(p, DALCS_JUMP_IF_ZERO, begin, 1);
        dalcs_parser_choice(p);
        const size_t skip_second = dalcs_parser_emit_code(p, DALCS_JUMP, begin, 1);
        dalcs_parser_land(p, skip_first);
        if (p->symbol != DALCS_SYMBOL_COLON) {
            dalcs_parser_report(p, DALCS_ERROR, begin, 1, "condition ? value : otherwise",
                                "this '?' has no ':'");
            return;
        }
        dalcs_parser_next(p);
        dalcs_parser_choice(p);
        dalcs_parser_land(p, skip_second);
    }
    p->depth--;
}

struct dalcs_expression *dalcs_expression_parse(const struct dalcs_expression_context *context,
                                                const struct dalcs_expression_text *text) {
    struct dalcs_parser p = {.context = context, .text = text};
    dalcs_parser_next(&p);
    if (p.symbol == DALCS_SYMBOL_END) {
        dalcs_parser_report(&p, DALCS_ERROR, 0, 1, NULL, "the expression is empty");
    } else {
        dalcs_parser_choice(&p);
    }
    if (!p.failed && p.symbol != DALCS_SYMBOL_END) {
        dalcs_parser_unexpected(&p);
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
