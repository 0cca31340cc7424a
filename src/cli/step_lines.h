/* step_lines.h - a line for each step of .step: its values, and what the first signals came to. */
#ifndef DALCS_STEP_LINES_H
#define DALCS_STEP_LINES_H

#include "measure.h"

#include <stdio.h>

enum { DALCS_STEP_SIGNALS = 4, DALCS_STEP_PARAMETERS = 4 };

struct dalcs_step_line {
    enum dalcs_analysis analysis;
    size_t step;
    double parameter[DALCS_STEP_PARAMETERS];
    double value[DALCS_STEP_SIGNALS]; /* average of .tran, largest of .ac, else the last */
};

struct dalcs_step_lines {
    struct dalcs_step_line *line; /* heap */
    size_t n, capacity;
    const struct dalcs_plot *plot[DALCS_N_ANALYSES]; /* the last of each, borrowed */
};

/* After a plot; nothing for one that is not of .step. */
enum dalcs_status dalcs_step_lines_add(struct dalcs_step_lines *lines,
                                       const struct dalcs_measure *measure) DALCS_MUST_CHECK;

/* Steps that failed stand in their place, with the report's reason. */
void dalcs_step_lines_write(FILE *out, const struct dalcs_step_lines *lines,
                            const struct dalcs_report *report, enum dalcs_analysis analysis);

void dalcs_step_lines_finish(struct dalcs_step_lines *lines);

#endif
