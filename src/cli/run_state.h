/* run_state.h - a run of `dalcs run` on its way, and what its parts do with it. */
#ifndef DALCS_RUN_STATE_H
#define DALCS_RUN_STATE_H

#include "arguments.h"
#include "bifurcation_chart.h"
#include "measures_file.h"
#include "outputs.h"
#include "print_table.h"
#include "progress.h"
#include "times.h"

struct dalcs_run {
    const struct dalcs_cli *cli;
    const struct dalcs_session *session; /* which runs */
    struct dalcs_outputs outputs;
    struct dalcs_measures_file measures;
    struct dalcs_print_table printed;
    struct dalcs_progress progress;
    double time;      /* s, how far the run has come */
    bool is_timeless; /* ... or not: its rows are points */
    bool has_script;  /* a .control block says what is run */
    double n_rows;    /* of .tran in each step at least; 0: not known */
    bool quiet;
    bool is_collected;
    struct dalcs_bifurcation_chart bifurcation;
};

/* The options of the command line, as the library takes them. */
struct dalcs_run_options dalcs_run_options_of(const struct dalcs_run *run,
                                              const struct dalcs_arguments *arguments,
                                              const struct dalcs_times *times);
/* Nobody looks at a row. */
void dalcs_run_leave_rows_out(struct dalcs_run_options *options);

struct dalcs_sink dalcs_run_sink(struct dalcs_run *run);

/* All is there that there is: of .step perhaps some have failed, and others have not. */
bool dalcs_run_is_whole(const struct dalcs_report *report, enum dalcs_status status);
void dalcs_run_tell(const struct dalcs_run *run, const struct dalcs_arguments *arguments,
                    const struct dalcs_report *report, enum dalcs_status status);
/* What a run of a script has measured: the next one has its own. `user` is the struct dalcs_run. */
void dalcs_run_tell_measured(void *user, struct dalcs_session *session, enum dalcs_status status);

/* The pictures that were asked for; but for losses they need the run's files. */
enum dalcs_status dalcs_run_draw(struct dalcs_run *run, const struct dalcs_arguments *arguments,
                                 const struct dalcs_report *report,
                                 bool has_files) DALCS_MUST_CHECK;

#endif
