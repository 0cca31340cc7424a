/* tied.c - diodes that may be on either side, and how one of the two is chosen. */
#include "tied.h"

#include "doubt.h"
#include "extremes.h"
#include "guard_values.h"
#include "magnitudes.h"

#include <math.h>

double dalcs_tied_nothing(const struct dalcs_radau_part *part, int pair, const double *unit) {
    double limit = dalcs_doubt_noise_about(part, pair, dalcs_guard_scale(part, pair, unit), unit);
    return limit + dalcs_guard_rounding(part, pair, unit);
}

/* Are all of these no more than that? */
static bool is_nothing(const struct dalcs_radau_part *part, int pair, const double *value,
                       int stride, const double *unit) {
    double limit = dalcs_tied_nothing(part, pair, unit);
    bool nothing = true;
    for (int k = 0; k < part->stages.layout.n_nodes && nothing; k++) {
        nothing = fabs(value[k * stride]) <= limit;
    }
    return nothing;
}

bool dalcs_tied_was_at_rest(const struct dalcs_radau_part *part, int pair, const double *unit) {
    const double *before =
        pair < part->component->system->n_pairs ? dalcs_guard_values_before(part, pair) : NULL;
    return before != NULL && is_nothing(part, pair, before, part->stages.layout.stride, unit);
}

/* Is it the argument of a formula's jump, on the side that is written for equality? Then this decides. */
static bool is_as_written(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_pair *pair = p->system->pair;
    bool is = false;
    if (guard < p->system->n_pairs && pair[guard].is_jump) {
        is = !dalcs_osnsp_is_on(p, guard) && !dalcs_osnsp_is_on(p, guard + 1) &&
             pair[guard + 1].is_left_out[0];
    } else if (guard > 0 && guard < p->system->n_pairs && pair[guard - 1].is_jump) {
        is = dalcs_osnsp_is_on(p, guard) && dalcs_osnsp_is_on(p, guard - 1) &&
             pair[guard - 1].is_left_out[1];
    }
    return is;
}

bool dalcs_tied_is(const struct dalcs_radau_part *part, int pair, const double *unit) {
    double work[DALCS_MAX_NODES];
    int stride;
    const double *value = dalcs_guard_values(part, pair, work, &stride);
    return dalcs_guard_is_one(part, pair) && is_nothing(part, pair, value, stride, unit) &&
           !dalcs_guard_has_crossed(part, pair, value, stride, unit) && !is_as_written(part, pair);
}

/* A closed pair that had no current in the whole segment before either? An open one without voltage may
 * have got another in parallel. */
static bool was_tied(const struct dalcs_radau_part *part, int pair, const double *unit) {
    bool is_closed = part->guards.flipped && dalcs_osnsp_is_on(&part->component->osnsp, pair);
    return is_closed && dalcs_tied_was_at_rest(part, pair, unit);
}

/* An open pair without the least voltage, where all answers are the only ones: to close it would change nothing. */
static bool is_settled(const struct dalcs_radau_part *part, int pair) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *value = part->segment.out + dalcs_system_n_equations(p->system) + pair;
    bool settled = dalcs_osnsp_is_unique(p) && !dalcs_osnsp_is_on(p, pair);
    for (int k = 0; k < l->n_nodes && settled; k++) {
        settled = value[k * l->stride] == 0.0;
    }
    return settled;
}

bool dalcs_tied_stay(const struct dalcs_radau_part *part, bool is_determined, const double *unit) {
    int n_pairs = part->component->system->n_pairs;
    bool tied = false;
    for (int d = 0; d < n_pairs && !tied && !(n_pairs > DALCS_MANY_PAIRS && part->guards.flipped);
         d++) {
        tied = dalcs_tied_is(part, d, unit) && !is_settled(part, d) &&
               !(is_determined && was_tied(part, d, unit));
    }
    return tied;
}

/* Is its value at the end of the step above 0 by more than at the start, however little that is beyond rounding? */
static bool grows(const struct dalcs_radau_part *part, int pair, const double *unit) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *value =
        part->segment.out + dalcs_system_n_equations(part->component->system) + pair;
    return value[(l->n_nodes - 1) * l->stride] >
           dalcs_larger(fabs(value[0]), dalcs_guard_rounding_across(part, pair, unit));
}

bool dalcs_tied_leaves(const struct dalcs_radau_part *part, int pair, double sign) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *value =
        part->segment.out + dalcs_system_n_equations(part->component->system) + pair;
    double last = sign * value[(l->n_nodes - 1) * l->stride];
    bool does = part->segment.rounding == 1.0 && last > 0.0 &&
                fabs(value[0]) <= dalcs_slight * dalcs_slight * last;
    for (int k = 1; k < l->n_nodes && does; k++) {
        does = sign * value[k * l->stride] > sign * value[(k - 1) * l->stride];
    }
    return does;
}

/* Is a pair above 0, by more than rounding, halfway to `end`? */
static bool is_above(const struct dalcs_radau_part *part, int pair, double end,
                     const double *unit) {
    const double *value =
        part->segment.out + dalcs_system_n_equations(part->component->system) + pair;
    return dalcs_guard_value_at(part, value, part->stages.layout.stride, 0.5 * end) >
           dalcs_tied_nothing(part, pair, unit);
}

bool dalcs_tied_open_idle(struct dalcs_radau_part *part, const uint64_t *before, double end,
                          const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int d = 0; d < p->system->n_pairs; d++) {
        bool is_tried = dalcs_osnsp_is_on(p, d) && !dalcs_mode_has(before, d);
        if (is_tried && !is_above(part, d, end, unit) && !dalcs_tied_leaves(part, d, 1.0)) {
            dalcs_osnsp_command(p, d, false);
            found = true;
        }
    }
    return found;
}

bool dalcs_tied_turn(struct dalcs_radau_part *part, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int d = 0; d < p->system->n_pairs && p->system->n_pairs <= DALCS_MANY_PAIRS; d++) {
        if (!dalcs_tied_is(part, d, unit)) {
            continue;
        }
        bool is_on = dalcs_osnsp_is_on(p, d);
        if (is_on ? !grows(part, d, unit) : dalcs_tied_leaves(part, d, -1.0)) {
            dalcs_osnsp_command(p, d, !is_on);
            found = true;
        }
    }
    return found;
}

bool dalcs_tied_share(struct dalcs_radau_part *part, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool may_share = p->system->n_pairs <= DALCS_MANY_PAIRS && !dalcs_osnsp_is_unique(p);
    bool found = false;
    for (int d = 0; d < p->system->n_pairs && may_share; d++) {
        if (!dalcs_osnsp_is_on(p, d) && dalcs_tied_is(part, d, unit)) {
            dalcs_osnsp_command(p, d, true);
            found = true;
        }
    }
    return found;
}
