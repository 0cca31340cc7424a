/* instant.h - when a measurement's condition holds: rises and falls through a level, counted.
 *
 * A rise is counted where a formula that has been clearly below the level reaches it, be it by a jump,
 * and likewise a fall; rounding about the level counts for nothing. */
#ifndef DALCS_INSTANT_H
#define DALCS_INSTANT_H

#include "measurement.h"
#include "stretch.h"

struct dalcs_instant {
    const struct dalcs_measure_instant *card;
    double at, delay; /* the card's, or from earlier measurements */
    int side; /* where it has last been clearly and not been counted from: -1 below, 1 above, 0 */
    double scale;
    int n; /* counted so far */
    bool found;
    double time;
    bool has_no_value;
};

/* At the start of a run. */
struct dalcs_instant dalcs_instant_start(const struct dalcs_measure_instant *card);

/* At the one point of a stretch that has no more, before an edge at the start. */
void dalcs_instant_look_before(struct dalcs_instant *instant, const struct dalcs_stretch *stretch);

/* Looks at [from, to] of a stretch; true when `time` is a new one. */
bool dalcs_instant_look(struct dalcs_instant *instant, const struct dalcs_stretch *stretch,
                        double from, double to);

#endif
