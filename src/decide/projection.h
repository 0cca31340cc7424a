/* projection.h - a state that is a little off is put on what its mode allows.
 *
 * That is where the stages of a step in the mode are, here so short a step that only such a defect moves the
 * state, and where their polynomial starts. */
#ifndef DALCS_PROJECTION_H
#define DALCS_PROJECTION_H

#include "radau_state.h"

/* What a projecting step tells. */
enum dalcs_projection {
    DALCS_PROJECTION_BLIND,    /* nothing: the mode is not seen in so short a step */
    DALCS_PROJECTION_IN_PLACE, /* the states are where the mode allows */
    DALCS_PROJECTION_MOVED,    /* they are now */
    DALCS_PROJECTION_JUMPS /* that is farther away than an event's error, and none has moved there */
};

/* For a state that is off as interpolation leaves it at an event. If there is nothing to move, the step that was
 * tried before is there again. limit: s, up to which a step may go; fixed: the step is given; may_jump: what it finds is a part
 * of a jump that is told, else it moves no state farther than an event's error. */
enum dalcs_status dalcs_projection_try(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double limit, bool fixed, bool may_jump,
                                       enum dalcs_projection *told) DALCS_MUST_CHECK;

/* May it find anything to move? Not where all states move in a projecting step by much more than their drift
 * in the step that was tried, nor where that step's map tells that they are where the mode allows. It saves a map. */
bool dalcs_projection_sees(struct dalcs_radau_part *part, bool fixed);

/* For one that is off by so little that it moves farther in the shortest of steps, and dalcs_projection_try
 * cannot tell: rounding of voltages across milliohms, on factors, may be more current than is allowed. It goes
 * to where the polynomial of the step starts that was tried last. False: that is farther away than an error
 * may be, over its own scale, or, within_unit, over unit[2], V and A; then something much faster than the step goes on. */
bool dalcs_projection_settle(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             const double *unit, bool within_unit);

#endif
