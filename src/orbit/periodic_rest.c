/* periodic_rest.c - what a small signal makes of the guards of diodes that rest.
 *
 * Where it makes nothing of them the answer of the mode is one of the circuit, whichever side such a diode is on: an
 * antiparallel diode across a closed switch without resistance, for example. */
#include "periodic_rest.h"

#include "guard_scale.h"
#include "magnitudes.h"
#include "rounding.h"

#include <math.h>

/* The largest of a row behind the start of the piece. */
static double largest_of(const struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                         double complex phase, int row) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    double largest = 0.0;
    for (int node = 1; node < flow->stages.layout.n_nodes; node++) {
        const size_t at = dalcs_periodic_flow_at(flow, node, row);
        double complex sum = phase * map->driven[at];
        for (int k = 0; k < flow->n_columns; k++) {
            sum += r->now[k] * map->state[(size_t)k * size + at];
        }
        largest = fmax(largest, cabs(sum));
    }
    return largest;
}

/* In A, else in V: a row of an open pair has its w. */
static bool is_current(const struct dalcs_system *s, const uint64_t *mode, int row) {
    const int pair = row - dalcs_system_n_equations(s);
    return pair >= 0 ? dalcs_mode_has(mode, pair) : s->column_is_current[row];
}

/* unit[2]: V, A: the largest of each. */
static void find_units(const struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                       double complex phase, double unit[2]) {
    const struct dalcs_system *s = r->flow->system;
    unit[0] = unit[1] = 0.0;
    for (int row = 0; row < dalcs_system_n_columns(s); row++) {
        double *of = &unit[is_current(s, map->mode, row) ? 1 : 0];
        *of = fmax(*of, largest_of(r, map, phase, row));
    }
}

/* What rounding makes of a guard that is 0, as of that of a run in a step of this length (guard_scale.h). */
static double rounding_of(const struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                          int pair, const double unit[2]) {
    const struct dalcs_part_laws *laws = &r->flow->orbit->rates.part->laws;
    const double held = dalcs_mode_has(map->mode, pair) ? laws->held_charge[pair] * unit[0]
                                                        : laws->held_flux[pair] * unit[1];
    return dalcs_sum_rounded / map->h * held;
}

const char *dalcs_periodic_rest_look(const struct dalcs_periodic_response *r,
                                     const struct dalcs_flow_piece *piece, double complex phase) {
    const struct dalcs_system *s = r->flow->system;
    const struct dalcs_flow_map *map = piece->map;
    double unit[2];
    if (piece->resting == NULL) {
        return NULL;
    }
    find_units(r, map, phase, unit);
    for (int k = 0; k < s->n_pairs; k++) {
        if (!dalcs_mode_has(piece->resting, k)) {
            continue;
        }
        const double guard = largest_of(r, map, phase, dalcs_system_n_equations(s) + k);
        const double nothing =
            dalcs_alike * unit[dalcs_mode_has(map->mode, k) ? 1 : 0] + rounding_of(r, map, k, unit);
        if (guard > nothing) {
            return s->pair[k].element;
        }
    }
    return NULL;
}
