/* guards.c - when guards fall, and what a fall means. */
#include "guards.h"

#include "crossing.h"
#include "doubt.h"
#include "extremes.h"
#include "guard_scale.h"
#include "guard_values.h"
#include "pair_laws.h"
#include "quads.h"
#include "step_length.h"
#include "tied.h"

#include <math.h>

/* The part of its doubt that counts in later steps where such a pair goes on falling, or stays where it is: a diode
 * that waits for the whole band is wrong meanwhile, and a jump when it turns, which may turn its neighbours. One that
 * comes down to 0 from above and goes up again, as that of a peak detector without a load at each peak, may be on the
 * other side by as much. */
static const double part_of_doubt = 1e-3;

/* A guard that begins a mode next to 0 is off by so many times that, as far as its beginning tells. */
static const double began = 10.0;

/* The voltage of a diode that has just opened, and rises, may begin so far below 0, over the largest: what a sum of
 * siemens and microsiemens rounds of the latter, where only these lead on, is no event. */
static const double blocking = 1e-9;

/* An error of the polynomial may be so many bands at its start. */
static const double shallow = 100.0;

/* And so much is let be in any case, over the unit's scale, where it is over at once; so much, where time
 * does not tell it from nothing. */
static const double slight = 1e-8, unresolved = 1e-5;

/* What dies away between two nodes leaves so much of itself, of either sign, at those behind: in the first step
 * of a mode, and in later ones, which have got longer meanwhile. */
static const double swing = 0.1, late_swing = 0.01;

/* Falls this near to each other, in steps, are one event. */
static const double same_on_maps = 1e-13;
static const double same_on_factors = 1e-9;

/* And those that are so near and no more than their doubt above 0 at the first of them. */
static const double same_by_value = 1e-10;

/* A fall this early in a step is one from the start; so early where no pair has changed sides and it was above 0
 * by no more than its doubt: from rest a circuit may begin to move as a power of time. */
static const double soon_after = 1e-6, from_rest = 1.0 / 64.0;

enum dalcs_status dalcs_guards_setup(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    size_t n_equations = (size_t)dalcs_system_n_equations(s);
    part->laws.held_charge = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(double));
    part->laws.held_flux = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(double));
    part->laws.pair_row = dalcs_arena_alloc(&part->arena, 2 * (size_t)s->n_pairs, sizeof(int));
    part->laws.law = dalcs_arena_alloc(&part->arena, DALCS_PAIR_LAWS * (size_t)s->n_pairs,
                                       sizeof(*part->laws.law));
    part->laws.rate =
        dalcs_pair_rate_create(&part->arena, s->n_pairs, part->component->osnsp.n_words);
    part->laws.inductance = dalcs_arena_alloc(&part->arena, n_equations, sizeof(double));
    part->guards.bound = dalcs_arena_alloc(
        &part->arena, (size_t)dalcs_quads_of(dalcs_guards_number(part)) + DALCS_QUAD,
        sizeof(double));
    part->guards.doubtful =
        dalcs_arena_alloc(&part->arena, (size_t)dalcs_guards_number(part), sizeof(int));
    if (part->guards.bound == NULL || part->guards.doubtful == NULL ||
        part->laws.held_charge == NULL || part->laws.held_flux == NULL ||
        part->laws.pair_row == NULL || part->laws.law == NULL || part->laws.rate == NULL ||
        part->laws.inductance == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_pair_laws_find(part);
    return dalcs_stages_have_maps(&part->stages) ? DALCS_OK : dalcs_doubt_setup(part);
}

static void arm_controls(struct dalcs_radau_part *part, bool at_end, double band,
                         const double *unit) {
    int node = at_end ? part->stages.layout.n_nodes - 1 : 0;
    for (int g = part->component->system->n_pairs; g < dalcs_guards_number(part); g++) {
        if (!(at_end && part->guards.armed[g])) {
            part->guards.armed[g] = dalcs_guard_control_at(part, g, node) >
                                    band * dalcs_guard_control_scale(part, g, unit);
        }
    }
}

/* Is a pair on the side that it was on in the segment before, with the same value? */
static bool goes_on(const struct dalcs_radau_part *part, int pair, double value) {
    const double *before = dalcs_guard_values_before(part, pair);
    if (before == NULL) {
        return false;
    }
    double last =
        dalcs_guard_value_at(part, before, part->stages.layout.stride, part->segment.end_before);
    return fabs(value - last) <= dalcs_guard_agreeing * value;
}

void dalcs_guards_arm(struct dalcs_radau_part *part, bool at_end, const double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_pairs = p->system->n_pairs;
    double band = dalcs_doubt_band(part);
    double known = dalcs_doubt_noise(part);
    const double *value = part->segment.out + (at_end ? (l->n_nodes - 1) * l->stride : 0) +
                          dalcs_system_n_equations(p->system);
    bool *armed = part->guards.armed;
    for (int d = 0; d < n_pairs; d++) {
        if (p->is_diode[d] && !(at_end && armed[d])) {
            double scale = unit[dalcs_osnsp_is_on(p, d)];
            armed[d] =
                value[d] > band * scale ||
                (value[d] > known * scale && ((!at_end && goes_on(part, d, value[d])) ||
                                              value[d] > dalcs_doubt_about(part, d, scale, unit)));
        }
    }
    if (part->stages.n_watched > 0) {
        arm_controls(part, at_end, band, unit);
    }
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

/* Is a guard above 0 before times can be told apart? */
static bool is_over_at_once(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            const double *value, int stride) {
    double instant = dalcs_smaller(1.0, dalcs_length_shortest(r) / part->segment.h);
    return dalcs_guard_value_at(part, value, stride, instant) > 0.0;
}

/* A guard that starts a little below 0 and is above after next to no time: the flank of a source, when it
 * begins, may take over from a current within 1e-16 s. Or after less than times can be told apart: the
 * last digit of a time makes volts of a current that has nowhere to go but a leak. */
static bool is_over_soon(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                         const double *value, int stride, double scale) {
    double little = fmax(shallow * dalcs_doubt_band(part), slight) * scale;
    return (value[0] >= -little && dalcs_guard_value_at(part, value, stride, soon_after) > 0.0) ||
           (value[0] >= -unresolved * scale && is_over_at_once(r, part, value, stride));
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
static double doubt_at_first(struct dalcs_radau_part *part, const double *value, int stride,
                             double end, double doubt) {
    const struct dalcs_collocation *m = part->stages.method;
    double least = dalcs_larger(began * fabs(value[0]), part_of_doubt * doubt);
    double depth = dalcs_smaller(doubt, dalcs_larger(least, part->segment.ratio * doubt));
    for (int k = 1; k <= m->s && m->node[k] <= end && !part->guards.may_dip; k++) {
        part->guards.may_dip = value[k * stride] < -least && value[k * stride] >= -depth;
    }
    return depth;
}

/* How far a guard may fall and is no event: where it is armed by rounding, `noise`, or as far as it may be touching
 * 0. */
static double doubt_of(struct dalcs_radau_part *part, int guard, const double *value, int stride,
                       double end, double noise, const double *unit) {
    int last = part->stages.layout.n_nodes - 1;
    double scale = dalcs_guard_scale(part, guard, unit);
    bool is_armed = part->guards.armed[guard];
    if (is_armed && (end < 1.0 ? dalcs_guard_value_at(part, value, stride, end)
                               : value[last * stride]) <= noise) {
        return noise; /* it does not come back */
    }
    double doubt = dalcs_doubt_of_fall(part, guard, scale, unit);
    if (is_armed) {
        return dalcs_larger(noise, part_of_doubt * doubt);
    }
    if (part->guards.fresh && guard < part->component->system->n_pairs &&
        dalcs_guard_has_crossed(part, guard, value, stride, unit)) {
        return dalcs_osnsp_is_on(&part->component->osnsp, guard)
                   ? dalcs_doubt_of_closed(part, guard, scale)
                   : dalcs_larger(dalcs_doubt_band(part), blocking) * scale;
    }
    if (part->guards.fresh) {
        return doubt_at_first(part, value, stride, end, doubt);
    }
    return value[last * stride] < (1.0 - dalcs_guard_agreeing) * value[0] ? part_of_doubt * doubt
                                                                          : doubt;
}

/* Does a guard that falls at `theta` or later do so at an event that is no farther before than errors move it? Diodes
 * in series open together, whichever has a rounding more: leaks alone would take that down, late. */
static bool falls_with(const struct dalcs_radau_part *part, int guard, double event, double theta,
                       const double *unit) {
    if (!part->guards.armed[guard] || theta - event > same_by_value) {
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

/* The first of the doubtful ones. */
static double find_first(const struct dalcs_radau *r, struct dalcs_radau_part *part, double end,
                         const double *unit, bool *at_once) {
    double first = INFINITY;
    double same = part->segment.rounding > 1.0 ? same_on_factors : same_on_maps;
    double together = dalcs_larger(same, 2.0 * r->resolution / part->segment.h);
    double band = dalcs_doubt_band(part);
    double too_late = end_of_events(r, part, end, band);
    int last = part->stages.layout.n_nodes - 1;
    int n_pairs = part->component->system->n_pairs;
    for (int k = 0; k < part->guards.n_doubtful; k++) {
        int g = part->guards.doubtful[k];
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = dalcs_guard_values(part, g, work, &stride);
        double scale = dalcs_guard_scale(part, g, unit);
        double rounding = dalcs_guard_rounding(part, g, unit);
        double zero = dalcs_doubt_noise_about(part, g, scale, unit);
        if (!part->guards.fresh && value[0] <= part_of_doubt * band * scale &&
            fabs(value[last * stride]) <= zero + rounding) {
            part->guards.armed[g] = false; /* what has died away has no sign any more */
        }
        if (part->guards.bound[g] >= -zero - rounding) {
            continue;
        }
        if (!part->guards.armed[g] && !part->guards.fresh && value[0] > zero + rounding) {
            part->guards.armed[g] = g < n_pairs && goes_on(part, g, value[0]);
        }
        double depth = doubt_of(part, g, value, stride, end, zero, unit);
        depth += rounding;
        if (part->guards.bound[g] >= -depth) {
            continue;
        }
        if (part->guards.fresh && value[0] < -depth &&
            is_over_soon(r, part, value, stride, scale)) {
            depth = -2.0 * value[0];
        }
        struct dalcs_crossing c =
            dalcs_crossing_find(part->stages.method, value, stride, end, depth,
                                part->guards.n_crossed > 0 ? first : 0.0);
        bool is_late =
            c.theta >= too_late && dalcs_guard_value_at(part, value, stride, end) >= -band * scale;
        if (!c.falls || is_late ||
            (c.theta > first + together && !falls_with(part, g, first, c.theta, unit))) {
            continue;
        }
        if (c.theta < first - together && !all_fall_with(part, c.theta, first, unit)) {
            part->guards.n_crossed = 0;
            *at_once = false;
            part->guards.slips = false;
        }
        first = dalcs_smaller(first, c.theta);
        bool slips = part->guards.fresh && c.theta <= from_rest && c.peak <= depth;
        part->guards.slips = part->guards.slips || slips;
        bool soon = c.at_once ||
                    (slips && (!part->guards.flipped || dalcs_tied_was_at_rest(part, g, unit))) ||
                    (c.theta <= soon_after && c.peak <= band * scale);
        *at_once = *at_once || (!part->guards.armed[g] && soon);
        part->guards.crossed[part->guards.n_crossed++] = g;
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

bool dalcs_guards_recover(const struct dalcs_radau_part *part, const double *unit) {
    int last = part->stages.layout.n_nodes - 1;
    bool all = true;
    for (int k = 0; k < part->guards.n_crossed && all; k++) {
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = dalcs_guard_values(part, part->guards.crossed[k], work, &stride);
        double band =
            dalcs_doubt_band(part) * dalcs_guard_scale(part, part->guards.crossed[k], unit);
        all = value[0] >= -shallow * band && value[last * stride] > 0.0;
    }
    return all;
}

/* Where in the step a guard that is below 0 at its start is above again; INFINITY if it is not. */
static double rise_of(const struct dalcs_radau_part *part, const double *value, int stride) {
    double negative[DALCS_MAX_NODES];
    for (int i = 0; i < part->stages.layout.n_nodes; i++) {
        negative[i] = -value[i * stride];
    }
    struct dalcs_crossing rise =
        dalcs_crossing_find(part->stages.method, negative, 1, 1.0, 0.0, 0.0);
    return value[0] < 0.0 && rise.falls ? rise.theta : INFINITY;
}

double dalcs_guards_recovery(const struct dalcs_radau_part *part) {
    double latest = 0.0;
    for (int k = 0; k < part->guards.n_crossed; k++) {
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = dalcs_guard_values(part, part->guards.crossed[k], work, &stride);
        latest = dalcs_larger(latest, rise_of(part, value, stride));
    }
    return latest;
}

bool dalcs_guards_swing(const struct dalcs_radau_part *part) {
    int last = part->stages.layout.n_nodes - 1;
    bool all = part->guards.n_crossed > 0;
    double part_left = part->guards.fresh ? swing : late_swing;
    for (int k = 0; k < part->guards.n_crossed && all; k++) {
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = dalcs_guard_values(part, part->guards.crossed[k], work, &stride);
        double least = 0.0;
        for (int i = 1; i < last; i++) {
            least = dalcs_smaller(least, value[i * stride]);
        }
        all = value[last * stride] > 0.0 && least > -part_left * value[0];
    }
    return all;
}

/* Is it below 0 from the start on, and does not come back by half up to `end`? By more than `least`, or by more
 * than `nothing` and always the same, as no error of the polynomial is. */
static bool stays_below(const struct dalcs_radau_part *part, int pair, double end, double least,
                        double nothing) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *value =
        part->segment.out + dalcs_system_n_equations(part->component->system) + pair;
    bool stays = value[0] < -nothing;
    bool same = true;
    for (int k = 1; k < l->n_nodes && part->stages.method->node[k] <= end && stays; k++) {
        stays = value[k * l->stride] < 0.5 * value[0];
        same = same && fabs(value[k * l->stride] - value[0]) <= -dalcs_guard_agreeing * value[0];
    }
    return stays && (same || value[0] < -least);
}

bool dalcs_guards_stay_negative(const struct dalcs_radau_part *part, double end,
                                const double *unit) {
    int n_pairs = part->component->system->n_pairs;
    double noise = dalcs_beyond_noise * dalcs_doubt_noise(part);
    double least = fmax(part_of_doubt * dalcs_doubt_band(part), noise);
    bool negative = false;
    for (int k = 0; k < part->guards.n_doubtful && !negative && n_pairs <= DALCS_MANY_PAIRS; k++) {
        int d = part->guards.doubtful[k];
        if (d < n_pairs) {
            double scale = dalcs_guard_scale(part, d, unit);
            double rounding = dalcs_guard_rounding(part, d, unit);
            negative =
                stays_below(part, d, end, least * scale + rounding, noise * scale + rounding);
        }
    }
    return negative;
}

/* Nodes at the start of the present segment at which a pair is negative and that does not count: what is over before
 * it begins, and what a current is off by that begins. */
static int count_excused(const struct dalcs_radau *r, const struct dalcs_radau_part *part, int pair,
                         const double *value, const double *unit) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n = 0;
    if (!part->guards.fresh || value[0] >= 0.0) {
        return 0;
    }
    if (is_over_soon(r, part, value, l->stride, dalcs_guard_scale(part, pair, unit))) {
        return 1;
    }
    bool begins = dalcs_guard_has_crossed(part, pair, value, l->stride, unit);
    if (!begins && is_over_at_once(r, part, value, l->stride)) {
        return 1;
    }
    while (begins && n < l->n_nodes && value[n * l->stride] < 0.0) {
        n++;
    }
    return n;
}

double dalcs_guards_wrong_sign(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                               double end, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double worst = 0.0;
    for (int i = 0; i < part->guards.n_doubtful && part->guards.doubtful[i] < s->n_pairs; i++) {
        int d = part->guards.doubtful[i];
        const double *value = part->segment.out + dalcs_system_n_equations(s) + d;
        double scale = dalcs_guard_scale(part, d, unit);
        double least = 0.0;
        int k = count_excused(r, part, d, value, unit);
        for (; k < l->n_nodes && part->stages.method->node[k] <= end; k++) {
            least = dalcs_smaller(least, value[k * l->stride]);
        }
        if (least < 0.0) {
            worst = dalcs_larger(worst, -least / scale);
        }
    }
    return worst;
}

void dalcs_guards_flip(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    for (int k = 0; k < part->guards.n_crossed; k++) {
        int d = dalcs_guard_pair(part, part->guards.crossed[k]);
        dalcs_osnsp_command(p, d, !dalcs_osnsp_is_on(p, d));
    }
}

/* Is it 0 at all nodes, as far as digits tell? */
static bool rests(const struct dalcs_radau_part *part, int guard, const double *unit) {
    double nothing = dalcs_guard_rounding(part, guard, unit);
    bool is = true;
    for (int k = 0; k < part->stages.layout.n_nodes && is; k++) {
        is = fabs(dalcs_guard_control_at(part, guard, k)) <= nothing;
    }
    return is;
}

bool dalcs_guards_open_resting(struct dalcs_radau_part *part, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool any = false;
    for (int g = p->system->n_pairs; g < dalcs_guards_number(part); g++) {
        int d = dalcs_guard_pair(part, g);
        bool has_closed = dalcs_osnsp_is_on(p, d) && dalcs_guard_has_flipped(part, d) &&
                          !dalcs_pair_remembers(&p->system->pair[d]);
        if (has_closed && rests(part, g, unit)) {
            dalcs_osnsp_command(p, d, false);
            any = true;
        }
    }
    return any;
}
