/* step_error.c - the error estimate against each signal's own scale.
 *
 * Two things are looked at. The drift of the states is how far they miss, at the start of the step, a
 * polynomial one degree lower, filtered through one step of implicit Euler (Hairer and Wanner, Solving
 * ODEs II, sec. IV.8): of order s + 1 like the dense output; current_error.c carries it on to currents.
 * The ripple is what curved sources do between the nodes, carried to every voltage and current; it
 * alone sees variables of index 2, such as the current of a source across a capacitor. */
#include "step_error.h"

#include "current_error.h"
#include "extremes.h"
#include "quads.h"
#include "wide_vectors.h"

#include <math.h>
#include <string.h>

/* Signals smaller than this part of the largest of their unit are held to that one's scale; the
 * current of a pair likewise. */
static const double smallest_scale = 1e-5;
static const double smallest_pair = 1e-2;

/* No column is known better than this part of what would balance the largest of the others. */
static const double rounding_part = 2e-14;

/* Sources that disagree by more than this part of the largest signal. */
static const double clash_part = 1e-9;

static bool is_on(const struct dalcs_radau_part *part, int pair) {
    return dalcs_osnsp_is_on(&part->component->osnsp, pair);
}

/* What the columns are in a mode, in whole quads. A pair is a voltage while it is open. */
struct dalcs_column_kinds {
    uint64_t *mode;
    double *is_volt, *is_ampere, *is_closed; /* 1 or 0: V or A of an equation, A of a closed pair */
    double *leans; /* 1; 0: it moves a switch, and is held to its own scale however small that is */
    uint64_t *counts; /* all bits, but none of an open pair, whose voltage is one of the columns */
};

/* Columns that move switches: their scale is at least what takes the control to its threshold. */
static void find_controls(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    for (int d = 0; d < s->n_pairs; d++) {
        double threshold = fmax(fabs(s->pair[d].turn_on), fabs(s->pair[d].turn_off));
        for (int k = s->control.p[d]; k < s->control.p[d + 1]; k++) {
            int c = s->control.j[k];
            if (c < dalcs_system_n_equations(s)) {
                part->scales.kinds->leans[c] = 0.0;
                part->scales.column[c] =
                    dalcs_larger(part->scales.column[c], threshold / fabs(s->control.x[k]));
            }
        }
    }
}

/* Lambda and w of a formula have no unit; thresholds of diodes that are far away make a large w of small voltages.
 * Neither is a signal of the circuit, by which others are measured. */
static bool measures_nothing(const struct dalcs_system *s, int pair) {
    return s->pair[pair].is_formula || s->F.p[pair] < s->F.p[pair + 1];
}

enum dalcs_status dalcs_step_setup(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    size_t n = (size_t)dalcs_quads_of(dalcs_system_n_columns(s));
    part->scales.column = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    part->scales.magnitude = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    part->scales.kinds = dalcs_arena_alloc(&part->arena, 1, sizeof(*part->scales.kinds));
    if (part->scales.column == NULL || part->scales.magnitude == NULL ||
        part->scales.kinds == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_column_kinds *kinds = part->scales.kinds;
    kinds->mode = dalcs_arena_alloc(&part->arena, (size_t)part->component->osnsp.n_words,
                                    sizeof(*kinds->mode));
    kinds->is_volt = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    kinds->is_ampere = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    kinds->is_closed = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    kinds->leans = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    kinds->counts = dalcs_arena_alloc(&part->arena, n, sizeof(*kinds->counts));
    if (kinds->leans == NULL || kinds->mode == NULL || kinds->is_volt == NULL ||
        kinds->is_ampere == NULL || kinds->is_closed == NULL || kinds->counts == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int c = 0; c < dalcs_system_n_columns(s); c++) { /* of the mode with all pairs open */
        bool is_pair = c >= dalcs_system_n_equations(s);
        kinds->is_ampere[c] = !is_pair && s->column_is_current[c] ? 1.0 : 0.0;
        bool is_far = is_pair && measures_nothing(s, c - dalcs_system_n_equations(s));
        kinds->is_volt[c] = is_far ? 0.0 : 1.0 - kinds->is_ampere[c];
        kinds->leans[c] = 1.0;
        kinds->counts[c] = is_pair ? 0 : UINT64_MAX;
        if (s->is_part != NULL && s->is_part[c]) { /* what reads it is judged */
            kinds->is_volt[c] = kinds->leans[c] = 0.0;
            kinds->counts[c] = 0;
        }
    }
    find_controls(part);
    return DALCS_OK;
}

/* Brings what pairs are up to the present mode. */
static void find_kinds(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_column_kinds *kinds = part->scales.kinds;
    int n_pairs = p->system->n_pairs;
    int c = dalcs_system_n_equations(p->system);
    for (int first = 0; first < n_pairs; first += 64) {
        uint64_t mode = p->mode[first / 64];
        uint64_t changed = mode ^ kinds->mode[first / 64];
        kinds->mode[first / 64] = mode;
        for (int k = c + first; changed != 0; k++, changed >>= 1, mode >>= 1) {
            if ((changed & 1) != 0) {
                double closed = (double)(int)(mode & 1);
                kinds->is_volt[k] = measures_nothing(p->system, k - c) ? 0.0 : 1.0 - closed;
                bool is_judged = !p->system->pair[k - c].is_formula; /* else what reads it is */
                kinds->is_closed[k] = is_judged ? closed : 0.0;
                kinds->counts[k] = is_judged ? -(mode & 1) : 0;
            }
        }
    }
}

/* Each unit vouches a little for the other. */
static void cross_units(const struct dalcs_radau_part *part, double *unit) {
    double volt = unit[0];
    unit[0] = dalcs_larger(unit[0], part->scales.cross[0] * unit[1]);
    unit[1] = dalcs_larger(unit[1], part->scales.cross[1] * volt);
}

/* The last node that belongs to the segment. */
static int last_node(const struct dalcs_radau_part *part, double end) {
    const struct dalcs_collocation *m = part->stages.method;
    int last = m->s;
    while (last > 0 && m->node[last] > end) {
        last--;
    }
    return last;
}

/* value[n], in whole quads, = the columns of `out` at the nodes, weighted. */
DALCS_TWICE(void, weigh,
            (const struct dalcs_stage_layout *l, const double *weight, const double *out, int n,
             double *value),
            (l, weight, out, n, value)) {
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad sum = {0.0};
        for (int k = 0; k < l->n_nodes; k++) {
            dalcs_quad y;
            dalcs_quad_load(&y, out + k * l->stride + c);
            sum += weight[k] * y;
        }
        dalcs_quad_store(value + c, &sum);
    }
}

void dalcs_step_states(const struct dalcs_radau_part *part, double theta, double *x) {
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);
    weigh(&part->stages.layout, weight, part->segment.out, part->component->system->n_x, x);
}

void dalcs_step_values(const struct dalcs_radau_part *part, double theta, double *value) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    if (theta == 0.0 || theta == 1.0) {
        int node = theta == 0.0 ? 0 : l->n_nodes - 1;
        memcpy(value, part->segment.out + node * l->stride, (size_t)l->stride * sizeof(*value));
        return;
    }
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);
    weigh(l, weight, part->segment.out, l->stride, value);
}

/* magnitude: the larger of |first| and |last|; raises unit[2] to the largest of them. */
DALCS_TWICE(void, compare_ends,
            (const struct dalcs_column_kinds *kinds, int n, const double *first, const double *last,
             double *magnitude, double *unit),
            (kinds, n, first, last, magnitude, unit)) {
    dalcs_quad volts = {unit[0]};
    dalcs_quad amperes = {unit[1]};
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad m;
        dalcs_quad other;
        dalcs_quad is_closed;
        dalcs_quad_load(&m, first + c);
        dalcs_quad_load(&other, last + c);
        dalcs_quad_unsign(&m);
        dalcs_quad_unsign(&other);
        dalcs_quad_raise(&m, &other);
        dalcs_quad_store(magnitude + c, &m);
        dalcs_quad_load(&other, kinds->is_volt + c);
        other *= m;
        dalcs_quad_raise(&volts, &other);
        dalcs_quad_load(&other, kinds->is_ampere + c);
        dalcs_quad_load(&is_closed, kinds->is_closed + c);
        other = m * (other + is_closed);
        dalcs_quad_raise(&amperes, &other);
    }
    unit[0] = dalcs_quad_largest(&volts);
    unit[1] = dalcs_quad_largest(&amperes);
}

/* The larger of what a column is at the first and at the last known node of a segment; raises the
 * units to the largest of them. */
static void find_magnitudes(struct dalcs_radau_part *part, double end, double *unit) {
    const double *known = part->segment.out + last_node(part, end) * part->stages.layout.stride;
    find_kinds(part);
    compare_ends(part->scales.kinds, dalcs_system_n_columns(part->component->system),
                 part->segment.out, known, part->scales.magnitude, unit);
    part->scales.magnitude_end = end;
}

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
    return rounding_part * part->segment.rounding * balanced;
}

/* One more error, over what is allowed for it. Divisions are dear, and few columns are worse than all
 * before. */
static inline void judge(struct dalcs_step_quality *q, double error, double allowed, int of) {
    if (!(error <= allowed)) {
        q->of_unit = dalcs_larger(q->of_unit, error / q->unit[of]);
    }
    if (!(error <= q->ratio * allowed) && q->ratio == q->ratio) {
        q->ratio = error / allowed;
    }
}

/* What is allowed by kind (V, A, A of pairs): the tolerance times the scale of a column, which is at
 * least `least`, and `besides`. */
struct allowance {
    double tolerance, least[3], besides[3];
};

static void find_allowance(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                           const struct dalcs_step_quality *q, struct allowance *a) {
    a->tolerance = part->inner_tolerance;
    a->least[0] = smallest_scale * q->unit[0];
    a->least[1] = smallest_scale * q->unit[1];
    a->least[2] = smallest_pair * q->unit[1];
    a->besides[0] = r->besides[0] + dalcs_step_crossed(part, 0, q->here);
    a->besides[1] = r->besides[1] + dalcs_step_crossed(part, 1, q->here);
    a->besides[2] = rounding_part * part->segment.rounding * q->unit[1] + a->besides[1];
}

double dalcs_step_scale(const struct dalcs_radau_part *part, int column, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    int pair = column - dalcs_system_n_equations(s);
    if (pair >= 0 && !is_on(part, pair)) {
        return 0.0;
    }
    double least = pair >= 0 ? smallest_pair * unit[1]
                             : part->scales.kinds->leans[column] * smallest_scale *
                                   unit[s->column_is_current[column] ? 1 : 0];
    return dalcs_larger(least,
                        dalcs_larger(part->scales.column[column], part->scales.magnitude[column]));
}

/* The errors over what is allowed, with `rounding` besides. */
static void compare(const struct dalcs_radau_part *part, const struct allowance *a,
                    const double *natural, double rounding, struct dalcs_step_quality *q) {
    const struct dalcs_system *s = part->component->system;
    const double *drift = part->segment.out + part->stages.layout.drift;
    const double *ripple = part->segment.out + part->stages.layout.ripple;
    bool curved = part->excitation.is_curved;
    q->ratio = 0.0;
    q->drift = 0.0;
    q->of_unit = 0.0;
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < (curved ? n_equations : s->n_x); c++) {
        int of = s->column_is_current[c] ? 1 : 0;
        if (part->scales.kinds->counts[c] == 0) {
            continue;
        }
        double allowed = a->tolerance * dalcs_step_scale(part, c, q->unit) + rounding * natural[c] +
                         a->besides[of];
        double error = c < s->n_x ? fabs(drift[c]) : 0.0;
        if (error > q->drift * allowed) {
            q->drift = error / allowed;
        }
        judge(q, curved ? dalcs_larger(error, fabs(ripple[c])) : error, allowed, of);
    }
    for (int c = n_equations; curved && c < n_equations + s->n_pairs; c++) {
        if (part->scales.kinds->counts[c] != 0) { /* an open one's voltage is one of the columns */
            double scale = dalcs_step_scale(part, c, q->unit);
            judge(q, fabs(ripple[c]), a->tolerance * scale + a->besides[2], 1);
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
    find_magnitudes(part, end, q->here);
    q->unit[0] = dalcs_larger(q->here[0], part->scales.unit[0]);
    q->unit[1] = dalcs_larger(q->here[1], part->scales.unit[1]);
    cross_units(part, q->unit);
    find_allowance(r, part, q, &a);
    compare_all(part, &a, curved ? dalcs_system_n_columns(s) : s->n_x, s->n_x, drift, ripple, q);
    if (!(q->ratio <= 1.0)) { /* is it rounding? Few steps have to ask. */
        compare(part, &a, dalcs_stage_natural_units(entry), dalcs_step_rounding(part, entry), q);
    }
    q->own = q->ratio;
    if (q->ratio <= 1.0) {
        struct dalcs_lever_error e;
        dalcs_current_error(part, entry, q->unit, a.besides, &e);
        q->own = dalcs_larger(q->ratio, e.of_currents);
        q->ratio = dalcs_larger(q->own, e.of_voltages);
        q->of_unit = e.of_unit;
    }
}

/* Those of n columns, but of a current only since its pair closed. */
DALCS_TWICE(void, raise_scales,
            (int n, const double *magnitude, const uint64_t *counts, double *scale),
            (n, magnitude, counts, scale)) {
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad now;
        dalcs_quad most;
        dalcs_quad_load(&most, scale + c);
        dalcs_quad_load(&now, magnitude + c);
        dalcs_quad_raise(&most, &now);
        dalcs_quad_mask(&most, counts + c);
        dalcs_quad_store(scale + c, &most);
    }
}

void dalcs_step_remember(struct dalcs_radau_part *part, double end, const double *unit) {
    if (end != part->scales.magnitude_end) {
        double here[2] = {0.0, 0.0};
        find_magnitudes(part, end, here);
    }
    raise_scales(dalcs_system_n_columns(part->component->system), part->scales.magnitude,
                 part->scales.kinds->counts, part->scales.column);
    part->scales.unit[0] = unit[0];
    part->scales.unit[1] = unit[1];
}

bool dalcs_step_clashes(const struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry,
                        double end, const double *unit) {
    const struct dalcs_collocation *m = part->stages.method;
    const double *clash = part->segment.out + part->stages.layout.n_fixed;
    const double *last = clash + dalcs_stage_n_clashes(entry);
    double limit = clash_part * dalcs_larger(unit[0], unit[1]);
    for (; clash < last; clash += m->s) { /* those of one null vector, at the stages */
        for (int i = 0; i < m->s && (i == 0 || m->node[i + 1] <= end); i++) {
            if (fabs(clash[i]) > limit) {
                return true;
            }
        }
    }
    return false;
}
