/* stage_change.h - changes of single pairs of a factored mode, the base. */
#ifndef DALCS_STAGE_CHANGE_H
#define DALCS_STAGE_CHANGE_H

#include "stage_factors.h"

/* A column of G in the order of the base: what is not nothing of it, in runs. */
struct dalcs_stage_response {
    int n_runs;
    int *first, *end; /* [n_runs] positions */
    double *value;    /* of all runs, one behind the other */
};

/* One pair of the base changes: an open one closes, a closed one opens. */
struct dalcs_stage_change {
    int pair;
    bool refused;                   /* digits would cancel: the other fields are not set */
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

/* The change of pair d of a base that has factors of its own. It belongs to the base, and is computed at the first
 * call. */
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
