/* lemke.h - Lemke's method for a horizontal linear complementarity problem (Cottle, Pang and Stone, The Linear
 * Complementarity Problem, 1992, ch. 4), on a dense tableau in extended precision.
 *
 *     a - b = S (a + b) + h,     0 <= a _|_ b >= 0, or one of them 0 and the other free.
 *
 * Where |S| < 1 in the Euclidean norm the problem has exactly one solution, and the method ends in it: a
 * complementary basis is found with pivots of at least 1, whatever S is, for one of 1 - S_kk and 1 + S_kk is
 * at least that in each Schur complement, which is such a problem again; in that basis the matrix is
 * positive definite. Ties are broken lexicographically, so that no basis comes again. */
#ifndef DALCS_LEMKE_H
#define DALCS_LEMKE_H

#include "memory.h"

#include <stdbool.h>

struct dalcs_lemke {
    int n;

    enum dalcs_lemke_law {
        DALCS_LEMKE_EITHER, /* 0 <= a _|_ b >= 0 */
        DALCS_LEMKE_A_FREE, /* b = 0 */
        DALCS_LEMKE_B_FREE  /* a = 0 */
    } *
        law; /* [n] */

    double *S;  /* [n][n] by rows */
    double *h;  /* [n] */
    bool *is_a; /* [n] the answer: may a be other than 0, or b? */
    int *basic; /* [n] work: the column of each row, k of a_k, n + k of b_k, 2 n of the cover */
    long double *tableau; /* [n][2 n + 2] work: a, b, cover, right-hand side */
    struct dalcs_arena arena;
};

/* Room for a problem; all 0. On failure there is nothing to finish. */
enum dalcs_status dalcs_lemke_setup(struct dalcs_lemke *l, int n) DALCS_MUST_CHECK;

/* is_a of the solution. DALCS_NOT_CONVERGED: a ray, or more than `limit` pivots; is_a is where it ended.
 * DALCS_SINGULAR: there is no basis. */
enum dalcs_status dalcs_lemke_solve(struct dalcs_lemke *l, int limit) DALCS_MUST_CHECK;

void dalcs_lemke_finish(struct dalcs_lemke *l);

#endif
