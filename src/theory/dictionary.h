/* dictionary.h - linear equations as basic variables by the others. Private to this folder. */
#ifndef DALCS_DICTIONARY_H
#define DALCS_DICTIONARY_H

#include "lcs.h"

enum dalcs_variable_kind {
    DALCS_VARIABLE_ZERO,
    DALCS_VARIABLE_DERIVATIVE,
    DALCS_VARIABLE_STATE,
    DALCS_VARIABLE_ALGEBRAIC,
    DALCS_VARIABLE_CURRENT,
    DALCS_VARIABLE_REVERSE,
    DALCS_VARIABLE_INPUT,
    DALCS_VARIABLE_INPUT_DERIVATIVE,
    DALCS_VARIABLE_GONE
};

struct dalcs_variable {
    enum dalcs_variable_kind kind;
    int index;
};

struct dalcs_dictionary {
    int n_rows, n_columns;
    struct dalcs_matrix a, size; /* balanced: element * row_scale * column_scale */
    double *row_scale, *column_scale;
    struct dalcs_variable *row, *column;
};

bool dalcs_variable_is_of_pair(enum dalcs_variable_kind kind);

/* Exchanges until only derivatives and one variable of each pair are basic. */
const char *dalcs_dictionary_reduce(struct dalcs_dictionary *d, int *steps);

#endif
