/* table_audit.h - what leaves the program of rows, checked once more: the table of the summary, and a row of each file.
 *
 * What some rows add to one signal, all of which are drawn, is added up a second time. One row, which is drawn likewise, is
 * kept and looked for in the files that were written. Both cost little beside writing rows. */
#ifndef DALCS_TABLE_AUDIT_H
#define DALCS_TABLE_AUDIT_H

#include "cli.h"
#include "measure.h"
#include "table.h"

#include <stdint.h>

struct dalcs_table_audit_sums {
    const struct dalcs_plot *plot; /* borrowed; NULL: none over time */
    uint64_t seed;
    bool is_full;                /* all rows of a signal, else those that are drawn */
    size_t n_rows;               /* so far */
    size_t next_look, next_kept; /* rows: the next that are looked at, and the next that is kept */
    int n_looks;
    size_t signal; /* that is added up; before some rows and behind them: */
    struct dalcs_measure_signal before;
    double time, first; /* of the last row in front of them, and of the first of all */
    const char *wrong;  /* what of it is another number; NULL: nothing */
    size_t kept;        /* the number of the row that is kept */
    double *row;        /* [1 + n_signals] its time and values; heap */
};

enum dalcs_status dalcs_table_audit_begin(struct dalcs_table_audit_sums *a,
                                          const struct dalcs_plot *plot) DALCS_MUST_CHECK;

/* Is there anything to do about the next n rows? If not, only their number counts. */
static inline bool dalcs_table_audit_is_due(struct dalcs_table_audit_sums *a, size_t n) {
    const size_t until = a->n_rows + n;
    const bool is_due = a->is_full || until > a->next_look || until > a->next_kept;
    a->n_rows = is_due ? a->n_rows : until;
    return is_due;
}

/* Rows that are about to be measured, and that were. */
void dalcs_table_audit_before(struct dalcs_table_audit_sums *a,
                              const struct dalcs_measure *measure);
void dalcs_table_audit_after(struct dalcs_table_audit_sums *a, const struct dalcs_measure *measure,
                             size_t n, const double *time, const double *value);

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
