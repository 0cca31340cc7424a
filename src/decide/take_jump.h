/* take_jump.h - a jump that is known becomes the state of its part, and is told. */
#ifndef DALCS_TAKE_JUMP_H
#define DALCS_TAKE_JUMP_H

#include "radau_state.h"

/* part->x becomes r->base->jump.after. part->work.y2 is the second of two micro-steps of length h, the last ones. */
enum dalcs_status dalcs_take_jump(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  double h) DALCS_MUST_CHECK;

#endif
