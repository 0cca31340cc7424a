/* expression.h - formulas on cards: text with places, compiled once, evaluated for each instance.
 *
 * doc/netlist.md says for users what a formula may hold. The text of one may run over several lines;
 * each byte of it knows its place in the netlist. Operations are in the order of their evaluation and
 * work on a stack; ?:, && and || jump, so that what is not needed is not evaluated. */
#ifndef DALCS_EXPRESSION_H
#define DALCS_EXPRESSION_H

#include "names.h"
#include "netlist.h"

/* The part of an expression's text that lies on one line. */
struct dalcs_piece {
    const struct dalcs_source_line *line;
    int begin;  /* its first byte in the text */
    int offset; /* the same byte in line->text */
};

struct dalcs_expression_text {
    const char *text; /* lower case */
    int length;
    const struct dalcs_piece *piece;
    int n_pieces;
};

enum dalcs_operation_code {
    DALCS_PUSH_NUMBER,
    DALCS_PUSH_NAME,     /* a parameter */
    DALCS_PUSH_ARGUMENT, /* of the function whose body this is */
    DALCS_PUSH_SIGNAL,   /* v(...) or i(...) with `count` names, */
    DALCS_SIGNAL_NAME,   /* which follow */
    DALCS_NEGATE,
    DALCS_NOT,
    DALCS_ADD,
    DALCS_SUBTRACT,
    DALCS_MULTIPLY,
    DALCS_DIVIDE,
    DALCS_REMAINDER,
    DALCS_QUOTIENT, /* a\b: without its fraction */
    DALCS_POWER,
    DALCS_EQUAL,
    DALCS_UNEQUAL,
    DALCS_LESS,
    DALCS_LESS_EQUAL,
    DALCS_GREATER,
    DALCS_GREATER_EQUAL,
    DALCS_TO_LOGIC,     /* 1 unless 0 */
    DALCS_JUMP,         /* on by `count` operations */
    DALCS_JUMP_IF_ZERO, /* the same; takes the condition off the stack */
    DALCS_JUMP_AND,     /* if 0, keeping it; else takes it off */
    DALCS_JUMP_OR,      /* if not 0, as 1; else takes it off */
    DALCS_CHECK_CALL,   /* of a function that other simulators have: is it the netlist's own? */
    DALCS_CALL
};

struct dalcs_operation {
    enum dalcs_operation_code code;
    int count;         /* of arguments, of operations to jump over, or which argument */
    int begin, length; /* its place in the text */

    union {
        double number;
        const char *name; /* of a parameter, a function, a node, an element */
    } u;
};

struct dalcs_expression {
    struct dalcs_expression_text text;
    const struct dalcs_operation *operation;
    int n;
    bool is_wrong; /* an error was reported */
};

/* The text of token[0..n-1] as it stands, lower case; lines are joined by a blank. A single {...} or
 * '...' is what is inside it. False when out of memory. */
bool dalcs_expression_text(struct dalcs_arena *arena, const struct dalcs_token *token, int n,
                           struct dalcs_expression_text *text) DALCS_MUST_CHECK;

/* The piece that holds text[begin]. */
const struct dalcs_piece *dalcs_expression_piece(const struct dalcs_expression_text *text,
                                                 int begin);

/* The place of text[begin..begin+length-1]. */
struct dalcs_location dalcs_expression_place(const struct dalcs_expression_text *text, int begin,
                                             int length);

/* What a parse needs of its surroundings. */
struct dalcs_expression_context {
    struct dalcs_arena *arena;
    struct dalcs_diag *diag;
    const struct dalcs_origin *instance; /* for messages, or NULL */
    const struct dalcs_names *arguments; /* name -> index, of a function's body; else NULL */
    bool has_signals;                    /* v(a), v(a,b) and i(x) are signals */
    bool is_condition;                   /* of .if: = compares too, as in ngspice */
    bool is_transfer;                    /* of s: ^ is a power in every dialect */
    struct dalcs_dialect dialect;
    bool *noted_caret; /* this and the next: a note about it was made */
    bool *noted_log;
    bool *noted_pwr; /* NULL: none is made */
};

/* Compiles a text. NULL when out of memory; errors are reported and make it is_wrong. */
struct dalcs_expression *dalcs_expression_parse(const struct dalcs_expression_context *context,
                                                const struct dalcs_expression_text *text);

/* ---- functions.c: what is built in ------------------------------------------------------------ */

struct dalcs_function {
    const char *name;
    int least, most; /* arguments */
    double (*one)(double x);
    double (*two)(double x, double y);
    double (*many)(const double *x, int n);
};

/* A function by name, or NULL. */
const struct dalcs_function *dalcs_function_find(const char *name, enum dalcs_dialect_name dialect);

/* Why a function of other simulators is not here, as a hint; NULL for any other name. */
const char *dalcs_function_refusal(const char *name);

/* ddt(x), idt(x, first, reset) and sdt: of a source's formula alone, which becomes a capacitor with it. */
/* LTspice's delay(x, t) and absdelay(x, t). */
bool dalcs_function_is_delay(const char *name);

/* LTspice's rand(x), random(x) and white(x): a random value for each whole x. */
bool dalcs_function_is_noise(const char *name);

bool dalcs_function_remembers(const char *name, int *least, int *most);

/* The name of a built-in function like this one, or NULL. */
const char *dalcs_function_nearest(const char *name);

/* The value of a constant (pi, e, ...); false when there is none of that name. */
bool dalcs_constant_find(const char *name, double *value);

#endif
