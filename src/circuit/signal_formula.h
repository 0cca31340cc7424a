/* signal_formula.h - formulas of signals, as measurements have them: v(out)*i(v1), max(v(a),0) - time.
 *
 * Compiled once from the text of a card; evaluated at any point of a waveform. */
#ifndef DALCS_SIGNAL_FORMULA_H
#define DALCS_SIGNAL_FORMULA_H

#include "expression.h"

/* Of a complex signal; the plain one is its magnitude. A real signal has only itself. */
enum dalcs_signal_part {
    DALCS_PART_PLAIN,
    DALCS_PART_MAGNITUDE,
    DALCS_PART_DECIBEL,
    DALCS_PART_PHASE, /* degrees */
    DALCS_PART_REAL,
    DALCS_PART_IMAGINARY
};

struct dalcs_signal_formula_step {
    enum dalcs_signal_formula_put {
        DALCS_PUT_NOTHING,  /* an operation: code */
        DALCS_PUT_VALUE,    /* number */
        DALCS_PUT_SIGNAL,   /* index, part */
        DALCS_PUT_TIME,     /* or what is swept */
        DALCS_PUT_RESULT,   /* index: of an earlier measurement */
        DALCS_PUT_ARGUMENT, /* stack[index] once more: of a function that is written out */
        DALCS_PUT_DOWN      /* the topmost to stack[index], where it is the topmost then */
    } push;

    enum dalcs_operation_code code;
    enum dalcs_signal_part part;
    int count; /* of arguments, or of steps to jump over */
    int index;
    double number;
    const struct dalcs_function *function;
};

/* n = 0: there is none. */
struct dalcs_signal_formula {
    int n;
    const struct dalcs_signal_formula_step *step;
    const char *text; /* as on the card, lower case */
    int deepest;      /* the stack */
    bool is_affine;   /* a sum of signals, time and numbers with constant factors */
    bool is_constant;
    bool has_results;
};

enum { DALCS_SIGNAL_FORMULA_DEEPEST = 128 }; /* values on the stack */

/* The values that a formula is evaluated with. */
struct dalcs_signal_formula_point {
    double time;
    const void *user;
    double (*signal)(const struct dalcs_signal_formula_point *point, int index,
                     enum dalcs_signal_part part); /* NULL: it has none */
    const double *result;                          /* [measurements]; NULL: it has none */
};

/* NAN where it has no value, such as at a division by 0. */
double dalcs_signal_formula_value(const struct dalcs_signal_formula *formula,
                                  const struct dalcs_signal_formula_point *point);

#endif
