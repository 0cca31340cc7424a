/* partition.h - which unknowns act on which: a system as blocks that can be solved one after the other.
 *
 * A column depends on those that its equation holds (of a pair: those that its w holds). What depends on each
 * other, directly or through others, is a strongly connected part (Tarjan 1972), and the parts have an order
 * in which each depends on earlier ones alone: the block triangular form (Pothen and Fan 1990). A source that
 * only reads, and what it drives, comes behind what it reads. */
#ifndef DALCS_PARTITION_H
#define DALCS_PARTITION_H

#include "system.h"

struct dalcs_partition {
    int n_blocks;
    int *block_of;       /* [n_columns] in order of solution */
    bool *is_monotone;   /* [n_blocks] its part of the OSNSP is monotone: solvable iff feasible */
    bool all_monotone;   /* each of them */
    bool jumps_as_usual; /* nothing that reads acts on a state */
    bool *is_driven;     /* [n_columns] something that reads acts on it; NULL: on none */
    struct dalcs_arena arena;
};

/* Of a system that tells what reads (system.h); of another one, or where nothing is gained, there is one block.
 * Neighbours in the order are one block as long as nothing in it reads. On failure *p is zeroed. */
enum dalcs_status dalcs_partition_find(struct dalcs_partition *p,
                                       const struct dalcs_system *s) DALCS_MUST_CHECK;

/* Of an open quantity, value[n_pairs] is what it is in pairs: what readers make of it, in later blocks than the first in
 * which it is anything, becomes 0, and what it is in pairs of another kind. block_of[n_columns]; NULL: there is one block. */
void dalcs_partition_keep_first(const int *block_of, const struct dalcs_system *s,
                                enum dalcs_pair_kind kind, double *value);

void dalcs_partition_finish(struct dalcs_partition *p);

#endif
