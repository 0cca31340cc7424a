/* inductance.h - a group of magnetically coupled coils as independent states.
 *
 * With coupling k = 1 the inductance matrix is singular: some coil currents are no states. Coils are
 * split into independent ones I and dependent ones J so that L_II is nonsingular and
 * L_JJ = L_JI L_II^-1 L_IJ. With the turns ratios N = L_II^-1 L_IJ, the states are the magnetising
 * currents x = i_I + N i_J, and
 *     L_II x' = v_I,      0 = v_J - N' v_I,
 * an ideal transformer and a nonsingular P_I. */
#ifndef DALCS_INDUCTANCE_H
#define DALCS_INDUCTANCE_H

#include "memory.h"

struct dalcs_inductance {
    int n;         /* coils */
    int rank;      /* independent ones */
    int *coil;     /* [n] position in the group; the first `rank` are independent */
    double *ratio; /* [rank][n - rank] N, row by row */
};

/* L is [n][n], symmetric, H. *valid is false, and *group of no use, when L is not positive
 * semidefinite. The caller finishes *group; on failure it is zeroed. */
enum dalcs_status dalcs_inductance_split(struct dalcs_inductance *group, int n, const double *L,
                                         bool *valid) DALCS_MUST_CHECK;

void dalcs_inductance_finish(struct dalcs_inductance *group);

#endif
