/* radau_internal.h - what the files behind radau.h share. */
#ifndef DALCS_RADAU_INTERNAL_H
#define DALCS_RADAU_INTERNAL_H

#include "radau.h"
#include "transition.h"

#include <math.h>
#include <string.h>

/* segment.c: from part->segment.t, part->x and the mode to a segment that holds until part->t_end. */
enum dalcs_status dalcs_segment_begin(struct dalcs_radau *r,
                                      struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* The present step up to theta is a segment; part->segment.t_end and part->segment.why are known. */
void dalcs_segment_accept(struct dalcs_radau *r, struct dalcs_radau_part *part, double theta,
                          double residual);

/* part->segment.in for a step of length part->segment.h from part->t. */
void dalcs_segment_inputs(struct dalcs_radau_part *part);

/* Such a step in the present mode, into part->out. */
enum dalcs_status dalcs_segment_solve(struct dalcs_radau_part *part,
                                      struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* Defects of a state, over what is allowed, that need no projection; of larger ones currents across
 * capacitors are the derivatives. */
static const double dalcs_worth_projecting = 1e-2;

/* Equations without derivatives hold to rounding, even if it is rounding of large conductances, unless
 * a mode is singular and the states contradict it, which takes a circuit that is not passive. */
static const double dalcs_largest_residual = 1e-6;

/* restart.c: two micro-steps from part->segment.t decide mode and state; a jump is reported. `longer` makes
 * them 2^(5 longer) times as long; mode_only leaves the state as it is. *is_off: it jumps by no
 * more than the error that the state of an event has, or so it seems, and was left where it is, for a
 * projecting step to decide; in large parts on factors, whose rounding such a step would not survive, and
 * for NULL it was moved. */
enum dalcs_status dalcs_radau_restart(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      int longer, bool mode_only, bool *is_off) DALCS_MUST_CHECK;

/* The state becomes part->after. */
void dalcs_radau_go_after(const struct dalcs_radau *r, struct dalcs_radau_part *part);

/* s; of one of them. */
double dalcs_radau_micro_length(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                                int longer);

/* One step of implicit Euler of length h as the present segment. */
enum dalcs_status dalcs_radau_euler_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double h) DALCS_MUST_CHECK;

/* One problem of such a step, of length h to part->segment.t + tau, from state[n_x] into y[n_columns], with the switches where
 * they then stand; part->guards.slides is set where nothing fits. */
enum dalcs_status dalcs_radau_implicit_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                            double h, double tau, const double *state,
                                            double *y) DALCS_MUST_CHECK;

/* part->work.y1 at the end of a step of implicit Euler of length h becomes the present segment, along which states go
 * straight; all columns do, from before[n_columns], if that is not NULL. */
void dalcs_radau_accept_euler(const struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                              const double *before);

/* Calls on_open for the segments that have just begun in a mode that leaves something open. */
enum dalcs_status dalcs_radau_tell_open(struct dalcs_radau *r) DALCS_MUST_CHECK;

/* The next edge, command or the stop time. */
double dalcs_radau_limit(const struct dalcs_radau *r, const struct dalcs_radau_part *part);

/* A part without memory at t: y and u. */
enum dalcs_status dalcs_radau_solve(struct dalcs_radau *r, struct dalcs_radau_part *part, double t,
                                    enum dalcs_side side) DALCS_MUST_CHECK;

/* A column of a part that sources alone decide, by its number. */
double dalcs_radau_bystander(const struct dalcs_radau_part *part, int bystander, double t,
                             enum dalcs_side side);

/* Where t is in the present segment, which may end a rounding earlier. */
static inline double dalcs_radau_theta(const struct dalcs_radau_part *part, double t) {
    double theta = (t - part->segment.t) / part->segment.h;
    return theta < part->segment.end ? theta : part->segment.end;
}

static inline double dalcs_radau_ladder(const struct dalcs_radau_part *part, int level) {
    enum { FAR = 900 }; /* beyond, the power of 2 might not be a normal number */

    if (level < -FAR || level > FAR) {
        return ldexp(part->length.rung, -level);
    }
    uint64_t bits = (uint64_t)(1023 - level) << 52;
    double power;
    memcpy(&power, &bits, sizeof(power));
    return part->length.rung * power;
}

/* part->segment.out is put aside, and what was aside is part->out. */
static inline void dalcs_radau_swap_out(struct dalcs_radau_part *part, double **aside) {
    double *out = part->segment.out;
    part->segment.out = *aside;
    *aside = out;
}

#endif
