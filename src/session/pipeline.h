/* pipeline.h - what the files that run analyses share. */
#ifndef DALCS_PIPELINE_H
#define DALCS_PIPELINE_H

#include "session_internal.h"

enum { DALCS_N_IN_ORDER = 6 };

/* In the order in which they run. */
extern const enum dalcs_analysis dalcs_analyses_in_order[DALCS_N_IN_ORDER];

/* These analyses of the session's circuit, one after the other; step: the one of .step, or NULL. */
enum dalcs_status dalcs_run_analyses(struct dalcs_session *session,
                                     const struct dalcs_run_options *options,
                                     const struct dalcs_sink *sink, const struct dalcs_plot *step,
                                     const enum dalcs_analysis *analysis,
                                     size_t n) DALCS_MUST_CHECK;

/* Those that the netlist asks for, else the one that the options name. */
enum dalcs_status dalcs_run_asked(struct dalcs_session *session,
                                  const struct dalcs_run_options *options,
                                  const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* .wcase, after a run with all tolerances in the middle: the runs at their ends, into the report. */
enum dalcs_status dalcs_worst_case_run(struct dalcs_session *session,
                                       const struct dalcs_run_options *options,
                                       const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* Each analysis in all steps before the next one. */
enum dalcs_status dalcs_stepped_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* Switches that slid, and those that no command agreed with what followed from it. steps: of implicit Euler. */
void dalcs_run_warn_of_switches(struct dalcs_run *r, const struct dalcs_component *c, long steps);

/* Runs .op into r->sink. */
enum dalcs_status dalcs_operating_point_run(struct dalcs_run *r) DALCS_MUST_CHECK;

#endif
