/* stage_factors.h - one mode and step length of a large system, factored. */
#ifndef DALCS_STAGE_FACTORS_H
#define DALCS_STAGE_FACTORS_H

#include "stage_matrix.h"
#include "stages_internal.h"

/* The places of unknowns in a system's LU, which has its own order. */
struct dalcs_stage_order {
    int n;          /* positions */
    int *row_of;    /* [n] row of M at position i; n_rows + k: choice k */
    double *scale;  /* [n] of that row */
    int *position;  /* [n] of an unknown */
    int *of_pair;   /* [n_pairs] position of a pair's lambda */
    int *wave_at;   /* [plan->waves.n_waves] position of the entry's row, -1: not there */
    int *choice_at; /* [singular.n] */
};

/* Those of an update are its base's but for `pair`, `pair_scale` and where lambdas are. */
struct dalcs_stage_factors {
    int n;
    int n_pairs; /* present */
    int *pair;   /* [n_pairs] */
    int n_systems;
    struct dalcs_lu lu[DALCS_STAGE_SYSTEMS]; /* the real one first */
    struct dalcs_stage_order order[DALCS_STAGE_SYSTEMS];
    double *column_scale;                 /* [n_equations] */
    double *pair_scale;                   /* [n_pairs] */
    double *function_share;               /* [functions][DALCS_N_SHARES] */
    struct dalcs_stage_singular singular; /* n is 0: regular */
    struct dalcs_stage_update *update;    /* NULL: these are its own factors */
    struct dalcs_stage_change **change;   /* [pairs of the system] NULL: none is known */
};

/* stage_change.c: the unknown that a column of the system is, lambdas of `pair` from n_equations on; -1: none. */
int dalcs_stage_unknown(const struct dalcs_stage_factors *f, int column);

/* stage_build.c: what row r of M without derivatives misses at y, an answer at a node, and the sum of
 * its terms' sizes. */
struct dalcs_row_miss {
    double missed, terms;
};

struct dalcs_row_miss dalcs_stage_factors_miss_of_row(const struct dalcs_stages *stages,
                                                      const struct dalcs_stage_entry *entry, int r,
                                                      int node, const double *in, const double *y);

/* stage_build.c: the largest miss of the rows without derivatives over the largest of their terms,
 * balanced, at the last stage of the step from in[n_in] to out that was made last. */
double dalcs_stage_factors_miss(const struct dalcs_stages *stages,
                                const struct dalcs_stage_entry *entry, const double *in,
                                const double *out);

#endif
