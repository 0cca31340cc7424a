/* steady_multipliers.h - the multipliers of an orbit, from the monodromy matrices of its last pass. Private to this folder. */
#ifndef DALCS_STEADY_MULTIPLIERS_H
#define DALCS_STEADY_MULTIPLIERS_H

#include "steady.h"

/* A multiplier is 1 within what rounding and the tolerance make of it. */
static const double dalcs_steady_near_one = 1e-9;

/* "v(c1)", "i(l1)": a state by its number; NULL when out of memory. */
const char *dalcs_steady_name(struct dalcs_steady *st, int state);

/* All of them, the largest first; the session's. */
enum dalcs_status dalcs_steady_find_multipliers(struct dalcs_steady *st,
                                                struct dalcs_floquet **found,
                                                size_t *n) DALCS_MUST_CHECK;

/* Takes out the one that is nearest to 1, which of an oscillation is its flow and says nothing of stability. Its real part. */
double dalcs_steady_take_out_flow(struct dalcs_floquet *m, size_t *n);

/* How many are left without those of states whose value is lost within a period. */
size_t dalcs_steady_count_lasting(const struct dalcs_floquet *m, size_t n);

/* The size of the largest multiplier of the last pass, but for that of a flow; 0 if it cannot be told. */
double dalcs_steady_largest_multiplier(struct dalcs_steady *st);

#endif
