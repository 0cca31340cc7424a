/* formula_writer.h - writes the formulas of elements that are defined by formulas. */
#ifndef DALCS_FORMULA_WRITER_H
#define DALCS_FORMULA_WRITER_H

#include "builder.h"

#include "formula.h"

/* Makes parts of a formula, numbered as they are made: each after what it is made of. They live as long as the builder.
 * NULL, of a part and of what is made of it: out of memory. */
struct dalcs_formula_writer {
    struct dalcs_builder *builder;
    const struct dalcs_token *element;
    const struct dalcs_expression_text *text; /* what messages quote */
    int n; /* 0, or above the numbers of a formula that becomes a part */
};

/* False when out of memory. */
bool dalcs_formula_writer_start(struct dalcs_formula_writer *w, struct dalcs_builder *builder,
                                const struct dalcs_token *element) DALCS_MUST_CHECK;

const struct dalcs_formula *dalcs_formula_number(struct dalcs_formula_writer *w, double value);

/* v(a,b) or i(a), or the time; b may be NULL. */
const struct dalcs_formula *dalcs_formula_signal(struct dalcs_formula_writer *w,
                                                 enum dalcs_formula_kind kind,
                                                 const struct dalcs_token *a,
                                                 const struct dalcs_token *b);
const struct dalcs_formula *dalcs_formula_operation(struct dalcs_formula_writer *w,
                                                    enum dalcs_operation_code code,
                                                    const struct dalcs_formula *a,
                                                    const struct dalcs_formula *b);
const struct dalcs_formula *dalcs_formula_call(struct dalcs_formula_writer *w, const char *function,
                                               int n, const struct dalcs_formula *const *argument);

/* A part as another formula has it, of other arguments. */
const struct dalcs_formula *dalcs_formula_like(struct dalcs_formula_writer *w,
                                               const struct dalcs_formula *part,
                                               const struct dalcs_formula *const *argument);

/* A token of another text at the place of one. */
struct dalcs_token *dalcs_formula_name(struct dalcs_builder *builder, const struct dalcs_token *at,
                                       const char *text);

/* The token that stands for a formula. */
const struct dalcs_token *dalcs_formula_token(struct dalcs_formula_writer *w,
                                              const struct dalcs_formula *formula);

#endif
