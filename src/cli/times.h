/* times.h - the output times of `--at`. */
#ifndef DALCS_TIMES_H
#define DALCS_TIMES_H

#include "arguments.h"

struct dalcs_times {
    double *time; /* [n] ascending, s */
    size_t n;
};

/* Those of the file, one time a line up to `stop`, SPICE suffixes allowed, blank lines and lines starting with # or *
 * skipped; and those that are listed. None: n is 0. Messages go to cli->err. */
enum dalcs_status dalcs_times_read(struct dalcs_times *times, const struct dalcs_cli *cli,
                                   const struct dalcs_arguments *arguments,
                                   double stop) DALCS_MUST_CHECK;

void dalcs_times_finish(struct dalcs_times *times);

#endif
