/* raw_header.h - one plot of a raw file: what its header says, and where its numbers are. */
#ifndef DALCS_RAW_HEADER_H
#define DALCS_RAW_HEADER_H

#include <stdbool.h>
#include <stddef.h>

/* One plot of a file. */
struct dalcs_raw_plot {
    const char *title, *name, *variables; /* places in the text; NULL: not there */
    bool complex_values, ascii;
    bool is_ltspice, says_double, by_signal;
    double offset; /* of the axis */
    size_t n_variables, n_points;
    const char *data;
};

struct dalcs_raw_text {
    const char *at, *end;
};

/* The next line without its end; false at the end of the text. */
bool dalcs_raw_next_line(struct dalcs_raw_text *text, const char **line, size_t *length);

/* Stops behind "Binary:" or "Values:"; plot->data stays NULL where the text ends before. */
void dalcs_raw_read_header(struct dalcs_raw_plot *plot, struct dalcs_raw_text *text);

/* Are its values, but for the axis, of 4 bytes? */
bool dalcs_raw_is_single(const struct dalcs_raw_plot *plot);

/* Goes to where the header of the next plot starts, and counts the points before it. */
void dalcs_raw_skip_points(struct dalcs_raw_plot *plot, struct dalcs_raw_text *text);

#endif
