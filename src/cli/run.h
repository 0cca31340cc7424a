/* run.h - one run, whichever command line it comes from. */
#ifndef DALCS_CLI_RUN_H
#define DALCS_CLI_RUN_H

#include "arguments.h"

/* The paths have been checked. Runs the netlist, prints and writes what there is. */
enum dalcs_status dalcs_cli_run_arguments(const struct dalcs_cli *cli,
                                          const struct dalcs_arguments *arguments) DALCS_MUST_CHECK;

#endif
