/* report_reader.h - the events of a run, out of the report that it wrote. */
#ifndef DALCS_REPORT_READER_H
#define DALCS_REPORT_READER_H

#include "conduction.h"
#include "diag.h"
#include "margin_lines.h"

/* Adds the events and jumps of a file that `dalcs run --report` wrote. Errors come with a message;
 * DALCS_E_OPTION also where this program was built without a JSON library. */
enum dalcs_status dalcs_report_reader_read(const char *path, struct dalcs_conduction *conduction,
                                           struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The margins of a loop that the report has, or none. */
enum dalcs_status dalcs_report_reader_margins(const char *path, struct dalcs_margin_lines *lines,
                                              struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
