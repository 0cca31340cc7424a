/* unused_options.h - what the command line asks for and a run cannot give. */
#ifndef DALCS_UNUSED_OPTIONS_H
#define DALCS_UNUSED_OPTIONS_H

#include "arguments.h"

/* Warns of options that this netlist, or the other ones, leave without an effect. main: the analysis whose rows a file
 * with room for one holds. */
void dalcs_unused_options_warn(const struct dalcs_cli *cli, const struct dalcs_arguments *arguments,
                               const struct dalcs_session *session, enum dalcs_analysis main);

#endif
