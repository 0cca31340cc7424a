/* step_length.h - how long a step is, on a ladder of powers of 2. */
#ifndef DALCS_STEP_LENGTH_H
#define DALCS_STEP_LENGTH_H

#include "radau_state.h"
#include "rounding.h"

#include <math.h>

/* Up or down at once. */
enum { DALCS_LENGTH_MOST_RUNGS = 6 };

/* s; in a shorter one the times of its nodes have less than six bits of their own. */
static inline double dalcs_length_shortest(const struct dalcs_radau *r) {
    return 64.0 * r->resolution;
}

/* s; the longest step worth trying. */
double dalcs_length_longest(const struct dalcs_radau *r, const struct dalcs_radau_part *part);

/* s; the longest one that is needed where sources or commands of switches come back: the longest between two edges
 * of one of them; INFINITY: none do. */
double dalcs_length_of_spans(const struct dalcs_radau_part *part);

/* Is a span (s) as long as from `from` to `to` (s), to the rounding of times? */
static inline bool dalcs_length_is_same(double span, double from, double to) {
    return fabs(to - from - span) <= dalcs_rounded * to;
}

/* s; as the first span between commands that was as long, and steps were fitted to, had it; 0: there was none. */
double dalcs_length_known_span(const struct dalcs_radau_part *part, double from, double to);

/* s; the present one of the ladder, or, if commands of a switch are periodic, `limit` (s) is no more than one such step away and no
 * less than half of it, the span up to there, from a command to another: it recurs, and its map serves. */
double dalcs_length_fitted(struct dalcs_radau_part *part, double limit);

/* s; the step at which the error of following the fastest source is about what is allowed. */
double dalcs_length_promising(const struct dalcs_radau_part *part);

/* How many rungs longer a step would be as accurate as it need be; ratio: its error over what is
 * allowed. */
double dalcs_length_rungs_promised(const struct dalcs_radau_part *part, double ratio);

/* Moves part->length.level down after a step that is not accurate; stuck: so many in a row, before this one,
 * that were no better for being shorter. */
void dalcs_length_shorten(struct dalcs_radau_part *part, double ratio, int stuck);

/* Moves part->length.level up after a step that is, if the error promises it, or, as errors near rounding
 * promise nothing, now and then to see. */
void dalcs_length_lengthen(struct dalcs_radau_part *part, double ratio);

#endif
