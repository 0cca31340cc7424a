/* tail.h - the last rows of a run, for a closer look at how it ended. */
#ifndef DALCS_TAIL_H
#define DALCS_TAIL_H

#include "dalcs.h"

enum { DALCS_TAIL_ROWS = 8000 };

struct dalcs_tail {
    size_t n_values; /* in a row, without its time */
    size_t n_added;  /* rows so far; the last DALCS_TAIL_ROWS of them are there */
    double *cell;    /* ring of rows: [DALCS_TAIL_ROWS * (1 + n_values)] */
};

enum dalcs_status dalcs_tail_init(struct dalcs_tail *tail, size_t n_values) DALCS_MUST_CHECK;

/* value[n_values] */
void dalcs_tail_add(struct dalcs_tail *tail, double time, const double *value);

size_t dalcs_tail_n_rows(const struct dalcs_tail *tail);

/* Row i, 0 being the oldest one there: its time, then its values. */
const double *dalcs_tail_row(const struct dalcs_tail *tail, size_t i);

/* Accepts a zeroed one. */
void dalcs_tail_finish(struct dalcs_tail *tail);

#endif
