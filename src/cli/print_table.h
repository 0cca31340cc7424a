/* print_table.h - the tables of .print and .plot in batch mode, as ngspice prints them. */
#ifndef DALCS_PRINT_TABLE_H
#define DALCS_PRINT_TABLE_H

#include "dalcs.h"

#include <stdio.h>

/* Zero-initialise, then set `out`. */
struct dalcs_print_table {
    FILE *out; /* NULL: print nothing */
    const struct dalcs_plot *plot;

    struct dalcs_print_card_table {
        size_t n_columns;

        struct dalcs_print_table_column {
            size_t signal; /* of the plot */
            const char *title;
            enum dalcs_print_part part;
        } * column; /* [n_columns] heap */

        double *kept; /* rows until it is their turn: the scale, then two numbers each; heap */
        size_t n_kept, capacity;
        size_t n_rows;
    } * table; /* [n_tables] heap; the first one is printed row by row */

    size_t n_tables;
};

/* One table for each card of the session that shows this analysis; all signals where there is no card
 * at all. An operating point is printed as a list besides. */
enum dalcs_status dalcs_print_table_begin(struct dalcs_print_table *print,
                                          const struct dalcs_session *session,
                                          const struct dalcs_plot *plot) DALCS_MUST_CHECK;
enum dalcs_status dalcs_print_table_row(struct dalcs_print_table *print, double scale,
                                        const double *value) DALCS_MUST_CHECK;

/* The tables that had to wait. */
void dalcs_print_table_end(struct dalcs_print_table *print);
/* Prints what an interrupted run has left in them. */
void dalcs_print_table_finish(struct dalcs_print_table *print);

#endif
