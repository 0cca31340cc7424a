/* periodic_rest.c - what a small signal makes of the guards of diodes that rest, or only come near to 0.
 *
 * Where it makes nothing of them the answer of the mode is one of the circuit, whichever side such a diode is on: an
 * antiparallel diode across a closed switch without resistance, for example. */
#include "periodic_rest.h"

#include "guard_scale.h"
#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

/* A row at one of the nodes. */
static double complex value_at(const struct dalcs_periodic_response *r,
                               const struct dalcs_flow_map *map, double complex phase, int row,
                               int node) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    const size_t at = dalcs_periodic_flow_at(flow, node, row);
    double complex sum = phase * map->driven[at];
    for (int k = 0; k < flow->n_columns; k++) {
        sum += r->now[k] * map->state[(size_t)k * size + at];
    }
    return sum;
}

/* The largest of a row behind the start of the piece. */
static double largest_of(const struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                         double complex phase, int row) {
    double largest = 0.0;
    for (int node = 1; node < r->flow->stages.layout.n_nodes; node++) {
        largest = fmax(largest, cabs(value_at(r, map, phase, row, node)));
    }
    return largest;
}

/* A row at a part of the piece, by the polynomial through the nodes behind its start. */
static double moved_at(const struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                       double complex phase, int row, double theta) {
    double weight[DALCS_MAX_NODES];
    double complex sum = 0.0;
    dalcs_collocation_weights_from(r->flow->stages.method, 1, theta, weight);
    for (int node = 1; node < r->flow->stages.layout.n_nodes; node++) {
        sum += weight[node] * value_at(r, map, phase, row, node);
    }
    return cabs(sum);
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

/* ---- Diodes that only come near to their other side ---------------------------------------------- */

static const struct dalcs_orbit_span *span_of(const struct dalcs_orbit_part *orbit,
                                              const struct dalcs_orbit_low *low) {
    for (int k = 0; k < orbit->n; k++) {
        const struct dalcs_orbit_span *span = &orbit->span[k];
        if (span->from <= low->t && low->t <= span->to &&
            dalcs_mode_has(span->mode, low->pair) == low->on) {
            return span;
        }
    }
    return NULL;
}

/* The largest difference of two maps' states at their ends, in the units of energies, over what the states are there. */
static double differ(const struct dalcs_periodic_flow *flow, const struct dalcs_flow_map *map,
                     const double *other) {
    const int last = flow->stages.layout.n_nodes - 1;
    const size_t size = dalcs_periodic_flow_size(flow);
    double most = 0.0;
    for (int k = 0; k < flow->n_x; k++) {
        double sum = 0.0;
        double of = 0.0;
        for (int x = 0; x < flow->n_x; x++) {
            const double at = map->state[(size_t)k * size + dalcs_periodic_flow_at(flow, last, x)];
            sum += pow(flow->unit[x] * (at - other[k * flow->n_x + x]), 2.0);
            of += pow(flow->unit[x] * at, 2.0);
        }
        most = fmax(most, sum > 0.0 ? sqrt(sum / (sum + of)) : 0.0);
    }
    return most;
}

/* Does it matter on which side the pair is while a signal of the relative size e, much smaller than the orbit, has it on the
 * other one? It turns around there, which takes the root of e of the time that the piece lasts. A diode that ties a capacitor to a
 * source, or cuts a coil off, changes the states in no time. One across a closed switch with a resistance does not, and the
 * response is right in the limit. A mode that has no map is one that a diode alone cannot come to, and may matter. */
static bool matters(struct dalcs_periodic_flow *flow, const struct dalcs_orbit_low *low,
                    double length) {
    const struct dalcs_orbit_part *orbit = flow->orbit;
    const struct dalcs_orbit_span *span = span_of(orbit, low);
    const int last = flow->stages.layout.n_nodes - 1;
    const size_t n_x = (size_t)flow->n_x;
    const double h = length * sqrt(dalcs_small);
    uint64_t *mode = dalcs_arena_alloc(&flow->arena, (size_t)flow->stages.n_words, sizeof *mode);
    double *end = dalcs_arena_alloc(&flow->arena, n_x * n_x, sizeof *end);
    struct dalcs_flow_map *map;
    if (span == NULL || mode == NULL || end == NULL ||
        dalcs_periodic_flow_map(flow, span, low->t, h, &map) != DALCS_OK) {
        return true;
    }
    for (size_t k = 0; k < n_x; k++) {
        for (size_t x = 0; x < n_x; x++) {
            end[k * n_x + x] = map->state[k * dalcs_periodic_flow_size(flow) +
                                          dalcs_periodic_flow_at(flow, last, (int)x)];
        }
    }
    memcpy(mode, span->mode, (size_t)flow->stages.n_words * sizeof *mode);
    mode[low->pair / 64] ^= (uint64_t)1 << (low->pair % 64);
    struct dalcs_orbit_span other = *span;
    other.mode = mode;
    return dalcs_periodic_flow_map(flow, &other, low->t, h, &map) != DALCS_OK ||
           differ(flow, map, end) > dalcs_small;
}

/* Is the signal that takes the diode there much smaller than the orbit? Of a larger one nobody expects its response. */
static bool is_slight(const struct dalcs_periodic_response *r, double reach, const double unit[2]) {
    const struct dalcs_radau_part *part = r->flow->orbit->rates.part;
    return reach * unit[0] <= dalcs_small * part->scales.unit[0] &&
           reach * unit[1] <= dalcs_small * part->scales.unit[1];
}

const struct dalcs_orbit_low *dalcs_periodic_near_look(const struct dalcs_periodic_response *r,
                                                       const struct dalcs_flow_piece *piece,
                                                       double complex phase, double *reach) {
    const struct dalcs_orbit_near *near = &r->flow->orbit->near;
    const struct dalcs_flow_map *map = piece->map;
    double unit[2] = {-1.0, -1.0};
    for (int m = 0; m < near->n; m++) {
        const struct dalcs_orbit_low *low = &near->low[m];
        if (low->t < piece->t || low->t > piece->t + map->h ||
            dalcs_mode_has(map->mode, low->pair) != low->on) {
            continue;
        }
        if (unit[0] < 0.0) {
            find_units(r, map, phase, unit);
        }
        const int row = dalcs_system_n_equations(r->flow->system) + low->pair;
        const double moved = moved_at(r, map, phase, row, (low->t - piece->t) / map->h);
        const double nothing =
            dalcs_alike * unit[low->on ? 1 : 0] + rounding_of(r, map, low->pair, unit);
        *reach = low->value / moved;
        if (moved > nothing && is_slight(r, *reach, unit) && matters(r->flow, low, map->h)) {
            return low;
        }
    }
    return NULL;
}
