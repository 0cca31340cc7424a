/* stage_functions.h - what maps take of the functions of sources: it depends on the step length alone, and a few
 * lengths serve all modes. */
#ifndef DALCS_STAGE_FUNCTIONS_H
#define DALCS_STAGE_FUNCTIONS_H

#include "quads.h"
#include "stages_internal.h"

/* Solutions of one unknown side by side: the real eigenvalue's, then (re, im) of each complex one's, 0
 * where there are fewer: loops of known length are worth more than what they skip. */
enum { DALCS_SOLUTION_PARTS = 1 + 2 * DALCS_MAX_CONJUGATES };

/* An answer at all nodes side by side, behind them what sources do between the nodes. */
enum { DALCS_RIPPLE_LANE = DALCS_MAX_NODES, DALCS_LANES = DALCS_MAX_NODES + DALCS_QUAD };

/* What the stages take of each part of a solution. */
typedef long double dalcs_stage_factors_of_parts[DALCS_MAX_STAGES][DALCS_SOLUTION_PARTS];

/* A function of a source. */
struct dalcs_stage_function {
    double share[DALCS_LANES]; /* at the nodes, and what these miss of it in between */
    dalcs_stage_factors_of_parts factor;
};

/* Step lengths that are remembered. */
enum { DALCS_STAGE_LENGTHS = 8 };

struct dalcs_stage_functions {
    int n;    /* lengths known */
    int next; /* the one to give way */

    struct dalcs_stage_length {
        double h;
        struct dalcs_stage_function *function; /* [n_functions] */
    } length[DALCS_STAGE_LENGTHS];

    /* Of what is the same at all stages, as states and constants are; where it is, is the caller's. */
    dalcs_stage_factors_of_parts *constant_factor;
};

void dalcs_stage_functions_setup(struct dalcs_stage_functions *functions,
                                 const struct dalcs_collocation *method,
                                 dalcs_stage_factors_of_parts *constant_factor);
void dalcs_stage_functions_finish(struct dalcs_stage_functions *functions);

/* All functions in a step of length h; NULL: out of memory. */
const struct dalcs_stage_function *
dalcs_stage_functions_get(struct dalcs_stage_functions *functions,
                          const struct dalcs_stages *stages, double h);

#endif
