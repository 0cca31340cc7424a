/* smooth_step.h - a step of a part that has smooth sources.
 *
 * Within a step such a source is the polynomial through its values at the nodes, for which a step is linear as for other
 * sources. Newton's method finds values that are the functions of what they read at these nodes: with the factors or
 * the map of the step as it is, and a small dense matrix of the slopes (Hairer and Wanner, Solving ODEs II, section
 * IV.8; the matrix of the step itself has no part of the functions). What the polynomial misses between the nodes is in
 * the step's error as what it misses of a sine is. */
#ifndef DALCS_SMOOTH_STEP_H
#define DALCS_SMOOTH_STEP_H

#include "radau_state.h"

enum dalcs_status dalcs_smooth_step_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* As dalcs_segment_solve(). DALCS_NOT_CONVERGED: a shorter step may. */
enum dalcs_status dalcs_smooth_step_solve(struct dalcs_radau_part *part,
                                          struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* The present step once more, to the rounding of the functions. Newton's method ends where the values agree to what they are
 * asked for in the equations; a source of 3 V behind a milliohm is known to a nanoampere then, and no shorter step
 * mends that. */
enum dalcs_status dalcs_smooth_step_refine(struct dalcs_radau_part *part,
                                           struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* What rounding of the functions makes of the drift of the states, [n_x], in the present step: no shorter step has less of
 * it beside what the functions do. Of a line far steeper than its function it excuses nothing. NULL: there are none, or it is not
 * known. */
const double *dalcs_smooth_step_rounding(struct dalcs_radau_part *part,
                                         struct dalcs_stage_entry *entry);

/* Do functions move a pair by what they add to their lines, in a mode that was solved so far, or is it not known? */
bool dalcs_smooth_step_moves(const struct dalcs_radau_part *part, int pair);

/* How a small change of the states changes the present step: the first call is for the slopes, the others put the changes
 * of the sources behind those of the states into in[n_in], out being the answer to in[] without them. */
enum dalcs_status dalcs_smooth_step_vary_begin(struct dalcs_radau_part *part,
                                               struct dalcs_stage_entry *entry) DALCS_MUST_CHECK;
void dalcs_smooth_step_vary(const struct dalcs_radau_part *part, const double *out, double *in);

/* Does a function have no value somewhere in the present step up to *theta, or since the segment before? Then *theta is
 * where, and the component's functions tell which. */
bool dalcs_smooth_step_meets_pole(const struct dalcs_radau_part *part, double *theta);

/* The present step up to theta is a segment: what follows starts with the values there. */
void dalcs_smooth_step_note(struct dalcs_radau_part *part, double theta);

/* The same of a step of implicit Euler, that the one-step problem was solved for last. */
bool dalcs_smooth_euler_meets_pole(const struct dalcs_radau_part *part);
void dalcs_smooth_euler_note(const struct dalcs_radau_part *part);

#endif
