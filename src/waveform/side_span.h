/* side_span.h - a mean over the sides of a slide as the span of a stretch. */
#ifndef DALCS_SIDE_SPAN_H
#define DALCS_SIDE_SPAN_H

#include "side_means.h"
#include "stretch.h"

/* From one time to another of the present segment, in which the mean slides. */
void dalcs_side_means_span(const struct dalcs_side_means *means, int index,
                           const struct dalcs_stretch_rule *rule, double from, double to,
                           struct dalcs_span *span);

#endif
