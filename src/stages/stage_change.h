/* stage_change.h - what a factored mode, a base, knows of pairs of its that change. */
#ifndef DALCS_STAGE_CHANGE_H
#define DALCS_STAGE_CHANGE_H

#include "stage_factors.h"

/* A column of G in the order of the base: what is not nothing of it, in runs. */
struct dalcs_stage_response {
    int n_runs;
    int *first, *end; /* [n_runs] positions */
    double *value;    /* of all runs, one behind the other */
};

/* What a base knows of one of its pairs that changes: an open one closes, a closed one opens. */
struct dalcs_stage_change {
    int pair;
    bool refused;                   /* digits would cancel: nothing else is known */
    double row_scale, column_scale; /* of one that closes */
    int n_terms;                    /* of its w in unknowns of the base, balanced */
    int *unknown;
    double *value;
    int row_at[DALCS_STAGE_SYSTEMS]; /* positions of its row and its lambda, of one that opens */
    int lambda_at[DALCS_STAGE_SYSTEMS];
    struct dalcs_stage_response response[DALCS_STAGE_SYSTEMS];
    double largest; /* of all of them, in magnitude */
    size_t bytes;
};

/* What the base, whose factors are its own, knows of a change of pair d. It belongs to the base, and
 * is found out when it is asked for the first time. */
enum dalcs_status dalcs_stage_change_get(struct dalcs_stages *stages,
                                         struct dalcs_stage_entry *base, int d,
                                         struct dalcs_stage_change **change) DALCS_MUST_CHECK;

void dalcs_stage_changes_destroy(const struct dalcs_stages *stages,
                                 struct dalcs_stage_change **change);

/* Element at a position; part 0 or, of complex numbers, which have a stride of 2, 1. */
double dalcs_stage_response_element(const struct dalcs_stage_response *g, int at, int stride,
                                    int part);

/* work -= nu G */
void dalcs_stage_response_subtract(const struct dalcs_stage_response *g, double nu, double *work);
void dalcs_stage_response_subtract_complex(const struct dalcs_stage_response *g, double re,
                                           double im, double *work);

#endif
