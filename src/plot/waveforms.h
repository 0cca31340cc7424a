/* waveforms.h - a table of results read back from a file: of ours, of ngspice, of anything that
 * writes SPICE's raw files or comma-separated values. */
#ifndef DALCS_WAVEFORMS_H
#define DALCS_WAVEFORMS_H

#include "dalcs.h"
#include "diag.h"
#include "digits.h"
#include "dimension.h"

/* Zero-initialise; finish frees everything. */
struct dalcs_waveforms {
    const char *title;     /* "" where the file has none */
    const char *plot_name; /* "Transient Analysis" */
    size_t n_columns;      /* at least 1; column 0 is the axis: time, frequency or what was swept */
    const char **name;     /* [n_columns], as in the file */
    struct dalcs_dimension *dimension; /* [n_columns] */
    struct dalcs_precision
        *precision;              /* [n_columns] what a number x may be off by, for its digits */
    struct dalcs_digits *digits; /* [n_columns] of text, while it is read */
    size_t n_rows;
    double *value;       /* [n_rows * n_columns], row after row */
    size_t n_plots;      /* in the file */
    size_t plot;         /* which one of them this is, from 1 */
    bool complex_values; /* a column is followed by its phase */
    struct dalcs_arena arena;
};

/* Reads a file by what is in it, not by its name. `plot` counts from 1; 0 takes the last one with
 * more than one row, else the last. DALCS_E_IO: it cannot be read; DALCS_E_OPTION: it is no such
 * file or has no such plot. Both come with a message. */
enum dalcs_status dalcs_waveforms_read_file(struct dalcs_waveforms *waveforms, const char *path,
                                            size_t plot, struct dalcs_diag *diag) DALCS_MUST_CHECK;
enum dalcs_status dalcs_waveforms_read_text(struct dalcs_waveforms *waveforms, const char *path,
                                            const char *text, size_t length, size_t plot,
                                            struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The two formats; text is NUL-terminated at text[length]. */
bool dalcs_waveforms_is_raw(const char *text, size_t length);
enum dalcs_status dalcs_waveforms_read_raw(struct dalcs_waveforms *waveforms, const char *path,
                                           const char *text, size_t length, size_t plot,
                                           struct dalcs_diag *diag) DALCS_MUST_CHECK;
enum dalcs_status dalcs_waveforms_read_csv(struct dalcs_waveforms *waveforms, const char *path,
                                           const char *text, size_t length,
                                           struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Makes room for `capacity` columns without names and rows. */
enum dalcs_status dalcs_waveforms_set_columns(struct dalcs_waveforms *waveforms,
                                              size_t n_columns) DALCS_MUST_CHECK;

/* Where the axis turns back several runs follow one another: the rows [*first, *end) of run `run`,
 * from 1; returns how many runs there are. A descending run is one as well. */
size_t dalcs_waveforms_find_run(const struct dalcs_waveforms *waveforms, size_t run, size_t *first,
                                size_t *end);

/* Keeps the rows [first, end), in ascending order of the axis. */
void dalcs_waveforms_keep_rows(struct dalcs_waveforms *waveforms, size_t first, size_t end);

void dalcs_waveforms_finish(struct dalcs_waveforms *waveforms);

#endif
