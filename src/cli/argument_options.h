/* argument_options.h - the options of `dalcs run`, as getopt_long finds them. */
#ifndef DALCS_ARGUMENT_OPTIONS_H
#define DALCS_ARGUMENT_OPTIONS_H

#include "arguments.h"

/* Reads all options up to --help. It leaves optind at the words that are no options. */
enum dalcs_status dalcs_arguments_read_options(struct dalcs_arguments *arguments,
                                               const struct dalcs_cli *cli, int argc,
                                               char **argv) DALCS_MUST_CHECK;

/* "run", "steady", "bode" or "envelope". */
const char *dalcs_arguments_verb(const struct dalcs_arguments *arguments);

#endif
