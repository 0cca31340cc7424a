/* audit_points.h - operating points under the laws of the elements (file_audit.h), as tables of one row. */
#ifndef DALCS_AUDIT_POINTS_H
#define DALCS_AUDIT_POINTS_H

#include "session_internal.h"

#include "logic_run.h"

/* An operating point that was solved. */
struct dalcs_solved_point {
    const struct dalcs_circuit *circuit;
    const struct dalcs_network *network;
    const struct dalcs_euler *euler;
    struct dalcs_logic_run *logic;
    const double *row; /* [n_outputs] */
    bool remembers; /* it is one of several in a row: switches with hysteresis keep their sides */
};

/* Goes into the report. DALCS_REFUTED, with a message, where it breaks a law by more than the tolerance. Nothing is asked
 * with --audit off, and of a system file. */
enum dalcs_status dalcs_audit_point(struct dalcs_run *r,
                                    const struct dalcs_solved_point *point) DALCS_MUST_CHECK;

/* A frequency was audited, too: its worst defect over its scale, and of what. */
enum dalcs_status dalcs_audit_add_frequency(struct dalcs_run *r, double defect, const char *what,
                                            double frequency) DALCS_MUST_CHECK;

/* What was found of them since this was called last goes into the report, beside what that has of a waveform. */
void dalcs_audit_add_points(struct dalcs_run *r);

#endif
