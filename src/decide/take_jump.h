/* take_jump.h - a jump that is known becomes the state of its part, and is told. */
#ifndef DALCS_TAKE_JUMP_H
#define DALCS_TAKE_JUMP_H

#include "radau_state.h"

/* The jump at part->segment.t into r->base->jump, as far as problems without time tell it; the rest is that of the last two
 * micro-steps, of length h (s), and part->work.after. */
enum dalcs_status dalcs_find_jump(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  double h) DALCS_MUST_CHECK;

/* part->x becomes r->base->jump.after. part->work.y2 is the second of two micro-steps of length h, the last ones. */
enum dalcs_status dalcs_take_jump(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  double h) DALCS_MUST_CHECK;

/* Is the exact jump of state x known? What sources that read act on jumps by more than problems without time tell. */
bool dalcs_jump_is_told(const struct dalcs_radau *r, const struct dalcs_radau_part *part, int x);

/* Does the exact jump, where it is known, move a state by more than the error that the state of an event has? */
bool dalcs_jump_is_noticeable(const struct dalcs_radau *r, const struct dalcs_radau_part *part);

#endif
