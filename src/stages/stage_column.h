/* stage_column.h - one column of a map. Private to src/stages. */
#ifndef DALCS_STAGE_COLUMN_H
#define DALCS_STAGE_COLUMN_H

#include "stage_workshop.h"

/* The input of a column of the map: a source's values at the nodes and their error in between, 0 for a state, and,
 * as in stage_functions.h, the stages' share of it and what they take of each part of a solution. */
struct dalcs_stage_drive {
    const double *share;
    const struct dalcs_extended_row *stages, *of_part;
};

/* Where a column of the map goes, and of that of the drift of currents. */
struct dalcs_map_column {
    double *out, *currents;
};

/* One column of the map, with its clashes: the answer to in[column] = 1. And on to the next. */
void dalcs_stage_column_fill(struct dalcs_stage_workshop *b, int column, int rhs_column,
                             const struct dalcs_stage_drive *drive, struct dalcs_map_column *to);

/* How well the rounded answer at the last stage satisfies the equations without derivatives, in
 * balanced units. In a singular mode sources may disagree; the clashes show that. */
void dalcs_stage_column_check(struct dalcs_stage_workshop *b, int column, int rhs_column,
                              double share);

#endif
