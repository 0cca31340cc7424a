/* atomic_file.h - an output file that appears under its name only when it is complete. */
#ifndef DALCS_ATOMIC_FILE_H
#define DALCS_ATOMIC_FILE_H

#include "dalcs.h"

#include <stdio.h>
#include <sys/types.h>

/* Zero-initialise. After a failure `error` is the errno and `path` (if not NULL) the file meant. */
struct dalcs_atomic_file {
    FILE *stream;    /* NULL when not open */
    char *path;      /* where it will be, symbolic links followed */
    char *temporary; /* where it is: in the same folder, "out.csv.partial-XXXXXX" */
    char *buffer;    /* of stream */
    int error;
};

/* Is the path "-"? What is written there appears at once, when it is complete or kept. */
bool dalcs_is_standard_output(const char *path);

/* Opens a temporary file next to `path`. Refuses a path that is something else than a plain file,
 * or a plain file that may not be written. */
enum dalcs_status dalcs_atomic_file_open(struct dalcs_atomic_file *file,
                                         const char *path) DALCS_MUST_CHECK;

/* Closes and gives the file its name, replacing what was there. On failure nothing is left of the
 * new file and the old one is untouched. */
enum dalcs_status dalcs_atomic_file_commit(struct dalcs_atomic_file *file) DALCS_MUST_CHECK;

/* Closes a file whose contents stop early and leaves it as "out.partial.csv". *left_at (free() it)
 * says where; NULL on failure, and then nothing is left. */
enum dalcs_status dalcs_atomic_file_keep(struct dalcs_atomic_file *file,
                                         char **left_at) DALCS_MUST_CHECK;

/* "dir/out.csv" -> "dir/out.partial.csv"; NULL when out of memory; free() it. */
char *dalcs_partial_name(const char *path);

/* After a write that failed: what the system took of the stream so far, and no more, is at `descriptor`
 * (the file's own), `size` bytes from its start. */
enum dalcs_status dalcs_atomic_file_recover(struct dalcs_atomic_file *file, int *descriptor,
                                            off_t *size) DALCS_MUST_CHECK;

/* Removes what was written, if anything. Accepts a zeroed file and leaves one; `error` is kept. */
void dalcs_atomic_file_discard(struct dalcs_atomic_file *file);

#endif
