/* formula_writer.h - formulas that no card has in full: of the control of a thyristor, of a resistor's voltage. */
#ifndef DALCS_FORMULA_WRITER_H
#define DALCS_FORMULA_WRITER_H

#include "builder.h"

#include "formula.h"

/* Makes parts of a formula, numbered as they are made: each after what it is made of. They live as long as the
 * builder; all are NULL when memory has run out, which the builder knows then. */
struct dalcs_formula_writer {
    struct dalcs_builder *builder;
    const struct dalcs_token *element;
    const struct dalcs_expression_text *text; /* what messages quote */
    int n; /* 0, or above the numbers of a formula that becomes a part */
};

const struct dalcs_formula *dalcs_formula_number(struct dalcs_formula_writer *w, double value);

/* v(a), v(a,b) or i(a); b: NULL for none. */
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

/* What a device puts out: the formula of a token, as of a B source. */
void dalcs_behavioural_add_formula(struct dalcs_builder *builder, const struct dalcs_device *device,
                                   const struct dalcs_token *formula);

#endif
