/* step_scales.c - how large each signal has been, and what a step is between its nodes. */
#include "step_scales.h"

#include "extremes.h"
#include "quads.h"
#include "wide_vectors.h"

#include <math.h>
#include <string.h>

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

/* A part of a formula is judged by what reads it. The output of a comparison shows nothing of its argument but when it
 * changes its sign: as a control, that is held to its own scale. */
static void find_arguments(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    for (int d = 0; d < s->n_pairs && s->is_part != NULL; d++) {
        for (int k = s->C.p[d]; k < s->C.p[d + 1] && s->pair[d].is_jump; k++) {
            const int c = s->C.j[k];
            if (c < dalcs_system_n_equations(s) && s->is_part[c]) {
                part->scales.kinds->counts[c] = UINT64_MAX;
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
    find_arguments(part);
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

void dalcs_step_find_magnitudes(struct dalcs_radau_part *part, double end, double *unit) {
    const double *known = part->segment.out + last_node(part, end) * part->stages.layout.stride;
    find_kinds(part);
    compare_ends(part->scales.kinds, dalcs_system_n_columns(part->component->system),
                 part->segment.out, known, part->scales.magnitude, unit);
    part->scales.magnitude_end = end;
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
        dalcs_step_find_magnitudes(part, end, here);
    }
    raise_scales(dalcs_system_n_columns(part->component->system), part->scales.magnitude,
                 part->scales.kinds->counts, part->scales.column);
    part->scales.unit[0] = unit[0];
    part->scales.unit[1] = unit[1];
}

void dalcs_step_take_in(struct dalcs_radau_part *part) {
    double unit[2] = {part->scales.unit[0], part->scales.unit[1]};
    dalcs_step_find_magnitudes(part, 1.0, unit);
    dalcs_step_remember(part, 1.0, unit);
}
