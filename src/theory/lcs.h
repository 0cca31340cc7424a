/* lcs.h - the linear complementarity system that a DALCS comes down to:
 *
 *     x' = A x + B u + E s + E1 s',   y = C x + D u + F s + F1 s',   0 <= u _|_ y >= 0
 *
 * Where B_II is invertible this is remark 5.13 of Brogliato 2022. Where it is not, as beside a
 * bridge rectifier whose output floats, current and voltage of some diodes change their roles (a
 * principal pivot, under which passivity, P-matrices and stability stay what they are), and states
 * that the equations tie to others and to sources are eliminated; then derivatives of sources may
 * appear. */
#ifndef DALCS_LCS_H
#define DALCS_LCS_H

#include "blocks.h"

struct dalcs_lcs {
    const struct dalcs_blocks *blocks;
    const char *obstacle; /* why there is none; NULL: there is one */
    int n, m, k;
    int *state;       /* [n] column of x that each state is */
    bool *is_swapped; /* [m] u is the voltage in reverse and y the current */
    struct dalcs_matrix A, B, C, D;
    struct dalcs_matrix E, F;    /* [n][2 k], [m][2 k]: s, then s' */
    struct dalcs_matrix full_x;  /* [blocks n][n + m] all states by x and u */
    struct dalcs_matrix full_z;  /* [p][n + m] */
    bool *z_is_free;             /* [p] that no equation determines */
    struct dalcs_matrix storage; /* [n][n] the stored energy is 1/2 x' storage x */
    int index_steps;             /* states eliminated */
};

/* Everything is in the arena. */
enum dalcs_status dalcs_lcs_build(struct dalcs_lcs *lcs, struct dalcs_arena *arena,
                                  const struct dalcs_blocks *blocks) DALCS_MUST_CHECK;

/* Names of u and of y. */
const char *dalcs_lcs_u_name(const struct dalcs_lcs *lcs, int i, struct dalcs_arena *arena);
const char *dalcs_lcs_state_name(const struct dalcs_lcs *lcs, int i, struct dalcs_arena *arena);

#endif
