/* variation_rank.c - V through a segment that changes few of its directions.
 *
 * In a ladder of diodes and capacitors the states of an open mode stay, those of a mode that conducts follow the source, and a
 * load takes a little: the map S of a segment leaves V as it is, but for (S - 1) V of a low rank. Then
 *
 *     V += Q Q'(S - 1) V = Q W' V,    W = (S' - 1) Q,
 *
 * with an orthonormal basis Q of what S changes. It is found from sums of columns at random, four at a time, until four of
 * them change by fewer than four directions more: the probability that the columns then change by others is 0 (N. Halko,
 * P. G. Martinsson and J. A. Tropp, SIAM Rev. 53, 2011, section 4). W, and how the guard depends on states, are steps of
 * the transposed equations, of four columns at once (stage_columns.h). So a segment takes twice as many of these as Q has
 * fours of directions, where all columns would take a quarter of their number. What is left out is rounding of the sums. */
#include "variation_rank.h"

#include "wide_vectors.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Fours of directions, at most: a segment that changes more has taken a quarter of what it takes anyway. */
static int most_fours(const struct dalcs_variation_part *v) {
    return v->n_columns / (4 * DALCS_COLUMNS);
}

enum dalcs_status dalcs_variation_rank_setup(struct dalcs_variation_part *v,
                                             struct dalcs_arena *arena) {
    const size_t n = (size_t)v->n_x;
    const size_t n_all = n * (size_t)most_fours(v);
    dalcs_four *storage = dalcs_arena_alloc(arena, 2 * n_all + n + 1, sizeof *storage);
    if (storage == NULL) {
        return DALCS_E_NOMEM;
    }
    v->rank = (struct dalcs_variation_rank){
        .basis = storage, .weight = storage + n_all, .other = storage + 2 * n_all};
    return DALCS_OK;
}

/* 1 or -1 in each of four sums, for column k (G. Marsaglia's xorshift, J. Stat. Softw. 8, 2003). */
static void draw_signs(uint64_t *random, dalcs_four *sign) {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    for (int l = 0; l < DALCS_COLUMNS; l++) {
        (*sign)[l] = (*random >> (20 + l)) % 2 == 0 ? 1.0 : -1.0;
    }
}

/* Sums of the columns, energies being alike. */
DALCS_TWICE(void, draw, (struct dalcs_variation_part * v, uint64_t *random), (v, random)) {
    dalcs_four *z = v->four.states;
    memset(z, 0, (size_t)v->n_x * sizeof *z);
    for (int k = 0; k < v->n_columns; k++) {
        const double *column = v->v + (size_t)k * (size_t)v->n_x;
        dalcs_four sign;
        draw_signs(random, &sign);
        sign /= v->rates.unit[k];
        for (int x = 0; x < v->n_x; x++) {
            z[x] += sign * column[x];
        }
    }
}

/* The largest sum of squares, and whose. */
static double largest_of(const dalcs_four *square, int *which) {
    *which = 0;
    for (int l = 1; l < DALCS_COLUMNS; l++) {
        *which = (*square)[l] > (*square)[*which] ? l : *which;
    }
    return (*square)[*which];
}

/* The largest of four vectors a - b, energies being alike; b: NULL for 0. */
static double size_of(const struct dalcs_variation_part *v, const dalcs_four *a,
                      const dalcs_four *b) {
    dalcs_four square = {0.0};
    int which;
    for (int x = 0; x < v->n_x; x++) {
        const dalcs_four at = v->rates.unit[x] * (b != NULL ? a[x] - b[x] : a[x]);
        square += at * at;
    }
    return sqrt(largest_of(&square, &which));
}

/* The least column that is more than rounding, in the units of the sums. */
DALCS_TWICE(double, least_column, (const struct dalcs_variation_part *v, double rounding),
            (v, rounding)) {
    double least = INFINITY;
    for (int k = 0; k < v->n_columns; k++) {
        const double *column = v->v + (size_t)k * (size_t)v->n_x;
        dalcs_four square = {0.0};
        for (int x = 0; x < v->n_x; x++) {
            const double at = v->rates.unit[x] * column[x];
            square[x % DALCS_COLUMNS] += at * at;
        }
        const double size = sqrt(square[0] + square[1] + square[2] + square[3]) / v->rates.unit[k];
        least = size > rounding ? fmin(least, size) : least;
    }
    return least;
}

/* Does a new mode allow every column, but for what the run may be off by? variation.c takes larger parts of one, and only
 * these, out of it. Sums have what is not allowed of all columns. *least: of them, once it was asked for; else 0. */
static bool is_allowed(const struct dalcs_variation_part *v, double rounding, double *least) {
    const double off = size_of(v, v->four.begin, v->four.states);
    if (off > rounding && *least == 0.0) {
        *least = least_column(v, rounding);
    }
    return off <= rounding || off <= v->part->tolerance * *least;
}

/* y, four vectors, less their parts in the directions of fours. */
DALCS_TWICE(void, take_out, (int n_x, int n_fours, const dalcs_four *basis, dalcs_four *y),
            (n_x, n_fours, basis, y)) {
    for (int k = 0; k < n_fours * DALCS_COLUMNS; k++) {
        const dalcs_four *q = basis + (size_t)(k / DALCS_COLUMNS) * (size_t)n_x;
        const int l = k % DALCS_COLUMNS;
        dalcs_four part = {0.0};
        for (int x = 0; x < n_x; x++) {
            part += q[x][l] * y[x];
        }
        for (int x = 0; x < n_x; x++) {
            y[x] -= q[x][l] * part;
        }
    }
}

/* One more four of the basis, behind n_fours: directions of y that are longer than rounding, the longest first. Returns how
 * many. What a short one has left of the long ones is taken out once more (L. Giraud, J. Langou, M. Rozloznik and J. van
 * den Eshof, Numer. Math. 101, 2005): it would count these twice. */
static int add_directions(int n_x, int n_fours, dalcs_four *basis, dalcs_four *y, double rounding) {
    dalcs_four *q = basis + (size_t)n_fours * (size_t)n_x;
    memset(q, 0, (size_t)n_x * sizeof *q);
    for (int n = 0; n < DALCS_COLUMNS; n++) {
        dalcs_four part = {0.0};
        int which;
        take_out(n_x, n_fours + 1, basis, y);
        for (int x = 0; x < n_x; x++) {
            part += y[x] * y[x];
        }
        const double length = sqrt(largest_of(&part, &which));
        if (!(length > rounding)) {
            return n;
        }
        for (int x = 0; x < n_x; x++) {
            y[x] /= length;
        }
        take_out(n_x, n_fours + 1, basis, y);
        double again = 0.0;
        for (int x = 0; x < n_x; x++) {
            again += y[x][which] * y[x][which];
        }
        for (int x = 0; x < n_x; x++) {
            q[x][n] = y[x][which] / sqrt(again);
            y[x] *= length;
        }
    }
    return DALCS_COLUMNS;
}

/* v->rank.basis of what the step changes. *n_last: directions in the last four. Returns the number of fours, or 0. */
static int find_basis(struct dalcs_variation_part *v, const struct dalcs_stage_entry *entry,
                      bool is_new, int *n_last) {
    uint64_t random = 0x9e3779b97f4a7c15u;
    double rounding = 0.0;
    double least = 0.0;
    for (int g = 0; g < most_fours(v); g++) {
        dalcs_four *y = v->four.end;
        draw(v, &random);
        const double size = size_of(v, v->four.states, NULL);
        rounding = fmax(rounding, v->n_x * DBL_EPSILON * size);
        dalcs_stage_columns_apply(&v->part->stages, entry, &v->four);
        if (is_new && !is_allowed(v, rounding, &least)) {
            return 0;
        }
        for (int x = 0; x < v->n_x; x++) {
            y[x] = v->rates.unit[x] * (y[x] - v->four.states[x]);
        }
        *n_last = add_directions(v->n_x, g, v->rank.basis, y, rounding);
        if (*n_last < DALCS_COLUMNS) {
            return g + 1;
        }
    }
    return 0;
}

/* W of a four; in its direction `guard` (-1: none) how the guard depends on states. */
static void find_weights(struct dalcs_variation_part *v, const struct dalcs_stage_entry *entry,
                         int four, int guard) {
    struct dalcs_stage_columns *c = &v->four;
    dalcs_four *q = v->rank.basis + (size_t)four * (size_t)v->n_x;
    dalcs_four *weight = v->rank.weight + (size_t)four * (size_t)v->n_x;
    for (int x = 0; x < v->n_x; x++) {
        c->end[x] = v->rates.unit[x] * q[x];
    }
    memset(&c->guard, 0, sizeof c->guard);
    if (guard >= 0) {
        c->guard[guard] = 1.0;
    }
    dalcs_stage_columns_apply_back(&v->part->stages, entry, c);
    for (int x = 0; x < v->n_x; x++) {
        weight[x] = c->states[x] - v->rates.unit[x] * q[x];
        q[x] /= v->rates.unit[x];
    }
}

/* column += Q W' column; returns what stands in the last place of W' column. */
DALCS_TWICE(double, change,
            (const struct dalcs_variation_part *v, int n_fours, int last, double *column),
            (v, n_fours, last, column)) {
    dalcs_four *by = v->rank.other;
    double value = 0.0;
    memset(by, 0, (size_t)v->n_x * sizeof *by);
    for (int g = 0; g < n_fours; g++) {
        const dalcs_four *weight = v->rank.weight + (size_t)g * (size_t)v->n_x;
        const dalcs_four *q = v->rank.basis + (size_t)g * (size_t)v->n_x;
        dalcs_four part = {0.0};
        for (int x = 0; x < v->n_x; x++) {
            part += column[x] * weight[x];
        }
        for (int x = 0; x < v->n_x; x++) {
            by[x] += part * q[x];
        }
        value = part[last];
    }
    for (int x = 0; x < v->n_x; x++) {
        column[x] += by[x][0] + by[x][1] + by[x][2] + by[x][3];
    }
    return value;
}

static bool pass(struct dalcs_variation_part *v, const struct dalcs_stage_entry *entry,
                 bool is_new) {
    int last;
    const bool has_guard = v->four.row >= 0;
    const int n_fours = find_basis(v, entry, is_new, &last);
    for (int g = 0; g < n_fours; g++) {
        find_weights(v, entry, g, has_guard && g == n_fours - 1 ? last : -1);
    }
    for (int k = 0; k < v->n_columns && n_fours > 0; k++) {
        const double guard = change(v, n_fours, last, v->v + (size_t)k * (size_t)v->n_x);
        v->guard[k] = has_guard ? guard : 0.0;
    }
    return n_fours > 0;
}

/* After k segments in a row that it could not pass the next 2^k - 1 are not asked: what is lost to them grows with the
 * logarithm of their number. */
bool dalcs_variation_pass_rank(struct dalcs_variation_part *v,
                               const struct dalcs_stage_entry *entry, const double *weight, int row,
                               bool is_new) {
    struct dalcs_variation_rank *r = &v->rank;
    if (r->wait > 0 || most_fours(v) == 0) {
        r->wait -= r->wait > 0 ? 1 : 0;
        return false;
    }
    v->four.weight = weight;
    v->four.row = row;
    const bool passed = pass(v, entry, is_new);
    r->failed = passed ? 0 : 2 * r->failed + 1;
    r->wait = r->failed;
    return passed;
}
