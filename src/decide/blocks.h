/* blocks.h - of a step that does not hold, what acts and what only reads (partition.h).
 *
 * A block depends on those before it alone. So where a step is wrong in one of them, those before it are as they would be
 * without it, and what is asked of the circuit is asked of it and of those behind it. Where nothing only reads there is
 * one block, and all of this is 0. */
#ifndef DALCS_BLOCKS_H
#define DALCS_BLOCKS_H

#include "radau_state.h"

/* The first block in which something crosses in the present step. */
int dalcs_blocks_first_crossed(const struct dalcs_radau_part *part);

/* The first block with a state that the present step has wrong by more than is allowed over unit[2], V and A; 0 where a
 * diode before it has the wrong sign as well, or where it is no state that is wrong. */
int dalcs_blocks_first_wrong(const struct dalcs_radau_part *part, const double *unit);

/* Diodes of blocks before `block` go back to where they were in mode[(n_pairs + 63) / 64]. */
void dalcs_blocks_put_back(struct dalcs_radau_part *part, int block, const uint64_t *mode);

#endif
