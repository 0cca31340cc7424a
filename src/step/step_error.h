/* step_error.h - how large signals are, and how far a step may be off. */
#ifndef DALCS_STEP_ERROR_H
#define DALCS_STEP_ERROR_H

#include "radau_state.h"

#include "magnitudes.h"
#include "rounding.h"

/* What is known of a step that has been solved. */
struct dalcs_step_quality {
    double ratio;   /* estimated error over what is allowed; NaN when the step means nothing */
    double own;     /* the part of it without voltages that states are levered up to */
    double drift;   /* the part of it that comes from where the states start */
    double here[2]; /* V, A: the largest of each in the segment */
    double unit[2]; /* V, A: so far */
};

/* A voltage that is 0 is no better than what rounding of this step's currents drives through the
 * largest conductance of the circuit, nor a current than rounding of the voltages through the least: ten roundings of a
 * sum, as scales.cross has a millionth of them. V or A; of: 0 of a voltage, 1 of a current. */
static inline double dalcs_step_crossed(const struct dalcs_radau_part *part, int of,
                                        const double unit[2]) {
    return dalcs_beyond * dalcs_sum_rounded / dalcs_nothing * part->scales.cross[of] * unit[1 - of];
}

/* Of a part that is otherwise set up. */
enum dalcs_status dalcs_step_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* x[n_x], or value[n_columns + n_watched], with room for whole quads (quads.h), at theta of the present
 * step. */
void dalcs_step_states(const struct dalcs_radau_part *part, double theta, double *x);
void dalcs_step_values(const struct dalcs_radau_part *part, double theta, double *value);

/* The segment ends at `end` (in steps). */
void dalcs_step_judge(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                      struct dalcs_stage_entry *entry, double end,
                      struct dalcs_step_quality *quality);

/* What a column of 1 in balanced units (dalcs_stage_natural_units) may be off by rounding in this step if it has no more
 * than a map has. */
double dalcs_step_rounding(const struct dalcs_radau_part *part,
                           const struct dalcs_stage_entry *entry);

/* What the errors of a column are held to, without its tolerance: its own scale, or a part of its unit's. 0 of an
 * open pair, which has no current. */
double dalcs_step_scale(const struct dalcs_radau_part *part, int column, const double *unit);

/* Remembers the largest magnitudes of an accepted segment. */
void dalcs_step_remember(struct dalcs_radau_part *part, double end, const double *unit);

/* And those of a whole segment that nobody has judged. */
void dalcs_step_take_in(struct dalcs_radau_part *part);

/* Do sources disagree in a singular mode? Then it cannot be this one. */
bool dalcs_step_clashes(const struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry,
                        double end, const double *unit);

#endif
