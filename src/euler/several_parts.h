/* several_parts.h - the parts of the time of switches that slide at once. Private to several_slides.c. */
#ifndef DALCS_SEVERAL_PARTS_H
#define DALCS_SEVERAL_PARTS_H

#include "sliding_internal.h"

enum { DALCS_MOST_SEVERAL = 5 };

_Static_assert(1 << DALCS_MOST_SEVERAL == DALCS_MOST_SIDES, "a side for each of their positions");

/* Groups that slide: the k-th has the bit k of a corner. */
struct dalcs_several {
    int n;
    int first[DALCS_MOST_SEVERAL];   /* of each group */
    double part[DALCS_MOST_SEVERAL]; /* of the time, on its other side */
};

/* The part of the time in a corner, by all groups but one; -1: by all. */
double dalcs_several_weight(const struct dalcs_several *of, int corner, int but);

/* How far the mean has the i-th beyond its threshold, and what the controls are that make it up. */
double dalcs_several_beyond(const struct dalcs_positions *p, const struct dalcs_several *of, int i,
                            double *largest);

/* By Newton's method: that all first ones are on their thresholds in the mean. Returns whether that is possible. */
bool dalcs_several_find_parts(const struct dalcs_positions *p, struct dalcs_several *of);

/* Does each turn its own control off, more than others turn it on? */
bool dalcs_several_is_only_one(const struct dalcs_positions *p, const struct dalcs_several *of);

/* Half of the time, all. */
void dalcs_several_halve(struct dalcs_several *of);

/* One that reads what the last one reads, on another threshold: both are not on theirs at once, whatever the parts are. -1:
 * there is none. is_on: where it stands while the last one is on its threshold. */
int dalcs_several_find_tied(const struct dalcs_positions *p, const struct dalcs_several *of,
                            bool *is_on);

#endif
