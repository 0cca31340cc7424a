/* polynomial_means.h - integrals over a step of polynomials times exp(-j kappa theta). */
#ifndef DALCS_POLYNOMIAL_MEANS_H
#define DALCS_POLYNOMIAL_MEANS_H

#include "periodic_flow.h"

/* weight[n_nodes] such that the integral over theta of a quantity times exp(-j kappa theta) is the sum of weight *
 * value at node. */
void dalcs_mean_weights(const struct dalcs_periodic_flow *flow, double kappa,
                        double complex *weight);

#endif
