/* start_file.h - .spiceinit: commands that ngspice's users have it execute before anything else. */
#ifndef DALCS_START_FILE_H
#define DALCS_START_FILE_H

#include "status.h"

/* Zero-initialise. */
struct dalcs_start_file {
    char *path, *text; /* heap; NULL: there is none */
    char *at;          /* behind the last command; NULL: before the first */
    int line;          /* of the last command, from 1 */
};

/* Reads ./.spiceinit, else that of the user's home, as ngspice does. One that cannot be read is none. */
enum dalcs_status dalcs_start_file_read(struct dalcs_start_file *file) DALCS_MUST_CHECK;

/* The next `set` or `unset`, without comments and the blanks around it; NULL: that was all. For other commands
 * there is no shell or no circuit yet: `left_out` is told of each. */
const char *dalcs_start_file_next(struct dalcs_start_file *file,
                                  void (*left_out)(void *user, const struct dalcs_start_file *file,
                                                   const char *command),
                                  void *user);

void dalcs_start_file_finish(struct dalcs_start_file *file);

#endif
