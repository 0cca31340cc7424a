/* dimension.h - what a signal measures: volts, amperes, their products and quotients. */
#ifndef DALCS_DIMENSION_H
#define DALCS_DIMENSION_H

#include <stdbool.h>

/* V^volt A^ampere s^second; all 0: a number. */
struct dalcs_dimension {
    signed char volt, ampere, second;
    bool degree, decibel; /* an angle, a level; a number otherwise */
};

enum { DALCS_DIMENSION_TEXT = 24 };

bool dalcs_dimension_equal(struct dalcs_dimension a, struct dalcs_dimension b);

/* a b for sign 1, a / b for sign -1. Exponents beyond what the text has room for give a number. */
struct dalcs_dimension dalcs_dimension_multiply(struct dalcs_dimension a, struct dalcs_dimension b,
                                                int sign);

/* "V", "W", "V/s", "V^2"; "" of a number. */
const char *dalcs_dimension_unit(char text[DALCS_DIMENSION_TEXT], struct dalcs_dimension dimension);

/* "voltage", "power"; "value" where there is no word for it. */
const char *dalcs_dimension_quantity(struct dalcs_dimension dimension);

/* The dimension of a signal by its name: v(...) volts, i(...), @d1[id] and v1#branch amperes. */
struct dalcs_dimension dalcs_dimension_of_name(const char *name);

#endif
