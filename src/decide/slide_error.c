/* slide_error.c - how far a tried segment along a threshold is off.
 *
 * What is known at the start is no part of the polynomial through the other nodes. Of states it is the state. Of other columns it
 * is what the first steps of the sequences have for steps of length 0: they are from the state itself. */
#include "slide_try.h"

#include "rounding.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

/* How far the polynomial of a column through the nodes misses what is known at the start, as of any other step
 * (step_error.c), but for what rounding at the nodes makes of that. */
static double miss_at_start(const struct dalcs_radau_part *part, int column, double rounding,
                            const struct dalcs_slide_try *of) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double amplified = 0.0;
    double start = 0.0;
    for (int node = 1; node < l->n_nodes; node++) {
        amplified += fabs(of->start[node]) * rounding;
        start += of->start[node] * part->segment.out[node * l->stride + column];
    }
    return l->n_nodes > 2 ? fmax(0.0, fabs(start - part->segment.out[column]) - amplified) : 0.0;
}

/* Of a column at a node. A pair stands between both units. */
static double rounding_of(const struct dalcs_radau_part *part, int column, bool is_current,
                          const struct dalcs_slide_try *of) {
    const double *unit = part->scales.unit;
    const double own = fmax(unit[is_current], of->largest[is_current]);
    const double other = fmax(unit[!is_current], of->largest[!is_current]);
    const bool is_pair = column >= dalcs_system_n_equations(part->component->system);
    return of->rounding * (is_pair ? fmax(own, other) : own);
}

/* Of a column of that size: what rounding makes of a mean, as the sequences add it up. States are what a mean makes of them. */
static double noise_of(const struct dalcs_radau_part *part, int column, double size,
                       const struct dalcs_slide_try *of) {
    const int n_x = part->component->system->n_x;
    return n_x > 0 && column >= n_x ? of->rounding / dalcs_sum_rounded * of->noise * size : 0.0;
}

/* How far a column's start is from where the segment before ended: a pair may have changed sides between the start and the first
 * node, and nothing at the nodes shows that. */
static double miss_before(const struct dalcs_radau_part *part, int column,
                          const struct dalcs_slide_try *of) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double before = part->segment.out_before[(l->n_nodes - 1) * l->stride + column];
    const bool is_known = of->follows && column < dalcs_system_n_equations(part->component->system);
    return is_known ? fabs(part->segment.out[column] - before) : 0.0;
}

/* How far a column is off, over what is allowed: what the last order changes, and how far it misses the start. A state
 * beside larger ones, as a leak of a coil at rest beside one that conducts, has rounding of theirs. */
static double error_of_column(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                              int column, bool is_current, const struct dalcs_slide_try *of) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double rounding = of->knows_start ? rounding_of(part, column, is_current, of) : 0.0;
    double error = 0.0;
    double size = of->knows_start ? fabs(part->segment.out[column]) : 0.0;
    for (int node = 1; node < l->n_nodes; node++) {
        const double value = part->segment.out[node * l->stride + column];
        const double other = part->work.out_tried[node * l->stride + column];
        error = fmax(error, fabs(value - other) - rounding);
        size = fmax(size, fabs(value));
    }
    size = fmax(size, dalcs_step_scale(part, column, part->scales.unit));
    if (of->knows_start) {
        const double at_nodes = rounding + noise_of(part, column, size, of);
        error = fmax(error, miss_at_start(part, column, at_nodes, of));
        error = fmax(error, miss_before(part, column, of) - 2.0 * at_nodes);
    }
    return error > 0.0 ? error / (part->inner_tolerance * size + r->besides[is_current]) : 0.0;
}

/* The largest of states; without states of all but the currents of pairs. */
static double error_of_states(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                              const struct dalcs_slide_try *of) {
    const struct dalcs_system *s = part->component->system;
    double worst = 0.0;
    const int n = s->n_x > 0 ? s->n_x : dalcs_system_n_equations(s);
    for (int x = 0; x < n; x++) {
        worst = fmax(worst, error_of_column(r, part, x, s->column_is_current[x], of));
    }
    return worst;
}

/* And of other columns, with the currents of pairs that conduct on either side: what sources and formulas do meanwhile is in
 * no state where a threshold holds all of them. */
static double error_of_pairs(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             const struct dalcs_slide_try *of) {
    const struct dalcs_system *s = part->component->system;
    struct dalcs_osnsp *p = &part->component->osnsp;
    const size_t bytes = (size_t)p->n_words * sizeof(uint64_t);
    double worst = 0.0;
    for (int c = s->n_x; c < dalcs_system_n_equations(s) && s->n_x > 0; c++) {
        worst = fmax(worst, error_of_column(r, part, c, s->column_is_current[c], of));
    }
    memcpy(part->work.mode_before, p->mode, bytes);
    memcpy(p->mode, part->work.mode_first, bytes);
    for (int d = 0; d < s->n_pairs; d++) {
        if (dalcs_mode_has(p->mode, d)) {
            worst =
                fmax(worst, error_of_column(r, part, dalcs_system_n_equations(s) + d, true, of));
        }
    }
    memcpy(p->mode, part->work.mode_before, bytes);
    return worst;
}

void dalcs_slide_find_errors(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             struct dalcs_slide_try *of) {
    of->states = error_of_states(r, part, of);
    of->pairs = error_of_pairs(r, part, of);
    of->is_coarse = of->pairs > 1.0 || part->stages.method->s == 1;
    of->bare = of->pairs;
    of->pairs /= 1.0 + of->noise / part->inner_tolerance;
}
