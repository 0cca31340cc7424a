/* jumps_internal.h - one system of the networks of a jump. Private to jumps.c and jumps_setup.c. */
#ifndef DALCS_JUMPS_INTERNAL_H
#define DALCS_JUMPS_INTERNAL_H

#include "jumps.h"

/* One system of one of the two networks. */
struct dalcs_jump_part {
    enum dalcs_impulse_kind kind;
    int owner; /* system of the circuit */
    int next;  /* part of the same owner, -1: last */
    struct dalcs_osnsp osnsp;
    double *u, *y;  /* [n_x + n_inputs], [n_columns] */
    bool is_driven; /* sources that read act on one of its states: it is no problem of its own */
    int *state;     /* [n_x] the owner's column */
    int *pair;      /* [n_pairs] the owner's pair */
    int *input;     /* [n_inputs] the owner's; 0 for the constant 1 */
    int n_sources;

    struct source {
        const struct dalcs_output *impulse, *driven; /* C and V, or Wb and A */
    } * source;                                      /* [n_outputs] those that may do work */
};

#endif
