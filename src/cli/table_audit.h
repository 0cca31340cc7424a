/* table_audit.h - what leaves the program of rows, checked once more: the table of the summary, and a row of each file.
 *
 * One signal of a plot, which is drawn, is added up a second time, and one row, which is drawn likewise, is kept and looked
 * for in the files that were written. Both cost little beside writing a row. */
#ifndef DALCS_TABLE_AUDIT_H
#define DALCS_TABLE_AUDIT_H

#include "cli.h"
#include "measure.h"
#include "table.h"

#include <stdint.h>

struct dalcs_table_audit_sums {
    const struct dalcs_plot *plot; /* borrowed; NULL: none over time */
    uint64_t seed;
    size_t n_rows;
    size_t signal;      /* that is added up */
    double time, value; /* of the last row */
    double first, least, most;
    double mean, square; /* integrals of the lines between rows, and of their squares */
    size_t kept;         /* the number of the row that is kept */
    double *row;         /* [1 + n_signals] its time and values; heap */
};

enum dalcs_status dalcs_table_audit_begin(struct dalcs_table_audit_sums *a,
                                          const struct dalcs_plot *plot) DALCS_MUST_CHECK;
void dalcs_table_audit_row(struct dalcs_table_audit_sums *a, double time, const double *value);

/* Against what the summary says; DALCS_E_INTERNAL, and a message, where it says something else. */
enum dalcs_status dalcs_table_audit_summary(const struct dalcs_table_audit_sums *a,
                                            const struct dalcs_measure *measure,
                                            const struct dalcs_cli *cli) DALCS_MUST_CHECK;

/* The kept row in a file that is complete and has nothing but this plot. */
enum dalcs_status dalcs_table_audit_file(const struct dalcs_table_audit_sums *a,
                                         const struct dalcs_table_format *format, const char *path,
                                         const struct dalcs_cli *cli) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_table_audit_finish(struct dalcs_table_audit_sums *a);

#endif
