/* evaluation.h - the evaluation of an expression to a number, on a stack. Private to this folder. */
#ifndef DALCS_EVALUATION_H
#define DALCS_EVALUATION_H

#include "language.h"

/* One run: of an expression, or of a function's body with its arguments at stack[base]. */
struct dalcs_evaluation {
    struct dalcs_language *language;
    struct dalcs_scope *scope;
    const struct dalcs_expression *expression;
    size_t base;
};

/* An error at the place of an operation. */
void dalcs_evaluation_report(const struct dalcs_evaluation *r, const struct dalcs_operation *o,
                             const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* WRONG: out of memory. */
enum dalcs_outcome dalcs_evaluation_push(struct dalcs_language *language, double value);

/* Was an error reported that may be why a name is not known? */
bool dalcs_language_hides_names(const struct dalcs_language *language);

/* Runs all operations of the expression. */
enum dalcs_outcome dalcs_evaluation_run(struct dalcs_evaluation *r);

/* Calls a function of the netlist, one that is built in, or draws a random value. */
enum dalcs_outcome dalcs_evaluation_call(const struct dalcs_evaluation *r,
                                         const struct dalcs_operation *o);

/* Before the arguments of v(...), white(...) and the like, unless the netlist has such a function. */
enum dalcs_outcome dalcs_evaluation_check_call(const struct dalcs_evaluation *r,
                                               const struct dalcs_operation *o);

#endif
