/* stage_freedom.h - may every state be what it likes in a mode?
 *
 * It may if, the states given, everything else follows: if the block K of the equations without
 * derivatives and closed pairs, in the columns without memory and their lambda, is regular (index 1).
 * K falls into small pieces, for capacitors' voltages and coils' currents are given; a pair that
 * changes concerns the one that it is in. */
#ifndef DALCS_STAGE_FREEDOM_H
#define DALCS_STAGE_FREEDOM_H

#include "status.h"

#include <stdbool.h>

struct dalcs_stage_entry;
struct dalcs_stage_plan;

/* Pieces of K of more rows are not looked into. */
enum { DALCS_STAGE_MOST_PIECE = 48 };

struct dalcs_stage_freedom {
    bool *is_given;   /* [n_rows] columns: states, and what a row of K by itself makes of these */
    bool *is_used;    /* [n_rows] those rows, and those with derivatives */
    int *row_seen;    /* [n_rows] in the search of this number */
    int *column_seen; /* [n_rows] */
    int search;

    /* the piece */
    int n_rows, n_columns;
    int row[DALCS_STAGE_MOST_PIECE], column[DALCS_STAGE_MOST_PIECE];
    long double *K; /* [n_rows][n_rows] */
};

enum dalcs_status dalcs_stage_freedom_setup(struct dalcs_stage_plan *plan) DALCS_MUST_CHECK;

void dalcs_stage_freedom_finish(struct dalcs_stage_freedom *freedom);

/* Of what is awake. false: no, or not known. */
bool dalcs_stage_freedom_of_mode(struct dalcs_stage_plan *plan,
                                 const struct dalcs_stage_entry *entry);

/* The same, if it is so in a mode from which this one differs in a pair. To be asked for each such pair. */
bool dalcs_stage_freedom_of_change(struct dalcs_stage_plan *plan,
                                   const struct dalcs_stage_entry *entry, int pair);

#endif
