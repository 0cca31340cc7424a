/* start_variables.h - what is set before a netlist in ngspice's place: by -D and in .spiceinit. */
#ifndef DALCS_START_VARIABLES_H
#define DALCS_START_VARIABLES_H

#include "arguments.h"
#include "start_file.h"

/* Zero-initialise but for the first two. What the arguments get of it lives as long as this. */
struct dalcs_start_variables {
    const struct dalcs_cli *cli; /* where notes go */
    struct dalcs_arguments *arguments;
    size_t capacity;
    struct dalcs_start_file file;
};

/* Takes "name" or "name=value". */
enum dalcs_status dalcs_start_variables_take(struct dalcs_start_variables *variables,
                                             const char *text) DALCS_MUST_CHECK;

/* Takes those of the user's .spiceinit, if there is one, and says so. */
enum dalcs_status
dalcs_start_variables_read(struct dalcs_start_variables *variables) DALCS_MUST_CHECK;

void dalcs_start_variables_finish(struct dalcs_start_variables *variables);

#endif
