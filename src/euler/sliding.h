/* sliding.h - between the two sides of a switch that opens what closes it and closes what opens it.
 *
 * Where the flow on either side of a threshold leads to the other one there is no way but along the threshold, by the
 * mean of both flows that stays there (Filippov 1988, chapter 2). In a step of implicit Euler that is the mean of the
 * answers in both positions whose control is the threshold. What the elements carry is a mean over time, too: a switch
 * has current as well as voltage then, and so have the diodes that turn with it.
 *
 * Formulas that jump turn as switches do: a comparator that commands switches, or one that only reads what they do. On the
 * threshold is what goes on through the event: the argument of the comparator, not its output. */
#ifndef DALCS_SLIDING_H
#define DALCS_SLIDING_H

#include "observer.h"
#include "positions.h"

/* Behind dalcs_positions_solve() with p->alternates, of a step of length 1 / sigma at the inputs u: y[n_columns] and p->osnsp->w, the answer on one
 * side, become the mean of all sides, which are told, with what rounding may make of their weights. sides->n = 0: there is
 * no such mean, and y has no meaning. */
enum dalcs_status dalcs_sliding_mean(struct dalcs_positions *p, double sigma, const double *u,
                                     double *y, struct dalcs_observed_sides *sides,
                                     double *noise) DALCS_MUST_CHECK;

/* Before a slide: nothing is known of what turns. */
void dalcs_sliding_begin(struct dalcs_positions *p);

/* In the answer y and that on the other side of half a micro-step, and then in those of a whole one: what jumps with
 * another does not decide where the slide is. */
void dalcs_sliding_note_gaps(struct dalcs_positions *p, const double *y);
void dalcs_sliding_compare_gaps(struct dalcs_positions *p, const double *y);

/* Behind these: where each follows another, in a loop without a state, a formula that moves what turns, and that no other
 * formula moves, decides. y, u: of the last one. */
enum dalcs_status dalcs_sliding_find_commanding(struct dalcs_positions *p, const double *u,
                                                const double *y) DALCS_MUST_CHECK;

/* Do all switches that turn follow one formula? Then there are no positions between both. */
bool dalcs_sliding_follows_one(const struct dalcs_positions *p);

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
