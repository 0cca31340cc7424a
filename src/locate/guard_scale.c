/* guard_scale.c - of voltages that move switches, and of rounding as it follows from maps and Kirchhoff's laws. */
#include "guard_scale.h"

#include "extremes.h"
#include "pair_laws.h"
#include "rounding.h"
#include "step_error.h"

#include <math.h>

double dalcs_guard_control_scale(const struct dalcs_radau_part *part, int guard,
                                 const double *unit) {
    const struct dalcs_system *s = part->component->system;
    int d = dalcs_guard_pair(part, guard);
    double size = 0.0;
    for (int k = s->control.p[d]; k < s->control.p[d + 1]; k++) {
        size += fabs(s->control.x[k]) * dalcs_step_scale(part, s->control.j[k], unit);
    }
    return fmax(size, fmax(fabs(s->pair[d].turn_on), fabs(s->pair[d].turn_off)));
}

/* Of a guard by the map of the step; `most` where there is none. */
static double rounding_by_map(const struct dalcs_radau_part *part, int place, double most) {
    if (!dalcs_guard_has_map(part)) {
        return most;
    }
    return dalcs_smaller(most, dalcs_sum_rounded *
                                   dalcs_stage_spread(&part->stages, part->segment.entry, place,
                                                      part->segment.in, part->scales.column));
}

double dalcs_guard_rounding_across(const struct dalcs_radau_part *part, int pair,
                                   const double *unit) {
    bool is_on = dalcs_osnsp_is_on(&part->component->osnsp, pair);
    double leak =
        is_on && dalcs_guard_nothing_flows(part, unit) ? part->scales.leak * unit[0] : 0.0;
    return dalcs_larger(dalcs_step_crossed(part, is_on ? 1 : 0, unit), leak);
}

/* By what is held beside it. */
static double rounding_of_pair(const struct dalcs_radau_part *part, int guard, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    double most = dalcs_guard_most_rounding(part, guard, unit);
    if (dalcs_guard_may_read_rates(part)) {
        return rounding_by_map(part, dalcs_system_n_equations(s) + guard, INFINITY);
    }
    if (!(most > 0.0)) {
        return 0.0;
    }
    bool is_on = dalcs_osnsp_is_on(&part->component->osnsp, guard);
    most = is_on ? dalcs_pair_charge_rate(part, guard) * unit[0]
                 : part->laws.held_flux[guard] / part->segment.h * unit[1];
    if (!dalcs_guard_has_map(part) && !is_on) {
        most = dalcs_smaller(most, dalcs_pair_flux(part, guard) / part->segment.h);
    }
    return rounding_by_map(part, dalcs_system_n_equations(s) + guard, dalcs_sum_rounded * most);
}

double dalcs_guard_rounding(const struct dalcs_radau_part *part, int guard, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    if (guard < s->n_pairs) {
        return rounding_of_pair(part, guard, unit) + dalcs_guard_rounding_across(part, guard, unit);
    }
    double most =
        dalcs_guard_may_read_rates(part) ? INFINITY : dalcs_guard_most_rounding(part, guard, unit);
    return most > 0.0 ? rounding_by_map(part, dalcs_system_n_columns(s) + guard - s->n_pairs, most)
                      : 0.0;
}
