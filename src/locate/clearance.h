/* clearance.h - guards of a brief step (stage_brief.h), by their polynomials and the scales so far.
 *
 * They are asked for no more than what is plain: each stays so far above 0 that it could be armed at the start and
 * has no fall, or it falls once, from there to as far below 0. What is not plain is for guards.h. */
#ifndef DALCS_CLEARANCE_H
#define DALCS_CLEARANCE_H

#include "radau_state.h"

/* Is every guard so far above 0 during the whole step? Then all are armed. */
bool dalcs_guards_clear(struct dalcs_radau_part *part, const double *coefficient);

/* Does just one fall, up to `end` in steps, and no other? Then it is part->crossed. *theta: when; `end` where none
 * does at all. A pair that has just changed sides may begin at 0. */
bool dalcs_guards_plain(struct dalcs_radau_part *part, const double *coefficient, double end,
                        double *theta);

/* Of a step of length part->segment.h in the present mode: sign times each coefficient of this guard is above *bound, in V
 * or A, where it is as clear as that. false: a switch by itself, which has none. */
bool dalcs_guards_clearance(const struct dalcs_radau_part *part, int guard, double *sign,
                            double *bound);

#endif
