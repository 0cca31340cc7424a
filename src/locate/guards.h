/* guards.h - what ends a mode: lambda or w that falls below 0, a voltage that moves a switch.
 *
 * Guards are numbered: first the pairs (switches have none), then the watched switches. */
#ifndef DALCS_GUARDS_H
#define DALCS_GUARDS_H

#include "step_error.h"

/* Of a part that is otherwise set up. */
enum dalcs_status dalcs_guards_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* Guards that are clear of 0 at the start, or at the end, of a step are armed: from then on every fall
 * below 0 counts. Those that start within the error of 0, because they have just crossed it, count when
 * they leave it downwards (doubt.h). */
void dalcs_guards_arm(struct dalcs_radau_part *part, bool at_end, const double *unit);

/* The first to fall up to `end`, listed in part->guards.crossed; INFINITY when none does. *at_once: one that
 * is not armed was never positive, so the mode is wrong from the start. */
double dalcs_guards_first_fall(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                               double end, const double *unit, bool *at_once);

/* Do the guards of a first fall at once come back within the step, and from no farther below 0 than an error
 * of the polynomial may put them, which is least exact at its start? */
bool dalcs_guards_recover(const struct dalcs_radau_part *part, const double *unit);

/* Where in the step the guards that have just fallen, all below 0 from the start, are above it again;
 * INFINITY if one is not. */
double dalcs_guards_recovery(const struct dalcs_radau_part *part);

/* Did what crossed only dip below 0, by a part of what it began with, and is it above at the end? That may be
 * two crossings, or the polynomial, which swings where something has died away between two nodes. */
bool dalcs_guards_swing(const struct dalcs_radau_part *part);

/* Is there a diode that is on the wrong side from the start of the step up to `end`, in steps? By no more
 * than the error, or it would have ended the segment; but an error of 0 grows, or goes. Of the guards that
 * dalcs_guards_first_fall looked at; large components are not asked. */
bool dalcs_guards_stay_negative(const struct dalcs_radau_part *part, double end,
                                const double *unit);

/* The most negative lambda or w at the nodes up to `end`, over the largest of its unit; 0 when none. Of
 * a step in which a first fall has been looked for. The start does not count for what is over at once. */
double dalcs_guards_wrong_sign(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                               double end, const double *unit);

/* What crossed changes sides. */
void dalcs_guards_flip(struct dalcs_radau_part *part);

/* Does a guess change a diode beside those that crossed which begins below 0 by more than it may be off by? What crosses at
 * an event begins with the error of its time, and what crosses a little later does not yet. */
bool dalcs_guards_overreach(const struct dalcs_radau_part *part, const double *unit);

/* What rests at its threshold, so that all terms of its expansion at the start of the step are 0, is on the side that its
 * comparison has at equality: a switch without hysteresis is open, as it is on above its threshold alone, and a jump of a
 * formula has the value that is written for it (> and < are false, >= and <= are true). What rounding makes of such an
 * argument decides nothing. Returns whether the mode changes. */
bool dalcs_guards_rest(struct dalcs_radau_part *part, const double *unit);

#endif
