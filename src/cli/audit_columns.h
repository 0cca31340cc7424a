/* audit_columns.h - what has to be seen of a file of waveforms before it is audited. */
#ifndef DALCS_AUDIT_COLUMNS_H
#define DALCS_AUDIT_COLUMNS_H

#include "waveforms.h"

/* "time (ms)", "v(out) [mV]": such columns are in s, V and A from then on, and lose the unit in their names. */
enum dalcs_status dalcs_audit_take_units(struct dalcs_waveforms *w) DALCS_MUST_CHECK;

/* Does the time go back within a run, and not to its start? Rows [first, end) are those of the run. */
enum dalcs_status dalcs_audit_check_order(const struct dalcs_waveforms *w, const char *path,
                                          size_t first, size_t end,
                                          struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Notes values that are no numbers. */
void dalcs_audit_note_gaps(const struct dalcs_waveforms *w, struct dalcs_diag *diag);

#endif
