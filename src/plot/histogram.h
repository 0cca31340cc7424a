/* histogram.h - how often values occur in the rows of a table, such as measurements of many runs. */
#ifndef DALCS_HISTOGRAM_H
#define DALCS_HISTOGRAM_H

#include "selection.h"

/* The counts of the selection's one signal in classes of equal width, as a table whose axis is the signal; rows without a
 * value are left out. Finish it. Errors come with a message. */
enum dalcs_status dalcs_histogram_make(struct dalcs_waveforms *histogram,
                                       const struct dalcs_selection *selection,
                                       struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
