/* source_period.h - the common period of all sources that a part sees. */
#ifndef DALCS_SOURCE_PERIOD_H
#define DALCS_SOURCE_PERIOD_H

#include "radau_state.h"

/* Of all sources, if each is a constant or oscillates; 0: it is not so. */
enum dalcs_status dalcs_source_period(const struct dalcs_radau_part *part,
                                      double *period) DALCS_MUST_CHECK;

#endif
