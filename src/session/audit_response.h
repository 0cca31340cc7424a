/* audit_response.h - frequencies of .ac under the laws of the elements (response.h). */
#ifndef DALCS_AUDIT_RESPONSE_H
#define DALCS_AUDIT_RESPONSE_H

#include "session_internal.h"

#include "audit_points.h"
#include "response.h"

#include <stdint.h>

/* The columns of one system, real and imaginary parts. */
struct dalcs_response_columns {
    const double *part[2];
};

struct dalcs_audit_response {
    struct dalcs_run *run;
    const struct dalcs_readout *readout; /* NULL: nothing is asked */
    struct dalcs_response_columns *of;   /* [n_systems] where the answers are */
    struct dalcs_response_audit laws;
    struct dalcs_response_values values;
    bool *is_there, *is_restless; /* [n_devices] */
    int *node_system;             /* [n_nodes] -1: 0 V */
    int n, next;                  /* frequencies; which is looked at next */
    uint64_t seed;
    struct dalcs_arena arena;
};

/* Around an operating point of the session's circuit, which is audited as such, its row apart; `of`: where the answers at n frequencies will be. Does nothing
 * with --audit off. DALCS_REFUTED, with a message, where the operating point is wrong. */
enum dalcs_status dalcs_audit_response_start(struct dalcs_audit_response *a, struct dalcs_run *r,
                                             const struct dalcs_solved_point *point,
                                             struct dalcs_response_columns *of,
                                             int n) DALCS_MUST_CHECK;

/* The k-th frequency, of which row[2 n_outputs] is written. DALCS_REFUTED, with a message, where a law is broken. */
enum dalcs_status dalcs_audit_response_look(struct dalcs_audit_response *a, int k, double frequency,
                                            const double *row) DALCS_MUST_CHECK;

/* ---- Around an orbit (audit_periodic.h) ---------------------------------------------------------- */

/* For what is written alone. */
enum dalcs_status dalcs_audit_response_rows(struct dalcs_audit_response *a, struct dalcs_run *r,
                                            const struct dalcs_euler *euler,
                                            struct dalcs_response_columns *of,
                                            int n) DALCS_MUST_CHECK;

/* Is the k-th frequency looked at? */
bool dalcs_audit_response_draws(struct dalcs_audit_response *a, int k);

/* a->values, from the answers. */
void dalcs_audit_response_read(struct dalcs_audit_response *a);

/* What has been found goes into the report, and the worst ends the run if it is too much. */
enum dalcs_status dalcs_audit_response_tell(struct dalcs_run *r, struct dalcs_response_audit *laws,
                                            double frequency) DALCS_MUST_CHECK;

/* An error, and DALCS_REFUTED. */
enum dalcs_status dalcs_audit_response_refute(struct dalcs_run *r, double frequency,
                                              const char *what, double off,
                                              const char *unit) DALCS_MUST_CHECK;

/* Is what is written what a->values has? */
enum dalcs_status dalcs_audit_response_row(struct dalcs_audit_response *a, double frequency,
                                           const double *row) DALCS_MUST_CHECK;

void dalcs_audit_response_finish(struct dalcs_audit_response *a);

#endif
