/* sliding_internal.h - what turns, on both sides of a slide. Private to sliding.c, slide_leaders.c, slide_corners.c,
 * several_slides.c and several_parts.c.
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

/* Does the i-th stand differently on both sides? */
static inline bool dalcs_turning_turns(const struct dalcs_positions *p, int i) {
    const int d = dalcs_turning_pair(p, i);
    return dalcs_osnsp_is_on(p->osnsp, d) != dalcs_mode_has(p->other, d);
}

/* And does no other one decide that? */
bool dalcs_turning_leads(const struct dalcs_positions *p, int i);

/* How far beyond its threshold the control of a switch is, or the argument of a jump. */
double dalcs_turning_beyond(const struct dalcs_positions *p, int i, const double *y,
                            const double *w);

/* In the answer y and p->osnsp->w, and on the other side. */
static inline double dalcs_turning_here(const struct dalcs_positions *p, int i, const double *y) {
    return dalcs_turning_beyond(p, i, y, p->osnsp->w);
}

static inline double dalcs_turning_there(const struct dalcs_positions *p, int i) {
    return dalcs_turning_beyond(p, i, p->other_y, p->other_w);
}

/* slide_leaders.c: does what begins to turn during a slide follow? y: on one side of a step of length 1 / sigma at the inputs u.
 * Where it does not turn in the half of the step, it follows what moves it at once, until a step tells more. */
enum dalcs_status dalcs_turning_compare_new(struct dalcs_positions *p, double sigma,
                                            const double *u, const double *y) DALCS_MUST_CHECK;

/* slide_memory.c: do formulas that turn hold each other on their sides, in the answer y of a loop without a state? */
enum dalcs_status dalcs_turning_find_memory(struct dalcs_positions *p, const double *u,
                                            const double *y, bool *remembers) DALCS_MUST_CHECK;

/* The weight of the other side with which the i-th is at its threshold, and what rounding may make of it. */
double dalcs_turning_weight(const struct dalcs_positions *p, int i, const double *y, double *noise);

/* Is the i-th no farther off its threshold than moves it, or than digits of controls so large tell? */
bool dalcs_turning_is_at_threshold(const struct dalcs_positions *p, int i, double off,
                                   double largest);

/* The same of a mean of both sides. */
bool dalcs_turning_fits(const struct dalcs_positions *p, int i, double weight, const double *y);

/* Puts a switch, or the output of a jump. */
void dalcs_turning_put(struct dalcs_positions *p, int i, bool is_on);

/* Is it one of a jump, or of one in p->leads? */
bool dalcs_turning_is_of_jump(const struct dalcs_positions *p, int pair, bool leading_only);

/* Jumps that are not in p->leads take the side of their argument in y and p->osnsp->w. Returns whether one changed. */
bool dalcs_turning_put_followers(struct dalcs_positions *p, const double *y);

/* Of the k-th side in p->sides: its answer, the voltages of its pairs, its mode. */
static inline double *dalcs_corner_y(const struct dalcs_positions *p, int corner) {
    return p->sides.y + (ptrdiff_t)corner * dalcs_system_n_columns(p->osnsp->system);
}

static inline double *dalcs_corner_w(const struct dalcs_positions *p, int corner) {
    return p->sides.w + (ptrdiff_t)corner * p->osnsp->system->n_pairs;
}

static inline uint64_t *dalcs_corner_mode(const struct dalcs_positions *p, int corner) {
    return p->sides.mode + (ptrdiff_t)corner * p->osnsp->n_words;
}

/* Is the i-th on, on the side of all or on the other one? The output of a jump is on the side of what it commands (sliding.c). */
static inline bool dalcs_turning_is_on_at(const struct dalcs_positions *p, int i, bool is_other) {
    const uint64_t *mode = is_other == (i < p->n) ? p->other : p->present;
    return dalcs_mode_has(mode, dalcs_turning_pair(p, i));
}

/* slide_corners.c: the answers on all sides of groups that slide, in p->sides; the rest of what leads stays as told there. y and
 * p->sides.w_of_y are that on one side of all, and p->other_y that on the other side of all. */
enum dalcs_status dalcs_corners_find(struct dalcs_positions *p, const double *u, const double *y,
                                     int n_groups, bool *are_complete) DALCS_MUST_CHECK;

/* several_slides.c: as dalcs_sliding_mean(), where one weight does not fit all. What slides is in a group. */
enum dalcs_status dalcs_sliding_mean_of_several(struct dalcs_positions *p, const double *u,
                                                double *y, struct dalcs_observed_sides *sides,
                                                double *noise) DALCS_MUST_CHECK;

#endif
