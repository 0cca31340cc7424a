/* several_slides.c - switches that slide at once, each for itself.
 *
 * Each is on its other side for a part of the time of its own. Where no clock ties them to each other, each side of one
 * goes with each of the others, for the product of their parts of the time, and these are such that the mean has each at its
 * threshold (Alexander and Seidman, Sliding modes in intersecting switching surfaces, 1998: blending). */
#include "sliding_internal.h"

#include "dense_solve.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

/* Newton's method: where what each reads goes on in a straight line with what each does, one of these does. */
enum { MOST_SEVERAL = 3, MOST_NEWTON = 16, ROWS = 4 * MOST_SEVERAL };

_Static_assert(1 << MOST_SEVERAL == DALCS_MOST_SIDES, "a side for each of their positions");

struct several {
    int n;
    int first[MOST_SEVERAL]; /* of each group */
    double part[MOST_SEVERAL];
};

static double *corner_y(const struct dalcs_positions *p, int corner) {
    return p->sides.y + (ptrdiff_t)corner * dalcs_system_n_columns(p->osnsp->system);
}

static double *corner_w(const struct dalcs_positions *p, int corner) {
    return p->sides.w + (ptrdiff_t)corner * p->osnsp->system->n_pairs;
}

static double beyond(const struct dalcs_positions *p, int i, int corner) {
    return dalcs_turning_beyond(p, i, corner_y(p, corner), corner_w(p, corner));
}

/* Those that one weight puts on their thresholds, as complementary switches, are one. of->n is 0 where they are too many. */
static void find_groups(struct dalcs_positions *p, const double *y, struct several *of) {
    of->n = 0;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        p->sides.group[i] = -1;
    }
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        if (!dalcs_turning_leads(p, i)) {
            continue;
        }
        double noise;
        int g = 0;
        while (g < of->n &&
               !dalcs_turning_fits(p, i, dalcs_turning_weight(p, of->first[g], y, &noise), y)) {
            g++;
        }
        if (g == MOST_SEVERAL) {
            of->n = 0;
            return;
        }
        if (g == of->n) {
            of->first[of->n++] = i;
        }
        p->sides.group[i] = g;
    }
}

/* Those that lead stand as in a corner; the output of a jump is on the side of what it commands (sliding.c). */
static void put_leading(struct dalcs_positions *p, int corner) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        const int g = p->sides.group[i];
        if (g >= 0) {
            const bool is_other = (corner >> g & 1) != 0;
            const uint64_t *mode = is_other == (i < p->n) ? p->other : p->present;
            dalcs_turning_put(p, i, dalcs_mode_has(mode, dalcs_turning_pair(p, i)));
        }
    }
}

/* All else goes where the answer y has it. The answers on the way to a corner are none of the circuit: a switch with
 * hysteresis remembers p->present, not these. Returns whether something changed. */
static bool put_others(struct dalcs_positions *p, const double *y) {
    const struct dalcs_osnsp *o = p->osnsp;
    bool any = false;
    for (int k = 0; k < o->signs.n_violating; k++) {
        const int pair = o->signs.violating[k];
        if (!dalcs_turning_is_of_leading_jump(p, pair)) {
            dalcs_osnsp_command(p->osnsp, pair, !dalcs_osnsp_is_on(o, pair));
            any = true;
        }
    }
    for (int i = 0; i < p->n; i++) {
        if (p->sides.group[i] < 0 && dalcs_positions_moves_from(p, i, p->present, y)) {
            dalcs_turning_put(p, i, !dalcs_osnsp_is_on(o, p->pair[i]));
            any = true;
        }
    }
    return any;
}

static enum dalcs_status find_corner(struct dalcs_positions *p, const double *u, int corner,
                                     bool *is_complete) {
    struct dalcs_osnsp *o = p->osnsp;
    double *y = corner_y(p, corner);
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    put_leading(p, corner);
    *is_complete = false;
    for (int round = 0; round <= o->system->n_pairs && !*is_complete; round++) {
        enum dalcs_status status = dalcs_osnsp_answer(o, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        *is_complete = !put_others(p, y);
    }
    memcpy(corner_w(p, corner), o->w, (size_t)o->system->n_pairs * sizeof(double));
    for (int k = 0; k < o->n_words; k++) {
        p->sides.conducted[k] |= o->mode[k];
        p->mark[k] &= o->mode[k];
    }
    return DALCS_OK;
}

/* y is the answer on one side of all; that on the other side of all is p->other_y. What is on in all corners stays in
 * p->mark. */
static enum dalcs_status find_corners(struct dalcs_positions *p, const double *u, const double *y,
                                      const struct several *of, bool *are_complete) {
    const struct dalcs_system *s = p->osnsp->system;
    const size_t y_bytes = (size_t)dalcs_system_n_columns(s) * sizeof(double);
    const size_t w_bytes = (size_t)s->n_pairs * sizeof(double);
    const size_t mode_bytes = (size_t)p->osnsp->n_words * sizeof(uint64_t);
    const int last = (1 << of->n) - 1;
    memcpy(p->present, p->osnsp->mode, mode_bytes);
    memcpy(corner_y(p, 0), y, y_bytes);
    memcpy(corner_w(p, 0), p->osnsp->w, w_bytes);
    memcpy(corner_y(p, last), p->other_y, y_bytes);
    memcpy(corner_w(p, last), p->other_w, w_bytes);
    for (int k = 0; k < p->osnsp->n_words; k++) {
        p->sides.conducted[k] = p->present[k] | p->other[k];
        p->mark[k] = p->present[k] & p->other[k];
    }
    enum dalcs_status status = DALCS_OK;
    *are_complete = true;
    for (int corner = 1; corner < last && status == DALCS_OK && *are_complete; corner++) {
        status = find_corner(p, u, corner, are_complete);
    }
    memcpy(p->osnsp->mode, p->present, mode_bytes);
    return status;
}

/* The part of the time in a corner, by all groups but one; -1: by all. */
static double weight_of(const struct several *of, int corner, int but) {
    double weight = 1.0;
    for (int g = 0; g < of->n; g++) {
        weight *= g == but ? 1.0 : (corner >> g & 1) != 0 ? of->part[g] : 1.0 - of->part[g];
    }
    return weight;
}

/* How far the mean has the i-th beyond its threshold, and what the controls are that make it up. */
static double beyond_in_mean(const struct dalcs_positions *p, const struct several *of, int i,
                             double *largest) {
    const double turn_on = i < p->n ? p->osnsp->system->pair[p->pair[i]].turn_on : 0.0;
    double sum = 0.0;
    *largest = 0.0;
    for (int corner = 0; corner < 1 << of->n; corner++) {
        const double at = beyond(p, i, corner);
        sum += weight_of(of, corner, -1) * at;
        *largest += fabs(at + turn_on);
    }
    return sum;
}

/* In rows of a quad: how far each first one is beyond its threshold, behind how that changes with the parts of the time. */
static void fill_rows(const struct dalcs_positions *p, const struct several *of, double *a) {
    const int row = dalcs_dense_row(of->n, 1);
    memset(a, 0, ROWS * sizeof(*a));
    for (int g = 0; g < of->n; g++) {
        double largest;
        for (int corner = 0; corner < 1 << of->n; corner++) {
            const double at = beyond(p, of->first[g], corner);
            for (int by = 0; by < of->n; by++) {
                const double sign = (corner >> by & 1) != 0 ? 1.0 : -1.0;
                a[g * row + by] += sign * weight_of(of, corner, by) * at;
            }
        }
        a[g * row + of->n] = beyond_in_mean(p, of, of->first[g], &largest);
    }
}

/* Does each turn its own control off, more than others turn it on? Where all principal minors are above 0 no other parts of
 * the time do (Cottle, Pang and Stone, The Linear Complementarity Problem, thm 3.3.7). Of switches that hold each other
 * open, as in a flip-flop, two stay, and the mean is where neither does. */
static bool is_only_one(const struct dalcs_positions *p, const struct several *of) {
    const int row = dalcs_dense_row(of->n, 1);
    double a[ROWS];
    double m[MOST_SEVERAL][MOST_SEVERAL] = {{0}};
    fill_rows(p, of, a);
    bool is = true;
    for (int by = 0; by < of->n; by++) {
        const int i = of->first[by];
        const bool closes =
            dalcs_mode_has(i < p->n ? p->other : p->present, dalcs_turning_pair(p, i));
        for (int g = 0; g < of->n; g++) {
            m[g][by] = closes ? -a[g * row + by] : a[g * row + by];
        }
    }
    for (int g = 0; g < of->n; g++) {
        is = is && m[g][g] > 0.0;
        for (int k = 0; k < g; k++) {
            is = is && m[g][g] * m[k][k] > m[g][k] * m[k][g];
        }
    }
    return is &&
           (of->n < MOST_SEVERAL || m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                                            m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                                            m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) >
                                        0.0);
}

/* By Newton's method, from half of the time on. */
static bool find_parts(const struct dalcs_positions *p, struct several *of) {
    const int row = dalcs_dense_row(of->n, 1);
    double moved = INFINITY;
    for (int g = 0; g < of->n; g++) {
        of->part[g] = 0.5;
    }
    for (int k = 0; k < MOST_NEWTON && moved > dalcs_rounded; k++) {
        double a[ROWS];
        fill_rows(p, of, a);
        if (!(dalcs_dense_solve(of->n, 1, a) > 0.0)) {
            return false;
        }
        moved = 0.0;
        for (int g = 0; g < of->n; g++) {
            of->part[g] -= a[g * row + of->n];
            moved = fmax(moved, fabs(a[g * row + of->n]));
        }
    }
    bool are_inside = true;
    for (int g = 0; g < of->n; g++) {
        are_inside = are_inside && of->part[g] > 0.0 && of->part[g] < 1.0;
    }
    return are_inside;
}

static bool all_fit(const struct dalcs_positions *p, const struct several *of) {
    bool fit = true;
    for (int i = 0; i < dalcs_turning_n(p) && fit; i++) {
        if (p->sides.group[i] >= 0) {
            double largest;
            const double off = beyond_in_mean(p, of, i, &largest);
            fit = dalcs_turning_is_at_threshold(p, i, off, largest);
        }
    }
    return fit;
}

static void put_mean(struct dalcs_positions *p, const struct several *of, double *y,
                     struct dalcs_observed_sides *sides) {
    const struct dalcs_system *s = p->osnsp->system;
    *sides = (struct dalcs_observed_sides){.n = 1 << of->n};
    memset(y, 0, (size_t)dalcs_system_n_columns(s) * sizeof(double));
    memset(p->osnsp->w, 0, (size_t)s->n_pairs * sizeof(double));
    for (int corner = 0; corner < sides->n; corner++) {
        const double weight = weight_of(of, corner, -1);
        sides->y[corner] = corner_y(p, corner);
        sides->weight[corner] = weight;
        for (int k = 0; k < dalcs_system_n_columns(s); k++) {
            y[k] += weight * corner_y(p, corner)[k];
        }
        for (int d = 0; d < s->n_pairs; d++) {
            p->osnsp->w[d] += weight * corner_w(p, corner)[d];
        }
    }
}

enum dalcs_status dalcs_sliding_mean_of_several(struct dalcs_positions *p, const double *u,
                                                double *y, struct dalcs_observed_sides *sides,
                                                double *noise) {
    struct several of;
    find_groups(p, y, &of);
    if (of.n < 2) {
        return DALCS_OK;
    }
    bool are_complete;
    DALCS_TRY(find_corners(p, u, y, &of, &are_complete));
    if (!are_complete || !find_parts(p, &of) || !all_fit(p, &of) || !is_only_one(p, &of)) {
        return DALCS_OK;
    }
    *noise = 0.0;
    for (int g = 0; g < of.n; g++) {
        double own;
        (void)dalcs_turning_weight(p, of.first[g], y, &own);
        *noise = fmax(*noise, own);
    }
    put_mean(p, &of, y, sides);
    /* A pair that is off in some corner turns, though it may be on in the two that differ in all (sliding.h). */
    memcpy(p->other, p->mark, (size_t)p->osnsp->n_words * sizeof(*p->other));
    return DALCS_OK;
}
