/* lemma41.h - items 2 and 3 of lemma 4.1 of Brogliato 2022: when the model's passivity is that of the step,
 * without D + D' > 0. */
#ifndef DALCS_LEMMA41_H
#define DALCS_LEMMA41_H

#include "findings.h"
#include "step_blocks.h"

/* Adds both conditions for the step h in s, P_I - h A_I being regular. */
enum dalcs_status dalcs_lemma41_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                      double h) DALCS_MUST_CHECK;

#endif
