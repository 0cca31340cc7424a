/* periodic_rest.h - does a small signal reach a diode that has neither voltage nor current (orbit_rest.h)? */
#ifndef DALCS_PERIODIC_REST_H
#define DALCS_PERIODIC_REST_H

#include "periodic_response.h"

/* Its element, of one for which it does in the piece, whose map is that of the frequency; else NULL. phase: of the small
 * signals where the piece begins; r->now: the perturbation there. */
const char *dalcs_periodic_rest_look(const struct dalcs_periodic_response *r,
                                     const struct dalcs_flow_piece *piece, double complex phase);

/* One of the times at which a diode only comes near to its other side (orbit_near.h), of those in the piece, if that counts
 * for small signals; *reach: of them, by which they take it there. NULL: none. */
const struct dalcs_orbit_low *dalcs_periodic_near_look(const struct dalcs_periodic_response *r,
                                                       const struct dalcs_flow_piece *piece,
                                                       double complex phase, double *reach);

#endif
