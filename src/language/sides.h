/* sides.h - sums of parts of one quantity, side by side. Private to this folder. */
#ifndef DALCS_SIDES_H
#define DALCS_SIDES_H

#include "kinks.h"

enum { DALCS_SIDES_MOST_TERMS = 64 };

/* A sum of parts, each with a factor: those that have kinks of the quantity, and others. */
struct dalcs_sides_terms {
    int n;
    const struct dalcs_formula *part[DALCS_SIDES_MOST_TERMS];
    double factor[DALCS_SIDES_MOST_TERMS];
    bool has_kink[DALCS_SIDES_MOST_TERMS];
};

/* The terms with kinks as a sum of smooth functions, which each read the quantity on one side, and of steps where two sides do
 * not meet; `where` itself: their sides are lines, or meet without steps, or have no value at a kink; NULL: out of memory. */
const struct dalcs_formula *dalcs_sides_write(const struct dalcs_kinks *kinks,
                                              struct dalcs_rewriting *r,
                                              const struct dalcs_sides_terms *t,
                                              const struct dalcs_formula *where);

#endif
