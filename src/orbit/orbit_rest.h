/* orbit_rest.h - pairs that stay at their corner for a span of the orbit, with neither lambda nor w.
 *
 * To the first order a small signal leaves each pair on its side where lambda + w > 0 but at instants. Where both stay 0 it
 * decides the side itself: a diode conducts one half of a sine and cuts the other off, and no linear response exists,
 * unless the signal does not come to the pair at all (Cottle, Pang and Stone, The Linear Complementarity Problem, chapter
 * 7, on nondegenerate solutions).
 */
#ifndef DALCS_ORBIT_REST_H
#define DALCS_ORBIT_REST_H

#include "orbit_log.h"

/* What pairs come to in the present segment, which is of the span; and whether they come near to it (orbit_near.h). */
enum dalcs_status dalcs_orbit_rest_note(struct dalcs_orbit_part *p,
                                        const struct dalcs_orbit_span *span) DALCS_MUST_CHECK;

/* After the run of a period of length T (s): spans end where what rests changes, and have it. */
enum dalcs_status dalcs_orbit_rest_find(struct dalcs_orbit_part *p, double T) DALCS_MUST_CHECK;

void dalcs_orbit_rest_finish(struct dalcs_orbit_part *p);

#endif
