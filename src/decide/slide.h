/* slide.h - a segment along the threshold of a switch that opens what closes it and closes what opens it. */
#ifndef DALCS_SLIDE_H
#define DALCS_SLIDE_H

#include "radau_state.h"

/* One segment along a threshold, as the present one, as long as its error allows and up to `limit` (s) at most. starts: the
 * one before did not slide. *slides: there is one; if not, nothing is changed but part->work. */
enum dalcs_status dalcs_slide_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   double limit, bool starts, bool *slides) DALCS_MUST_CHECK;

#endif
