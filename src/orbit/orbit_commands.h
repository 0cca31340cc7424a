/* orbit_commands.h - how far small signals of sources move the commands at which spans end. */
#ifndef DALCS_ORBIT_COMMANDS_H
#define DALCS_ORBIT_COMMANDS_H

#include "orbit_log.h"

void dalcs_orbit_take_command(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span, int pair,
                              double t, bool *any);

/* Those that are due where the segment ends. */
void dalcs_orbit_find_commands(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span);

/* Where the period ends, of what begins with it: is there an event that small signals move? The last span has it then. */
bool dalcs_orbit_find_last(struct dalcs_orbit_part *p);

#endif
