/* limit_constants.h - the constants of the limit of implicit Euler. Private to this folder. */
#ifndef DALCS_LIMIT_CONSTANTS_H
#define DALCS_LIMIT_CONSTANTS_H

#include "euler_limit.h"
#include "passivity.h"
#include "step_blocks.h"

struct dalcs_limit_case {
    struct dalcs_findings *f;
    struct dalcs_arena *work;
    const struct dalcs_blocks *b;
    double h;
    const struct dalcs_limit_given *given;
};

struct dalcs_limit_constants {
    bool are_known;
    const char *why;  /* not */
    double k15, norm; /* 1/s; |S P_I| */
};

/* The step's matrices by D11 (pairs 1) and its zero block (pairs 2). */
struct dalcs_limit_halves {
    struct dalcs_quadruple q;
    struct dalcs_matrix S, SP;              /* S and S P_I */
    struct dalcs_matrix D1, B1, B2, C1, C2; /* of the step */
    struct dalcs_matrix L1, L2, C_I1;       /* of the model */
};

/* The largest singular value. */
enum dalcs_status dalcs_limit_norm(const struct dalcs_matrix *m, double *norm,
                                   struct dalcs_arena *arena);

/* The same of a b. */
enum dalcs_status dalcs_limit_norm_of_product(const struct dalcs_matrix *left,
                                              const struct dalcs_matrix *right, double *norm,
                                              struct dalcs_arena *arena);

/* *are_blocks: they are what the propositions ask for. */
enum dalcs_status dalcs_limit_take_halves(const struct dalcs_limit_case *l, double h,
                                          struct dalcs_limit_halves *s, bool *are_blocks);

/* k15 for steps of h, or why it is not known. */
enum dalcs_status dalcs_limit_find_constants(const struct dalcs_limit_case *l, double h,
                                             struct dalcs_limit_constants *k);

#endif
