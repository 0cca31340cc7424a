/* kinks.h - formulas of one quantity, and where they have kinks. Private to this folder. */
#ifndef DALCS_KINKS_H
#define DALCS_KINKS_H

#include "rewriting.h"

enum dalcs_kinks_state {
    DALCS_KINKS_UNKNOWN,
    DALCS_KINKS_NUMBER,
    DALCS_KINKS_OF_ONE, /* it reads the quantity and no other */
    DALCS_KINKS_OTHER
};

struct dalcs_kinks_part {
    enum dalcs_kinks_state state;
    bool has_kink;
    bool is_curved;  /* on some side of its kinks it is no line */
    bool is_stepped; /* on each side it is a number */
    bool has_step;   /* it has sgn() or a step */
    double size;     /* parts, with those that are shared as often as they are read */
};

/* A formula as one of a quantity, which is no sum or product with a number. */
struct dalcs_kinks {
    enum dalcs_dialect_name dialect;
    const struct dalcs_formula *quantity;
    struct dalcs_kinks_part *part; /* by number_of, of all parts of the formula */
};

/* What a part is, and of what; fills in kinks->part. */
const struct dalcs_kinks_part *dalcs_kinks_mark(struct dalcs_kinks *kinks,
                                                const struct dalcs_formula *f);

/* Is it abs, sgn, a step, max, min or limit, whose kinks are where a line is 0? */
bool dalcs_kinks_is_call(const struct dalcs_formula *f);
bool dalcs_kinks_is_step_call(const struct dalcs_formula *f);
bool dalcs_kinks_is_condition(const struct dalcs_formula *f);

/* A value, and what rounding may have made of it. */
struct dalcs_kinks_value {
    double value, rounding;
};

/* The value where the quantity is at x, as it is on the side of its kinks where the quantity is at `side`. */
struct dalcs_kinks_value dalcs_kinks_evaluate(const struct dalcs_kinks *kinks,
                                              const struct dalcs_formula *f, double side, double x);

/* Of arguments of max, min and limit: which one it is where the quantity is at `side`. */
int dalcs_kinks_chosen(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double side);

/* A kink between low and high, where none is between kinks that were found before; false: there is none. */
bool dalcs_kinks_find(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double low,
                      double high, double *at);

/* A number between two, one of which may be infinite, or both. */
double dalcs_kinks_between(double low, double high);

#endif
