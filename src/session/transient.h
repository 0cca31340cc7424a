/* transient.h - what the files of a transient share. */
#ifndef DALCS_TRANSIENT_H
#define DALCS_TRANSIENT_H

#include "session_internal.h"

struct dalcs_audit_run;
struct dalcs_energy;
struct dalcs_logic_run;
struct dalcs_measures;
struct dalcs_schedule;

/* Whether a source jumps at t. */
bool dalcs_sources_jump(const struct dalcs_circuit *circuit, double t);

/* Whether there is more than one row at t = 0: a source jumps there, or a switch that sources control moves. Before the
 * start; without radau (NULL) steps see the second alone at their ends. */
bool dalcs_transient_begins_with_a_jump(const struct dalcs_circuit *circuit,
                                        struct dalcs_radau *radau);

/* Gates at t; a loop of them that does not settle is refused. */
enum dalcs_status dalcs_transient_decide(struct dalcs_run *r, struct dalcs_logic_run *logic,
                                         double t) DALCS_MUST_CHECK;

/* Steps between calls of the sink's progress. */
long dalcs_transient_progress_interval(const struct dalcs_network *n);

/* From a start to the end with one of the Radau methods. */
enum dalcs_status dalcs_transient_walk(struct dalcs_run *r, struct dalcs_radau *radau,
                                       struct dalcs_measures *measures,
                                       struct dalcs_audit_run *audit,
                                       struct dalcs_logic_run *logic) DALCS_MUST_CHECK;

/* Rows further apart than half a period do not show a sine, nor do averages over them. `since` when there are no
 * others; INFINITY: never. */
void dalcs_transient_warn_of_coarse_rows(struct dalcs_run *r, const struct dalcs_schedule *schedule,
                                         double since);

/* Which method each component goes with, and why. */
enum dalcs_status dalcs_transient_report_methods(struct dalcs_run *r,
                                                 const struct dalcs_radau *radau) DALCS_MUST_CHECK;

/* What a run with one of the Radau methods took, and notes of what was odd. */
void dalcs_transient_add_radau_work(struct dalcs_run *r, const struct dalcs_radau *radau);

/* The ledger into the report. Where it does not add up, an equation was not what its devices are, or a
 * step went where it should not. */
enum dalcs_status dalcs_transient_close_ledger(struct dalcs_run *r, struct dalcs_energy *energy,
                                               struct dalcs_euler *e,
                                               struct dalcs_radau *radau) DALCS_MUST_CHECK;

#endif
