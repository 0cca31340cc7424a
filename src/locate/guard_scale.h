/* guard_scale.h - what guards are, and are measured by: the scale of their unit, and rounding. */
#ifndef DALCS_GUARD_SCALE_H
#define DALCS_GUARD_SCALE_H

#include "radau_state.h"

#include "formula_scale.h"
#include "magnitudes.h"
#include "rounding.h"

static inline int dalcs_guards_number(const struct dalcs_radau_part *part) {
    return part->component->system->n_pairs + part->stages.n_watched;
}

/* The pair of a guard. */
static inline int dalcs_guard_pair(const struct dalcs_radau_part *part, int guard) {
    int n_pairs = part->component->system->n_pairs;
    return guard < n_pairs ? guard : part->stages.watched[guard - n_pairs];
}

/* A switch has no sign to keep. */
static inline bool dalcs_guard_is_one(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    return guard >= p->system->n_pairs || p->lists.is_diode[guard];
}

/* Is a pair on another side than in the mode that held last? */
static inline bool dalcs_guard_has_flipped(const struct dalcs_radau_part *part, int pair) {
    return dalcs_mode_has(part->memory.modes_before, pair) !=
           dalcs_osnsp_is_on(&part->component->osnsp, pair);
}

/* V or A; of a voltage or current that moves a switch: its own, as large as what it is a sum of has been, or its
 * thresholds. What is switched may be a million times as much. */
double dalcs_guard_control_scale(const struct dalcs_radau_part *part, int guard,
                                 const double *unit);

/* V or A. */
static inline double dalcs_guard_scale(const struct dalcs_radau_part *part, int guard,
                                       const double *unit) {
    return guard < part->component->system->n_pairs
               ? dalcs_formula_scale(
                     part, guard, unit[dalcs_osnsp_is_on(&part->component->osnsp, guard) ? 1 : 0],
                     unit)
               : dalcs_guard_control_scale(part, guard, unit);
}

/* What rounding makes of a guard that is 0 at most, in V or A: as far as what is held beside it tells. The capacitors at a
 * diode make of the digits of a voltage in a step a current, which is none however small the others are; so for coils and
 * their currents. A dense map tells what rounding of states and sources makes of a guard itself, which is often far less. */
static inline double dalcs_guard_most_rounding(const struct dalcs_radau_part *part, int guard,
                                               const double *unit) {
    const struct dalcs_system *s = part->component->system;
    if (guard >=
        s->n_pairs) { /* small beside others it is as exact as the sums that these are in */
        return dalcs_beyond * dalcs_sum_rounded *
               unit[dalcs_system_control_is_current(s, dalcs_guard_pair(part, guard))];
    }
    bool is_on = dalcs_osnsp_is_on(&part->component->osnsp, guard);
    return dalcs_sum_rounded / part->segment.h *
           (is_on ? part->laws.held_charge[guard] * unit[0]
                  : part->laws.held_flux[guard] * unit[1]);
}

/* Is the step a dense map, which tells what rounding of states and sources makes of anything? */
static inline bool dalcs_guard_has_map(const struct dalcs_radau_part *part) {
    return part->segment.entry != NULL && dalcs_stage_has_map(part->segment.entry);
}

/* Does what a map tells of rounding count, whatever is held beside a guard? */
static inline bool dalcs_guard_may_read_rates(const struct dalcs_radau_part *part) {
    return part->laws.reads_rates && dalcs_guard_has_map(part);
}

/* Has no current flowed that is more than what the conductances make of the voltages next to nothing? The unit's scale of
 * currents says nothing then. */
static inline bool dalcs_guard_nothing_flows(const struct dalcs_radau_part *part,
                                             const double *unit) {
    return unit[1] <= part->scales.cross[1] * unit[0];
}

/* What rounding makes of a pair that is 0 where its whole unit is, in V or A. Where nothing flows in an island that
 * floats, the sum of two conductances, rounded, less each of them is a leak to ground of the last digit. */
double dalcs_guard_rounding_across(const struct dalcs_radau_part *part, int pair,
                                   const double *unit);

/* The same of all that is known. */
double dalcs_guard_rounding(const struct dalcs_radau_part *part, int guard, const double *unit);

#endif
