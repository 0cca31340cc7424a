/* csv_cells.c - cells, with quotes around those that hold commas or quotes. */
#include "csv_cells.h"

#include <stdbool.h>
#include <string.h>

void dalcs_csv_text(struct dalcs_csv_cells *cells, const char *text, size_t length) {
    fputs(cells->n++ > 0 ? "," : "", cells->out);
    const bool quotes = memchr(text, ',', length) != NULL || memchr(text, '"', length) != NULL;
    fputs(quotes ? "\"" : "", cells->out);
    for (size_t k = 0; k < length; k++) {
        fputs(text[k] == '"' ? "\"" : "", cells->out);
        fputc(text[k], cells->out);
    }
    fputs(quotes ? "\"" : "", cells->out);
}

void dalcs_csv_number(struct dalcs_csv_cells *cells, double value) {
    char text[DALCS_DECIMAL_SIZE];
    const size_t length = dalcs_decimal_write(cells->decimal, value, text);
    dalcs_csv_text(cells, text, length);
}

void dalcs_csv_end(struct dalcs_csv_cells *cells) {
    fputc('\n', cells->out);
    cells->n = 0;
}
