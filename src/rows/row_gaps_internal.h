/* row_gaps_internal.h - places at which derivatives are looked at. Private to row_gaps.c and row_gaps_setup.c. */
#ifndef DALCS_ROW_GAPS_INTERNAL_H
#define DALCS_ROW_GAPS_INTERNAL_H

#include "row_gaps.h"

/* Where in a step derivatives are looked at: its start, its end and between. Second derivatives of nine stages
 * have degree 7, fourth ones 5. */
enum { DALCS_N_PLACES = 8 };

/* Derivatives of the k-th function of Newton's basis. */
struct dalcs_row_basis {
    double second[DALCS_MAX_NODES][DALCS_N_PLACES], fourth[DALCS_MAX_NODES][DALCS_N_PLACES];
};

static inline bool dalcs_row_is_current(const struct dalcs_row_gaps *gaps, int output) {
    return gaps->rows->radau->base->network->output[output].is_current;
}

#endif
