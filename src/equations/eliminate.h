/* eliminate.h - z by x, lambda and the inputs. Private to src/equations. */
#ifndef DALCS_ELIMINATE_H
#define DALCS_ELIMINATE_H

#include "network.h"

/* z = Z (x, lambda, s): dense, row by row. */
struct dalcs_elimination {
    const struct dalcs_system *from;
    size_t n_z, n_right; /* columns: x, lambda, inputs */
    double *Z;           /* [n_z][n_right], of malloc */
    bool is_regular;
    const char *because; /* it is not */
    int n_controls;      /* unknowns that stay, each the sum that moves a switch: see reduce.c */
    int *control_of;     /* [n_pairs] which of these is a pair's, -1: none */
};

/* Fills *z up to `because`; a singular B_II is no failure. Words are in arena. */
enum dalcs_status dalcs_eliminate(struct dalcs_elimination *z, const struct dalcs_system *from,
                                  struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Of m[n][n]. LAPACKE_dlange allocates, and does not say when that failed. */
double dalcs_dense_one_norm(const double *m, size_t n);

/* x, lambda and inputs, as they are counted without z, to columns of the reduced system. */
static inline int dalcs_elimination_column(const struct dalcs_elimination *z, int j) {
    return j < z->from->n_x ? j : j + z->n_controls;
}

/* Outputs and states of `to`, read without the z of each system of `from`. */
enum dalcs_status dalcs_eliminate_outputs(const struct dalcs_elimination *all,
                                          const struct dalcs_network *from,
                                          struct dalcs_network *to) DALCS_MUST_CHECK;

#endif
