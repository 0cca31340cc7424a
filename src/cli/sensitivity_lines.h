/* sensitivity_lines.h - what .sens says, in a table. */
#ifndef DALCS_SENSITIVITY_LINES_H
#define DALCS_SENSITIVITY_LINES_H

#include "dalcs.h"

#include <stdio.h>

/* Writes the change of each result in per cent for one per cent of each value; nothing without .sens. */
void dalcs_sensitivity_lines_write(FILE *out, const struct dalcs_report *report);

#endif
