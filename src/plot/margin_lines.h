/* margin_lines.h - where the gain of a loop is 1 and where its phase is 180 degrees, as lines of a picture. */
#ifndef DALCS_MARGIN_LINES_H
#define DALCS_MARGIN_LINES_H

#include "figure.h"

enum { DALCS_MOST_MARGIN_LINES = 12 };

/* Zero-initialise; finish frees everything. */
struct dalcs_margin_lines {
    const char *loop; /* the source in it; NULL: no gain of a loop */
    int n;
    struct dalcs_figure_line line[DALCS_MOST_MARGIN_LINES];
    struct dalcs_arena arena;
};

/* The first panel has the gain in dB, the second one its phase. */
enum dalcs_status dalcs_margin_lines_begin(struct dalcs_margin_lines *lines,
                                           const char *loop) DALCS_MUST_CHECK;

/* A margin in deg where the gain is 1, or in dB; beyond those that there is room for, nothing. */
enum dalcs_status dalcs_margin_lines_add(struct dalcs_margin_lines *lines, bool of_phase,
                                         double frequency, double margin) DALCS_MUST_CHECK;

/* Those of a run that has just ended. */
enum dalcs_status dalcs_margin_lines_add_report(struct dalcs_margin_lines *lines,
                                                const struct dalcs_report *report) DALCS_MUST_CHECK;

void dalcs_margin_lines_finish(struct dalcs_margin_lines *lines);

#endif
