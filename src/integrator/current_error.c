/* current_error.c - the drift of the states (step_error.c), carried on to currents.
 *
 * 400 V that feed 100 uF through 1 mohm: a millivolt is an ampere, so that a state well within its
 * tolerance can make a current of 40 A wrong. Of voltages nothing like it is asked: a coil cut off by
 * 10 Mohm has transients of 10 ps, which nobody wants to wait for. In most circuits no state has such a
 * lever; that is looked up now and then, and costs them nothing else. */
#include "current_error.h"

#include "extremes.h"
#include "step_error.h"

#include <float.h>
#include <math.h>

/* What is left of the drift after its filter once more is this many times what currents are off by between
 * the nodes, while something dies away within the step to a third or less. */
static const double pessimism = 10.0;

/* No step gets longer for an error below this part of what is allowed. */
static const double noticed = 1.0 / 512.0;

/* With a lever this is what is left above rounding. */
static const double least_tolerance = 1e-10;

/* Roundings in an element of a map times its input, which has those of the steps before. */
static const double roundings = 32.0 * DBL_EPSILON;

/* What rounding of voltages makes of the current that is their difference over a resistance no step mends; a
 * part of that is in its drift, too, where nearly all of it cancels. */
static const double roundings_apart = 0.25 * DBL_EPSILON;

/* Of what rounding of the largest column may make of a current, on factors: the drift is a solution by
 * itself, of small numbers. */
static const double on_factors = 1.0 / 16.0;

/* Steps with an entry until levers are looked up again, as scales grow, and by how much they may. */
enum { STEPS_BETWEEN = 256 };

static const double growth = 2.0;

static double allowed_of(const struct dalcs_radau *r, const struct dalcs_radau_part *part, int k,
                         const double unit[2], double besides) {
    return dalcs_larger(r->inner_tolerance, least_tolerance) *
               dalcs_step_scale(part, part->stages.current[k], unit) +
           besides;
}

/* Could states as large as they have been make an error that is noticed? */
static bool has_lever(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                      const struct dalcs_stage_entry *entry, const double unit[2], double besides) {
    for (int k = 0; k < part->stages.n_currents; k++) {
        double spread =
            dalcs_stage_spread_of_current(&part->stages, entry, k, part->in, part->scale);
        if (growth * spread > pessimism * noticed * allowed_of(r, part, k, unit, besides)) {
            return true;
        }
    }
    return false;
}

/* The largest of what currents have been made of in steps with a lever. */
static void raise_parts(struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry) {
    const struct dalcs_stages *stages = &part->stages;
    for (int k = 0; k < stages->n_currents; k++) {
        double spread =
            dalcs_stage_spread(stages, entry, stages->current[k], part->in, part->scale);
        part->current_parts[k] = dalcs_larger(part->current_parts[k], spread);
    }
}

/* Has a state a lever in this step? The note of an entry counts its steps until that is looked up again:
 * positive without a lever, negative with one. On factors it is not looked up. */
static bool may_matter(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                       struct dalcs_stage_entry *entry, const double unit[2], double besides) {
    int *note = dalcs_stage_note(entry);
    if (*note > 0) {
        --*note;
        return false;
    }
    if (part->stages.n_currents == 0 || !dalcs_stage_has_map(entry)) {
        return part->stages.n_currents > 0;
    }
    if (*note == 0) {
        *note = has_lever(r, part, entry, unit, besides) ? -STEPS_BETWEEN : STEPS_BETWEEN;
    }
    bool has = *note < 0;
    if (*note == -STEPS_BETWEEN) {
        raise_parts(part, entry);
    }
    *note += has ? 1 : 0;
    return has;
}

/* What rounding may make of the drift of a current. */
static double rounding_of(const struct dalcs_radau_part *part,
                          const struct dalcs_stage_entry *entry, int k) {
    const struct dalcs_stages *stages = &part->stages;
    if (dalcs_stage_has_map(entry)) {
        return roundings * dalcs_stage_spread_of_current(stages, entry, k, part->in, part->scale) +
               roundings_apart * part->current_parts[k];
    }
    return on_factors * dalcs_step_rounding(part, entry) *
           dalcs_stage_natural_units(entry)[stages->current[k]];
}

double dalcs_current_error(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                           struct dalcs_stage_entry *entry, const double unit[2], double besides,
                           double *of_unit) {
    struct dalcs_stages *stages = &part->stages;
    *of_unit = 0.0;
    if (!may_matter(r, part, entry, unit, besides)) {
        return 0.0;
    }
    dalcs_stages_drift_of_currents(stages, entry, part->in, part->current_drift);
    double worst = noticed;
    for (int k = 0; k < stages->n_currents; k++) {
        double error = fabs(part->current_drift[k]) / pessimism;
        double allowed = allowed_of(r, part, k, unit, besides);
        bool counts = error > dalcs_smaller(worst, 1.0) * allowed &&
                      error * pessimism > rounding_of(part, entry, k);
        if (counts) {
            worst = dalcs_larger(worst, error / allowed);
            *of_unit = error > allowed ? dalcs_larger(*of_unit, error / unit[1]) : *of_unit;
        }
    }
    return worst > noticed ? worst : 0.0;
}
