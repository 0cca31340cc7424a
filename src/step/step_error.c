/* step_error.c - the error estimate against each signal's own scale.
 *
 * Two things are looked at. The drift of the states is how far they miss, at the start of the step, a
 * polynomial one degree lower, filtered through one step of implicit Euler (Hairer and Wanner, Solving
 * ODEs II, sec. IV.8): of order s + 1 like the dense output; current_error.c carries it on to currents.
 * The ripple is what curved sources do between the nodes, carried to every voltage and current; it
 * alone sees variables of index 2, such as the current of a source across a capacitor. */
#include "step_scales.h"

#include "current_error.h"
#include "extremes.h"
#include "magnitudes.h"
#include "quads.h"
#include "rounding.h"
#include "smooth_step.h"
#include "wide_vectors.h"

#include <math.h>

static bool is_on(const struct dalcs_radau_part *part, int pair) {
    return dalcs_osnsp_is_on(&part->component->osnsp, pair);
}

/* A quantity of one unit has a part of the other unit's scale. */
static void cross_units(const struct dalcs_radau_part *part, double *unit) {
    double volt = unit[0];
    unit[0] = dalcs_larger(unit[0], part->scales.cross[0] * unit[1]);
    unit[1] = dalcs_larger(unit[1], part->scales.cross[1] * volt);
}

/* No column is known better than a sum of what would balance the largest of the others, by ten of its roundings. */
double dalcs_step_rounding(const struct dalcs_radau_part *part,
                           const struct dalcs_stage_entry *entry) {
    int n_equations = dalcs_system_n_equations(part->component->system);
    const double *final = part->segment.out + part->stages.method->s * part->stages.layout.stride;
    const double *inverse = dalcs_stage_natural_units(entry) + n_equations;
    double balanced = 0.0;
    const bool *is_part = part->component->system->is_part;
    for (int c = 0; c < n_equations; c++) {
        bool counts =
            is_part == NULL || !is_part[c]; /* in no unit: what it adds elsewhere is there */
        balanced = counts ? dalcs_larger(balanced, fabs(final[c]) * inverse[c]) : balanced;
    }
    return dalcs_beyond * dalcs_sum_rounded * balanced;
}

/* On factors, errors are beyond what a sum has. No more than that is allowed: what a guard may be off by, two digits, would
 * hide errors of a phase of 10 V beside a frequency of 6 MV, and of currents through what is open. */
static double above_map(const struct dalcs_radau_part *part) {
    return part->segment.rounding > 1.0 ? dalcs_beyond : 1.0;
}

/* One more error, over what is allowed for it. Divisions cost time, and few columns are worse than all
 * before. */
static inline void judge(struct dalcs_step_quality *q, double error, double allowed) {
    if (!(error <= q->ratio * allowed) && q->ratio == q->ratio) {
        q->ratio = error / allowed;
    }
}

/* What is allowed by kind (V, A, A of pairs): the tolerance times the scale of a column, which is at
 * least `least`, and `besides`. */
struct allowance {
    double tolerance, least[3], besides[3];
};

/* Signals that are nothing beside the largest of their unit are held to that one's scale; the current of a pair where it
 * is slight beside it. */
static void find_allowance(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                           const struct dalcs_step_quality *q, struct allowance *a) {
    a->tolerance = part->inner_tolerance;
    a->least[0] = dalcs_nothing * q->unit[0];
    a->least[1] = dalcs_nothing * q->unit[1];
    a->least[2] = dalcs_slight * q->unit[1];
    a->besides[0] = r->besides[0] + dalcs_step_crossed(part, 0, q->here) +
                    dalcs_sum_rounded * part->scales.constant[0];
    a->besides[1] = r->besides[1] + dalcs_step_crossed(part, 1, q->here) +
                    dalcs_sum_rounded * part->scales.constant[1];
    a->besides[2] = dalcs_beyond * dalcs_sum_rounded * above_map(part) * q->unit[1] + a->besides[1];
}

double dalcs_step_scale(const struct dalcs_radau_part *part, int column, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    int pair = column - dalcs_system_n_equations(s);
    if (pair >= 0 && !is_on(part, pair)) {
        return 0.0;
    }
    double least = pair >= 0 ? dalcs_slight * unit[1]
                             : part->scales.kinds->leans[column] * dalcs_nothing *
                                   unit[s->column_is_current[column] ? 1 : 0];
    return dalcs_larger(least,
                        dalcs_larger(part->scales.column[column], part->scales.magnitude[column]));
}

/* The errors over what is allowed, with `rounding` besides, and `of_functions` of each state. */
static void compare(const struct dalcs_radau_part *part, const struct allowance *a,
                    const double *natural, double rounding, const double *of_functions,
                    struct dalcs_step_quality *q) {
    const struct dalcs_system *s = part->component->system;
    const double *drift = part->segment.out + part->stages.layout.drift;
    const double *ripple = part->segment.out + part->stages.layout.ripple;
    bool curved = part->excitation.is_curved;
    q->ratio = 0.0;
    q->drift = 0.0;
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < (curved ? n_equations : s->n_x); c++) {
        int of = s->column_is_current[c] ? 1 : 0;
        if (part->scales.kinds->counts[c] == 0) {
            continue;
        }
        double allowed = a->tolerance * dalcs_step_scale(part, c, q->unit) + rounding * natural[c] +
                         a->besides[of] +
                         (of_functions != NULL && c < s->n_x ? of_functions[c] : 0.0);
        double error = c < s->n_x ? fabs(drift[c]) : 0.0;
        if (error > q->drift * allowed) {
            q->drift = error / allowed;
        }
        judge(q, curved ? dalcs_larger(error, fabs(ripple[c])) : error, allowed);
    }
    for (int c = n_equations; curved && c < n_equations + s->n_pairs; c++) {
        if (part->scales.kinds->counts[c] != 0) { /* an open one's voltage is one of the columns */
            double scale = dalcs_step_scale(part, c, q->unit);
            judge(q, fabs(ripple[c]), a->tolerance * scale + a->besides[2]);
        }
    }
}

/* The errors of n columns over what is allowed, without rounding, and the part of the n_x drifts in
 * them: numbers up to 1, or that a closer look is due. ripple may be NULL. */
DALCS_TWICE(void, compare_all,
            (const struct dalcs_radau_part *part, const struct allowance *a, int n, int n_x,
             const double *drift, const double *ripple, struct dalcs_step_quality *q),
            (part, a, n, n_x, drift, ripple, q)) {
    const struct dalcs_column_kinds *kinds = part->scales.kinds;
    dalcs_quad worst = {0.0};
    dalcs_quad worst_drift = {0.0};
    dalcs_quad sum = {0.0}; /* shows NaN, which comparisons hide */
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad is_volt;
        dalcs_quad is_ampere;
        dalcs_quad is_closed;
        dalcs_quad scale;
        dalcs_quad magnitude;
        dalcs_quad leans;
        dalcs_quad_load(&is_volt, kinds->is_volt + c);
        dalcs_quad_load(&is_ampere, kinds->is_ampere + c);
        dalcs_quad_load(&is_closed, kinds->is_closed + c);
        dalcs_quad_load(&leans, kinds->leans + c);
        dalcs_quad_load(&scale, part->scales.column + c);
        dalcs_quad_load(&magnitude, part->scales.magnitude + c);
        dalcs_quad_raise(&scale, &magnitude);
        magnitude =
            leans * (a->least[0] * is_volt + a->least[1] * is_ampere) + a->least[2] * is_closed;
        dalcs_quad_raise(&scale, &magnitude);
        dalcs_quad allowed =
            a->tolerance * scale +
            (a->besides[0] * is_volt + a->besides[1] * is_ampere + a->besides[2] * is_closed);
        dalcs_quad error;
        if (ripple != NULL) {
            dalcs_quad_load(&error, ripple + c);
            dalcs_quad_unsign(&error);
            error /= allowed;
            dalcs_quad_mask(&error, kinds->counts + c);
            sum += error;
            dalcs_quad_raise(&worst, &error);
        }
        if (c < n_x) {
            dalcs_quad_load(&error, drift + c);
            dalcs_quad_unsign(&error);
            error /= allowed;
            dalcs_quad_keep(&error, n_x - c);
            sum += error;
            dalcs_quad_raise(&worst_drift, &error);
        }
    }
    double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    q->drift = dalcs_quad_largest(&worst_drift);
    q->ratio = all == all ? dalcs_larger(q->drift, dalcs_quad_largest(&worst)) : all;
}

void dalcs_step_judge(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                      struct dalcs_stage_entry *entry, double end, struct dalcs_step_quality *q) {
    const struct dalcs_system *s = part->component->system;
    bool curved = part->excitation.is_curved;
    const double *drift = part->segment.out + part->stages.layout.drift;
    const double *ripple = curved ? part->segment.out + part->stages.layout.ripple : NULL;
    struct allowance a;
    *q = (struct dalcs_step_quality){0};
    dalcs_step_find_magnitudes(part, end, q->here);
    q->unit[0] = dalcs_larger(q->here[0], part->scales.unit[0]);
    q->unit[1] = dalcs_larger(q->here[1], part->scales.unit[1]);
    cross_units(part, q->unit);
    find_allowance(r, part, q, &a);
    compare_all(part, &a, curved ? dalcs_system_n_columns(s) : s->n_x, s->n_x, drift, ripple, q);
    if (!(q->ratio <= 1.0)) { /* is it rounding? The test is needed for few steps. */
        compare(part, &a, dalcs_stage_natural_units(entry),
                above_map(part) * dalcs_step_rounding(part, entry),
                dalcs_smooth_step_rounding(part, entry), q);
    }
    q->own = q->ratio;
    if (q->ratio <= 1.0) {
        struct dalcs_lever_error e;
        dalcs_current_error(part, entry, q->unit, a.besides, &e);
        q->own = dalcs_larger(q->ratio, e.of_currents);
        q->ratio = dalcs_larger(q->own, e.of_voltages);
    }
}

/* Up to where clash k at a node is none. Sources disagree by errors of one-step problems. What a comparison reads is at rest
 * or moves, however slowly: rounding alone is nothing, and that of a row is of what it reads. Voltages elsewhere have no
 * part in it, such as those of a coil that a switch interrupts. */
static double clash_limit(const struct dalcs_radau_part *part,
                          const struct dalcs_stage_entry *entry, int k, int node,
                          const double *unit) {
    const struct dalcs_stages *stages = &part->stages;
    const int row = stages->layout.n_fixed + k * stages->method->s + node - 1;
    if (!dalcs_stage_gives_rows_up(entry)) {
        return dalcs_alike * dalcs_larger(unit[0], unit[1]);
    }
    if (dalcs_stage_has_map(entry)) {
        return dalcs_beyond * dalcs_sum_rounded *
               dalcs_stage_spread(stages, entry, row, part->segment.in, part->scales.column);
    }
    double *size = part->work.size;
    for (int c = 0; c < dalcs_system_n_columns(part->component->system); c++) {
        size[c] = dalcs_step_scale(part, c, unit);
    }
    return dalcs_answer_rounded *
           dalcs_stage_clash_size(stages, entry, k, node, part->segment.in, size);
}

bool dalcs_step_clashes(const struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry,
                        double end, const double *unit) {
    const struct dalcs_collocation *m = part->stages.method;
    const double *clash = part->segment.out + part->stages.layout.n_fixed;
    const int n = dalcs_stage_n_clashes(entry) / m->s; /* null vectors, each at all stages */
    for (int k = 0; k < n; k++) {
        for (int node = 1; node <= m->s && (node == 1 || m->node[node] <= end); node++) {
            if (fabs(clash[k * m->s + node - 1]) > clash_limit(part, entry, k, node, unit)) {
                return true;
            }
        }
    }
    return false;
}
