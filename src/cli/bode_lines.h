/* bode_lines.h - `dalcs bode`: its help, and what it says of a response. */
#ifndef DALCS_BODE_LINES_H
#define DALCS_BODE_LINES_H

#include "dalcs.h"

#include <stdio.h>

extern const char dalcs_bode_help[];

/* The orbit's frequency, the margins of a loop; nothing without a response around an orbit. */
void dalcs_bode_lines_write(FILE *out, const struct dalcs_report *report);

#endif
