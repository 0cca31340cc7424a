/* stage_functions.h - what maps take of the functions of sources: it depends on the step length alone, and a few
 * lengths serve all modes. */
#ifndef DALCS_STAGE_FUNCTIONS_H
#define DALCS_STAGE_FUNCTIONS_H

#include "quads.h"
#include "stages_internal.h"

/* An answer at all nodes side by side, behind them what sources do between the nodes. */
enum { DALCS_RIPPLE_LANE = DALCS_MAX_NODES, DALCS_LANES = DALCS_MAX_NODES + DALCS_QUAD };

/* A function of a source. */
struct dalcs_stage_function {
    double share[DALCS_LANES]; /* at the nodes, and what these miss of it in between */
    struct dalcs_extended_row
        stages; /* at the stages, and in place s their polynomial at the start */
    /* what these take of each part of a solution */
    struct dalcs_extended_row of_part[DALCS_SOLUTION_PARTS];
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
};

void dalcs_stage_functions_finish(struct dalcs_stage_functions *functions);

/* All functions in a step of length h; NULL: out of memory. */
const struct dalcs_stage_function *
dalcs_stage_functions_get(struct dalcs_stage_functions *functions,
                          const struct dalcs_stages *stages, double h);

#endif
