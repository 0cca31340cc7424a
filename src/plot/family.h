/* family.h - the runs that follow one another in a file of .step or .mc, one signal of each. */
#ifndef DALCS_FAMILY_H
#define DALCS_FAMILY_H

#include "family_chart.h"
#include "selection.h"

/* The one signal that the groups name, from `from` to `to` (NAN: as far as the file goes). `by` is the column that colours
 * the runs, constant in each; "" takes the first one that differs between them. Names are in the waveforms' arena. Finish it. Errors come with a message. */
enum dalcs_status dalcs_family_make(struct dalcs_family *family, struct dalcs_waveforms *waveforms,
                                    const char *const *group, size_t n_groups, double from,
                                    double to, const char *by,
                                    struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
