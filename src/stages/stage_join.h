/* stage_join.h - Kirchhoff's current law of a node and of the node behind a resistor that leads nowhere else,
 * added up.
 *
 * A coil with a resistor in series: between them is a node whose current is (v - v')/R. Where R is milliohms,
 * rounding of hundreds of volts is a current of 1e-9 A, by which a diode and the coil that it feeds then
 * differ; in a step of 1e-15 s, that is hundreds of volts again. The sum has no R in it: the current of the
 * coil itself flows on. Any row may be added to another, so whatever is taken for such a node is right. */
#ifndef DALCS_STAGE_JOIN_H
#define DALCS_STAGE_JOIN_H

#include "system.h"

/* Of rows of A and E: other[r] is added to row r, and after it next[other]; -1: none. */
struct dalcs_stage_join {
    int *other; /* [n_equations] */
    int *next;  /* [n_equations] */
};

/* After `part`, which begins with r itself, of the rows that make up row r; -1: no more. */
static inline int dalcs_stage_join_after(const struct dalcs_stage_join *join, int r, int part) {
    return part == r ? join->other[r] : join->next[part];
}

enum dalcs_status dalcs_stage_join_find(struct dalcs_stage_join *join,
                                        const struct dalcs_system *s) DALCS_MUST_CHECK;
void dalcs_stage_join_finish(struct dalcs_stage_join *join);

/* Adds row r of A as it is after that to column r of t, times factor. work[2 n_columns]: 0 before and after. */
enum dalcs_status dalcs_stage_join_row(const struct dalcs_stage_join *join,
                                       const struct dalcs_system *s, int r, double factor,
                                       double *work, struct dalcs_triplets *t) DALCS_MUST_CHECK;

#endif
