/* rational.h - a formula of s as a ratio of two polynomials, and a delay. */
#ifndef DALCS_RATIONAL_H
#define DALCS_RATIONAL_H

#include "builder.h"

enum { DALCS_RATIONAL_DEGREE = 20 };

struct dalcs_polynomial {
    int degree;
    double c[DALCS_RATIONAL_DEGREE + 1]; /* of s^k; c[degree] is not 0, unless the degree is 0 */
};

struct dalcs_rational {
    struct dalcs_polynomial above, below;
    double delay; /* s, T of exp(-s T) times the ratio; never below 0 of one that was made */
};

/* s is what a formula calls time; false when an error was reported: it is no such ratio. */
bool dalcs_rational_make(struct dalcs_builder *builder, const struct dalcs_formula *formula,
                         struct dalcs_rational *r);

/* The states of a ratio that is not improper, which `device`, of an element called `name`, puts out: of the voltage between
 * two nodes. */
void dalcs_transfer_expand(struct dalcs_builder *builder, const struct dalcs_token *name,
                           struct dalcs_device *device, const struct dalcs_rational *r,
                           const int *input);

#endif
