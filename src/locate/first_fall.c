/* first_fall.c - which guard falls first in a step, and what a fall means. */
#include "guards_internal.h"

#include "crossing.h"
#include "doubt.h"
#include "extremes.h"
#include "guard_scale.h"
#include "guard_values.h"
#include "magnitudes.h"
#include "quads.h"
#include "rounding.h"
#include "tied.h"

#include <math.h>

/* A guard that is looked at, up to `end`, in steps. */
struct look {
    int guard;
    const double *value; /* at the nodes, with their stride: work, or the answer itself */
    int stride;
    double work[DALCS_MAX_NODES];
    double end;
    double scale;
    double nothing; /* what rounding leaves of a guard that is 0 */
    const double *unit;
};

static void look_at(struct look *a, const struct dalcs_radau_part *part, int guard, double end,
                    const double *unit) {
    a->guard = guard;
    a->end = end;
    a->unit = unit;
    a->value = dalcs_guard_values(part, guard, a->work, &a->stride);
    a->scale = dalcs_guard_scale(part, guard, unit);
    a->nothing = dalcs_tied_nothing(part, guard, unit);
}

static void bound_controls(const struct dalcs_radau_part *part) {
    for (int g = part->component->system->n_pairs; g < dalcs_guards_number(part); g++) {
        double work[DALCS_MAX_NODES + DALCS_QUAD] = {0.0};
        int stride;
        const double *value = dalcs_guard_values(part, g, work, &stride);
        dalcs_crossing_bounds(part->stages.method, 1, value, stride, part->guards.bound + g);
    }
}

static void bound_all(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    dalcs_crossing_bounds(part->stages.method, s->n_pairs,
                          part->segment.out + dalcs_system_n_equations(s),
                          part->stages.layout.stride, part->guards.bound);
    if (part->stages.n_watched > 0) {
        bound_controls(part);
    }
}

/* The guards that bounds do not clear. */
static void find_doubtful(struct dalcs_radau_part *part) {
    bound_all(part);
    const double *bound = part->guards.bound;
    int n = dalcs_guards_number(part);
    int n_doubtful = 0;
    for (int g = 0; g < n; g++) {
        if (!(bound[g] >= 0.0) && dalcs_guard_is_one(part, g)) {
            part->guards.doubtful[n_doubtful++] = g;
        }
    }
    part->guards.n_doubtful = n_doubtful;
}

/* What crosses at the stop time, up to the error, is left to a longer run: where in the step that begins. */
static double end_of_events(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            double end, double band) {
    bool stops =
        end <= 1.0 && part->segment.t + end * part->segment.h >= r->options.stop - r->resolution;
    return stops ? end - band * r->options.stop / part->segment.h : INFINITY;
}

/* How far a guard may fall in the first step of a mode and is no event, at most `doubt`: what it is off by at its
 * beginning, on either side of 0, and in this step by what the step is off by. Notes a dip that only a shorter
 * step tells. */
static double doubt_at_first(struct dalcs_radau_part *part, const struct look *a, double doubt) {
    const struct dalcs_collocation *m = part->stages.method;
    const double *value = a->value;
    double least = dalcs_larger(dalcs_beyond * fabs(value[0]), dalcs_small * doubt);
    double depth = dalcs_smaller(doubt, dalcs_larger(least, part->segment.ratio * doubt));
    for (int k = 1; k <= m->s && m->node[k] <= a->end && !part->guards.may_dip; k++) {
        part->guards.may_dip = value[k * a->stride] < -least && value[k * a->stride] >= -depth;
    }
    return depth;
}

/* How far a guard may fall beyond rounding and is no event: where it is armed not at all, or as far as it may be touching 0.
 *
 * A small part of its doubt counts in later steps where such a pair goes on falling, or stays where it is: a diode that waits
 * for the whole band is wrong meanwhile, and a jump when it turns, which may turn its neighbours. One that comes down to 0
 * from above and goes up again, as that of a peak detector without a load at each peak, may be on the other side by as
 * much. */
static double doubt_of(struct dalcs_radau_part *part, const struct look *a) {
    const int guard = a->guard;
    const double *value = a->value;
    const double last = value[(part->stages.layout.n_nodes - 1) * a->stride];
    const bool is_armed = part->guards.armed[guard];
    if (is_armed && (a->end < 1.0 ? dalcs_guard_value_at(part, value, a->stride, a->end) : last) <=
                        a->nothing) {
        return 0.0; /* it does not come back */
    }
    double doubt = dalcs_doubt_about(part, guard, a->scale, a->unit);
    if (is_armed) {
        return dalcs_small * doubt;
    }
    if (part->guards.fresh && guard < part->component->system->n_pairs &&
        dalcs_guard_has_crossed(part, guard, value, a->stride, a->unit)) {
        /* Below 0 by what a sum of siemens and microsiemens rounds of the latter, where only these lead on, a voltage
         * that rises is no event. */
        return dalcs_osnsp_is_on(&part->component->osnsp, guard)
                   ? dalcs_doubt_of_closed(part, guard, a->scale)
                   : dalcs_larger(dalcs_doubt_band(part), dalcs_alike) * a->scale;
    }
    if (part->guards.fresh) {
        return doubt_at_first(part, a, doubt);
    }
    return last < (1.0 - dalcs_slight) * value[0] ? dalcs_small * doubt : doubt;
}

/* Does a guard that falls at `theta` or later do so at an event that is no farther before than errors move it? Diodes
 * in series open together, whichever has a rounding more: leaks alone would take that down, late. Falls are alike, in
 * steps, if the later guard is no more than its doubt above 0 at the first: without that opposite diodes of a bridge open
 * 64 ns apart (together.py), and what opens by itself does so later by more. */
static bool falls_with(const struct dalcs_radau_part *part, int guard, double event, double theta,
                       const double *unit) {
    if (!part->guards.armed[guard] || theta - event > dalcs_alike) {
        return false;
    }
    double work[DALCS_MAX_NODES];
    int stride;
    const double *value = dalcs_guard_values(part, guard, work, &stride);
    double scale = dalcs_guard_scale(part, guard, unit);
    return dalcs_guard_value_at(part, value, stride, event) <=
           dalcs_doubt_about(part, guard, scale, unit);
}

/* All that have crossed at `theta`. */
static bool all_fall_with(const struct dalcs_radau_part *part, double event, double theta,
                          const double *unit) {
    bool all = part->guards.n_crossed > 0;
    for (int k = 0; k < part->guards.n_crossed && all; k++) {
        all = falls_with(part, part->guards.crossed[k], event, theta, unit);
    }
    return all;
}

/* What has died away has no sign any more. */
static void disarm(const struct dalcs_radau_part *part, const struct look *a, double band) {
    const double last = a->value[(part->stages.layout.n_nodes - 1) * a->stride];
    if (!part->guards.fresh && a->value[0] <= dalcs_small * band * a->scale &&
        fabs(last) <= a->nothing) {
        part->guards.armed[a->guard] = false;
    }
}

/* How deep a fall must be: deeper than `depth`, and than a beginning below 0 that is over soon. */
static double depth_of_fall(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            const struct look *a, double depth) {
    const bool is_over = part->guards.fresh && a->value[0] < -depth &&
                         dalcs_guard_is_over_soon(r, part, a->value, a->stride, a->scale);
    return is_over ? -2.0 * a->value[0] : depth;
}

/* It falls, with or before those that have crossed at *first. */
static void note_fall(struct dalcs_radau_part *part, const struct look *a,
                      const struct dalcs_crossing *c, double depth, bool *at_once) {
    struct dalcs_part_guards *guards = &part->guards;
    /* On factors a guard that is above what rounding leaves of it falls at a time of its own, however soon: of diodes beside
     * closed switches, which take over one after the other, the band of kilovolts would be all of their nanovolts. */
    const double near =
        part->segment.rounding > 1.0 ? a->nothing : dalcs_doubt_band(part) * a->scale;
    /* From rest a circuit may begin to move as a power of time. */
    const bool slips = guards->fresh && c->peak <= depth;
    guards->slips = guards->slips || slips;
    const bool soon =
        c->at_once ||
        (slips && (!guards->flipped || dalcs_tied_was_at_rest(part, a->guard, a->unit))) ||
        (c->theta <= dalcs_nothing && c->peak <= near); /* this early is from the start */
    *at_once = *at_once || (!guards->armed[a->guard] && soon);
    guards->crossed[guards->n_crossed++] = a->guard;
}

/* The first of the doubtful ones. */
static double find_first(const struct dalcs_radau *r, struct dalcs_radau_part *part, double end,
                         const double *unit, bool *at_once) {
    double first = INFINITY;
    double same = part->segment.rounding > 1.0 ? dalcs_alike : dalcs_answer_rounded;
    double together = dalcs_larger(same, 2.0 * r->resolution / part->segment.h);
    double band = dalcs_doubt_band(part);
    double too_late = end_of_events(r, part, end, band);
    for (int k = 0; k < part->guards.n_doubtful; k++) {
        struct look a;
        look_at(&a, part, part->guards.doubtful[k], end, unit);
        disarm(part, &a, band);
        const double bound = part->guards.bound[a.guard];
        if (bound >= -a.nothing) {
            continue;
        }
        double depth = dalcs_larger(a.nothing, doubt_of(part, &a));
        if (bound >= -depth) {
            continue;
        }
        depth = depth_of_fall(r, part, &a, depth);
        struct dalcs_crossing c =
            dalcs_crossing_find(part->stages.method, a.value, a.stride, end, depth,
                                part->guards.n_crossed > 0 ? first : 0.0);
        bool is_late = c.theta >= too_late &&
                       dalcs_guard_value_at(part, a.value, a.stride, end) >= -band * a.scale;
        if (!c.falls || is_late ||
            (c.theta > first + together && !falls_with(part, a.guard, first, c.theta, unit))) {
            continue;
        }
        if (c.theta < first - together && !all_fall_with(part, c.theta, first, unit)) {
            part->guards.n_crossed = 0;
            *at_once = false;
            part->guards.slips = false;
        }
        first = dalcs_smaller(first, c.theta);
        note_fall(part, &a, &c, depth, at_once);
    }
    return first;
}

double dalcs_guards_first_fall(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                               double end, const double *unit, bool *at_once) {
    part->guards.n_crossed = 0;
    part->guards.may_dip = false;
    part->guards.slips = false;
    *at_once = false;
    find_doubtful(part);
    return part->guards.n_doubtful > 0 ? find_first(r, part, end, unit, at_once) : INFINITY;
}
