/* collocation.h - the methods. Radau IIA: implicit Euler's family of order 2s - 1.
 *
 * A step of length h looks for the polynomial of degree s that starts at the present state and obeys
 * the equations at the nodes c_1 < ... < c_s = 1 (Ehle 1969; Hairer and Wanner, Solving ODEs II,
 * sec. IV.5 and VI.1). With Y_i the values there and A the Butcher matrix,
 *     sum_j (A^-1)_ij P (X_j - x_0) / h = A_I Y_i + E_I s_i,     0 = A_II Y_i + E_II s_i.
 * A^-1 has one real and (s-1)/2 pairs of conjugate eigenvalues mu; in the coordinates of its
 * eigenvectors, scaled so that each sees the constant 1 as 1, the stages separate into steps of
 * implicit Euler with sigma = mu / h, all but one complex. s = 1 is implicit Euler itself.
 *
 * Lobatto IIIC (Chipman 1971; Hairer and Wanner, table IV.5.12) has a stage at the start, too, which its
 * state need not meet, A_i1 = b_1, and otherwise the same equations, with one node less for as many
 * stages. It is of order 2s - 2 in its number of stages, L-stable and stiffly accurate. That stage's Y is
 * where the polynomial through the stages starts, of which Radau IIA has an extrapolation.
 *
 * The numbers are computed in extended precision when dalcs is built, not typed in. */
#ifndef DALCS_COLLOCATION_H
#define DALCS_COLLOCATION_H

#include "extended_rows.h"
#include "status.h"

#include <complex.h>

enum {
    DALCS_MAX_STAGES = 9,
    DALCS_MAX_NODES = 12, /* s + 1, in whole quads */
    DALCS_MAX_CONJUGATES = DALCS_MAX_STAGES / 2,
    DALCS_SOLUTION_PARTS = 1 + 2 * DALCS_MAX_CONJUGATES
};

enum dalcs_family { DALCS_RADAU_IIA, DALCS_LOBATTO_IIIC };

/* With the digits that the large elements of the eigenvectors (300 for s = 7, 3500 for 9) cost. Solutions are 1 + 2 n_pairs
 * parts, that of lambda and (re, im) of each of mu. */
struct dalcs_exact_collocation {
    long double back[DALCS_MAX_STAGES];
    long double lambda;
    long double complex mu[DALCS_MAX_CONJUGATES];
    /* what the nodes, and in place s the polynomial through the stages at 0, take of each part. Stage i is
     * to[i] W + sum over pairs of 2 Re(to_pair[i][p] W_p) */
    struct dalcs_extended_row to[DALCS_SOLUTION_PARTS];
    struct dalcs_extended_row from[DALCS_MAX_STAGES]; /* what the parts take of each stage */
};

/* Newton's form on all nodes, which come in Leja's order for the sake of rounding: place of the k-th, itself, and what the
 * difference of the value there from that at the first adds to the coefficients. */
struct dalcs_newton_form {
    int order[DALCS_MAX_NODES];
    double node[DALCS_MAX_NODES];
    double coefficient[DALCS_MAX_NODES]
                      [DALCS_MAX_NODES]; /* [k][coefficient], 0 for those before k */
};

struct dalcs_collocation {
    enum dalcs_family family;
    int s;        /* nodes behind the start, and the degree of the polynomials */
    int n_stages; /* 1, 3, 5, 7 or 9: those nodes, in this order, and with LOBATTO_IIIC, last, the start */
    int n_pairs;                  /* conjugate pairs of eigenvalues */
    double node[DALCS_MAX_NODES]; /* 0, c_1, ..., c_s */
    double lambda;                /* the real eigenvalue of A^-1 */
    double complex mu[DALCS_MAX_CONJUGATES];
    struct dalcs_exact_collocation exact;
    double barycentric[DALCS_MAX_NODES]; /* weights of all s + 1 nodes */
    struct dalcs_newton_form differences;
    double back[DALCS_MAX_STAGES];   /* value at 0 of the polynomial through the stages alone */
    double weight[DALCS_MAX_STAGES]; /* of the stages, in an integral over the step */

    struct { /* Gauss' rule with s nodes for integrals over (0, 1), then 1 with the weight 0 */
        double node[DALCS_MAX_NODES], weight[DALCS_MAX_NODES];
    } quadrature;

    struct {         /* where polynomials on all nodes are worst */
        double size; /* the product of the distances from all nodes there */
        double node;
        double value[DALCS_MAX_NODES]; /* of the polynomials */
        double
            factor; /* how much more their derivative may be off than the filter of the error estimate lets through */
    } worst;

    double
        spread; /* a polynomial leaves the range of its values at the nodes by at most this part */

    struct {
        double binomial[DALCS_MAX_NODES];                    /* s over 0..s */
        double from_nodes[DALCS_MAX_NODES][DALCS_MAX_NODES]; /* [node][coefficient] */
        double spread; /* coefficients leave the range of the values by at most this part */
    } bernstein;
};

/* NULL: there is none. */
const struct dalcs_collocation *dalcs_collocation_of(enum dalcs_family family, int n_stages);

/* The parts of a function of time by its values at the stages. */
void dalcs_collocation_parts(const struct dalcs_collocation *c, const double *at_stages,
                             struct dalcs_extended_row *part);

/* weight[s + 1], with room for all, such that a quantity at a finite theta (in steps) is the sum of
 * weight * value at node. */
void dalcs_collocation_weights(const struct dalcs_collocation *c, double theta, double *weight);

/* The same of the polynomial through the nodes from `first` on alone; of those before it the weights are 0. */
void dalcs_collocation_weights_from(const struct dalcs_collocation *c, int first, double theta,
                                    double *weight);

#endif
