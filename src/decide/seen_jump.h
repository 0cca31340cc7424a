/* seen_jump.h - a jump that no problem without time tells: what sources that read act on. */
#ifndef DALCS_SEEN_JUMP_H
#define DALCS_SEEN_JUMP_H

#include "radau_state.h"

/* part->x becomes the limit of what vanishing micro-steps see, from those of length h (s), and the jump is told. Where they
 * see a fast transient and no jump, part->x stays. The last micro-steps tell the mode. */
enum dalcs_status dalcs_take_seen_jump(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double h) DALCS_MUST_CHECK;

#endif
