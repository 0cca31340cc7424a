/* stage_load.h - right-hand sides of a step on sparse factors. Private to src/stages. */
#ifndef DALCS_STAGE_LOAD_H
#define DALCS_STAGE_LOAD_H

#include "stage_factors.h"

/* Shares of the waves in this step. */
void dalcs_stage_find_shares(const struct dalcs_stages *stages, const struct dalcs_stage_factors *f,
                             const double *coefficient);

/* plan->work.rhs = drive y + factor * constant, of the rows that are present. */
void dalcs_stage_find_drive(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_factors *f, const struct dalcs_csr *drive,
                            const double *y, double factor);

/* plan->work.from = the state and, of the rest, where the circuit was last: unknowns are increments over it. */
void dalcs_stage_find_start(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_factors *f, const double *x);

/* Of plan->work.rhs and a share of the waves: the unknowns of a system, balanced, to lu.work. */
void dalcs_stage_solve_loaded(const struct dalcs_stage_plan *plan,
                              const struct dalcs_stage_factors *f, int system, int share);

#endif
