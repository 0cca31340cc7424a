/* block.h - one block of a system that is solved in order (in_order.h). */
#ifndef DALCS_BLOCK_H
#define DALCS_BLOCK_H

#include "osnsp.h"

/* One block: columns, rows and pairs ascend as they do in the whole system. The inputs of its system are those of the
 * whole, then the columns that it reads. */
struct dalcs_block {
    struct dalcs_system system;
    struct dalcs_osnsp osnsp;
    int *column; /* [n_columns] of the whole system */
    int *row;    /* [n_equations] */
    int *read;   /* [n_read] columns of the whole system */
    int n_read;
    double *u, *y;
};

/* Makes block->system of the columns c with block_of[c] == number, and says what of the whole they are. place[n_columns]
 * is work. DALCS_NOT_CONVERGED: they are no system of their own. Whatever comes back, *block, zeroed before, needs
 * dalcs_block_finish(). */
enum dalcs_status dalcs_block_extract(struct dalcs_block *block, const struct dalcs_system *from,
                                      const int *block_of, int number, int *place) DALCS_MUST_CHECK;

void dalcs_block_finish(struct dalcs_block *block);

#endif
