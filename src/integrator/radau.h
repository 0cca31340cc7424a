/* radau.h - Radau IIA with error control over all components, events located by their polynomials.
 *
 * Each component goes its own way: from a consistent state it makes a step in its present mode, and
 * on the step's polynomials looks for the first time when the mode ends: a lambda or w that falls
 * below 0, a voltage that moves a switch. There, at edges of its sources and at commanded switches
 * the segment ends, though the step may have gone further; a new one starts. Which mode comes next is
 * first guessed (what crossed changes sides) and then certified, by a step whose lambda and w are
 * positive from the start; where that fails, two micro-steps of implicit Euler decide mode and jump.
 *
 * The loop over time is the caller's, dalcs_radau_next_stop telling where to go next. */
#ifndef DALCS_RADAU_H
#define DALCS_RADAU_H

#include "radau_state.h"

enum dalcs_status dalcs_radau_setup(struct dalcs_radau *r, struct dalcs_euler *base,
                                    const struct dalcs_radau_options *options,
                                    const struct dalcs_osnsp_options *osnsp) DALCS_MUST_CHECK;

void dalcs_radau_finish(struct dalcs_radau *r);

/* Does a switch that sources control move at t = 0? One whose gate leaves its threshold there stands as in the
 * operating point at 0 and moves just after it. Before the start. */
bool dalcs_radau_commands_at_start(struct dalcs_radau *r);

/* Stands at t = 0 with the components' states: initial[k][n_x] = x(0-), or NULL for the operating
 * point that base has solved. */
void dalcs_radau_start(struct dalcs_radau *r, double *const *initial);

/* Goes on from there: what happens at 0, and the first segments. */
enum dalcs_status dalcs_radau_begin(struct dalcs_radau *r) DALCS_MUST_CHECK;

/* The earliest end of a segment; INFINITY when nothing steps. *happens: not just the end of a step. */
double dalcs_radau_next_stop(struct dalcs_radau *r, bool *happens);

/* Ends all segments that end at t and starts the next ones. */
enum dalcs_status dalcs_radau_pass(struct dalcs_radau *r, double t) DALCS_MUST_CHECK;

/* A segment that has begun before t and would end behind it ends there. */
void dalcs_radau_cut(struct dalcs_radau_part *part, double t);

/* Stimuli (changed[n_stimuli of the circuit]) are others from t on: a part that they act on, whose segment begins or ends there, begins
 * anew. */
enum dalcs_status dalcs_radau_disturb(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      double t, const bool *changed) DALCS_MUST_CHECK;

/* y and u of every component at t, which lies in the present segments: the left limit at their ends,
 * the right one at their starts. Of few outputs or at many times: rows.h. */
enum dalcs_status dalcs_radau_evaluate(struct dalcs_radau *r, double t,
                                       enum dalcs_side side) DALCS_MUST_CHECK;

/* y and u of one component that steps, likewise. */
void dalcs_radau_read(struct dalcs_radau *r, int part, double t, enum dalcs_side side);

/* A part without memory at t: y and u. */
enum dalcs_status dalcs_radau_solve(struct dalcs_radau *r, struct dalcs_radau_part *part, double t,
                                    enum dalcs_side side) DALCS_MUST_CHECK;

/* A column of a part that sources alone decide, by its number. */
double dalcs_radau_bystander(const struct dalcs_radau_part *part, int bystander, double t,
                             enum dalcs_side side);

/* After a failure at t: y as far as each component came. */
void dalcs_radau_break_off(struct dalcs_radau *r, double t);

#endif
