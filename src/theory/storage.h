/* storage.h - which P > 0 make a system passive, among all: a semidefinite program.
 *
 * Asked for is a P = P' > 0 with Q(P) = -[A'P + PA, PB - C'; B'P - C, -(D + D')] >= 0. Where a motion
 * exp(st), Re s = 0, neither gains nor loses, its (x, u) is in the kernel of Q(P) whatever P is: as for
 * all lossless circuits. Then no Q(P) is positive definite and a solver of semidefinite programs finds
 * P at best to half of its digits. So these vectors are found first, at s = 0, at infinity and at the
 * imaginary eigenvalues of A, and Q(P) v = 0 is solved for P as it stands (facial reduction: J. Borwein,
 * H. Wolkowicz, J. Austral. Math. Soc. 30, 1981); the program has the rest. */
#ifndef DALCS_STORAGE_H
#define DALCS_STORAGE_H

#include "step_blocks.h"

/* P of at most so many rows is looked for. */
enum { DALCS_MOST_STORAGE = 20 };

struct dalcs_storage {
    bool is_found;
    struct dalcs_matrix P; /* [n][n]: verified */
    bool is_refuted;
    struct dalcs_matrix Z; /* [n + m][n + m]: verified, see below */
    double gain;           /* of Z, over the size of what it is made of */
    const char *why;       /* neither */
};

/* P is verified by the eigenvalues of Q(P) and of P, at the same tolerance as any other P. Z >= 0 refutes
 * every P: R = A Z11 + Z11 A' + B Z21 + Z12 B' >= 0 and -2 tr(C Z12) - tr((D + D') Z22) > 0, whereas
 * tr(Q(P) Z) = -tr(P R) + 2 tr(C Z12) + tr((D + D') Z22) >= 0 for a P that does. */
enum dalcs_status dalcs_storage_find(const struct dalcs_quadruple *q, struct dalcs_storage *found,
                                     struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Why no rate was found: there is none. */
extern const char *const dalcs_no_rate;

/* The largest eps for which some P makes Q(P) - eps [P, 0; 0, 0] >= 0, to 1e-3, with this P; 0: none, and
 * why. No eps above `most`. */
enum dalcs_status dalcs_storage_rate(const struct dalcs_quadruple *q, double most, double *eps,
                                     struct dalcs_matrix *P, const char **why,
                                     struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
