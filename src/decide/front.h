/* front.h - a pair closes onto what was at rest: which diodes behind it close with it.
 *
 * In a chain of diodes at rest each carries something from the moment on that the first one does, the
 * farther the less. No guard sees that before it has grown to the error, and to learn of one after the
 * other would take a step each. So the signs of the equations are followed from the pair that closes
 * through all that is at rest; their result is a guess of the mode, which is checked as any other. */
#ifndef DALCS_FRONT_H
#define DALCS_FRONT_H

#include "radau_state.h"

/* Of a large part, after pairs have changed sides at the end of the segment before, from the mode
 * part->memory.modes_before: closes the diodes that a front goes through. *found: there are any. */
enum dalcs_status dalcs_front_close(struct dalcs_radau_part *part, bool *found) DALCS_MUST_CHECK;

#endif
