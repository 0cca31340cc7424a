/* stage_shift.h - how far a mode moves the states of a small system at once.
 *
 * A mode may demand something of states, as a closed diode that they are the same on both sides of it; and what is far
 * faster than a step does the same as if it were demanded. A state that is off moves there in no time. That is linear in
 * the state and in what sources are, and a part of an entry: where it says that nothing moves, no step has to show it. */
#ifndef DALCS_STAGE_SHIFT_H
#define DALCS_STAGE_SHIFT_H

#include "dense_solve.h"
#include "stage_workshop.h"

/* Of a workshop's two moments, for up to n unknowns. */
static inline size_t dalcs_stage_shift_room(int n, int n_rhs) {
    return 2 * (size_t)n * (size_t)dalcs_dense_row(n, n_rhs);
}

/* b->solved.shift, once the workshop's unknowns without memory are eliminated. */
void dalcs_stage_shift_find(struct dalcs_stage_workshop *b);

/* From it the entry's, by rows. */
void dalcs_stage_shift_fill(const struct dalcs_stage_workshop *b,
                            const struct dalcs_stage_function *function);

#endif
