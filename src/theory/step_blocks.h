/* step_blocks.h - the one-step problem (3.2) of Brogliato 2022 without x:
 *
 *     At z + Bt lambda + Et = 0,   0 <= lambda _|_ Ct z + Dt lambda + Ft >= 0. */
#ifndef DALCS_STEP_BLOCKS_H
#define DALCS_STEP_BLOCKS_H

#include "blocks.h"

/* The four matrices that both forms, (3.1) and (3.2), are judged by. */
struct dalcs_quadruple {
    struct dalcs_matrix A, B, C, D; /* [p][p], [p][m], [m][p], [m][m] */
};

/* (B_II, L_II, C_II, D). */
struct dalcs_quadruple dalcs_model_quadruple(const struct dalcs_blocks *b);

/* (At, Bt, Ct, Dt) for h; DALCS_SINGULAR when P_I - h A_I is. */
enum dalcs_status dalcs_step_quadruple(struct dalcs_quadruple *q, const struct dalcs_blocks *b,
                                       double h, struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The least eigenvalue of [-XA - A'X, -XB + C'; ., D + D'], scaled. */
enum dalcs_status dalcs_quadruple_margin(const struct dalcs_quadruple *q,
                                         const struct dalcs_matrix *X, double *margin,
                                         struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Looks for an X > 0 that makes the margin >= 0 (passive) or > 0 (strictly passive): multiples of
 * the identity, of X2 with X2 B2 = C2' where D = diag(D11, 0), then a semidefinite program. With one
 * algebraic unknown the first decide; otherwise that nothing is found means something when
 * is_exhaustive, and `why` says what is missing when not. */
struct dalcs_passive_quadruple {
    bool is_passive, is_strict, is_exhaustive;
    const char *why;
    double margin;
    struct dalcs_matrix X;
};

enum dalcs_status dalcs_quadruple_passive(const struct dalcs_quadruple *q,
                                          struct dalcs_passive_quadruple *found,
                                          struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The least eigenvalue of the symmetric part of -R A R^-1, R R = X: its sign is that of -(XA + A'X),
 * its size that of lemmas 5.4 and 5.11. */
enum dalcs_status dalcs_index_strength(const struct dalcs_matrix *A, const struct dalcs_matrix *X,
                                       double *strength,
                                       struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* D = diag(D11, 0), with D11 symmetric and positive definite: assumptions 6 and 8. is_second[m] marks
 * the pairs of its zero block. */
enum dalcs_status dalcs_block_diagonal(const struct dalcs_matrix *D, bool *holds, bool *is_second,
                                       struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
