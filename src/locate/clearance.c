/* clearance.c - least coefficients, and one change of their sign. */
#include "clearance.h"

#include "crossing.h"
#include "doubt.h"
#include "guard_scale.h"
#include "magnitudes.h"

#include <math.h>

/* The smallest of the coefficients, which a polynomial is an average of everywhere, times `sign`. */
static double lowest(const struct dalcs_radau_part *part, const double *coefficient, double sign) {
    double least = sign * coefficient[0];
    for (int i = 1; i < part->stages.layout.n_nodes; i++) {
        least = dalcs_smaller(least, sign * coefficient[i]);
    }
    return least;
}

/* Sign times a voltage that moves a switch has to be above this for the switch to stay; 0 for a pair itself. */
static double threshold(const struct dalcs_radau_part *part, int guard, double *sign) {
    *sign = 1.0;
    if (guard < part->component->system->n_pairs) {
        return 0.0;
    }
    int d = dalcs_guard_pair(part, guard);
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_osnsp *p = &part->component->osnsp;
    bool is_on = dalcs_osnsp_is_on(p, d);
    *sign = is_on ? 1.0 : -1.0;
    return is_on ? dalcs_switch_opens_at(s, p->mode, d) : -s->pair[d].turn_on;
}

/* What a guard has to be above so that it is beyond doubt, but for rounding. */
static double doubtless(const struct dalcs_radau_part *part, int guard) {
    return dalcs_beyond * dalcs_doubt_band(part) *
           dalcs_guard_scale(part, guard, part->scales.unit);
}

static bool is_beyond_rounding(const struct dalcs_radau_part *part, int guard, double value) {
    return (!dalcs_guard_may_read_rates(part) &&
            value > dalcs_beyond * dalcs_guard_most_rounding(part, guard, part->scales.unit)) ||
           value > dalcs_beyond * dalcs_guard_rounding(part, guard, part->scales.unit);
}

/* Of one guard. */
static bool is_clear(const struct dalcs_radau_part *part, int guard, const double *coefficient) {
    double sign;
    double least = -threshold(part, guard, &sign) - doubtless(part, guard);
    least += lowest(part, coefficient, sign);
    return is_beyond_rounding(part, guard, least);
}

bool dalcs_guards_clearance(const struct dalcs_radau_part *part, int guard, double *sign,
                            double *bound) {
    *bound = threshold(part, guard, sign) + doubtless(part, guard) +
             dalcs_beyond * dalcs_guard_most_rounding(part, guard, part->scales.unit);
    return dalcs_guard_is_one(part, guard);
}

/* Is a guard plain up to `end`? Then *theta is brought forward to its fall, if it has one. */
static bool is_plain(struct dalcs_radau_part *part, int guard, const double *coefficient,
                     double end, double *theta) {
    double above[DALCS_MAX_NODES];
    double sign;
    double zero = threshold(part, guard, &sign);
    double bound = doubtless(part, guard);
    const int last = part->stages.method->s;
    double least = INFINITY;
    above[0] = sign * coefficient[0] - zero;
    for (int k = 1; k <= last; k++) {
        above[k] = sign * coefficient[k] - zero;
        least = dalcs_smaller(least, above[k]);
    }
    bool is_pair = guard < part->component->system->n_pairs;
    bool begins_at_0 = above[0] >= 0.0 && is_pair && dalcs_guard_has_flipped(part, guard);
    double first = begins_at_0 ? above[1] : dalcs_smaller(above[0], above[1]);
    if (!is_beyond_rounding(part, guard, first - bound)) {
        return false;
    }
    if (is_beyond_rounding(part, guard, least - bound)) {
        return true;
    }
    double fall = dalcs_crossing_only(part->stages.method, above, end, 2.0 * bound);
    if (!(fall < INFINITY) || part->guards.n_crossed > 0) {
        return false;
    }
    part->guards.crossed[part->guards.n_crossed++] = guard;
    *theta = fall;
    return true;
}

/* Of all guards: theta is NULL where none may fall. */
static inline bool look_at_all(struct dalcs_radau_part *part, const double *coefficient, double end,
                               double *theta) {
    bool all = true;
    part->guards.n_crossed = 0;
    part->guards.n_doubtful = 0;
    for (int g = 0; g < dalcs_guards_number(part) && all; g++) {
        part->guards.armed[g] = dalcs_guard_is_one(part, g);
        if (part->guards.armed[g]) {
            all = theta != NULL ? is_plain(part, g, coefficient, end, theta)
                                : is_clear(part, g, coefficient);
            coefficient += part->stages.layout.n_nodes;
        }
    }
    return all;
}

bool dalcs_guards_clear(struct dalcs_radau_part *part, const double *coefficient) {
    return look_at_all(part, coefficient, 1.0, NULL);
}

bool dalcs_guards_plain(struct dalcs_radau_part *part, const double *coefficient, double end,
                        double *theta) {
    *theta = end;
    return look_at_all(part, coefficient, end, theta);
}
