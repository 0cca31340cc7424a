/* doubt.c - the band of a guard. */
#include "doubt.h"

#include <math.h>

/* What the columns of a row other than `but` make of errors that are the same part of each. */
static double spread_of(const struct dalcs_radau_part *part, const struct dalcs_csr *m, int row,
                        int but, const double *unit) {
    double spread = 0.0;
    for (int k = m->p[row]; k < m->p[row + 1]; k++) {
        int c = m->j[k];
        spread += c == but ? 0.0 : fabs(m->x[k]) * dalcs_step_scale(part, c, unit);
    }
    return spread;
}

/* Of the current of a closed pair, by the KCL of its nodes: the better one. */
static double spread_of_current(const struct dalcs_radau_part *part, int pair, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    double least = INFINITY;
    for (int e = 0; e < 2; e++) {
        int row = part->pair_row[2 * pair + e];
        if (row < 0) {
            continue; /* ground */
        }
        double spread = spread_of(part, &s->A, row, dalcs_system_n_equations(s) + pair, unit);
        if (row < s->n_x) {
            spread += spread_of(part, &s->P, row, -1, unit) / part->h;
        }
        least = dalcs_smaller(least, spread);
    }
    return least;
}

/* The largest value of a row in the step, for what the polynomial may be off by. */
static double largest_of(const struct dalcs_radau_part *part, int row) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double size = 0.0;
    for (int k = 0; k < l->n_nodes; k++) {
        size = dalcs_larger(size, fabs(part->out[k * l->stride + row]));
    }
    return size;
}

double dalcs_doubt_noise_about(const struct dalcs_radau_part *part, int guard, double scale,
                               const double *unit) {
    const struct dalcs_system *s = part->component->system;
    double local = scale;
    if (part->rounding > 1.0 && guard < s->n_pairs) {
        local = dalcs_osnsp_is_on(&part->component->osnsp, guard)
                    ? spread_of_current(part, guard, unit)
                    : spread_of(part, &s->C, guard, -1, unit);
    }
    return dalcs_doubt_noise(part) * dalcs_smaller(local, scale);
}

/* What errors of all that a guard is made of come to. */
static double of_all(const struct dalcs_radau *r, const struct dalcs_radau_part *part, double size,
                     double scale) {
    return dalcs_doubts_over_tolerance * r->inner_tolerance * size +
           dalcs_beyond_noise * dalcs_doubt_noise(part) * scale;
}

/* Which is no more than the band. */
static double within_band(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                          double size, double scale) {
    return dalcs_smaller(of_all(r, part, size, scale), dalcs_doubt_band(r, part) * scale);
}

static double spread_at_start(const struct dalcs_radau_part *part, int place) {
    return dalcs_stage_spread(&part->stages, part->entry, place, part->in, part->scale);
}

double dalcs_doubt_about(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                         int guard, double scale, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    if (guard >= s->n_pairs || part->entry == NULL) {
        return dalcs_doubt_band(r, part) * scale;
    }
    int place = dalcs_system_n_equations(s) + guard;
    double spread;
    if (dalcs_stage_has_map(part->entry)) {
        spread = spread_at_start(part, place);
    } else if (dalcs_osnsp_is_on(&part->component->osnsp, guard)) {
        spread = spread_of_current(part, guard, unit);
    } else {
        spread = spread_of(part, &s->C, guard, -1, unit);
    }
    return within_band(r, part, largest_of(part, place) + spread, scale);
}

double dalcs_doubt_of_closed(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                             int pair, double scale) {
    double band = dalcs_doubt_band(r, part) * scale;
    if (part->entry == NULL || !dalcs_stage_has_map(part->entry)) {
        return band;
    }
    int place = dalcs_system_n_equations(part->component->system) + pair;
    return dalcs_larger(band, of_all(r, part, spread_at_start(part, place), scale));
}

/* Is a row below -`least` at all nodes behind the start? */
static bool is_below(const struct dalcs_radau_part *part, int row, double least) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    bool below = true;
    for (int k = 1; k < l->n_nodes && below; k++) {
        below = part->out[k * l->stride + row] < -least;
    }
    return below;
}

double dalcs_doubt_of_fall(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                           int guard, double scale, const double *unit) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const struct dalcs_system *s = part->component->system;
    double doubt = dalcs_doubt_about(r, part, guard, scale, unit);
    int place = dalcs_system_n_equations(s) + guard;
    bool has_map = part->entry != NULL && dalcs_stage_has_map(part->entry);
    if (guard >= s->n_pairs || !has_map || !is_below(part, place, 0.0)) {
        return doubt;
    }
    double spread = dalcs_stage_spread(&part->stages, part->entry,
                                       (l->n_nodes - 1) * l->stride + place, part->in, part->scale);
    double at_end = within_band(r, part, largest_of(part, place) + spread, scale);
    return is_below(part, place, at_end) ? dalcs_smaller(doubt, at_end) : doubt;
}
