/* runs.h - the runs of a sweep, one behind the other in a table, as tables of their own. */
#ifndef DALCS_RUNS_H
#define DALCS_RUNS_H

#include "waveforms.h"

/* Zero-initialise; finish frees everything. */
struct dalcs_runs {
    size_t n;                          /* 0: there is one run, or an axis descends */
    struct dalcs_waveforms *waveforms; /* [n] the rows of each, borrowed */
    const char **
        label; /* [n] what changes from run to run and not within one, "load = 200"; else "run 2" */
    struct dalcs_arena arena;
};

/* Of all rows of a table, which lives as long. */
enum dalcs_status dalcs_runs_find(struct dalcs_runs *runs,
                                  const struct dalcs_waveforms *all) DALCS_MUST_CHECK;

void dalcs_runs_finish(struct dalcs_runs *runs);

#endif
