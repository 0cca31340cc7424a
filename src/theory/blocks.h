/* blocks.h - one DALCS with some pairs held, as the dense blocks that the theorems speak of.
 *
 * A pair held closed is one algebraic row w = 0 and its current one more algebraic unknown; one held
 * open is not there. With every switch held, what remains is (2.1) of Brogliato 2022 with diodes as
 * its only pairs; with every pair held it is a mode. */
#ifndef DALCS_BLOCKS_H
#define DALCS_BLOCKS_H

#include "matrix.h"
#include "system.h"

enum dalcs_hold { DALCS_NOT_HELD, DALCS_HELD_OPEN, DALCS_HELD_CLOSED };

struct dalcs_blocks {
    const struct dalcs_system *system;
    const enum dalcs_hold *hold; /* [n_pairs]; borrowed */
    int n, p, m, k;              /* differential, algebraic, complementarity variables; inputs */
    struct dalcs_matrix P, A_I, B_I, L_I; /* L is the papers' B with a bar */
    struct dalcs_matrix A_II, B_II, L_II;
    struct dalcs_matrix C_I, C_II, D;
    struct dalcs_matrix E_I, E_II, F;
    struct dalcs_matrix storage; /* all zero when none is known */
    int *z_column;               /* [p] column of the system, currents held closed included */
    int *pair;                   /* [m] pair of the system */
};

/* Everything is in the arena. Row II k of B_II is the one that `dual` pairs with column z_column[k],
 * as far as there is one. */
enum dalcs_status dalcs_blocks_build(struct dalcs_blocks *b, struct dalcs_arena *arena,
                                     const struct dalcs_system *system,
                                     const enum dalcs_hold *hold) DALCS_MUST_CHECK;

/* Names for a person: "v(out)", "i(l1)", "i(d1)", and of the voltage across a diode in reverse
 * "-v(d1)". NULL when out of memory. */
const char *dalcs_column_name(const struct dalcs_system *system, int column,
                              struct dalcs_arena *arena);
const char *dalcs_reverse_name(const struct dalcs_system *system, int pair,
                               struct dalcs_arena *arena);
const char *dalcs_input_name(const struct dalcs_system *system, int input);

#endif
