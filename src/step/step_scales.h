/* step_scales.h - the scales of a step's columns. Private to src/step. */
#ifndef DALCS_STEP_SCALES_H
#define DALCS_STEP_SCALES_H

#include "step_error.h"

/* What the columns are in a mode, in whole quads. A pair is a voltage while it is open. */
struct dalcs_column_kinds {
    uint64_t *mode;
    double *is_volt, *is_ampere, *is_closed; /* 1 or 0: V or A of an equation, A of a closed pair */
    double *leans; /* 1; 0: it moves a switch, and is held to its own scale however small that is */
    uint64_t *counts; /* all bits, but none of an open pair, whose voltage is one of the columns */
};

/* The larger of what a column is at the first and at the last known node of a segment; raises the
 * units to the largest of them. */
void dalcs_step_find_magnitudes(struct dalcs_radau_part *part, double end, double *unit);

#endif
