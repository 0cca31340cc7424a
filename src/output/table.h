/* table.h - the rows of a run, streamed into a file in one of several formats. */
#ifndef DALCS_TABLE_H
#define DALCS_TABLE_H

#include "atomic_file.h"

/* A file format. The stream is seekable; errors stay in it, and the table looks. `state` is
 * state_size zeroed bytes. */
struct dalcs_table_format {
    const char *extension; /* ".csv" */
    size_t state_size;
    bool one_plot; /* can hold a single table, that of the main analysis when there are several */
    enum dalcs_status (*begin)(void *state, FILE *stream, const struct dalcs_plot *plot);
    /* n rows, their values one row after the other. */
    void (*rows)(void *state, FILE *stream, size_t n, const double *time, const double *value);
    /* Also called when the run was cut short, so that what is there can be read. */
    void (*end)(void *state, FILE *stream);
    /* How many of the file's first `size` bytes, all that the disk took, are whole rows and what they
     * need to be read; 0: none. Puts right what `end` would have. */
    off_t (*recover)(const void *state, int descriptor, off_t size);
    void (*finish)(void *state);
};

extern const struct dalcs_table_format dalcs_csv_format;
extern const struct dalcs_table_format dalcs_raw_format;
extern const struct dalcs_table_format dalcs_raw_ascii_format; /* the same file as text */

struct dalcs_table {
    const struct dalcs_table_format *format;
    const char *path; /* borrowed, as given */
    struct dalcs_atomic_file file;
    void *state;
    size_t n_rows; /* over all plots */
    bool in_plot;
    bool skipping; /* this plot is not for this file */
    enum dalcs_analysis main;
    bool splits_steps; /* each step of .step is a plot of its own */
    bool has_plot;     /* one of the main analysis was begun */
    size_t n_left_out; /* plots of the main analysis with no room left */
};

/* The format for a file name, by its extension in any case; NULL when there is none. */
const struct dalcs_table_format *dalcs_table_find_format(const char *path);

/* Touches no file: that waits for the first row of results. main: the main analysis that will come; a
 * format with room for one plot leaves the others out. */
enum dalcs_status dalcs_table_init(struct dalcs_table *table, const char *path,
                                   enum dalcs_analysis main) DALCS_MUST_CHECK;

/* The same in a given format; NULL is DALCS_E_OPTION. */
enum dalcs_status dalcs_table_init_as(struct dalcs_table *table, const char *path,
                                      const struct dalcs_table_format *format,
                                      enum dalcs_analysis main) DALCS_MUST_CHECK;

/* The callbacks of struct dalcs_sink. After DALCS_E_IO, table->file.error is the errno. */
enum dalcs_status dalcs_table_begin(struct dalcs_table *table, const struct dalcs_plot *plot);
enum dalcs_status dalcs_table_end(struct dalcs_table *table);

enum dalcs_status dalcs_table_rows(struct dalcs_table *table, size_t n, const double *time,
                                   const double *value);

/* All rows are with the system. */
enum dalcs_status dalcs_table_flush(struct dalcs_table *table) DALCS_MUST_CHECK;

/* Gives the complete file its name. */
enum dalcs_status dalcs_table_commit(struct dalcs_table *table) DALCS_MUST_CHECK;

/* Leaves what an interrupted run had, or what went onto a disk before it was full, under a name that
 * says so; *left_at (free() it) is NULL when there was nothing or it could not be written. */
enum dalcs_status dalcs_table_keep(struct dalcs_table *table, char **left_at) DALCS_MUST_CHECK;

/* Accepts a zeroed table. A file neither committed nor kept is removed. */
void dalcs_table_finish(struct dalcs_table *table);

#endif
