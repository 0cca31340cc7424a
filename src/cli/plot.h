/* plot.h - a file of waveforms that a command has just written, drawn as `dalcs plot` draws it. */
#ifndef DALCS_PLOT_H
#define DALCS_PLOT_H

#include "cli.h"

/* With the events, or the margins of the loop, that the report of the run has. Messages go to cli->err. */
enum dalcs_status dalcs_cli_draw_file(const struct dalcs_cli *cli, const char *file,
                                      const char *output, const struct dalcs_report *report,
                                      bool quiet) DALCS_MUST_CHECK;

#endif
