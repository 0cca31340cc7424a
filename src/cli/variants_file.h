/* variants_file.h - the table of many variants, row by row: what is there stays, whatever ends the run.
 *
 * While it grows it is "out.partial.csv"; whole, it gets its name. */
#ifndef DALCS_VARIANTS_FILE_H
#define DALCS_VARIANTS_FILE_H

#include "cli.h"

#include <stdio.h>

/* Zero-initialise. */
struct dalcs_variants_file {
    const char *path;
    char *partial; /* owned */
    FILE *stream;
    bool is_complete; /* a table of that name is there already, and was to be gone on with */
    size_t n_rows;    /* of an earlier run, that stay */
    size_t n_failed;  /* of these: with a reason in the last column */
};

/* The first columns of row `row` of the table, counted from 0; heap, NULL: out of memory. */
typedef char *dalcs_variant_begins(void *user, size_t row);

/* Opens the partial table and writes the header, which ends with a newline; resume: keeps the rows that are there, which
 * must be of these variants. Messages go to cli->err. */
enum dalcs_status dalcs_variants_file_open(struct dalcs_variants_file *file,
                                           const struct dalcs_cli *cli, const char *header,
                                           bool resume, dalcs_variant_begins *begins,
                                           void *user) DALCS_MUST_CHECK;

/* A row with its newline, on the disk when this returns. */
enum dalcs_status dalcs_variants_file_row(struct dalcs_variants_file *file,
                                          const char *row) DALCS_MUST_CHECK;

/* All rows are there: gives it its name. */
enum dalcs_status dalcs_variants_file_commit(struct dalcs_variants_file *file) DALCS_MUST_CHECK;

void dalcs_variants_file_finish(struct dalcs_variants_file *file);

#endif
