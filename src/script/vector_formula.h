/* vector_formula.h - formulas of vectors, as in `let x = mag(v(out))/2` and `print v(a)-v(b)`. */
#ifndef DALCS_VECTOR_FORMULA_H
#define DALCS_VECTOR_FORMULA_H

#include "vectors.h"

/* Zero-initialise all but vectors, text and arena. */
struct dalcs_vector_formula {
    const struct dalcs_vectors *vectors;
    const char *text;          /* lower case */
    size_t at;                 /* the next character */
    struct dalcs_arena *arena; /* of results */
    bool failed;
    bool out_of_memory;
    char message[160]; /* why it failed */
    char hint[160];    /* or "" */
    int depth;
};

/* The next formula of the text, as far as it goes: its name is the text of it. NULL when it failed. */
struct dalcs_vector *dalcs_vector_formula_next(struct dalcs_vector_formula *formula);

/* Only blanks are left. */
bool dalcs_vector_formula_at_end(struct dalcs_vector_formula *formula);

#endif
