/* guards.c - guards that are armed, and pairs that change sides. */
#include "guards_internal.h"

#include "doubt.h"
#include "formula_scale.h"
#include "guard_scale.h"
#include "guard_values.h"
#include "magnitudes.h"
#include "pair_laws.h"
#include "quads.h"
#include "tied.h"

#include <math.h>

enum dalcs_status dalcs_guards_setup(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    size_t n_equations = (size_t)dalcs_system_n_equations(s);
    part->laws.held_charge = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(double));
    part->laws.held_flux = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(double));
    part->laws.pair_row = dalcs_arena_alloc(&part->arena, 2 * (size_t)s->n_pairs, sizeof(int));
    part->laws.law = dalcs_arena_alloc(&part->arena, DALCS_PAIR_LAWS * (size_t)s->n_pairs,
                                       sizeof(*part->laws.law));
    part->laws.rate =
        dalcs_pair_rate_create(&part->arena, s->n_pairs, part->component->osnsp.n_words);
    part->laws.inductance = dalcs_arena_alloc(&part->arena, n_equations, sizeof(double));
    part->guards.bound = dalcs_arena_alloc(
        &part->arena, (size_t)dalcs_quads_of(dalcs_guards_number(part)) + DALCS_QUAD,
        sizeof(double));
    part->guards.doubtful =
        dalcs_arena_alloc(&part->arena, (size_t)dalcs_guards_number(part), sizeof(int));
    if (part->guards.bound == NULL || part->guards.doubtful == NULL ||
        part->laws.held_charge == NULL || part->laws.held_flux == NULL ||
        part->laws.pair_row == NULL || part->laws.law == NULL || part->laws.rate == NULL ||
        part->laws.inductance == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_pair_laws_find(part));
    DALCS_TRY(dalcs_formula_scale_setup(part));
    return dalcs_stages_have_maps(&part->stages) ? DALCS_OK : dalcs_doubt_setup(part);
}

static void arm_controls(struct dalcs_radau_part *part, bool at_end, double band,
                         const double *unit) {
    int node = at_end ? part->stages.layout.n_nodes - 1 : 0;
    for (int g = part->component->system->n_pairs; g < dalcs_guards_number(part); g++) {
        if (!(at_end && part->guards.armed[g])) {
            part->guards.armed[g] = dalcs_guard_control_at(part, g, node) >
                                    band * dalcs_guard_control_scale(part, g, unit);
        }
    }
}

bool dalcs_guard_goes_on(const struct dalcs_radau_part *part, int pair, double value) {
    const double *before = dalcs_guard_values_before(part, pair);
    if (before == NULL) {
        return false;
    }
    double last =
        dalcs_guard_value_at(part, before, part->stages.layout.stride, part->segment.end_before);
    /* The errors of both have nothing to do with each other: where they agree it is known, however small it is. */
    return fabs(value - last) <= dalcs_slight * value;
}

void dalcs_guards_arm(struct dalcs_radau_part *part, bool at_end, const double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_pairs = p->system->n_pairs;
    double band = dalcs_doubt_band(part);
    const double *value = part->segment.out + (at_end ? (l->n_nodes - 1) * l->stride : 0) +
                          dalcs_system_n_equations(p->system);
    bool *armed = part->guards.armed;
    for (int d = 0; d < n_pairs; d++) {
        if (p->lists.is_diode[d] && !(at_end && armed[d])) {
            double scale = dalcs_guard_scale(part, d, unit);
            armed[d] =
                value[d] > band * scale || (value[d] > dalcs_tied_nothing(part, d, unit) &&
                                            ((!at_end && dalcs_guard_goes_on(part, d, value[d])) ||
                                             value[d] > dalcs_doubt_about(part, d, scale, unit)));
        }
    }
    if (part->stages.n_watched > 0) {
        arm_controls(part, at_end, band, unit);
    }
}

void dalcs_guards_flip(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    for (int k = 0; k < part->guards.n_crossed; k++) {
        int d = dalcs_guard_pair(part, part->guards.crossed[k]);
        dalcs_osnsp_command(p, d, !dalcs_osnsp_is_on(p, d));
    }
}

bool dalcs_guards_overreach(const struct dalcs_radau_part *part, const double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const uint64_t *flipped = part->memory.modes_before + p->n_words;
    const double *value = part->segment.out + dalcs_system_n_equations(p->system);
    bool any = false;
    for (int d = 0; d < p->system->n_pairs && !any; d++) {
        const bool is_on = dalcs_osnsp_is_on(p, d);
        any = is_on != dalcs_mode_has(flipped, d) && p->lists.is_diode[d] && value[d] < 0.0 &&
              value[d] < -dalcs_doubt_about(part, d, dalcs_guard_scale(part, d, unit), unit);
    }
    return any;
}

/* Is it 0 at all nodes, to the digits of doubles? */
static bool rests(const struct dalcs_radau_part *part, int guard, double nothing) {
    double work[DALCS_MAX_NODES];
    int stride;
    const double *value = dalcs_guard_values(part, guard, work, &stride);
    bool is = true;
    for (int k = 0; k < part->stages.layout.n_nodes && is; k++) {
        is = fabs(value[k * stride]) <= nothing;
    }
    return is;
}

/* Opens switches without hysteresis whose control rests at their threshold. */
static bool open_switches(struct dalcs_radau_part *part, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool any = false;
    for (int g = p->system->n_pairs; g < dalcs_guards_number(part); g++) {
        int d = dalcs_guard_pair(part, g);
        bool is_strict = dalcs_osnsp_is_on(p, d) && !dalcs_pair_remembers(&p->system->pair[d]);
        if (is_strict && rests(part, g, dalcs_guard_rounding(part, g, unit))) {
            dalcs_osnsp_command(p, d, false);
            any = true;
        }
    }
    return any;
}

/* Puts a formula's jump, pairs d and d + 1, where the formula has the value that is written for an argument of 0. Both pairs
 * are closed above 0, where the argument is lambda of the second, and open below, where it is w of the first; the first
 * alone is closed where the value is between the two, as that of sgn is. */
static bool put_jump(struct dalcs_radau_part *part, int d, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_pair *pair = p->system->pair;
    const bool is_above = dalcs_osnsp_is_on(p, d);
    const bool is_between = is_above != dalcs_osnsp_is_on(p, d + 1);
    const bool rests_below = pair[d + 1].is_left_out[0];
    const bool rests_above = pair[d].is_left_out[1];
    const bool is_as_written = is_above ? rests_above : rests_below;
    const int argument = is_above ? d + 1 : d;
    const double nothing =
        dalcs_formula_argument_noise(part, d, unit) + dalcs_guard_rounding(part, argument, unit);
    if (is_between || is_as_written || dalcs_tied_leaves(part, argument, 1.0) ||
        !rests(part, argument, nothing)) {
        return false;
    }
    dalcs_osnsp_command(p, d, !rests_below);
    dalcs_osnsp_command(p, d + 1, rests_above);
    return true;
}

bool dalcs_guards_rest(struct dalcs_radau_part *part, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    bool any = open_switches(part, unit);
    for (int d = 0; d + 1 < s->n_pairs; d++) {
        any = (s->pair[d].is_jump && put_jump(part, d, unit)) || any;
    }
    return any;
}
