/* current_error.c - the drift of the states (step_error.c), carried on to currents, and to voltages that are made of
 * currents.
 *
 * 400 V that feed 100 uF through 1 mohm: a millivolt is an ampere, so that a state well within its
 * tolerance can make a current of 40 A wrong. And 0.1 A of two coils that meet at 70 kohm are 7 kV, so that a
 * ten millionth of them is a millivolt. The output of an amplifier is its gain times a state. Of other voltages
 * nothing like it is asked: a coil cut off by 10 Mohm has transients of 10 ps, which nobody wants to wait for. In most circuits no state has such a
 * lever; by maps that is looked up now and then, and costs them nothing else. Factors do not tell it: there all
 * voltages count that resistors make of coils, and search.c lets those pass that no shorter step mends. */
#include "current_error.h"

#include "extremes.h"
#include "magnitudes.h"
#include "rounding.h"
#include "step_error.h"

#include <math.h>

/* Steps with an entry until levers are looked up again, as scales grow; steps with one, which may be gone when scales have
 * grown. */
enum { STEPS_BETWEEN = 256, STEPS_WITH = 32 };

static double allowed_of(const struct dalcs_radau_part *part, int k, const double unit[2],
                         const double besides[2]) {
    int column = part->stages.levered[k];
    bool is_current = part->component->system->column_is_current[column];
    /* Megohms make voltages of the rounding of amperes: what nobody sees of one with a lever is let be. */
    const double least = is_current ? 0.0 : dalcs_slight * dalcs_nothing;
    return dalcs_larger(part->inner_tolerance, least) * dalcs_step_scale(part, column, unit) +
           besides[is_current];
}

/* The largest drift of a state, over what is allowed, that states as large as they have been could make. */
static double spread_of_states(const struct dalcs_radau_part *part,
                               const struct dalcs_stage_entry *entry, const double unit[2],
                               const double besides[2]) {
    const struct dalcs_system *s = part->component->system;
    double largest = 0.0;
    for (int x = 0; x < s->n_x; x++) {
        double spread = dalcs_stage_spread(&part->stages, entry, part->stages.layout.drift + x,
                                           part->segment.in, part->scales.column);
        double allowed = part->inner_tolerance * dalcs_step_scale(part, x, unit) +
                         besides[s->column_is_current[x]];
        largest = dalcs_larger(largest, spread / allowed);
    }
    return largest;
}

/* Could states as large as they have been make an error that is noticed? In a voltage one that is beyond that of states:
 * most voltages follow them. */
static bool has_lever(const struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry,
                      const double unit[2], const double besides[2]) {
    const struct dalcs_stages *stages = &part->stages;
    const bool *is_current = part->component->system->column_is_current;
    double of_states = -1.0;
    for (int k = 0; k < stages->n_levered; k++) {
        double spread =
            dalcs_stage_spread_of_current(stages, entry, k, part->segment.in, part->scales.column);
        double least = dalcs_beyond * allowed_of(part, k, unit, besides);
        if (spread > dalcs_small * least && !is_current[stages->levered[k]]) {
            of_states = of_states < 0.0 ? spread_of_states(part, entry, unit, besides) : of_states;
            least *= dalcs_larger(1.0, dalcs_beyond / dalcs_small * of_states);
        }
        if (spread > dalcs_small * least) {
            return true;
        }
    }
    return false;
}

/* The largest of what currents have been made of in steps with a lever. */
static void raise_parts(struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry) {
    const struct dalcs_stages *stages = &part->stages;
    for (int k = 0; k < stages->n_levered; k++) {
        double spread = dalcs_stage_spread(stages, entry, stages->levered[k], part->segment.in,
                                           part->scales.column);
        part->scales.current_parts[k] = dalcs_larger(part->scales.current_parts[k], spread);
    }
}

/* Has a state a lever in this step? The note of an entry counts its steps until that is looked up again:
 * positive without a lever, negative with one. On factors it is not looked up. */
static bool may_matter(struct dalcs_radau_part *part, struct dalcs_stage_entry *entry,
                       const double unit[2], const double besides[2]) {
    int *note = dalcs_stage_note(entry);
    if (*note > 0) {
        --*note;
        return false;
    }
    bool has = part->stages.n_levered > 0;
    if (has && *note == 0 && dalcs_stage_has_map(entry)) {
        has = has_lever(part, entry, unit, besides);
        *note = has ? -STEPS_WITH : STEPS_BETWEEN;
        if (has) {
            raise_parts(part, entry);
        }
    }
    *note += *note < 0 ? 1 : 0;
    return has;
}

/* What rounding may make of the drift of a current, or of a voltage: of what it is a difference of now, and of the most
 * that it has been one of, whose rounding the states keep; on factors, of a balanced column of 1 by `balanced`. */
static double rounding_of(const struct dalcs_radau_part *part,
                          const struct dalcs_stage_entry *entry, int k, double balanced) {
    const struct dalcs_stages *stages = &part->stages;
    if (dalcs_stage_has_map(entry)) {
        double spread =
            dalcs_stage_spread_of_current(stages, entry, k, part->segment.in, part->scales.column);
        return dalcs_sum_rounded * (spread + part->scales.current_parts[k]);
    }
    return balanced * dalcs_stage_natural_units(entry)[stages->levered[k]];
}

/* The drift on factors is a solution by itself, of small numbers: what cancels in stages is not in it. It takes a pass over
 * all columns. */
static double balanced_rounding(const struct dalcs_radau_part *part,
                                const struct dalcs_stage_entry *entry) {
    return dalcs_stage_has_map(entry) ? 0.0 : dalcs_step_rounding(part, entry);
}

void dalcs_current_error(struct dalcs_radau_part *part, struct dalcs_stage_entry *entry,
                         const double unit[2], const double besides[2],
                         struct dalcs_lever_error *e) {
    struct dalcs_stages *stages = &part->stages;
    *e = (struct dalcs_lever_error){0};
    int n = may_matter(part, entry, unit, besides) ? stages->n_levered : 0;
    if (n > 0) {
        dalcs_stages_drift_of_currents(stages, entry, part->segment.in, part->scales.current_drift);
    }
    double balanced = n > 0 ? balanced_rounding(part, entry) : 0.0;
    for (int k = 0; k < n; k++) {
        double *worst = k < stages->n_currents ? &e->of_currents : &e->of_voltages;
        /* What is left of the drift after its filter once more is so many times what currents are off by between the nodes,
         * while something dies away within the step to a third or less. */
        double error = fabs(part->scales.current_drift[k]) / dalcs_beyond;
        double allowed = allowed_of(part, k, unit, besides);
        double least = dalcs_larger(dalcs_small, dalcs_smaller(*worst, 1.0));
        if (!(error > least * allowed)) {
            continue;
        }
        if (!(error * dalcs_beyond > rounding_of(part, entry, k, balanced))) {
            continue;
        }
        *worst = dalcs_larger(*worst, error / allowed);
    }
}
