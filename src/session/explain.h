/* explain.h - numerical failures in words. Private to this folder. */
#ifndef DALCS_EXPLAIN_H
#define DALCS_EXPLAIN_H

#include "status.h"

#include <stdbool.h>

struct dalcs_circuit;
struct dalcs_component;
struct dalcs_euler;
struct dalcs_location;
struct dalcs_run;
struct dalcs_session;

/* Is it what holds a voltage of .ic at a start? Then this may help. */
bool dalcs_is_initial(const char *element);
extern const char dalcs_leave_initial[];

/* Where the netlist has an element; NULL when it is no device. */
const struct dalcs_location *dalcs_place_of(const struct dalcs_circuit *circuit,
                                            const char *element);

/* "KCL at out", "branch v1", "complementarity of d1"; NULL when out of memory. `where` is a row, or a
 * pair behind them, of a system of e's network, which need not be the session's. */
const char *dalcs_explain_row(struct dalcs_session *session, const struct dalcs_euler *e,
                              int system, int where);

/* Did the run end where a formula has no value? */
bool dalcs_failed_at_pole(const struct dalcs_euler *e, enum dalcs_status status);

/* Puts a numerical failure of e into words, into the report and, if wanted, into a dump. Other
 * statuses explain themselves elsewhere. Returns the status; instead of DALCS_INFEASIBLE, DALCS_NOT_CONVERGED where
 * no witness could be verified, or DALCS_E_NOMEM. */
enum dalcs_status dalcs_explain_failure(struct dalcs_run *r, const struct dalcs_euler *e,
                                        enum dalcs_status status) DALCS_MUST_CHECK;

/* No position of c->failure.restless agrees with its control. */
void dalcs_explain_restless(struct dalcs_session *s, const struct dalcs_component *c,
                            const char *when);

/* Newton's method has found no values of smooth functions that agree with what they read. */
void dalcs_explain_smooth(struct dalcs_session *s, const struct dalcs_component *c,
                          const char *when);

#endif
