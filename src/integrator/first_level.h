/* first_level.h - how long the first step of a mode is. */
#ifndef DALCS_FIRST_LEVEL_H
#define DALCS_FIRST_LEVEL_H

#include "radau_state.h"

/* The rung of the ladder of lengths to begin with behind an event. A mode that has been before, though not after this one, may
 * have the map of a longer step that suited it then, or the factors of a shorter one: it costs less to begin with that. Else
 * with a step as long as those before. */
int dalcs_first_level(struct dalcs_radau_part *part);

#endif
