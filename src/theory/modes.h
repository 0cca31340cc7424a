/* modes.h - the 2^m modes one by one: how they move, and for which steps each is solvable.
 *
 * By Heemels, Schumacher and Weiland 1999 an implicit Euler step is LCP(q, M(1/h)), M(s) = D + C (s I -
 * A)^-1 B. It has one solution for all data exactly when M(1/h) is a P-matrix (theorem 3.3), which for
 * all h below some h_max is decided by the signs of principal minors (corollary 3.12). A minor is the
 * quotient of two modes' determinants, so signs change only at positive real eigenvalues of modes:
 * h_max is one over the largest. */
#ifndef DALCS_MODES_H
#define DALCS_MODES_H

#include "lcs.h"

#include <stdint.h>

enum dalcs_minors {
    DALCS_MINORS_UNKNOWN,
    DALCS_MINORS_POSITIVE,
    DALCS_MINORS_ZERO,
    DALCS_MINORS_NEGATIVE
};

/* A mode: which pairs of the blocks have w = 0. */
struct dalcs_mode {
    bool *is_on;     /* [m] */
    double value[2]; /* 1/s: an eigenvalue */
    double *y;       /* [columns of the system] pairs (re, im): the eigenvector, with all that it
                        makes flow */
};

struct dalcs_modes {
    bool is_checked; /* false: too many of them */
    int n_singular;  /* modes whose equations are singular for every h */
    struct dalcs_mode
        fastest; /* with the largest positive real eigenvalue; value 0: none has one */
    struct dalcs_mode growing; /* with the largest real part above 0; value 0: none */
    double slowest;            /* 1/s: the largest real part of all modes, of those with states */
    enum dalcs_minors minors;  /* of M(s) for all s beyond the fastest */
    bool *bad;                 /* [m] a principal minor that is not positive */
    double bad_minor;          /* over the product of its columns' norms */
    double bad_sigma;          /* 1/s, where it was taken */
};

/* What is kept is in the arena. lcs may have an obstacle: then minors are unknown. */
enum dalcs_status dalcs_modes_find(struct dalcs_modes *modes, struct dalcs_arena *arena,
                                   const struct dalcs_lcs *lcs) DALCS_MUST_CHECK;

/* The principal minor of the rows that `on` has bits for, over the product of its rows' norms; below
 * 1e-11 rounding, and 0. work[rows * rows]. */
double dalcs_scaled_minor(const struct dalcs_matrix *M, uint32_t on, double *work);

/* M(sigma) of a real sigma; DALCS_SINGULAR at a pole. */
enum dalcs_status dalcs_step_matrix(const struct dalcs_lcs *lcs, double sigma,
                                    struct dalcs_matrix *M,
                                    struct dalcs_arena *arena) DALCS_MUST_CHECK;

#endif
