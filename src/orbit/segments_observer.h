/* segments_observer.h - an observer of segments alone; all other calls of a run do nothing. */
#ifndef DALCS_SEGMENTS_OBSERVER_H
#define DALCS_SEGMENTS_OBSERVER_H

#include "observer.h"

typedef void dalcs_segment_seen(void *user, const struct dalcs_radau_part *part,
                                const double *start);

struct dalcs_observer dalcs_segments_observer(void *user, dalcs_segment_seen *segment);

#endif
