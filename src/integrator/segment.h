/* segment.h - from a state and a guess of the mode to a segment that holds. */
#ifndef DALCS_SEGMENT_H
#define DALCS_SEGMENT_H

#include "radau_state.h"

/* From part->segment.t, part->x and the mode to a segment that holds until part->t_end. */
enum dalcs_status dalcs_segment_begin(struct dalcs_radau *r,
                                      struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* Calls on_open for the segments that have just begun in a mode that leaves something open. */
enum dalcs_status dalcs_radau_tell_open(struct dalcs_radau *r) DALCS_MUST_CHECK;

#endif
