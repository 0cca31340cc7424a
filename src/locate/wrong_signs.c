/* wrong_signs.c - guards that are below 0 somewhere in a step: what comes back, and what does not. */
#include "guards_internal.h"

#include "crossing.h"
#include "doubt.h"
#include "extremes.h"
#include "guard_scale.h"
#include "guard_values.h"
#include "magnitudes.h"
#include "step_length.h"

#include <math.h>

/* A wrong sign of at most this, over the unit's scale, counts as 0 in any case: times are too coarse to resolve it. */
static const double unresolved = 1e-5;

/* Is a guard above 0 before times can be told apart? */
static bool is_over_at_once(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            const double *value, int stride) {
    double instant = dalcs_smaller(1.0, dalcs_length_shortest(r) / part->segment.h);
    return dalcs_guard_value_at(part, value, stride, instant) > 0.0;
}

bool dalcs_guard_is_over_soon(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                              const double *value, int stride, double scale) {
    /* an error of the polynomial may be so many bands at its start */
    double little = 1.0 / dalcs_slight * dalcs_doubt_band(part) * scale;
    return (value[0] >= -little &&
            dalcs_guard_value_at(part, value, stride, dalcs_nothing) > 0.0) ||
           (value[0] >= -unresolved * scale && is_over_at_once(r, part, value, stride));
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
        all = value[0] >= -1.0 / dalcs_slight * band && value[last * stride] > 0.0;
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
    /* What dies away between two nodes leaves so much of itself, of either sign, at those behind: in the first step of a
     * mode, and in later ones, which have got longer meanwhile. */
    double part_left = part->guards.fresh ? 1.0 / dalcs_beyond : dalcs_slight;
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

/* Is it below 0 from the start on, by more than `least`, and does not come back by half up to `end`? */
static bool stays_below(const struct dalcs_radau_part *part, int pair, double end, double least) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *value =
        part->segment.out + dalcs_system_n_equations(part->component->system) + pair;
    bool stays = value[0] < -least;
    for (int k = 1; k < l->n_nodes && part->stages.method->node[k] <= end && stays; k++) {
        stays = value[k * l->stride] < 0.5 * value[0];
    }
    return stays;
}

bool dalcs_guards_stay_negative(const struct dalcs_radau_part *part, double end,
                                const double *unit) {
    int n_pairs = part->component->system->n_pairs;
    double noise = dalcs_beyond * dalcs_doubt_noise(part);
    double least = fmax(dalcs_small * dalcs_doubt_band(part), noise);
    bool negative = false;
    for (int k = 0; k < part->guards.n_doubtful && !negative && n_pairs <= DALCS_MANY_PAIRS; k++) {
        int d = part->guards.doubtful[k];
        if (d < n_pairs) {
            negative = stays_below(part, d, end,
                                   least * dalcs_guard_scale(part, d, unit) +
                                       dalcs_guard_rounding(part, d, unit));
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
    if (dalcs_guard_is_over_soon(r, part, value, l->stride, dalcs_guard_scale(part, pair, unit))) {
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
