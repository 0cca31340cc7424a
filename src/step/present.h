/* present.h - a part's present step: its input, its output, and its acceptance. */
#ifndef DALCS_PRESENT_H
#define DALCS_PRESENT_H

#include "radau_state.h"

#include <math.h>
#include <string.h>

/* The next edge, command or the stop time. */
double dalcs_radau_limit(const struct dalcs_radau *r, const struct dalcs_radau_part *part);

/* part->segment.in for a step of length part->segment.h from part->t. */
void dalcs_segment_inputs(struct dalcs_radau_part *part);

/* What was derived from the segment before is not valid for the present one. */
static inline void dalcs_segment_renew(struct dalcs_radau_part *part) {
    part->segment.number++;
}

/* Such a step in the present mode, into part->out. */
enum dalcs_status dalcs_segment_solve(struct dalcs_radau_part *part,
                                      struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* The present mode holds: from it pairs change sides the next time. */
void dalcs_present_hold(struct dalcs_radau_part *part);

/* The present step up to theta is a segment; part->segment.t_end and part->segment.why are known. */
void dalcs_segment_accept(struct dalcs_radau *r, struct dalcs_radau_part *part, double theta,
                          double residual);

/* The state becomes part->work.after. */
void dalcs_radau_go_after(const struct dalcs_radau *r, struct dalcs_radau_part *part);

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
