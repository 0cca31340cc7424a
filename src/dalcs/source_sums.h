/* source_sums.h - sums of sources that must be 0 at all times. Private to src/dalcs. */
#ifndef DALCS_SOURCE_SUMS_H
#define DALCS_SOURCE_SUMS_H

#include "circuit.h"

enum {
    DALCS_MOST_CONFLICTS = 20, /* that are told; the run finds the rest */
    DALCS_MOST_SUMMANDS = 60   /* of a sum that is looked at */
};

/* Sources with a sign. */
struct dalcs_source_sum {
    int n;
    int device[DALCS_MOST_SUMMANDS];
    double sign[DALCS_MOST_SUMMANDS];
};

enum dalcs_sum_verdict { DALCS_SUM_CONTRADICTS, DALCS_SUM_AGREES, DALCS_SUM_UNKNOWN };

/* Is the sum 0 at all times? Equal functions cancel; what is left must be constant to be judged.
 * *left: what is left over. */
enum dalcs_sum_verdict dalcs_source_sum_judge(const struct dalcs_circuit *c,
                                              const struct dalcs_source_sum *s, double *left);

void dalcs_source_sum_add(struct dalcs_source_sum *s, int device, double sign);

/* "v1 (5 V)", of a function of time "v1", of a short "r1". */
const char *dalcs_source_text(struct dalcs_arena *a, const struct dalcs_circuit *c, int device);

/* "a, b"; either may be empty. */
const char *dalcs_listed(struct dalcs_arena *a, const char *before, const char *after);

#endif
