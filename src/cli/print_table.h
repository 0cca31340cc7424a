/* print_table.h - the tables of .print and .plot in batch mode, as ngspice prints them. */
#ifndef DALCS_PRINT_TABLE_H
#define DALCS_PRINT_TABLE_H

#include "dalcs.h"

#include <stdio.h>

struct dalcs_print_table {
    FILE *out; /* NULL: print nothing */
    const struct dalcs_plot *plot;
    size_t n_rows;
};

void dalcs_print_table_begin(struct dalcs_print_table *table, const struct dalcs_plot *plot);
void dalcs_print_table_row(struct dalcs_print_table *table, double time, const double *value);

#endif
