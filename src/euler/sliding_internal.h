/* sliding_internal.h - what turns, on both sides of a slide. Private to sliding.c and several_slides.c.
 *
 * The i-th of what may turn is a switch, i < p->n, or a formula that jumps, behind those. */
#ifndef DALCS_SLIDING_INTERNAL_H
#define DALCS_SLIDING_INTERNAL_H

#include "sliding.h"

/* Behind the switches, the jumps of formulas. */
static inline int dalcs_turning_n(const struct dalcs_positions *p) {
    return p->n + p->n_jumps;
}

static inline int dalcs_turning_pair(const struct dalcs_positions *p, int i) {
    return i < p->n ? p->pair[i] : p->jump[i - p->n];
}

/* Does the i-th stand differently on both sides, and does no other one decide that? */
bool dalcs_turning_leads(const struct dalcs_positions *p, int i);

/* How far beyond its threshold the control of a switch is, or the argument of a jump. */
double dalcs_turning_beyond(const struct dalcs_positions *p, int i, const double *y,
                            const double *w);

/* The weight of the other side with which the i-th is at its threshold, and what rounding may make of it. */
double dalcs_turning_weight(const struct dalcs_positions *p, int i, const double *y, double *noise);

/* Is the i-th no farther off its threshold than moves it, or than digits of controls so large tell? */
bool dalcs_turning_is_at_threshold(const struct dalcs_positions *p, int i, double off,
                                   double largest);

/* The same of a mean of both sides. */
bool dalcs_turning_fits(const struct dalcs_positions *p, int i, double weight, const double *y);

/* Puts a switch, or the output of a jump. */
void dalcs_turning_put(struct dalcs_positions *p, int i, bool is_on);

/* Is it one of a jump in p->leads? */
bool dalcs_turning_is_of_leading_jump(const struct dalcs_positions *p, int pair);

/* several_slides.c: as dalcs_sliding_mean(), where one weight does not fit all. */
enum dalcs_status dalcs_sliding_mean_of_several(struct dalcs_positions *p, const double *u,
                                                double *y, struct dalcs_observed_sides *sides,
                                                double *noise) DALCS_MUST_CHECK;

#endif
