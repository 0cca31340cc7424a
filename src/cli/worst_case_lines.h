/* worst_case_lines.h - what .wcase says, in a table for people and in rows. */
#ifndef DALCS_WORST_CASE_LINES_H
#define DALCS_WORST_CASE_LINES_H

#include "cli.h"
#include "csv_cells.h"

/* Nothing where there is none. */
void dalcs_worst_case_lines_write(FILE *out, const struct dalcs_report *report);

/* The cells of run `run` that follow those of --set: values of the tolerances, measurements, what failed. */
void dalcs_worst_case_write_header(struct dalcs_csv_cells *cells,
                                   const struct dalcs_report *report);
void dalcs_worst_case_write_row(struct dalcs_csv_cells *cells, const struct dalcs_report *report,
                                size_t run);

/* Writes the number of failed runs and the reason of the first; DALCS_OK: none. */
enum dalcs_status dalcs_worst_case_tell_failed(const struct dalcs_cli *cli,
                                               const struct dalcs_report *report);

#endif
