/* filling.h - rows between those that are due, where the waveform is not what curves through these say.
 *
 * With them, between any two rows each signal is within `bound` times the largest value that it had up to there: of
 * the cubic through the two rows before and the two behind, where nothing happens between these; else, in the two
 * gaps on each side of an event or edge, at the start and at the stop, of the straight line. */
#ifndef DALCS_FILLING_H
#define DALCS_FILLING_H

#include "recorder.h"
#include "row_gaps.h"

struct dalcs_filling {
    bool is_on, by_lines;
    struct dalcs_row_gaps gaps;
    double start, stop;  /* s, of the rows and of the run */
    double least;        /* s, shorter gaps are not examined */
    double last, before; /* s, of the last row and of the one before */
    int beside;          /* gaps to come that lie beside what happened at one of them */
    double begin, until; /* s, of the stretch at hand */
    bool is_closed;      /* nothing is added to it */
    bool
        ends; /* with something that happens, and rows that are due are too far apart for lines there */
    double line, cubic; /* s, longest gaps in it */
    double step;        /* s, between rows that are due */
    double until_plain; /* s, up to which these are enough, but for those beside what began it */
    size_t n_left, n_for_each; /* rows that may still be added; more of them for each other row */
    double ended;              /* s, when there were none left; INFINITY: there are */
};

/* At most so many rows are added, and for_each more for each row that there is anyway. */
struct dalcs_filling_limit {
    size_t most, for_each;
};

/* For rows on a grid: from its start on, for the recorder's first n_shown outputs. by_lines: the curves are straight
 * lines everywhere. */
enum dalcs_status dalcs_filling_setup(struct dalcs_filling *f, const struct dalcs_recorder *r,
                                      struct dalcs_rows *rows, double bound, bool by_lines,
                                      const struct dalcs_filling_limit *limit) DALCS_MUST_CHECK;

/* Accepts a zeroed one, which never is on. */
void dalcs_filling_finish(struct dalcs_filling *f);

/* May rows be added at t? */
bool dalcs_filling_is_on(const struct dalcs_filling *f, double t);

/* The stretch from one time to another, in the present segments: in between nothing happens; ends: but then. */
enum dalcs_status dalcs_filling_enter(struct dalcs_filling *f, double from, double until,
                                      bool ends) DALCS_MUST_CHECK;

/* Like dalcs_recorder_list_due up to the end of the stretch, with what is added; *n_due of them are due. All are
 * taken to be written. */
int dalcs_filling_list(struct dalcs_filling *f, const struct dalcs_recorder *r, double near,
                       double *time, int most, int *n_due);

/* The last values of the rows are those of a row at t that was not listed; happens: something does there. */
void dalcs_filling_row(struct dalcs_filling *f, double t, bool happens);

#endif
