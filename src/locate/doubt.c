/* doubt.c - the band of a guard. */
#include "doubt.h"

#include "guard_scale.h"
#include "magnitudes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A pair by its nodes. */
struct place_of_pair {
    int row[2], pair;
};

static int compare_places(const void *a, const void *b) {
    const struct place_of_pair *p = a;
    const struct place_of_pair *q = b;
    const int first = (p->row[0] > q->row[0]) - (p->row[0] < q->row[0]);
    const int second = (p->row[1] > q->row[1]) - (p->row[1] < q->row[1]);
    return first != 0 ? first : second != 0 ? second : p->pair - q->pair;
}

/* Those between the same nodes, one after the other in a ring. */
static enum dalcs_status find_parallel(struct dalcs_radau_part *part) {
    const int n = part->component->system->n_pairs;
    struct dalcs_arena work = {0};
    struct place_of_pair *of = dalcs_arena_alloc(&work, (size_t)n, sizeof(*of));
    part->laws.next_parallel = dalcs_arena_alloc(&part->arena, (size_t)n, sizeof(int));
    if (of == NULL || part->laws.next_parallel == NULL) {
        dalcs_arena_finish(&work);
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < n; d++) {
        const int *row = part->laws.pair_row + 2 * (size_t)d;
        of[d] = (struct place_of_pair){{row[0], row[1]}, d};
    }
    qsort(of, (size_t)n, sizeof(*of), compare_places);
    for (int first = 0, k = 0; k < n; k++) {
        const bool is_last =
            k + 1 == n || of[k + 1].row[0] != of[k].row[0] || of[k + 1].row[1] != of[k].row[1];
        part->laws.next_parallel[of[k].pair] = is_last ? of[first].pair : of[k + 1].pair;
        first = is_last ? k + 1 : first;
    }
    dalcs_arena_finish(&work);
    return DALCS_OK;
}

enum dalcs_status dalcs_doubt_setup(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    DALCS_TRY(find_parallel(part));
    size_t n = (size_t)dalcs_system_n_equations(s);
    part->laws.charging_row = dalcs_arena_alloc(&part->arena, n, sizeof(int));
    if (part->laws.charging_row == NULL) {
        return DALCS_E_NOMEM;
    }
    memset(part->laws.charging_row, -1, n * sizeof(int));
    for (int r = 0; r < s->n_x; r++) {
        int first = s->A.p[r];
        int c = s->A.p[r + 1] == first + 1 ? s->A.j[first] : -1;
        if (s->row_is_current[r] && c >= s->n_x && s->column_is_current[c]) {
            part->laws.charging_row[c] = r;
        }
    }
    return DALCS_OK;
}

/* What errors of a column are a part of: what it has been. Of a current that charges a capacitor only what it is in
 * this step, and what errors of the voltage make of it: a spike long ago does not make it less known. */
static double size_of(const struct dalcs_radau_part *part, int column, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    double scale = dalcs_step_scale(part, column, unit);
    int row = column < dalcs_system_n_equations(s) ? part->laws.charging_row[column] : -1;
    if (row < 0) {
        return scale;
    }
    double charge = 0.0;
    for (int k = s->P.p[row]; k < s->P.p[row + 1]; k++) {
        charge += fabs(s->P.x[k]) * dalcs_step_scale(part, s->P.j[k], unit);
    }
    return dalcs_smaller(scale, part->scales.magnitude[column] + charge / part->segment.h);
}

/* What the columns of a row other than `but` make of errors that are the same part of each, or more than `most`: at a node
 * where hundreds of pairs meet, that of a pair's other node is less than that of a few of them. */
static double spread_of(const struct dalcs_radau_part *part, const struct dalcs_csr *m, int row,
                        int but, double most, const double *unit) {
    double spread = 0.0;
    for (int k = m->p[row]; k < m->p[row + 1] && spread <= most; k++) {
        int c = m->j[k];
        spread += c == but ? 0.0 : fabs(m->x[k]) * size_of(part, c, unit);
    }
    return spread;
}

/* Of the current of a closed pair, by the KCL of its nodes: the better one. */
static double spread_of_current(const struct dalcs_radau_part *part, int pair, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    const int *row = part->laws.pair_row + 2 * (size_t)pair;
    const bool begins_with_other =
        row[1] >= 0 && s->A.p[row[1] + 1] - s->A.p[row[1]] < s->A.p[row[0] + 1] - s->A.p[row[0]];
    double least = INFINITY;
    for (int e = 0; e < 2; e++) {
        const int r = row[begins_with_other ? 1 - e : e];
        if (r < 0) {
            continue; /* ground */
        }
        double spread = spread_of(part, &s->A, r, dalcs_system_n_equations(s) + pair, least, unit);
        if (r < s->n_x && spread <= least) {
            spread += spread_of(part, &s->P, r, -1, INFINITY, unit) / part->segment.h;
        }
        least = dalcs_smaller(least, spread);
    }
    return least;
}

double dalcs_pair_slope(const struct dalcs_system *s, int pair) {
    double ohms = 0.0;
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        ohms = s->C.j[k] == dalcs_system_n_equations(s) + pair ? fabs(s->C.x[k]) : ohms;
    }
    return ohms;
}

/* Of the voltage of an open pair. Beside a closed one, as a diode beside its switch is, it is Ohm's law that makes it of
 * a current, not the difference of two nodes that may be at kilovolts. */
static double spread_of_voltage(const struct dalcs_radau_part *part, int pair, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    double spread = spread_of(part, &s->C, pair, -1, INFINITY, unit);
    const bool is_across_ground = part->laws.pair_row[2 * (size_t)pair] < 0;
    for (int k = part->laws.next_parallel[pair]; k != pair && !is_across_ground;
         k = part->laws.next_parallel[k]) {
        if (dalcs_osnsp_is_on(&part->component->osnsp, k)) {
            spread =
                dalcs_smaller(spread, dalcs_pair_slope(s, k) * spread_of_current(part, k, unit));
        }
    }
    return spread;
}

/* What such errors make of a pair, as far as this follows from its row or its nodes: on factors. */
static double spread_about(const struct dalcs_radau_part *part, int pair, const double *unit) {
    return dalcs_osnsp_is_on(&part->component->osnsp, pair) ? spread_of_current(part, pair, unit)
                                                            : spread_of_voltage(part, pair, unit);
}

/* The largest value of a row in the step, for what the polynomial may be off by. */
static double largest_of(const struct dalcs_radau_part *part, int row) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double size = 0.0;
    for (int k = 0; k < l->n_nodes; k++) {
        size = dalcs_larger(size, fabs(part->segment.out[k * l->stride + row]));
    }
    return size;
}

double dalcs_doubt_noise_about(const struct dalcs_radau_part *part, int guard, double scale,
                               const double *unit) {
    double noise = dalcs_doubt_noise(part) * scale;
    if (!(part->segment.rounding > 1.0) || guard >= part->component->system->n_pairs) {
        return noise;
    }
    /* where nothing else flows, a current is still a difference of those that flow elsewhere */
    double local = dalcs_doubt_noise(part) * spread_about(part, guard, unit);
    return dalcs_smaller(noise, dalcs_larger(local, dalcs_beyond * dalcs_sum_rounded * scale));
}

/* What errors of all that a guard is made of come to, with noise that is a part of `of_noise`. */
static double of_all(const struct dalcs_radau_part *part, double size, double of_noise) {
    return dalcs_beyond * (part->inner_tolerance * size + dalcs_doubt_noise(part) * of_noise);
}

/* Which is no more than the band. */
static double within_band(const struct dalcs_radau_part *part, double size, double of_noise,
                          double scale) {
    return dalcs_smaller(of_all(part, size, of_noise), dalcs_doubt_band(part) * scale);
}

static double spread_at_start(const struct dalcs_radau_part *part, int place) {
    return dalcs_stage_spread(&part->stages, part->segment.entry, place, part->segment.in,
                              part->scales.column);
}

double dalcs_doubt_about(const struct dalcs_radau_part *part, int guard, double scale,
                         const double *unit) {
    const struct dalcs_system *s = part->component->system;
    if (guard >= s->n_pairs || part->segment.entry == NULL) {
        return dalcs_doubt_band(part) * scale;
    }
    int place = dalcs_system_n_equations(s) + guard;
    bool has_map = dalcs_stage_has_map(part->segment.entry);
    double spread = has_map ? spread_at_start(part, place) : spread_about(part, guard, unit);
    double size = largest_of(part, place) + spread;
    if (has_map || !dalcs_osnsp_is_on(&part->component->osnsp, guard)) {
        return within_band(part, size, scale, scale);
    }
    /* The band is a part of the largest current of all, what the tolerance promises one of this current's own scale. */
    double promised = dalcs_beyond * part->inner_tolerance * dalcs_step_scale(part, place, unit);
    return dalcs_smaller(within_band(part, size, size, scale), promised);
}

double dalcs_doubt_of_closed(const struct dalcs_radau_part *part, int pair, double scale) {
    double band = dalcs_doubt_band(part) * scale;
    if (!dalcs_guard_has_map(part)) {
        return band;
    }
    int place = dalcs_system_n_equations(part->component->system) + pair;
    return dalcs_larger(band, of_all(part, spread_at_start(part, place), scale));
}
