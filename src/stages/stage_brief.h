/* stage_brief.h - the part of a step's answer, on a dense map, that decides whether the step is a segment: the states at
 * its end, their drift, and the guards as polynomials. The whole answer has many times as many rows. If only a part of
 * the step may be a segment, the states at all nodes are in it, too. */
#ifndef DALCS_STAGE_BRIEF_H
#define DALCS_STAGE_BRIEF_H

#include "stages.h"

struct dalcs_stage_brief {
    struct dalcs_stage_entry *entry; /* held */
    long number;                     /* no other brief step of these stages has it */
    double *last;                    /* [n_x] states at the end of the step applied last */
    const double *drift;             /* [n_x] as in its answer */
    const double *guard; /* [guards][n_nodes] in Bernstein's basis: diodes, then watched voltages */
    const double *node;  /* [n_x][n_nodes in whole quads] states there; NULL: not asked for */
    int rows;
    double *map;    /* [rows][columns] by columns */
    double *answer; /* [rows] last, drift, guard, node */
};

/* *brief: of an entry with a map, which it holds. */
enum dalcs_status dalcs_stage_brief_create(struct dalcs_stages *stages,
                                           struct dalcs_stage_entry *entry, bool with_nodes,
                                           struct dalcs_stage_brief **brief) DALCS_MUST_CHECK;
void dalcs_stage_brief_destroy(struct dalcs_stages *stages, struct dalcs_stage_brief *brief);

/* in[n_in] as for dalcs_stages_apply. */
void dalcs_stage_brief_apply(const struct dalcs_stages *stages, struct dalcs_stage_brief *brief,
                             const double *in);

/* The states at theta, in steps, as those at the end; of a brief one with nodes. */
void dalcs_stage_brief_stop(const struct dalcs_stages *stages, struct dalcs_stage_brief *brief,
                            double theta);

/* Element `which` of the answer as a function of the states, the other inputs being as they are in `in`: factor[n_x]
 * of them, and what is returned for 0. */
double dalcs_stage_brief_row(const struct dalcs_stages *stages,
                             const struct dalcs_stage_brief *brief, int which, const double *in,
                             double *factor);

/* The whole answer is a sum of `columns` answers, of its entry, times the elements of `input`. */
int dalcs_stage_brief_columns(const struct dalcs_stages *stages);
const double *dalcs_stage_brief_column(const struct dalcs_stage_entry *entry, int column);
const double *dalcs_stage_brief_input(const struct dalcs_stages *stages, const double *in);

/* The whole answer out[n_fixed] of the entry of a brief one. */
void dalcs_stage_brief_expand(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, const double *in, double *out);

#endif
