/* slide.h - a segment along the threshold of a switch that opens what closes it and closes what opens it. */
#ifndef DALCS_SLIDE_H
#define DALCS_SLIDE_H

#include "radau_state.h"

/* One segment of length h along a threshold, as the present one. *slides: there is one; if not, nothing is changed but
 * part->work.y1 and part->y2. */
enum dalcs_status dalcs_slide_step(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   bool *slides) DALCS_MUST_CHECK;

#endif
