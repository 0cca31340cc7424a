/* farkas.h - does a combination of a problem's own equations contradict itself?
 *
 *     M y = b with M = sigma P - A, b = sigma P x_k + E s        (equations)
 *     C y - w = -F s                                             (pairs)
 *     control y - c = turn_off, or control y + c = turn_on       (switches: closed, open)
 *
 * with lambda, w >= 0 of diodes and c >= 0. Weights v of these rows whose combination has 0 for each unknown that
 * may have either sign, nothing positive for each that may not be negative, and something positive on the right, prove
 * that no y exists (J. Farkas, J. reine angew. Math. 124, 1902). Nothing of how the weights were found is used. */
#ifndef DALCS_FARKAS_H
#define DALCS_FARKAS_H

#include "system.h"

#include <math.h>

/* What is said of a pair. */
enum dalcs_side_claim {
    DALCS_EITHER_SIDE, /* a diode: lambda >= 0 and w >= 0, not one of them 0; a switch: nothing */
    DALCS_CLOSED,      /* w = 0 */
    DALCS_OPENED       /* lambda = 0 */
};

struct dalcs_claim {
    const struct dalcs_system *system;
    double sigma;
    const double *u;             /* [n_x + n_inputs] (x_k, s) */
    enum dalcs_side_claim *side; /* [n_pairs] */
    double reach[2];             /* V, A: no answer is farther away */
};

/* Digits that weights are given: those that are the same are then the same to the last one, and cancel. */
enum { DALCS_WEIGHT_BITS = 36 };

/* A weight, or a sum of products of weights, of which the largest term is so large, that is 0: the last of those digits. */
static inline double dalcs_weight_rounded(double largest) {
    return ldexp(largest, -DALCS_WEIGHT_BITS);
}

static inline int dalcs_claim_n_rows(const struct dalcs_system *s) {
    return dalcs_system_n_equations(s) + 2 * s->n_pairs;
}

/* Does a voltage or current of the circuit itself move this switch? Those of a block are told where they are. */
static inline bool dalcs_claim_follows(const struct dalcs_system *s, int pair) {
    return s->pair[pair].kind == DALCS_PAIR_SWITCH && !s->pair[pair].is_direct &&
           s->control.p != NULL && s->control.p[pair] < s->control.p[pair + 1];
}

/* The right-hand side of a row of the claim, and the sum of its terms' magnitudes. */
double dalcs_claim_right(const struct dalcs_claim *claim, int row, double *size);

/* Calls add(user, column, value) for each entry of a row; entries of one column add up. */
void dalcs_claim_visit(const struct dalcs_claim *claim, int row,
                       void (*add)(void *user, int column, double value), void *user);

/* Must this column be 0, whatever the other claims are? */
bool dalcs_claim_is_void(const struct dalcs_claim *claim, int column);

/* Do the weights v[n_rows], which are made to have the signs that they must, contradict the claim? Zeros may be missed
 * by as little as no answer within reach can make up for. sum[3 n_columns] is work. */
bool dalcs_claim_is_refuted(const struct dalcs_claim *claim, double *v, double *sum);

#endif
