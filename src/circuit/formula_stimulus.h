/* formula_stimulus.h - a piecewise-linear function of a sum of other stimuli: what a formula of sources alone puts out.
 * For stimulus.c, whose functions these are. */
#ifndef DALCS_FORMULA_STIMULUS_H
#define DALCS_FORMULA_STIMULUS_H

#include "stimulus.h"

double dalcs_formula_stimulus_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side);
double dalcs_formula_stimulus_next_edge(const struct dalcs_stimulus *s, double t);
double dalcs_formula_stimulus_operating_value(const struct dalcs_stimulus *s,
                                              bool transient_follows);
int dalcs_formula_stimulus_n_terms(const struct dalcs_stimulus *s);
void dalcs_formula_stimulus_piece(const struct dalcs_stimulus *s, double t,
                                  struct dalcs_stimulus_piece *piece);

#endif
