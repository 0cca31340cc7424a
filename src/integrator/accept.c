/* accept.c - a step that holds becomes a segment, and is kept for the next change of the same kind. */
#include "accept.h"

#include "extremes.h"
#include "guards.h"
#include "present.h"
#include "recurrence.h"
#include "step_length.h"
#include "transition.h"

#include <math.h>

/* All of a step of the ladder: a longer one may be as good. */
static bool is_whole(const struct dalcs_radau_part *part, double theta) {
    return theta == 1.0 && part->segment.h == dalcs_radau_ladder(part, part->length.level);
}

/* What began after pairs changed sides. */
static enum dalcs_status learn(struct dalcs_radau_part *part, const struct dalcs_search *search,
                               double theta, double error) {
    bool longer = !search->fixed && is_whole(part, theta) && part->guards.n_crossed == 0 &&
                  dalcs_length_rungs_promised(part, error) > 1.0 &&
                  dalcs_radau_ladder(part, part->length.level - 1) <=
                      dalcs_smaller(part->length.longest, part->length.longest_needed);
    int spare = longer ? 1 : 0; /* rungs that the first step may have more the next time */
    if (!search->guessed) {
        double promised =
            dalcs_smaller(dalcs_length_rungs_promised(part, error), DALCS_LENGTH_MOST_RUNGS);
        int by_analogy = search->first_level - part->length.level_before;
        dalcs_transition_began(part, search->first_level, (int)promised);
        spare = (int)dalcs_larger(spare, dalcs_smaller(promised, by_analogy));
        DALCS_TRY(dalcs_transition_learn(part, part->length.level - spare));
    } else if (!search->front) {
        dalcs_transition_pass(part, spare);
    } else if (spare > 0) {
        DALCS_TRY(dalcs_transition_learn(part, part->length.level - spare));
    }
    if (!search->fixed) {
        dalcs_recurrence_note(part);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_trial_accept(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     const struct dalcs_search *search,
                                     const struct dalcs_trial *trial) {
    const double theta = trial->next;
    const struct dalcs_step_quality *quality = &trial->quality;
    double t_end = part->segment.t + theta * part->segment.h;
    part->segment.why = part->guards.n_crossed > 0 ? DALCS_END_AT_EVENT : DALCS_END_OF_STEP;
    if (part->guards.n_crossed == 0 && t_end >= search->limit - r->resolution) {
        t_end = search->limit;
        part->segment.why = DALCS_END_AT_EDGE;
    }
    if (search->fixed && part->segment.why == DALCS_END_OF_STEP) {
        double whole =
            rint(t_end / part->segment.h) * part->segment.h; /* counted, not accumulated */
        t_end = fabs(t_end - whole) <= 4.0 * r->resolution ? whole : t_end;
    }
    part->segment.t_end = dalcs_smaller(t_end, search->limit);
    dalcs_step_remember(part, theta, quality->unit);
    if (theta == 1.0) {
        dalcs_guards_arm(part, true, quality->unit);
    }
    double wrong_sign = dalcs_guards_wrong_sign(r, part, theta, quality->unit);
    if (wrong_sign > r->wrong_sign) {
        r->wrong_sign = wrong_sign;
        r->wrong_time = part->segment.t;
    }
    if (part->guards.fresh && part->guards.flipped && !search->turns.any) {
        DALCS_TRY(learn(part, search, theta, quality->ratio));
    }
    dalcs_segment_accept(r, part, theta, dalcs_stage_residual(trial->entry));
    part->length.held_level = part->length.level;
    if (!search->fixed && is_whole(part, theta)) {
        dalcs_length_lengthen(part, quality->ratio);
    }
    return DALCS_OK;
}
