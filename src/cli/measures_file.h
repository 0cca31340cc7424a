/* measures_file.h - the results of .meas as a table: one row for each step of .step, or one. */
#ifndef DALCS_MEASURES_FILE_H
#define DALCS_MEASURES_FILE_H

#include "arguments.h"
#include "atomic_file.h"

/* Zero-initialise. */
struct dalcs_measures_file {
    const char *path; /* NULL: no file, and all functions return at once */
    struct dalcs_atomic_file file;
    size_t n_steps;
    size_t n_parameters, n_drawn; /* of .step; random values */
    const char **name;            /* [n_parameters + n_drawn] of both, the session's; heap */
    double *value;                /* [n_steps * (n_parameters + n_drawn)]; heap */
};

/* Opens it, so that a path which cannot be written ends the run before it starts. */
enum dalcs_status dalcs_measures_file_open(struct dalcs_measures_file *m,
                                           const struct dalcs_cli *cli,
                                           const char *path) DALCS_MUST_CHECK;

/* Keeps what a step is, and what was drawn for it. */
enum dalcs_status dalcs_measures_file_plot(struct dalcs_measures_file *m,
                                           const struct dalcs_session *session,
                                           const struct dalcs_plot *plot) DALCS_MUST_CHECK;

/* Columns: what --set and .step set, then the measurements; "nan" where nothing was found. Under its name when the
 * run ended well, else nowhere. DALCS_E_IO comes with a message. */
enum dalcs_status dalcs_measures_file_close(struct dalcs_measures_file *m,
                                            const struct dalcs_cli *cli,
                                            const struct dalcs_arguments *arguments,
                                            const struct dalcs_report *report,
                                            bool is_whole) DALCS_MUST_CHECK;

#endif
