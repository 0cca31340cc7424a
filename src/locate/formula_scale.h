/* formula_scale.h - what the kinks of formulas are held to. */
#ifndef DALCS_FORMULA_SCALE_H
#define DALCS_FORMULA_SCALE_H

#include "radau_state.h"

/* Where the output of each kink stands: those of pair d are place[p[d]] to place[p[d + 1] - 1]. */
struct dalcs_formula_places {
    int *p; /* [n_pairs + 1] */

    struct dalcs_formula_place {
        int row;       /* an equation; n_equations + e: the argument of pair e */
        double factor; /* of the output there */
    } * place;
};

/* Finds them: part->laws.places, NULL where no pair is a kink. */
enum dalcs_status dalcs_formula_scale_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* V or A. A kink whose argument is off by so much puts that into what the formula gives: so it is held to the scale of that, which
 * may be 1 V beside a kick of 1e10 V, but not closer than its argument is known. scale: of its unit, which is the answer where no
 * place tells, and the most otherwise. Where no current flows that of currents is next to nothing, and rounding of hundreds of
 * volts is more. */
double dalcs_formula_scale(const struct dalcs_radau_part *part, int pair, double scale,
                           const double *unit);

/* What the argument of a kink or a jump is known to, in its own unit: what it reads is. */
double dalcs_formula_argument_noise(const struct dalcs_radau_part *part, int pair,
                                    const double *unit);

#endif
