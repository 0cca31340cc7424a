/* report.h - what a run did, as JSON. */
#ifndef DALCS_REPORT_H
#define DALCS_REPORT_H

#include "dalcs.h"

#include <stdio.h>

/* Writes the report of a run that ended with `status`. Errors stay in the stream. */
void dalcs_report_write(FILE *stream, const struct dalcs_report *report, enum dalcs_status status);

#endif
