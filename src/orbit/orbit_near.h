/* orbit_near.h - times at which a pair only comes near to its corner, and stays on its side.
 *
 * The response to small signals takes each pair on the side that it has on the orbit. That is right for signals that
 * move lambda or w by less than it is away from 0. Where it only touches 0 no signal is as small: one sign of it takes the
 * pair to its other side, and the response has another derivative to each side (Cottle, Pang and Stone, The Linear
 * Complementarity Problem, chapter 7). A ring without losses touches its clamp at each turn. A current that fades away until a
 * command comes is as near. So is one that fades away just before: where the signal delays that, the command comes first, as at
 * the border of discontinuous conduction. Near is what is much smaller than the largest of this lambda or w on the orbit.
 */
#ifndef DALCS_ORBIT_NEAR_H
#define DALCS_ORBIT_NEAR_H

#include "orbit_log.h"

/* What pairs come to in the present segment, which is of the span. */
enum dalcs_status dalcs_orbit_near_note(struct dalcs_orbit_part *p,
                                        const struct dalcs_orbit_span *span) DALCS_MUST_CHECK;

/* After the run of a period: p->near.low has those times alone at which a pair is near. */
enum dalcs_status dalcs_orbit_near_find(struct dalcs_orbit_part *p) DALCS_MUST_CHECK;

void dalcs_orbit_near_finish(struct dalcs_orbit_part *p);

#endif
