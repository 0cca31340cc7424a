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

double dalcs_doubt_about(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                         int guard, double scale, const double *unit) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const struct dalcs_system *s = part->component->system;
    double band = dalcs_doubt_band(r, part) * scale;
    if (guard >= s->n_pairs || part->entry == NULL) {
        return band;
    }
    int place = dalcs_system_n_equations(s) + guard;
    double size = 0.0; /* for what the polynomial may be off by */
    for (int k = 0; k < l->n_nodes; k++) {
        size = dalcs_larger(size, fabs(part->out[k * l->stride + place]));
    }
    double spread;
    if (dalcs_stage_has_map(part->entry)) {
        spread = dalcs_stage_spread(&part->stages, part->entry, place, part->in, part->scale);
    } else if (dalcs_osnsp_is_on(&part->component->osnsp, guard)) {
        spread = spread_of_current(part, guard, unit);
    } else {
        spread = spread_of(part, &s->C, guard, -1, unit);
    }
    double own = dalcs_doubts_over_tolerance * r->inner_tolerance * (size + spread);
    return dalcs_smaller(own + dalcs_beyond_noise * dalcs_doubt_noise(part) * scale, band);
}
