/* bystanders.h - columns that sources alone decide, such as the voltage of a gate driver.
 *
 * Where no state, diode, switch or delayed source reaches a block of the equations, its columns are fixed sums of the
 * sources at any time. Its sources need not end a step: they are asked when the columns are. */
#ifndef DALCS_BYSTANDERS_H
#define DALCS_BYSTANDERS_H

#include "circuit.h"
#include "system.h"

struct dalcs_bystanders {
    int n;
    int *column;  /* [n] */
    double *gain; /* [n][n_inputs] column = gain inputs */
    bool *row;    /* [n_equations] belongs to such a block */
};

/* Without bystanders n = 0. */
enum dalcs_status dalcs_bystanders_find(struct dalcs_bystanders *bystanders,
                                        const struct dalcs_circuit *circuit,
                                        const struct dalcs_system *system) DALCS_MUST_CHECK;

void dalcs_bystanders_finish(struct dalcs_bystanders *bystanders);

#endif
