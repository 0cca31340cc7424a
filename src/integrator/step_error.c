/* step_error.c - the error estimate against each signal's own scale.
 *
 * Two things are looked at. The drift of the states is how far they miss, at the start of the step, a
 * polynomial one degree lower, filtered through one step of implicit Euler (Hairer and Wanner, Solving
 * ODEs II, sec. IV.8): of order s + 1 like the dense output. The ripple is what curved sources do
 * between the nodes, carried to every voltage and current; it alone sees variables of index 2, such as
 * the current of a source across a capacitor. */
#include "step_error.h"

#include "extremes.h"

#include <math.h>
#include <string.h>

/* Signals smaller than this part of the largest of their unit are held to that one's scale; the
 * current of a pair likewise. */
static const double smallest_scale = 1e-5;
static const double smallest_pair = 1e-2;

/* No column is known better than this part of what would balance the largest of the others. */
static const double rounding_part = 2e-14;

/* A voltage that is 0 is no better than what rounding of this step's currents drives through the
 * largest conductance of the circuit, nor a current than rounding of the voltages through the least:
 * the same part, over what find_cross_scales counts as nothing. */
static const double crossed = 2e-8;

/* Sources that disagree by more than this part of the largest signal. */
static const double clash_part = 1e-9;

static bool is_on(const struct dalcs_radau_part *part, int pair) {
    return dalcs_osnsp_is_on(&part->component->osnsp, pair);
}

/* The largest |y[begin..end-1]|: two running maxima, one alone would wait for itself. */
static double largest_of(const double *y, int begin, int end, double largest) {
    double other = 0.0;
    int c = begin;
    for (; c + 2 <= end; c += 2) {
        double a = fabs(y[c]);
        double b = fabs(y[c + 1]);
        largest = a > largest ? a : largest;
        other = b > other ? b : other;
    }
    if (c < end) {
        largest = dalcs_larger(largest, fabs(y[c]));
    }
    return dalcs_larger(largest, other);
}

static void raise_units(const struct dalcs_radau_part *part, const double *y, double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    int n_equations = dalcs_system_n_equations(p->system);
    for (int k = 0; k < p->n_runs && p->run[k].begin < n_equations; k++) {
        int end = p->run[k].end < n_equations ? p->run[k].end : n_equations;
        int of = p->run[k].is_current;
        unit[of] = largest_of(y, p->run[k].begin, end, unit[of]);
    }
    for (int d = 0; d < p->system->n_pairs; d++) {
        int of = is_on(part, d);
        unit[of] = dalcs_larger(unit[of], fabs(y[n_equations + d]));
    }
}

/* Each unit vouches a little for the other. */
static void cross_units(const struct dalcs_radau_part *part, double *unit) {
    double volt = unit[0];
    unit[0] = dalcs_larger(unit[0], part->cross[0] * unit[1]);
    unit[1] = dalcs_larger(unit[1], part->cross[1] * volt);
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

void dalcs_step_states(const struct dalcs_radau_part *part, double theta, double *x) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);
    for (int i = 0; i < part->component->system->n_x; i++) {
        double sum = 0.0;
        for (int k = 0; k < l->n_nodes; k++) {
            sum += weight[k] * part->out[k * l->stride + i];
        }
        x[i] = sum;
    }
}

void dalcs_step_values(const struct dalcs_radau_part *part, double theta, double *value) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    if (theta == 0.0 || theta == 1.0) {
        int node = theta == 0.0 ? 0 : l->n_nodes - 1;
        memcpy(value, part->out + node * l->stride, (size_t)l->stride * sizeof(*value));
        return;
    }
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);

    /* Sums stay in registers; each is made in the same order, whatever the width. */
    enum { WIDTH = 4 };

    int c = 0;
    for (; c + WIDTH <= l->stride; c += WIDTH) {
        double sum[WIDTH] = {0.0};
        for (int k = 0; k < l->n_nodes; k++) {
            const double *y = part->out + k * l->stride + c;
            for (int j = 0; j < WIDTH; j++) {
                sum[j] += weight[k] * y[j];
            }
        }
        memcpy(value + c, sum, sizeof(sum));
    }
    for (; c < l->stride; c++) {
        double sum = 0.0;
        for (int k = 0; k < l->n_nodes; k++) {
            sum += weight[k] * part->out[k * l->stride + c];
        }
        value[c] = sum;
    }
}

/* The larger of what a column is at the first and at the last known node of a segment; raises the
 * units to the largest of them. */
static void find_magnitudes(struct dalcs_radau_part *part, double end, double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    int n_equations = dalcs_system_n_equations(p->system);
    const double *first = part->out;
    const double *known = part->out + last_node(part, end) * part->stages.layout.stride;
    double *restrict magnitude = part->magnitude;
    for (int k = 0; k < p->n_runs && p->run[k].begin < n_equations; k++) {
        int run_end = p->run[k].end < n_equations ? p->run[k].end : n_equations;
        double largest = unit[p->run[k].is_current];
        for (int c = p->run[k].begin; c < run_end; c++) {
            double m = dalcs_larger(fabs(first[c]), fabs(known[c]));
            magnitude[c] = m;
            largest = dalcs_larger(largest, m);
        }
        unit[p->run[k].is_current] = largest;
    }
    for (int d = 0; d < p->system->n_pairs; d++) {
        int c = n_equations + d;
        int of = is_on(part, d);
        magnitude[c] = dalcs_larger(fabs(first[c]), fabs(known[c]));
        unit[of] = dalcs_larger(unit[of], magnitude[c]);
    }
    part->magnitude_end = end;
}

/* What a column of 1 in balanced units may be off by rounding in this step. */
static double rounding_of_step(const struct dalcs_radau_part *part,
                               const struct dalcs_stage_entry *entry) {
    int n_equations = dalcs_system_n_equations(part->component->system);
    const double *final = part->out + part->stages.method->s * part->stages.layout.stride;
    const double *inverse = dalcs_stage_natural_units(entry) + n_equations;
    double balanced = 0.0;
    for (int c = 0; c < n_equations; c++) {
        balanced = dalcs_larger(balanced, fabs(final[c]) * inverse[c]);
    }
    return rounding_part * part->rounding * balanced;
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

/* The errors over what is allowed, with `rounding` besides. */
static void compare(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                    const double *natural, double rounding, struct dalcs_step_quality *q) {
    const struct dalcs_system *s = part->component->system;
    const double *drift = part->out + part->stages.layout.drift;
    const double *ripple = part->out + part->stages.layout.ripple;
    bool curved = part->excitation.is_curved;
    double besides[2] = {0.1 * r->options.vntol + crossed * part->cross[0] * q->here[1],
                         0.1 * r->options.abstol + crossed * part->cross[1] * q->here[0]};
    double least[2] = {smallest_scale * q->unit[0], smallest_scale * q->unit[1]};
    q->ratio = 0.0;
    q->drift = 0.0;
    q->of_unit = 0.0;
    int c = 0;
    for (; c < s->n_x; c++) {
        int of = s->column_is_current[c] ? 1 : 0;
        double scale = dalcs_larger(dalcs_larger(part->scale[c], part->magnitude[c]), least[of]);
        double allowed = r->inner_tolerance * scale + rounding * natural[c] + besides[of];
        double error = fabs(drift[c]);
        if (error > q->drift * allowed) {
            q->drift = error / allowed;
        }
        judge(q, curved ? dalcs_larger(error, fabs(ripple[c])) : error, allowed, of);
    }
    int n_equations = dalcs_system_n_equations(s);
    for (; curved && c < n_equations; c++) {
        int of = s->column_is_current[c] ? 1 : 0;
        double scale = dalcs_larger(dalcs_larger(part->scale[c], part->magnitude[c]), least[of]);
        judge(q, fabs(ripple[c]), r->inner_tolerance * scale + rounding * natural[c] + besides[of],
              of);
    }
    double floor = rounding_part * part->rounding * q->unit[1] + besides[1];
    double least_pair = smallest_pair * q->unit[1];
    for (int d = 0; curved && d < s->n_pairs; d++, c++) {
        if (is_on(part, d)) { /* the voltage of the others is one of the columns */
            double scale =
                dalcs_larger(dalcs_larger(part->scale[c], part->magnitude[c]), least_pair);
            judge(q, fabs(ripple[c]), r->inner_tolerance * scale + floor, 1);
        }
    }
}

void dalcs_step_judge(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                      const struct dalcs_stage_entry *entry, double end,
                      struct dalcs_step_quality *q) {
    *q = (struct dalcs_step_quality){0};
    find_magnitudes(part, end, q->here);
    q->unit[0] = dalcs_larger(q->here[0], part->unit_scale[0]);
    q->unit[1] = dalcs_larger(q->here[1], part->unit_scale[1]);
    cross_units(part, q->unit);
    const double *natural = dalcs_stage_natural_units(entry);
    compare(r, part, natural, 0.0, q);
    if (!(q->ratio <= 1.0)) { /* is it rounding? Few steps have to ask. */
        compare(r, part, natural, rounding_of_step(part, entry), q);
    }
}

void dalcs_step_reach(struct dalcs_radau_part *part, double end, double *unit) {
    dalcs_step_values(part, end, part->y2);
    raise_units(part, part->y2, unit);
    cross_units(part, unit);
}

void dalcs_step_remember(struct dalcs_radau_part *part, double end, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    int n_equations = dalcs_system_n_equations(s);
    if (end != part->magnitude_end) {
        double here[2] = {0.0, 0.0};
        find_magnitudes(part, end, here);
    }
    const double *restrict magnitude = part->magnitude;
    double *restrict scale = part->scale;
    for (int c = 0; c < n_equations + s->n_pairs; c++) {
        scale[c] = scale[c] > magnitude[c] ? scale[c] : magnitude[c];
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (!is_on(part, d)) {
            scale[n_equations + d] = 0.0; /* of a current: since it closed */
        }
    }
    part->unit_scale[0] = unit[0];
    part->unit_scale[1] = unit[1];
}

bool dalcs_step_clashes(const struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry,
                        double end, const double *unit) {
    const struct dalcs_collocation *m = part->stages.method;
    const double *clash = part->out + part->stages.layout.n_fixed;
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
