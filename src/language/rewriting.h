/* rewriting.h - formulas that are others written differently: parts are shared where they stay. Private to this folder. */
#ifndef DALCS_REWRITING_H
#define DALCS_REWRITING_H

#include "formula.h"

struct dalcs_rewriting {
    struct dalcs_arena *arena;
    enum dalcs_dialect_name dialect;
    int n_parts; /* the next number */
    bool
        is_beneath_root; /* is what is changed the argument of a root or a logarithm, or a factor of it? */
    bool failed;         /* out of memory */
};

/* Are two formulas written alike? */
bool dalcs_formula_is_same(const struct dalcs_formula *a, const struct dalcs_formula *b);

bool dalcs_formula_is_call(const struct dalcs_formula *f, const char *name);
bool dalcs_formula_is_operation(const struct dalcs_formula *f, enum dalcs_operation_code code);

/* slope * of + constant, where `of` is no sum or product with a number; slope is not 0. A number is 1 * itself + 0. */
struct dalcs_formula_line {
    const struct dalcs_formula *of;
    double slope, constant;
};
struct dalcs_formula_line dalcs_formula_read_line(const struct dalcs_formula *f);

/* A part as f is, of n other arguments; NULL: out of memory. */
struct dalcs_formula *dalcs_rewriting_like(struct dalcs_rewriting *r, const struct dalcs_formula *f,
                                           int n, const struct dalcs_formula *const *argument);

/* Parts at the place of f; NULL: out of memory. */
struct dalcs_formula *dalcs_rewriting_number(struct dalcs_rewriting *r,
                                             const struct dalcs_formula *f, double value);
struct dalcs_formula *dalcs_rewriting_call(struct dalcs_rewriting *r, const struct dalcs_formula *f,
                                           const char *function, const struct dalcs_formula *a,
                                           const struct dalcs_formula *b);
struct dalcs_formula *dalcs_rewriting_product(struct dalcs_rewriting *r,
                                              const struct dalcs_formula *f,
                                              const struct dalcs_formula *a,
                                              const struct dalcs_formula *b);

/* a + b or a * b without what adds 0 or multiplies by 0 or 1, and a part times a number; NULL: out of memory, also where an
 * argument is. */
const struct dalcs_formula *dalcs_rewriting_combine(struct dalcs_rewriting *r,
                                                    const struct dalcs_formula *at,
                                                    enum dalcs_operation_code code,
                                                    const struct dalcs_formula *a,
                                                    const struct dalcs_formula *b);
const struct dalcs_formula *dalcs_rewriting_times(struct dalcs_rewriting *r,
                                                  const struct dalcs_formula *f, double factor);

/* The formula with each part, from the innermost on, as `change` makes it: f itself, or another one. NULL: out of memory. */
typedef const struct dalcs_formula *dalcs_rewriting_change(struct dalcs_rewriting *r,
                                                           const struct dalcs_formula *f);
const struct dalcs_formula *dalcs_formula_rewrite(struct dalcs_arena *arena,
                                                  const struct dalcs_formula *formula,
                                                  dalcs_rewriting_change *change);
const struct dalcs_formula *dalcs_formula_rewrite_in(struct dalcs_arena *arena,
                                                     const struct dalcs_formula *formula,
                                                     enum dalcs_dialect_name dialect,
                                                     dalcs_rewriting_change *change);

#endif
