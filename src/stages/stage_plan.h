/* stage_plan.h - what the sparse factors of all modes of one system have in common.
 *
 * With every pair present the matrix of an eigenvalue is
 *     M = [sigma P - A; C],     right-hand side  drive y_0 + constant + wave s~,
 * with some rows of A added to others (stage_join.h),
 * where drive = [A; -C], unknowns are increments over y_0, the states and what the rest was last (any
 * y_0 gives the same answer, but rounding is of the size of what is solved for), and the sources are
 * split into what is constant and what varies. The matrix of a mode is M without the rows and columns of open pairs, so its pattern, and
 * with it KLU's analysis, depends on the mode alone: the analyses of the last modes are kept. */
#ifndef DALCS_STAGE_PLAN_H
#define DALCS_STAGE_PLAN_H

#include "stage_join.h"
#include "stages.h"

/* Unknowns are turned into stages in pieces of this many, which stay in the fastest cache. */
enum {
    DALCS_STAGE_PIECE = 64,
    DALCS_STAGE_SYSTEMS = 1 + DALCS_MAX_CONJUGATES,
};

/* Where the shares of a wave in a step are: its values at the nodes, then these. */
enum {
    DALCS_SHARE_REAL = DALCS_MAX_NODES, /* seen by the real eigenvalue */
    DALCS_SHARE_PAIR,                   /* by the complex ones: re, im, re, ... */
    DALCS_SHARE_DRIFT = DALCS_SHARE_PAIR + 2 * DALCS_MAX_CONJUGATES,
    DALCS_SHARE_NONE,        /* 0 */
    DALCS_SHARE_RIPPLE,      /* missed between the nodes */
    DALCS_SHARE_RIPPLE_RATE, /* the same, in the error estimate */
    DALCS_N_SHARES
};

/* KLU's analysis of a mode. */
struct dalcs_stage_analysis {
    uint64_t *mode;
    bool is_singular; /* with choices in it */
    klu_symbolic *symbolic;
    klu_numeric *numeric[DALCS_STAGE_SYSTEMS]; /* of the last step length, or NULL */
};

/* The varying entries of E and F. */
struct dalcs_plan_waves {
    int n_waves;             /* entries of wave, by rows */
    int *wave_row, *wave_of; /* [n_waves] */
    double *wave_x;          /* [n_waves] */
    int *wave_begin;         /* [n_rows + 1] */
    int *wave_of_input;      /* [n_inputs] -1: constant */
};

/* Of one step. */
struct dalcs_plan_work {
    double *rhs;    /* [2 n_rows] of the rows of M, then of choices */
    double *share;  /* [waves][DALCS_N_SHARES] */
    double *near;   /* [n_rows] columns where the circuit was last; lambda of open pairs 0 */
    double *from;   /* [n_rows] of this step: y_0 */
    double *missed; /* [n_rows] by states at the start, then what is left of it; else 0 */
    double *guard;  /* [n_pairs + watched] */
};

struct dalcs_stage_plan {
    const struct dalcs_stages *stages;
    int n_rows;                       /* n_equations + n_pairs: rows and columns of M */
    struct dalcs_stage_join join;     /* rows of A and E that are added to others */
    struct dalcs_csr base;            /* columns of M without P: row c lists column c */
    struct dalcs_csr P;               /* columns of P */
    struct dalcs_csr drive;           /* [n_rows][n_rows] */
    struct dalcs_csr drive_of_states; /* [n_rows][n_x] its first columns */
    double *constant;                 /* [n_rows] */
    struct dalcs_plan_waves waves;
    /* Y_i = x_0 + sum over the parts (real, re, im, re, ...) of to[i] * part; to[0]: the value at 0
     * of the polynomial through the stages */
    double to[DALCS_MAX_NODES][DALCS_SOLUTION_PARTS];
    int n_parts;

    /* The row that each column had its pivot in when a mode was last factored, -1: none. KLU
     * looks for a transversal and takes the first free row of each column: with this one first
     * it hardly has to search, which takes quadratic time in a long multiplier. */
    int *match; /* [n_rows] */

    int n_analyses, most_analyses, most_kept;
    struct dalcs_stage_analysis *analysis; /* newest first */
    struct dalcs_plan_work work;
};

static inline int dalcs_stage_plan_n_equations(const struct dalcs_stage_plan *plan) {
    return dalcs_system_n_equations(plan->stages->system);
}

/* Allocates stages->plan if it is not there yet. */
enum dalcs_status dalcs_stage_plan_get(struct dalcs_stages *stages) DALCS_MUST_CHECK;

void dalcs_stage_plan_destroy(struct dalcs_stages *stages);

struct dalcs_stage_matrix;

/* KLU's analysis of the pattern of a mode's matrix. It belongs to the plan and stays until the next call. */
enum dalcs_status dalcs_stage_plan_analyze(struct dalcs_stages *stages, const uint64_t *mode,
                                           bool is_singular, const struct dalcs_stage_matrix *m,
                                           struct dalcs_stage_analysis **analysis) DALCS_MUST_CHECK;

#endif
