/* poly.h - what the files of POLY share. Private to this folder. */
#ifndef DALCS_POLY_H
#define DALCS_POLY_H

#include "reader.h"

struct poly {
    struct dalcs_reader *reader;
    struct dalcs_device *device; /* of the card, with its nodes; takes the first control */
    int n;
    int *node;                         /* [2 n] E, G */
    const struct dalcs_token **source; /* [n] F, H */
    double *coefficient;               /* [n + 1] or more */
    int n_coefficients;                /* up to the last one that is not 0 */
};

/* Puts `part` behind the device: in series with it, or beside it. */
bool dalcs_poly_place(const struct poly *p, struct dalcs_device *part, const char *what,
                      bool in_series);

/* The terms of second order and more; false after an error. */
bool dalcs_poly_add_products(const struct poly *p, bool in_series);

#endif
