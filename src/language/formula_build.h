/* formula_build.h - what runs the operations of an expression on a stack of formulas. Private to this folder. */
#ifndef DALCS_FORMULA_BUILD_H
#define DALCS_FORMULA_BUILD_H

#include "language.h"

/* One formula while it is made. */
struct dalcs_formula_work {
    struct dalcs_language *language;
    struct dalcs_scope *scope;
    const struct dalcs_formula **stack; /* heap */
    size_t n, capacity;
    int n_parts;
    int depth;
    const char
        *variable; /* a name that stands for a variable rather than a parameter; NULL: none */
    bool has_choices;
    bool failed;
};

/* An expression with its arguments, which stay where they are on the stack. */
struct dalcs_formula_frame {
    struct dalcs_expression *expression;
    size_t arguments;
};

/* An error at the place of an operation; `name` is for the one %s of the format. */
void dalcs_formula_fail(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                        const struct dalcs_operation *o, const char *hint, const char *format,
                        const char *name);

/* NULL: there was no memory for it, or an error was reported. */
void dalcs_formula_push(struct dalcs_formula_work *w, const struct dalcs_formula *formula);

/* A new part at the place of an operation. */
struct dalcs_formula *dalcs_formula_part(struct dalcs_formula_work *w,
                                         const struct dalcs_formula_frame *f,
                                         const struct dalcs_operation *o,
                                         enum dalcs_formula_kind kind);

/* Puts a part with the topmost n of the stack as its arguments in their place. */
void dalcs_formula_push_over(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                             const struct dalcs_operation *o, enum dalcs_formula_kind kind, int n);

/* Are the topmost n of the stack numbers? */
bool dalcs_formula_are_numbers(const struct dalcs_formula_work *w, int n);

/* The operation on the topmost n of the stack, which are numbers or, for the sake of the message that
 * will come of it, taken for 0. */
void dalcs_formula_fold(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                        const struct dalcs_operation *o, int n);

/* An operator on the topmost n of the stack. */
void dalcs_formula_apply(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                         const struct dalcs_operation *o, int n);

/* ---- formula_call.c: names, signals and calls ------------------------------------------------ */

void dalcs_formula_push_name(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                             const struct dalcs_operation *o);

void dalcs_formula_push_signal(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                               const struct dalcs_operation *o);

/* Before the arguments of a function that other simulators have: may a formula call it? */
void dalcs_formula_check_call(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                              const struct dalcs_operation *o);

void dalcs_formula_push_call(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f,
                             const struct dalcs_operation *o);

/* ---- formula.c ------------------------------------------------------------------------------- */

/* Runs operation[begin..end-1] of the frame. */
void dalcs_formula_run(struct dalcs_formula_work *w, const struct dalcs_formula_frame *f, int begin,
                       int end);

#endif
