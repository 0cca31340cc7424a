/* batch.h - what the files that ask batches share. */
#ifndef DALCS_AUDIT_BATCH_H
#define DALCS_AUDIT_BATCH_H

#include "screen.h"

/* The one that was asked by itself before the batch is in its first slot. */
enum { AUDIT_BATCH_FIRST = 1 };

static inline double *audit_batch_input(const struct audit_batch *b, int j) {
    return b->gathered.input + (size_t)j * DALCS_AUDIT_BATCH;
}

/* Of each slot. */
struct audit_batch_sums {
    double law[DALCS_AUDIT_BATCH], start[DALCS_AUDIT_BATCH];
    double end[DALCS_AUDIT_BATCH +
               1]; /* that of the slot before; so a jump is two numbers side by side */
    double below[DALCS_AUDIT_BATCH]; /* how far the least sign is below 0 */
};

/* batch_sums.c: the first slot that is beyond what is allowed; as many as there are: none is. */
int audit_batch_first(struct dalcs_audit *audit, struct audit_batch *b, struct audit_batch_sums *s);

#endif
