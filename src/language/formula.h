/* formula.h - an expression of voltages, currents and time, with all parameters in place.
 *
 * The B sources, and E and G with VALUE or TABLE, have such expressions. What language/ can say of them
 * is done here: parameters are numbers, functions of the netlist are written out, parts that depend on
 * numbers alone are one number, names of nodes and elements are those of the flat netlist. What they
 * mean for the circuit is said in circuit/behaviour.c. */
#ifndef DALCS_FORMULA_H
#define DALCS_FORMULA_H

#include "expression.h"

enum dalcs_formula_kind {
    DALCS_FORMULA_NUMBER,
    DALCS_FORMULA_VOLTAGE, /* v(a) or v(a,b) */
    DALCS_FORMULA_CURRENT, /* i(x) */
    DALCS_FORMULA_TIME,
    DALCS_FORMULA_OPERATION, /* `code`, of one or two arguments; JUMP_AND and JUMP_OR of two */
    DALCS_FORMULA_CHOICE,    /* condition, value, otherwise */
    DALCS_FORMULA_CALL       /* */
};

struct dalcs_formula {
    enum dalcs_formula_kind kind;
    enum dalcs_operation_code code;
    int number_of; /* of this part among all: every part is there once, though more may use it */
    double number;
    const char *function;                /* of a CALL */
    const struct dalcs_token *signal[2]; /* a node or two, or an element; NULL: none */
    int n;                               /* arguments */
    const struct dalcs_formula *const *argument;
    struct dalcs_location where;
    const struct dalcs_expression_text *text; /* of text[begin..end-1] */
    int begin, end;
};

/* In a formula of x, where x is a TIME, the time is a CALL of this name without arguments. */
extern const char dalcs_formula_time_beside[];

/* Does a text read the time, a voltage or a current? */
bool dalcs_formula_has_signal(const char *text);

/* Does a formula hold the value of an element or a model, as Xyce writes it, x1:r1:r and dmod:is? */
bool dalcs_formula_reads_value(const char *text);

/* Where CONTROL= of a switch starts, whose formula makes the control; card->n when there is none. */
int dalcs_formula_find_control(const struct dalcs_card *card);

/* Formulas written differently, in the arena; NULL: out of memory. The first has pwrs(x, y) where it is sgn(x)*abs(x)^y. The
 * second has pwrs(x, y) for the roots of both sides of 0. The third has what it holds at a number in the arguments of functions
 * that rise or fall. The fourth is a sum of smooth functions where it has steps and smooth sides that meet. The fifth has
 * values where parts are not chosen, too. The sixth has functions held in their domains, as in LTspice and Xyce, which take
 * the real part beyond. The seventh has functions that are bounded for quotients and logarithms of exponentials. */
struct dalcs_arena;
const struct dalcs_formula *dalcs_formula_signed_powers(struct dalcs_arena *arena,
                                                        const struct dalcs_formula *formula);
const struct dalcs_formula *dalcs_formula_joined_roots(struct dalcs_arena *arena,
                                                       const struct dalcs_formula *formula);
const struct dalcs_formula *dalcs_formula_held(struct dalcs_arena *arena,
                                               const struct dalcs_formula *formula,
                                               enum dalcs_dialect_name dialect);
const struct dalcs_formula *dalcs_formula_pieces(struct dalcs_arena *arena,
                                                 const struct dalcs_formula *formula,
                                                 enum dalcs_dialect_name dialect);
const struct dalcs_formula *dalcs_formula_guard(struct dalcs_arena *arena,
                                                const struct dalcs_formula *formula);
const struct dalcs_formula *dalcs_formula_real_part(struct dalcs_arena *arena,
                                                    const struct dalcs_formula *formula);
const struct dalcs_formula *dalcs_formula_exponentials(struct dalcs_arena *arena,
                                                       const struct dalcs_formula *formula,
                                                       enum dalcs_dialect_name dialect);

/* Is it a call of one of these functions? names: up to a NULL. */
bool dalcs_formula_is_call_of(const struct dalcs_formula *f, const char *const *names);

#endif
