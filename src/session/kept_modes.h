/* kept_modes.h - the modes of an engine, handed on to another one. */
#ifndef DALCS_KEPT_MODES_H
#define DALCS_KEPT_MODES_H

#include "euler.h"

struct dalcs_kept_modes {
    int n_systems, *n_pairs; /* heap: [n_systems] */
    uint64_t **mode;         /* heap: [n_systems][n_words] */
};

/* Those of e; what was kept before goes. */
enum dalcs_status dalcs_kept_modes_take(struct dalcs_kept_modes *kept,
                                        const struct dalcs_euler *e) DALCS_MUST_CHECK;

/* A first guess, where the pairs are the same: the answer is verified again. Switches with hysteresis keep their sides by
 * it. */
void dalcs_kept_modes_hand_on(const struct dalcs_kept_modes *kept, struct dalcs_euler *e);

void dalcs_kept_modes_finish(struct dalcs_kept_modes *kept);

#endif
