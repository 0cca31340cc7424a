/* vector_formula.h - formulas of vectors, as in `let x = mag(v(out))/2` and `print v(a)-v(b)`.
 *
 *     vector_formula.c    text -> values
 *     vector_values.c     values and operators
 *     vector_functions.c  functions of values
 *     vector_random.c     those of random values
 *     calculus.c          those that look along the scale */
#ifndef DALCS_VECTOR_FORMULA_H
#define DALCS_VECTOR_FORMULA_H

#include "definitions.h"
#include "vectors.h"

enum { DALCS_MOST_ARGUMENTS = 8 };

/* Zero-initialise all but vectors, text and arena. */
struct dalcs_vector_formula {
    const struct dalcs_vectors *vectors;
    const struct dalcs_definitions *definitions; /* of `define`; may be NULL */
    const char *text;                            /* lower case */
    size_t at;                                   /* the next character */
    struct dalcs_arena *arena;                   /* of results */
    /* in the body of a definition: what its parameters are */
    const struct dalcs_definition *definition;
    const struct dalcs_vector *const *argument; /* [n_parameters] */
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

/* ---- vector_values.c: for the files above ------------------------------------------------------------ */

enum dalcs_vector_operation {
    DALCS_VECTOR_ADD,
    DALCS_VECTOR_SUBTRACT,
    DALCS_VECTOR_MULTIPLY,
    DALCS_VECTOR_DIVIDE,
    DALCS_VECTOR_REMAINDER,
    DALCS_VECTOR_POWER,
    DALCS_VECTOR_LESS,
    DALCS_VECTOR_LESS_EQUAL,
    DALCS_VECTOR_GREATER,
    DALCS_VECTOR_GREATER_EQUAL,
    DALCS_VECTOR_EQUAL,
    DALCS_VECTOR_UNEQUAL,
    DALCS_VECTOR_AND,
    DALCS_VECTOR_OR
};

/* All return NULL when they failed, or when an operand is NULL. */
struct dalcs_vector *dalcs_vector_fail(struct dalcs_vector_formula *formula, const char *format,
                                       ...) __attribute__((format(printf, 2, 3)));
struct dalcs_vector *dalcs_vector_make(struct dalcs_vector_formula *formula, size_t n,
                                       bool is_complex);
struct dalcs_vector *dalcs_vector_number(struct dalcs_vector_formula *formula,
                                         double complex value);
struct dalcs_vector *dalcs_vector_copy(struct dalcs_vector_formula *formula,
                                       const struct dalcs_vector *vector);
struct dalcs_vector *dalcs_vector_combine(struct dalcs_vector_formula *formula,
                                          enum dalcs_vector_operation operation,
                                          const struct dalcs_vector *a,
                                          const struct dalcs_vector *b);

/* ---- vector_functions.c ------------------------------------------------------------------------------ */

/* argument[n], n >= 1. */
struct dalcs_vector *dalcs_vector_call(struct dalcs_vector_formula *formula, const char *name,
                                       const struct dalcs_vector *const *argument, size_t n);

/* ---- calculus.c --------------------------------------------------------------------------------------- */

/* The phase without its jumps by 2 pi. */
void dalcs_calculus_unwrap(double complex *value, size_t n);

/* to[n]: by the parabola through a value and its neighbours, and never across a jump, which has two rows at one
 * place of the scale. */
void dalcs_calculus_derivative(double complex *to, const double complex *value,
                               const double complex *scale, size_t n);

/* to[n]: from the first value on, by trapezoids. */
void dalcs_calculus_integral(double complex *to, const double complex *value,
                             const double complex *scale, size_t n);

/* The value at `at`, on the straight line between two rows; just behind a jump, and outside that of the end. */
double complex dalcs_calculus_interpolate(const double complex *value, const double complex *scale,
                                          size_t n, double at);

/* ---- vector_formula.c and vector_names.c ---------------------------------------------------------- */

/* Reads over a symbol or a word; false: it is not there. */
bool dalcs_vector_formula_take(struct dalcs_vector_formula *f, const char *symbol);

bool dalcs_vector_formula_is_of_name(char c);

/* a ? b : c, the loosest. */
struct dalcs_vector *dalcs_vector_formula_choice(struct dalcs_vector_formula *f);

/* A vector by its name, a constant, a call. NULL: an error was reported. */
struct dalcs_vector *dalcs_vector_formula_word(struct dalcs_vector_formula *f);

/* ---- vector_along.c ------------------------------------------------------------------------------- */

/* A vector of the same length and scale; NULL: out of memory. */
struct dalcs_vector *dalcs_vector_alike(struct dalcs_vector_formula *f,
                                        const struct dalcs_vector *x, bool is_complex);

/* ---- vector_random.c ------------------------------------------------------------------------------ */

bool dalcs_vector_is_random(const char *name);
struct dalcs_vector *dalcs_vector_random(struct dalcs_vector_formula *f, const char *name,
                                         const struct dalcs_vector *x);

/* A function that makes a vector of another one. */
typedef struct dalcs_vector *dalcs_vector_function(struct dalcs_vector_formula *f,
                                                   const struct dalcs_vector *x);

/* That of this name; NULL: it is none of these. */
dalcs_vector_function *dalcs_vector_along(const char *name);

#endif
