/* expression_call.c - names in an expression: parameters, calls, v(...), i(...) and if(...). */
#include "expression_parser.h"

#include <math.h>
#include <string.h>

static void expect_comma(struct dalcs_parser *p, int begin, int length) {
    if (p->symbol == DALCS_SYMBOL_COMMA) {
        dalcs_parser_next(p);
    } else {
        dalcs_parser_report(p, DALCS_ERROR, begin, length, "if(condition, value, otherwise)",
                            "'%.*s' takes 3 arguments", length, p->text->text + begin);
    }
}

/* if(condition, a, b): like condition ? a : b. */
static void parse_if(struct dalcs_parser *p, int begin, int length) {
    dalcs_parser_choice(p);
    const size_t skip_first = dalcs_parser_emit_code(p, DALCS_JUMP_IF_ZERO, begin, length);
    expect_comma(p, begin, length);
    dalcs_parser_choice(p);
    const size_t skip_second = dalcs_parser_emit_code(p, DALCS_JUMP, begin, length);
    dalcs_parser_land(p, skip_first);
    expect_comma(p, begin, length);
    dalcs_parser_choice(p);
    dalcs_parser_land(p, skip_second);
}

static void note_log(struct dalcs_parser *p, int begin, int length, const char *name) {
    if (strcmp(name, "log") == 0 && !*p->context->noted_log && !p->context->dialect.is_told) {
        *p->context->noted_log = true;
        dalcs_parser_report(
            p, DALCS_WARNING, begin, length, "write ln or log10",
            p->context->dialect.name == DALCS_DIALECT_XYCE
                ? "log is log10, as in Xyce and PSpice; elsewhere it is the natural logarithm"
                : "log is the natural logarithm, as in ngspice and LTspice; elsewhere it is "
                  "log10");
    }
}

/* The name of a node or an element, which may hold any byte but these, and what follows it. */
static void parse_signal_name(struct dalcs_parser *p) {
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
        dalcs_parser_report(p, DALCS_ERROR, p->begin, 1, NULL, "a name is missing");
        return;
    }
    const char *name =
        dalcs_arena_copy(p->context->arena, text + p->begin, (size_t)(stop - p->begin));
    p->out_of_memory = p->out_of_memory || name == NULL;
    p->failed = p->failed || name == NULL;
    if (name != NULL && p->context->arguments != NULL &&
        dalcs_names_find(p->context->arguments, name) >= 0) {
        dalcs_parser_report(p, DALCS_ERROR, p->begin, stop - p->begin,
                            "give the function the voltage itself",
                            "an argument is a value, not the name of a node or an element");
    }
    dalcs_parser_emit(p, (struct dalcs_operation){.code = DALCS_SIGNAL_NAME,
                                                  .begin = p->begin,
                                                  .length = stop - p->begin,
                                                  .u.name = name});
    p->begin = end;
    p->length = 0;
    dalcs_parser_next(p);
}

/* v(a), v(a,b), i(x): the parser stands at the parenthesis, not yet read beyond it. */
static void parse_signal(struct dalcs_parser *p, int begin, const char *name) {
    const int open = p->begin;
    const size_t place = dalcs_parser_emit(
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
    } while (p->symbol == DALCS_SYMBOL_COMMA && !p->failed);
    const int end = p->begin + p->length;
    dalcs_parser_close(p, open);
    if (n > (*name == 'v' ? 2 : 1)) {
        dalcs_parser_report(p, DALCS_ERROR, begin, end - begin, NULL,
                            *name == 'v' ? "a voltage is that of one node, or between two"
                                         : "a current is that of one element");
    }
    if (!p->failed) {
        p->operation[place].count = n;
        p->operation[place].length = end - begin;
    }
}

/* Does a point of a table stand here, as in table(x, (0, 1), (2, 5))? */
static bool is_point(const struct dalcs_parser *p, const char *function) {
    const char *text = p->text->text + p->begin;
    bool is = false;
    if (p->symbol != DALCS_SYMBOL_OPEN || *text != '(' ||
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

static void parse_point(struct dalcs_parser *p) {
    const int open = p->begin;
    dalcs_parser_next(p);
    dalcs_parser_choice(p);
    if (p->symbol == DALCS_SYMBOL_COMMA) {
        dalcs_parser_next(p);
        dalcs_parser_choice(p);
    }
    dalcs_parser_close(p, open);
}

/* Does what was emitted from operation `first` on read a voltage or a current? */
static bool reads_signal(const struct dalcs_parser *p, size_t first, size_t end) {
    bool reads = false;
    for (size_t k = first; k < end && !p->failed; k++) {
        reads = reads || p->operation[k].code == DALCS_PUSH_SIGNAL;
    }
    return reads;
}

/* May powers of signals be those of ngspice, which are others? */
static bool may_be_of_ngspice(const struct dalcs_parser *p) {
    const struct dalcs_expression_context *c = p->context;
    return c->has_signals && c->dialect.name != DALCS_DIALECT_LTSPICE &&
           c->dialect.name != DALCS_DIALECT_XYCE;
}

/* Once, and not where ngspice is declared. */
static void warn_of_ngspice(struct dalcs_parser *p, int begin, int length, const char *hint,
                            const char *message) {
    const struct dalcs_expression_context *c = p->context;
    if (!c->dialect.is_told && c->noted_pwr != NULL && !*c->noted_pwr) {
        *c->noted_pwr = true;
        dalcs_parser_report(p, DALCS_WARNING, begin, length, hint, "%s", message);
    }
}

/* The exponent that operations from `first` on are, if it is a number that is written; else NAN. */
static double written(const struct dalcs_parser *p, size_t first) {
    const bool is =
        !p->failed && p->n == first + 1 && p->operation[first].code == DALCS_PUSH_NUMBER;
    return is ? p->operation[first].u.number : (double)NAN;
}

bool dalcs_parser_takes_magnitude(struct dalcs_parser *p, int begin, int length, size_t first,
                                  size_t end) {
    const double past_even = fmod(written(p, end), 2.0); /* NAN: it may be */
    if (!may_be_of_ngspice(p) || past_even == 0.0 || !reads_signal(p, first, end)) {
        return false;
    }
    if (fabs(past_even) == 1.0) {
        warn_of_ngspice(p, begin, length, "x*x**2 for x**3 is the same everywhere",
                        "an odd power of what is below 0 is below 0, as in LTspice, PSpice and "
                        "Xyce; a source of ngspice takes the power of the magnitude");
    }
    return p->context->dialect.is_told;
}

/* Of a voltage or a current, pow(x, y) is that of the magnitude in ngspice and pwr(x, y) has the sign of x, and in no other
 * simulator. */
static const char *read_power(struct dalcs_parser *p, int begin, int length, const char *name,
                              size_t first, size_t end) {
    if (strcmp(name, "pow") == 0) {
        return dalcs_parser_takes_magnitude(p, begin, length, first, end) ? "pwr" : name;
    }
    if (strcmp(name, "pwr") != 0 || !may_be_of_ngspice(p)) {
        return name;
    }
    if (reads_signal(p, first, end)) {
        warn_of_ngspice(p, begin, length, "write pwrs(x, y) for that, or pwr(abs(x), y)",
                        "pwr(x, y) is abs(x)**y, as in LTspice, PSpice and Xyce; a source of "
                        "ngspice gives it the sign of x");
    }
    return p->context->dialect.is_told ? "pwrs" : name;
}

static void parse_call(struct dalcs_parser *p, int begin, int length, const char *name) {
    const int open = p->begin;
    const struct dalcs_function *function = dalcs_function_find(name, p->context->dialect.name);
    if (p->context->has_signals && (strcmp(name, "v") == 0 || strcmp(name, "i") == 0)) {
        parse_signal(p, begin, name);
        return;
    }
    dalcs_parser_next(p);
    if (function != NULL && function->one == NULL && function->two == NULL &&
        function->many == NULL) {
        parse_if(p, begin, length);
        dalcs_parser_close(p, open);
        return;
    }
    if (dalcs_function_refusal(name) != NULL) {
        dalcs_parser_emit(
            p, (struct dalcs_operation){
                   .code = DALCS_CHECK_CALL, .begin = begin, .length = length, .u.name = name});
    }
    int n = 0;
    const size_t first = p->n;
    size_t end = p->n; /* of the first argument */
    if (p->symbol != DALCS_SYMBOL_CLOSE) {
        do {
            if (n > 0) {
                dalcs_parser_next(p);
            }
            const bool has_two = n > 0 && is_point(p, name);
            if (has_two) {
                parse_point(p);
            } else {
                dalcs_parser_choice(p);
            }
            end = n == 0 ? p->n : end;
            n += has_two ? 2 : 1;
        } while (p->symbol == DALCS_SYMBOL_COMMA && !p->failed);
    }
    dalcs_parser_close(p, open);
    note_log(p, begin, length, name);
    name = n == 2 ? read_power(p, begin, length, name, first, end) : name;
    dalcs_parser_emit(
        p, (struct dalcs_operation){
               .code = DALCS_CALL, .count = n, .begin = begin, .length = length, .u.name = name});
}

void dalcs_parser_name(struct dalcs_parser *p) {
    const int begin = p->begin;
    const int length = p->length;
    const char *name = dalcs_arena_copy(p->context->arena, p->text->text + begin, (size_t)length);
    if (name == NULL) {
        p->out_of_memory = true;
        p->failed = true;
        return;
    }
    dalcs_parser_next(p);
    if (p->symbol == DALCS_SYMBOL_OPEN && p->text->text[p->begin] == '(') {
        parse_call(p, begin, length, name);
        return;
    }
    const int argument =
        p->context->arguments != NULL ? dalcs_names_find(p->context->arguments, name) : -1;
    dalcs_parser_emit(
        p, (struct dalcs_operation){.code = argument >= 0 ? DALCS_PUSH_ARGUMENT : DALCS_PUSH_NAME,
                                    .count = argument,
                                    .begin = begin,
                                    .length = length,
                                    .u.name = name});
}
