/* audit_points.h - operating points under the laws of the elements (file_audit.h), as tables of one row. */
#ifndef DALCS_AUDIT_POINTS_H
#define DALCS_AUDIT_POINTS_H

#include "session_internal.h"

#include "euler.h"

/* The answer of e, an operating point of the circuit, and its row[n_outputs] into the report. It may be one of
 * several in a row, remembers: switches with hysteresis keep their sides. DALCS_REFUTED, with a message, where it breaks a
 * law by more than the tolerance. Nothing is asked with --audit off, and of a system file. */
enum dalcs_status dalcs_audit_point(struct dalcs_run *r, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_euler *e, const double *row,
                                    bool remembers) DALCS_MUST_CHECK;

/* A frequency was audited, too: its worst defect over its scale, and of what. */
enum dalcs_status dalcs_audit_add_frequency(struct dalcs_run *r, double defect, const char *what,
                                            double frequency) DALCS_MUST_CHECK;

/* What was found of them, beside what the report has of a waveform. */
void dalcs_audit_add_points(struct dalcs_run *r);

#endif
