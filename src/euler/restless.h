/* restless.h - switches that no position suits: each one that they are put in makes their controls ask for another.
 *
 * Within a step that may be a matter of its length: the control of a chopper is what the coil carries at the end. In the
 * limit of vanishing steps, one behind the other, it is not: then no time passes between the positions, and there is no
 * solution that has the switch in one of them. Without a hysteresis there may be one between both (sliding.h). */
#ifndef DALCS_RESTLESS_H
#define DALCS_RESTLESS_H

#include "positions.h"

/* One of them. */
struct dalcs_restless {
    int pair; /* -1: there is none */
    double closed,
        open; /* V or A: what its control is where it is closed, so that it opens, and the other way round */
};

/* A step of length 1/sigma from the state in u; sigma is 0 without states. */
struct dalcs_restless_step {
    double sigma;
    const double *u; /* [n_x + n_inputs] */
    double *moving;  /* [n_x + n_inputs] for the steps behind it */
};

/* In this step and those behind it, and in such half as long: does a switch turn round and round in both, between controls
 * that are no closer in the shorter ones? may_slide: one that may be between both positions does not count. y, at->moving,
 * p->osnsp->mode and p->osnsp->w have no meaning behind it. */
enum dalcs_status dalcs_restless_find(struct dalcs_positions *p, bool may_slide,
                                      const struct dalcs_restless_step *at, double *y,
                                      struct dalcs_restless *found) DALCS_MUST_CHECK;

#endif
