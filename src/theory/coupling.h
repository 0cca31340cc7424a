/* coupling.h - P B = C', the coupling that the theorems share: assumption 1.1 of Brogliato and
 * Thibault 2010, 2 and 5(i) of Brogliato and Goeleven 2009, 5.1 of 2013; on the algebraic block
 * assumptions 2, 3, 7 and 9 of Brogliato 2022. */
#ifndef DALCS_COUPLING_H
#define DALCS_COUPLING_H

#include "matrix.h"

/* Is there a P = P' > 0 with P B = C'? Exactly when C B is symmetric and positive semidefinite and
 * has the rank of B and of C; then P = C' (C B)^+ C + a projector on the null space of B'. *P is that
 * one, [rows of B][rows of B], when *holds. *why: the condition that fails, NULL otherwise. */
enum dalcs_status dalcs_coupling_find(struct dalcs_matrix *P, bool *holds, const char **why,
                                      const struct dalcs_matrix *B, const struct dalcs_matrix *C,
                                      struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
