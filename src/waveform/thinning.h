/* thinning.h - leaves out the rows that straight lines between the others give.
 *
 * A sink between the recorder and the caller's. What it hands on are rows it got, unchanged. On the
 * straight lines between them no signal is further from a row left out than `bound` times the largest
 * value that the signal had up to there. The first and the last row stay, and so do both sides of a
 * discontinuity. It holds one row back, so its memory does not depend on their number. */
#ifndef DALCS_THINNING_H
#define DALCS_THINNING_H

#include "status.h"

struct dalcs_thinning {
    struct dalcs_sink sink; /* what rows are handed to; valid while this struct stays in place */
    const struct dalcs_sink *to; /* complete; borrowed */
    double bound;
    size_t n_signals;

    bool has_kept, has_held, refused;
    double kept_time, held_time;
    double *kept;       /* [n_signals] the last row handed on */
    double *held;       /* the newest row, if that is another one */
    double *low, *high; /* slopes from the kept row that are near enough to all rows since */
    double *scale;      /* the largest |value| so far */
};

/* `to` has all callbacks but may refuse rows. */
enum dalcs_status dalcs_thinning_setup(struct dalcs_thinning *t, const struct dalcs_sink *to,
                                       size_t n_signals, double bound) DALCS_MUST_CHECK;

/* Hands on the row held back. The sink's end does it by itself; a run that stops without it calls this,
 * unless it was a row that was refused. */
enum dalcs_status dalcs_thinning_flush(struct dalcs_thinning *t) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_thinning_finish(struct dalcs_thinning *t);

#endif
