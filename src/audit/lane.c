/* lane.c - stretches whose screen and image are at hand, as those of most are: they are asked all that a screen asks, with
 * less around it. Where the answer is not that all holds, or anything is missing, the stretch is asked as any other is, at
 * the time that was drawn, and only that asks for a look. */
#include "screen.h"

#include <string.h>

/* A multiplier whose product spreads keys (D. E. Knuth, The Art of Computer Programming 3, sec. 6.4). */
static const uint64_t spread = 0x9e3779b97f4a7c15u;

struct audit_lane *audit_lane_of(struct audit_watch *watch,
                                 const struct dalcs_audit_polynomials *p) {
    uint64_t bits;
    memcpy(&bits, &p->step, sizeof bits);
    return &watch->lane[((p->key ^ bits) * spread) >> (64 - AUDIT_LOG2_LANES)];
}

/* Sources in signs and in integrals are asked elsewhere, and so are smooth functions. */
static bool is_open(const struct audit_lane *lane, const struct audit_watch *watch,
                    const struct dalcs_audit_polynomials *p) {
    const struct audit_screen *screen = lane->screen;
    return lane->key == p->key && screen != NULL && lane->image->step == p->step &&
           screen->is_made && screen->rests == 0 && screen->n_terms[AUDIT_TERM_SIGN] == 0 &&
           screen->n_terms[AUDIT_TERM_FLOW] == 0 && watch->times.theta[0] <= p->end;
}

/* Is what the image has at the m-th time of use for that end? */
static bool has_end(const struct audit_image *image, int m, double end) {
    return image->at[m].place != NULL &&
           (audit_is_same_end(image->at[m].end, end) ||
            (image->at_node != NULL && !audit_is_same_end(image->end, end)));
}

/* The polynomials end where the stretch does, times in it can be told apart, and commands stay. */
static bool has_times(struct audit_screen *screen, const struct dalcs_audit_stretch *stretch,
                      const struct audit_part *part, double near) {
    const struct dalcs_audit_polynomials *p = stretch->stored;
    const double length = stretch->to - stretch->from;
    return fabs(length - p->end * p->step) <= near &&
           audit_can_tell_times(part, length, stretch->to) &&
           (screen->n_guards == 0 ||
            audit_is_guarded(screen, stretch->from + near, stretch->to - near));
}

/* Laws and signs at the m-th time, and the states behind the stretch before. */
static bool holds(struct dalcs_audit *audit, const struct audit_watch *watch,
                  const struct audit_lane *lane, const struct dalcs_audit_stretch *stretch, int m) {
    const struct dalcs_audit_polynomials *p = stretch->stored;
    struct audit_screen *screen = lane->screen;
    const double past = watch->times.theta[m] * p->step;
    double off;
    const double sign = audit_screen_by_image(watch, screen, p, m, lane->image, &off);
    double law = watch->place[AUDIT_PLACE_LAWS] + screen->rate * past;
    if (audit_laws_have_stimuli(screen)) {
        law += audit_laws_stimuli(audit, screen, stretch->from + past);
    }
    const double jump = watch->before.knows_states && !watch->is_put_off
                            ? fabs(watch->place[AUDIT_PLACE_START] - watch->before.states)
                            : 0.0;
    return off + fabs(law) <= screen->limit && -sign <= screen->limit && jump <= screen->limit;
}

bool audit_lane_passes(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_stretch *stretch) {
    const struct dalcs_audit_polynomials *p = stretch->stored;
    struct audit_watch *watch = part->watch;
    if (p == NULL || p->input == NULL || stretch->is_cut || part->has.smooth ||
        stretch->rule != DALCS_AUDIT_SMOOTH) {
        return false;
    }
    const struct audit_lane *lane = audit_lane_of(watch, p);
    const double near =
        part->tolerance * (stretch->to - stretch->from) + 4.0 * audit->options.resolution;
    if (!is_open(lane, watch, p) || !has_times(lane->screen, stretch, part, near)) {
        return false;
    }
    const int m = audit_watch_draw(audit, watch, p);
    if (!has_end(lane->image, m, p->end) || !holds(audit, watch, lane, stretch, m)) {
        return false;
    }
    lane->image->end = p->end;
    watch->image = lane->image;
    watch->screens.latest = lane->screen;
    watch->before.states = watch->place[AUDIT_PLACE_END];
    watch->before.knows_states = true;
    watch->makes = false;
    audit->count.screened++;
    audit->budget.spent += AUDIT_SCREEN_WORK;
    return true;
}
