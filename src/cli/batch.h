/* batch.h - ngspice's command line. */
#ifndef DALCS_BATCH_H
#define DALCS_BATCH_H

#include "cli.h"

/* Is there a -b? */
bool dalcs_cli_is_batch(int argc, char **argv);

enum dalcs_exit dalcs_cli_batch(const struct dalcs_cli *cli, int argc, char **argv);

/* The same where the program is called ngspice: -b is not needed. */
enum dalcs_exit dalcs_cli_ngspice(const struct dalcs_cli *cli, int argc, char **argv);

#endif
