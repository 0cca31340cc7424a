/* steady_lines.h - `dalcs steady`: its help, and what it says of an orbit. */
#ifndef DALCS_STEADY_LINES_H
#define DALCS_STEADY_LINES_H

#include "dalcs.h"

#include <stdbool.h>
#include <stdio.h>

extern const char dalcs_steady_help[];

/* Period, verdict, multipliers; nothing without a steady state. is_last_step: they are those of the last of several steps. */
void dalcs_steady_lines_write(FILE *out, const struct dalcs_report *report, bool is_last_step);

#endif
