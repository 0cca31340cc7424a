/* small_signal.h - responses around an operating point, for .ac and .tf. */
#ifndef DALCS_SMALL_SIGNAL_H
#define DALCS_SMALL_SIGNAL_H

#include "audit_response.h"
#include "gates.h"
#include "small_signal_part.h"

/* Zeroed but for the first three. */
struct dalcs_small_signal {
    struct dalcs_run *run;
    const char *card; /* ".ac", ".tf" */
    const struct dalcs_location *where;
    struct dalcs_small_signal_part *part; /* [n_parts] */
    int n_parts;
    double *row;                           /* [2 n_outputs] */
    struct dalcs_response_columns *column; /* [n_parts] for the audit */
    struct dalcs_audit_response audit;
};

/* Finds the operating point and which side each diode and switch is on, which goes into the report. */
enum dalcs_status dalcs_small_signal_find_point(const struct dalcs_small_signal *a,
                                                struct dalcs_euler *e,
                                                struct dalcs_logic_run *logic) DALCS_MUST_CHECK;

/* For n frequencies, with the AC values that the sources have now. */
enum dalcs_status dalcs_small_signal_setup(struct dalcs_small_signal *a,
                                           const struct dalcs_euler *e,
                                           struct dalcs_logic_run *logic, int n) DALCS_MUST_CHECK;

/* a->row, at a frequency. */
enum dalcs_status dalcs_small_signal_solve(struct dalcs_small_signal *a,
                                           double frequency) DALCS_MUST_CHECK;

/* What setup has made; it may be called again. */
void dalcs_small_signal_finish(struct dalcs_small_signal *a);

#endif
