/* orbit_analyses.h - .pss, .ac and .tran behind it, .env: what a session runs of them, and readies for them. */
#ifndef DALCS_ORBIT_ANALYSES_H
#define DALCS_ORBIT_ANALYSES_H

#include "session_internal.h"

/* For a netlist that has asked for no waveforms: its network with what an audit reads. */
enum dalcs_status dalcs_steady_prepare(struct dalcs_session *session) DALCS_MUST_CHECK;

/* Before step `step` of .step is built: the orbit of its anchor, if the analysis needs it and it is not known yet. */
enum dalcs_status dalcs_steady_anchor_prepare(struct dalcs_session *s,
                                              const struct dalcs_run_options *options,
                                              const struct dalcs_sink *sink,
                                              enum dalcs_analysis analysis,
                                              size_t step) DALCS_MUST_CHECK;
void dalcs_steady_anchor_forget(struct dalcs_session *s);

/* Before a run with these options: an anchor of other ones is none. */
void dalcs_steady_anchor_enter(struct dalcs_session *s, const struct dalcs_run_options *options);

/* Before a run that measures the gain of a loop by a current as well: adds the source of the current to the circuit. */
enum dalcs_status
dalcs_periodic_loop_prepare(struct dalcs_session *session,
                            const struct dalcs_run_options *options) DALCS_MUST_CHECK;

/* Runs .pss into r->sink. */
enum dalcs_status dalcs_steady_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Frees r->known. */
void dalcs_steady_forget(struct dalcs_run *r);

/* DALCS_E_NETLIST and a message where a switch follows a clock, which .ac around an operating point would not see. */
enum dalcs_status dalcs_commanded_ac_refuse(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Runs .ac around that orbit into r->sink. */
enum dalcs_status dalcs_periodic_ac_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Runs the .tran that starts on such an orbit. */
enum dalcs_status dalcs_steady_leave(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Runs .env into r->sink. */
enum dalcs_status dalcs_envelope_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Makes a .env of the options of the run (envelope_asked.c). */
enum dalcs_status dalcs_envelope_ask(struct dalcs_run *r) DALCS_MUST_CHECK;

#endif
