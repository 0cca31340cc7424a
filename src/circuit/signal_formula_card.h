/* signal_formula_card.h - what the two files that compile formulas of signals share. */
#ifndef DALCS_SIGNAL_FORMULA_CARD_H
#define DALCS_SIGNAL_FORMULA_CARD_H

#include "result_cards.h"

#include <stdarg.h>

/* A formula on its way to be compiled. */
struct dalcs_signal_compilation {
    struct dalcs_builder *builder;
    const struct dalcs_signal_formula_rules *rules;
    struct dalcs_expression_text text;
    char *masked;
    int n_signals; /* masked so far */
    int *signal;   /* [n_signals] of the builder's measured ones */
    enum dalcs_signal_part *part;
    int *factor; /* [n_signals] of a power, its current, as in `signal`; else -1 */
    bool failed;

    struct dalcs_signal_formula_step *step; /* heap */
    size_t n_steps, step_capacity;
    int height, deepest; /* of the stack */
    int depth;           /* of functions that call each other */
};

/* An error at text[begin..begin+length-1]. */
void dalcs_signal_compilation_report(struct dalcs_signal_compilation *c,
                                     const struct dalcs_expression_text *text, int begin,
                                     int length, const char *hint, const char *format,
                                     va_list arguments) __attribute__((format(printf, 6, 0)));

/* The index of a current, or of a voltage against ground or a second node, among the measured signals;
 * -1 when an error was reported. */
int dalcs_signal_compilation_find(struct dalcs_signal_compilation *c, bool is_current,
                                  const struct dalcs_token *first,
                                  const struct dalcs_token *second);

/* Which of the formula's signals stands behind a name; -1: none. */
int dalcs_signal_compilation_unmask(const char *name);

/* The steps of the parsed formula; false when an error was reported. */
bool dalcs_signal_compilation_steps(struct dalcs_signal_compilation *c,
                                    const struct dalcs_expression *expression,
                                    struct dalcs_signal_formula *formula);

/* Masks all signals of the text. */
void dalcs_signal_compilation_mask(struct dalcs_signal_compilation *c);

/* Keeps the steps as the formula. */
void dalcs_signal_compilation_finish(struct dalcs_signal_compilation *c,
                                     struct dalcs_signal_formula *formula);

#endif
