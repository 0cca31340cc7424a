/* sliding.h - between the two sides of a switch that opens what closes it and closes what opens it.
 *
 * Where the flow on either side of a threshold leads to the other one there is no way but along the threshold, by the
 * mean of both flows that stays there (Filippov 1988, chapter 2). In a step of implicit Euler that is the mean of the
 * answers in both positions whose control is the threshold. What the elements carry is a mean over time, too: a switch
 * has current as well as voltage then, and so have the diodes that turn with it. */
#ifndef DALCS_SLIDING_H
#define DALCS_SLIDING_H

#include "positions.h"

/* y[n_columns] and p->osnsp->w, the answer on one side, become the mean with that on the other side, whose weight is
 * returned, with what rounding may make of it. 0: there is no such mean, and nothing is changed. */
double dalcs_sliding_mean(struct dalcs_positions *p, double *y, double *noise);

/* While it lasts all that has conducted, on either side, is on. */
void dalcs_sliding_join(struct dalcs_positions *p, const uint64_t *conducted);

/* Where it has been joined it is on one side again. Returns whether it was. */
bool dalcs_sliding_leave(struct dalcs_positions *p);

/* Does a pair stand on both sides in turn at present? */
static inline bool dalcs_sliding_turns(const struct dalcs_positions *p, int pair) {
    bool stays = dalcs_mode_has(p->mark, pair) && dalcs_mode_has(p->other, pair);
    return p->joined && dalcs_osnsp_is_on(p->osnsp, pair) && !stays;
}

#endif
