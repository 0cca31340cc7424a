/* residual.h - how well an answer satisfies a one-step problem, computed apart from the engine. */
#ifndef DALCS_RESIDUAL_H
#define DALCS_RESIDUAL_H

#include "system.h"

/* The largest violation of any row, sign or complementarity by y[n_columns], each over its scale;
 * infinite where y is not a number. closed[n_pairs] tells the switches. */
double residual_of(const struct dalcs_system *system, double sigma, const double *u,
                   const bool *closed, const double *y);

#endif
