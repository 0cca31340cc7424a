/* passivity.h - can the circuit around its diodes give more energy than it got?
 *
 * Passive means: some P = P' > 0 makes [A'P + PA, PB - C'; B'P - C, -(D + D')] negative semidefinite
 * (definition 1 of Brogliato and Goeleven 2009). The P tried are the stored energy and the one that
 * PB = C' gives; the search over all P would be a semidefinite program. A witness against every P is
 * a motion: a mode in which the circuit grows without a source, or currents (voltages) a exp(s t) at
 * the diodes, Re s >= 0, to which the circuit gives energy. */
#ifndef DALCS_PASSIVITY_H
#define DALCS_PASSIVITY_H

#include "lcs.h"

/* The least eigenvalue of a symmetric Q in units in which no element of `size`, what the elements of Q
 * are made of, is above 1: with a unit of its own for each row it means the same in any units.
 * INFINITY of an empty matrix. */
enum dalcs_status dalcs_scaled_least(const struct dalcs_matrix *Q, const struct dalcs_matrix *size,
                                     double *least, struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The same of M + M'. */
enum dalcs_status dalcs_symmetric_part_least(const struct dalcs_matrix *M, double *least,
                                             struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Least eigenvalues below this are negative, above it positive; between them rounding may decide. */
static const double dalcs_definite = 1e-9;

/* The largest eigenvalue of the matrix above with eps P added to its first block, over the size of
 * what it is made of: up to rounding, at most 0 when passive with this P. */
enum dalcs_status dalcs_passivity_excess(const struct dalcs_lcs *lcs, const struct dalcs_matrix *P,
                                         double eps, double *excess,
                                         struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* An excess that is rounding only. */
static inline bool dalcs_is_dissipative(double excess) {
    return excess < dalcs_definite;
}

/* Is P positive definite, to rounding and whatever its units? */
enum dalcs_status dalcs_is_positive_definite(const struct dalcs_matrix *P, bool *is,
                                             struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The largest eps with which a P that makes it passive still does; 0 for none. */
enum dalcs_status dalcs_passivity_rate(const struct dalcs_lcs *lcs, const struct dalcs_matrix *P,
                                       double *eps, struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The dimension of the largest set of states that differences of two motions can stay in without
 * dissipating anything; 0: all motions meet in the end. Scaled eigenvalues of the inequality below
 * `noise` are 0. */
enum dalcs_status dalcs_passivity_lossless(const struct dalcs_lcs *lcs,
                                           const struct dalcs_matrix *P, double noise,
                                           int *dimension,
                                           struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* A motion u exp(s t), x exp(s t) to which the circuit gives energy. */
struct dalcs_giving {
    bool is_found;
    double s[2];   /* 1/s: re, im; INFINITY: at once, x = 0 */
    double power;  /* Re(y* u) over the sum of |y_i||u_i|, < 0 */
    double *u, *x; /* [m], [n] pairs (re, im) */
};

enum dalcs_status dalcs_passivity_refute(const struct dalcs_lcs *lcs, struct dalcs_giving *giving,
                                         struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
