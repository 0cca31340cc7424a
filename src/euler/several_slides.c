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
    bool stays[MOST_SEVERAL]; /* on one side: part is 0 or 1 */
};

static double beyond(const struct dalcs_positions *p, int i, int corner) {
    return dalcs_turning_beyond(p, i, dalcs_corner_y(p, corner), dalcs_corner_w(p, corner));
}

/* Those that one weight puts on their thresholds, as complementary switches, are one. of->n is 0 where they are too many. */
static void find_groups(struct dalcs_positions *p, const double *y, struct several *of) {
    *of = (struct several){0};
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
    for (int g = 0; g < of->n; g++) {
        for (int k = 0; k < of->n && of->stays[g]; k++) {
            a[g * row + k] = a[k * row + g] = k == g ? -1.0 : 0.0;
        }
        a[g * row + of->n] *= of->stays[g] ? 0.0 : 1.0;
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
        const bool closes = of->stays[by] || dalcs_turning_is_on_at(p, i, true);
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
        of->part[g] = of->stays[g] ? of->part[g] : 0.5;
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
    return true;
}

/* The one whose part is farthest from any; -1: all are parts. */
static int farthest_outside(const struct several *of) {
    int farthest = -1;
    double most = 0.0;
    for (int g = 0; g < of->n; g++) {
        const double outside = of->stays[g] ? -1.0 : fabs(of->part[g] - 0.5) - 0.5;
        if (outside >= most) {
            most = outside;
            farthest = g;
        }
    }
    return farthest;
}

/* One that would be on a side for more than all of the time stays there: it is about to leave its threshold, and in a step
 * of implicit Euler goes to and fro with the others. Is there a part of the time for any of the rest? */
static bool find_inside(const struct dalcs_positions *p, struct several *of) {
    int n_stay = 0;
    int outside = -1;
    do {
        if (!find_parts(p, of)) {
            return false;
        }
        outside = farthest_outside(of);
        if (outside >= 0) {
            of->stays[outside] = true;
            of->part[outside] = of->part[outside] < 0.5 ? 0.0 : 1.0;
            n_stay++;
        }
    } while (outside >= 0 && n_stay < of->n);
    return n_stay < of->n;
}

/* Is each at its threshold, or on the side of it that it stays on? */
static bool all_fit(const struct dalcs_positions *p, const struct several *of) {
    bool fit = true;
    for (int i = 0; i < dalcs_turning_n(p) && fit; i++) {
        const int g = p->sides.group[i];
        if (g >= 0) {
            double largest;
            const double off = beyond_in_mean(p, of, i, &largest);
            fit = dalcs_turning_is_at_threshold(p, i, off, largest) ||
                  (of->stays[g] && (off > 0.0) == dalcs_turning_is_on_at(p, i, of->part[g] > 0.5));
        }
    }
    return fit;
}

/* Of the corners that the mean is of. A pair that is off in one of them turns, though it may be on in the two that differ in
 * all (sliding.h). */
static void put_mean(struct dalcs_positions *p, const struct several *of, double *y,
                     struct dalcs_observed_sides *sides) {
    const struct dalcs_system *s = p->osnsp->system;
    *sides = (struct dalcs_observed_sides){0};
    memset(y, 0, (size_t)dalcs_system_n_columns(s) * sizeof(double));
    memset(p->osnsp->w, 0, (size_t)s->n_pairs * sizeof(double));
    memset(p->sides.conducted, 0, (size_t)p->osnsp->n_words * sizeof(uint64_t));
    memset(p->other, 0xff, (size_t)p->osnsp->n_words * sizeof(uint64_t));
    for (int corner = 0; corner < 1 << of->n; corner++) {
        const double weight = weight_of(of, corner, -1);
        if (weight == 0.0) {
            continue;
        }
        if (sides->n == 0) {
            memcpy(p->osnsp->mode, dalcs_corner_mode(p, corner),
                   (size_t)p->osnsp->n_words * sizeof(uint64_t));
        }
        sides->y[sides->n] = dalcs_corner_y(p, corner);
        sides->weight[sides->n++] = weight;
        for (int k = 0; k < dalcs_system_n_columns(s); k++) {
            y[k] += weight * dalcs_corner_y(p, corner)[k];
        }
        for (int d = 0; d < s->n_pairs; d++) {
            p->osnsp->w[d] += weight * dalcs_corner_w(p, corner)[d];
        }
        for (int k = 0; k < p->osnsp->n_words; k++) {
            p->sides.conducted[k] |= dalcs_corner_mode(p, corner)[k];
            p->other[k] &= dalcs_corner_mode(p, corner)[k];
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
    DALCS_TRY(dalcs_corners_find(p, u, y, of.n, &are_complete));
    if (!are_complete || !find_inside(p, &of) || !all_fit(p, &of) || !is_only_one(p, &of)) {
        return DALCS_OK;
    }
    *noise = 0.0;
    for (int g = 0; g < of.n; g++) {
        double own;
        (void)dalcs_turning_weight(p, of.first[g], y, &own);
        *noise = of.stays[g] ? *noise : fmax(*noise, own);
    }
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        const int g = p->sides.group[i];
        p->sides.group[i] = g >= 0 && of.stays[g] ? -1 : g;
    }
    put_mean(p, &of, y, sides);
    return DALCS_OK;
}
