/* csv_cells.h - one cell after the other of a table with commas. */
#ifndef DALCS_CSV_CELLS_H
#define DALCS_CSV_CELLS_H

#include "decimal.h"

#include <stdio.h>

struct dalcs_csv_cells {
    FILE *out;
    const struct dalcs_decimal *decimal;
    size_t n; /* in this line so far */
};

/* In quotes where it needs them. */
void dalcs_csv_text(struct dalcs_csv_cells *cells, const char *text, size_t length);
void dalcs_csv_number(struct dalcs_csv_cells *cells, double value);
void dalcs_csv_end(struct dalcs_csv_cells *cells);

#endif
