/* paths.h - the files that a run names: what it reads must be there, what it writes must overwrite
 * neither that nor another result. */
#ifndef DALCS_PATHS_H
#define DALCS_PATHS_H

#include "arguments.h"

/* Messages go to cli->err. Touches no file. */
enum dalcs_status dalcs_paths_check(const struct dalcs_cli *cli,
                                    const struct dalcs_arguments *arguments) DALCS_MUST_CHECK;

#endif
