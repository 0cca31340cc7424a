/* expression_parser.h - the text of an expression on its way to operations. Private to this folder. */
#ifndef DALCS_EXPRESSION_PARSER_H
#define DALCS_EXPRESSION_PARSER_H

#include "expression.h"

enum dalcs_symbol {
    DALCS_SYMBOL_END,
    DALCS_SYMBOL_NUMBER,
    DALCS_SYMBOL_NAME,
    DALCS_SYMBOL_OPEN,
    DALCS_SYMBOL_CLOSE,
    DALCS_SYMBOL_COMMA,
    DALCS_SYMBOL_QUESTION,
    DALCS_SYMBOL_COLON,
    DALCS_SYMBOL_OPERATOR, /* `code` says which; AND, OR and NOT besides */
    DALCS_SYMBOL_AND,
    DALCS_SYMBOL_OR,
    DALCS_SYMBOL_BANG,
    DALCS_SYMBOL_WRONG
};

struct dalcs_parser {
    const struct dalcs_expression_context *context;
    const struct dalcs_expression_text *text;
    struct dalcs_operation *operation; /* heap */
    size_t n;
    size_t capacity;
    int depth;
    bool failed;
    bool out_of_memory;

    enum dalcs_symbol symbol; /* the next one, */
    enum dalcs_operation_code code;
    int level;         /* of a binary operator: higher binds tighter */
    int begin, length; /* its place */
    int last_end;      /* where the one before it ended */
    double number;
};

/* The first error of a formula explains the others, which are left out. */
void dalcs_parser_report(struct dalcs_parser *p, enum dalcs_severity severity, int begin,
                         int length, const char *hint, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

/* An error: the symbol that is next cannot stand there. */
void dalcs_parser_unexpected(struct dalcs_parser *p);

/* Reads the symbol after this one. */
void dalcs_parser_next(struct dalcs_parser *p);

/* Appends an operation; its index, which a jump needs to be completed. */
size_t dalcs_parser_emit(struct dalcs_parser *p, struct dalcs_operation operation);

/* The same of an operation that is a code alone. */
size_t dalcs_parser_emit_code(struct dalcs_parser *p, enum dalcs_operation_code code, int begin,
                              int length);

/* Lets the jump at `place` go to what is emitted next. */
void dalcs_parser_land(struct dalcs_parser *p, size_t place);

/* Reads over the parenthesis that ends what began at `open`. */
void dalcs_parser_close(struct dalcs_parser *p, int open);

/* condition ? a : b, from the right. */
void dalcs_parser_choice(struct dalcs_parser *p);

/* A parameter, an argument or a call. */
void dalcs_parser_name(struct dalcs_parser *p);

/* Is a power, of the operations from `first` to `end` with the exponent behind them, that of the magnitude? So it is where a
 * source of ngspice is declared; where nothing is, a warning says that ngspice has it so. */
bool dalcs_parser_takes_magnitude(struct dalcs_parser *p, int begin, int length, size_t first,
                                  size_t end);

#endif
