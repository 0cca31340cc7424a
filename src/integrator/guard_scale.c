/* guard_scale.c - of voltages that move switches, and of rounding as maps and Kirchhoff's laws tell it. */
#include "guard_scale.h"

#include "extremes.h"
#include "pair_laws.h"

#include <math.h>

double dalcs_guard_control_scale(const struct dalcs_radau_part *part, int guard,
                                 const double *unit) {
    const struct dalcs_system *s = part->component->system;
    int d = dalcs_guard_pair(part, guard);
    return fmax(unit[dalcs_system_control_is_current(s, d)],
                fmax(fabs(s->pair[d].turn_on), fabs(s->pair[d].turn_off)));
}

double dalcs_guard_rounding(const struct dalcs_radau_part *part, int guard, const double *unit) {
    if (!(dalcs_guard_most_rounding(part, guard, unit) > 0.0)) {
        return 0.0;
    }
    bool is_on = dalcs_osnsp_is_on(&part->component->osnsp, guard);
    double most = is_on ? dalcs_pair_charge_rate(part, guard) * unit[0]
                        : part->held_flux[guard] / part->h * unit[1];
    if (part->entry != NULL && dalcs_stage_has_map(part->entry)) {
        int place = dalcs_system_n_equations(part->component->system) + guard;
        double by_map =
            dalcs_stage_spread(&part->stages, part->entry, place, part->in, part->scale);
        most = dalcs_smaller(most, by_map);
    } else if (!is_on) {
        most = dalcs_smaller(most, dalcs_pair_flux(part, guard) / part->h);
    }
    return dalcs_guard_rounded * most;
}
