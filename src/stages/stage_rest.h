/* stage_rest.h - parts of a large system that are at rest and left out of its steps.
 *
 * In a mode a system falls into islands that only open pairs tie together. An island without a source
 * in which every state is 0 and no pair is closed is at rest: all of it stays 0 until a pair at its
 * shore closes. What is at rest is in no matrix. Islands next to those that move are kept awake ahead
 * of time, so that a front that runs through a circuit rarely has to wake any. */
#ifndef DALCS_STAGE_REST_H
#define DALCS_STAGE_REST_H

#include "status.h"

#include <stdbool.h>
#include <stdint.h>

struct dalcs_stage_plan;

struct dalcs_stage_run {
    int begin, end;
};

struct dalcs_stage_runs {
    int n;
    struct dalcs_stage_run *run; /* ascending, apart from each other */
};

struct dalcs_stage_rest {
    bool any;                        /* something is at rest */
    bool settled;                    /* it never pays here: all stays awake */
    int n_awake;                     /* rows, and columns, of equations that are awake */
    int *row;                        /* [n_awake] ascending */
    int *column;                     /* [n_awake] ascending */
    uint64_t *may_close;             /* [n_words] pairs with both shores awake */
    struct dalcs_stage_runs states;  /* columns that are awake, with memory */
    struct dalcs_stage_runs without; /* and without */
    struct dalcs_stage_runs pairs;   /* whose w may differ from 0 */
};

/* All is awake. */
enum dalcs_status dalcs_stage_rest_setup(struct dalcs_stage_plan *plan) DALCS_MUST_CHECK;

void dalcs_stage_rest_finish(struct dalcs_stage_rest *rest);

/* Is all that moves in this mode, from the states x[n_x] or with x NULL from no matter where, awake? */
bool dalcs_stage_rest_allows(const struct dalcs_stage_plan *plan, const uint64_t *mode,
                             const double *x);

/* Puts to rest what may, or nothing where that is too little. */
enum dalcs_status dalcs_stage_rest_choose(struct dalcs_stage_plan *plan, const uint64_t *mode,
                                          const double *x) DALCS_MUST_CHECK;

/* Wakes all for good. */
void dalcs_stage_rest_end(struct dalcs_stage_plan *plan);

#endif
