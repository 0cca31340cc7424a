/* envelope_lines.h - `dalcs envelope`: its help, and what it says of the periods. */
#ifndef DALCS_ENVELOPE_LINES_H
#define DALCS_ENVELOPE_LINES_H

#include "dalcs.h"

#include <stdio.h>

extern const char dalcs_envelope_help[];

/* Writes the number of periods that were run; nothing without an envelope. */
void dalcs_envelope_lines_write(FILE *out, const struct dalcs_report *report);

#endif
