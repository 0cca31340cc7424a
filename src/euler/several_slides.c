/* several_slides.c - switches that slide at once, each for itself.
 *
 * Each is on its other side for a part of the time of its own. Where no clock ties them to each other, each side of one
 * goes with each of the others, for the product of their parts of the time, and these are such that the mean has each at its
 * threshold (Alexander and Seidman, Sliding modes in intersecting switching surfaces, 1998: blending).
 *
 * Not all that alternate in a step slide. The rest stay, on the side that their controls ask for in the mean: part_g is
 * within 0 and 1 and its control on the threshold, or part_g is 0 or 1 and its control beyond, to that side. It is a
 * complementarity problem of the parts within bounds. */
#include "several_parts.h"

#include <math.h>
#include <string.h>

/* Rounds of one search, of each group. Where all principal minors are above 0 a search ends (Murty 1974): mostly each group
 * changes once or twice. */
enum { ROUNDS_OF_EACH = 8 };

/* Those that one weight puts on their thresholds, as complementary switches, are one: they are kin of the first. Returns
 * the number of groups. */
static int find_groups(struct dalcs_positions *p, const double *y) {
    int n = 0;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        p->sides.kin[i] = -1;
        if (!dalcs_turning_leads(p, i)) {
            continue;
        }
        double noise;
        int g = 0;
        while (g < i && !(p->sides.kin[g] == g &&
                          dalcs_turning_fits(p, i, dalcs_turning_weight(p, g, y, &noise), y))) {
            g++;
        }
        p->sides.kin[i] = g;
        n += g == i ? 1 : 0;
    }
    return n;
}

static void add(struct dalcs_positions *p, struct dalcs_several *of, int first) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        p->sides.group[i] = p->sides.kin[i] == first ? of->n : p->sides.group[i];
    }
    of->part[of->n] = 0.5;
    of->first[of->n++] = first;
}

/* The answers of corners in which a group is on one side are those without it. */
static void leave_out_corners(struct dalcs_positions *p, int n, int group, bool on_other) {
    const struct dalcs_system *s = p->osnsp->system;
    for (int corner = 0; corner < 1 << (n - 1); corner++) {
        const int low = corner & ((1 << group) - 1);
        const int from = (corner - low) << 1 | (on_other ? 1 << group : 0) | low;
        memmove(dalcs_corner_y(p, corner), dalcs_corner_y(p, from),
                (size_t)dalcs_system_n_columns(s) * sizeof(double));
        memmove(dalcs_corner_w(p, corner), dalcs_corner_w(p, from),
                (size_t)s->n_pairs * sizeof(double));
        memmove(dalcs_corner_mode(p, corner), dalcs_corner_mode(p, from),
                (size_t)p->osnsp->n_words * sizeof(uint64_t));
    }
}

/* The group of those that slide stays on one side. */
static void stay(struct dalcs_positions *p, struct dalcs_several *of, int group, bool on_other) {
    leave_out_corners(p, of->n, group, on_other);
    p->sides.is_other[of->first[group]] = on_other;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        const int g = p->sides.group[i];
        p->sides.group[i] = g == group ? -1 : g - (g > group ? 1 : 0);
    }
    of->n--;
    for (int g = group; g < of->n; g++) {
        of->first[g] = of->first[g + 1];
        of->part[g] = of->part[g + 1];
    }
}

/* Of those that slide, the one whose part is farthest from any; -1: all are parts. */
static int farthest_outside(const struct dalcs_several *of) {
    int farthest = -1;
    double most = 0.0;
    for (int g = 0; g < of->n; g++) {
        const double outside = fabs(of->part[g] - 0.5) - 0.5;
        if (outside >= most) {
            most = outside;
            farthest = g;
        }
    }
    return farthest;
}

/* How far the mean has the i-th off its threshold, to the side that it does not stay on; 0: it fits. */
static double find_off(const struct dalcs_positions *p, const struct dalcs_several *of, int i) {
    double largest;
    const double off = dalcs_several_beyond(p, of, i, &largest);
    const bool fits =
        dalcs_turning_is_at_threshold(p, i, off, largest) ||
        (p->sides.group[i] < 0 &&
         (off > 0.0) == dalcs_turning_is_on_at(p, i, p->sides.is_other[p->sides.kin[i]]));
    return fits ? 0.0 : fabs(off);
}

/* The one that the mean contradicts most: of several with thresholds of one voltage, the first that it comes to. -1: none. */
static int find_against(const struct dalcs_positions *p, const struct dalcs_several *of) {
    int against = -1;
    double most = 0.0;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        const double off = p->sides.kin[i] >= 0 ? find_off(p, of, i) : 0.0;
        if (off > most) {
            most = off;
            against = i;
        }
    }
    return against;
}

/* The last one of those that slide has begun to, and no only mean has it do so with the rest. If it reads what another one
 * reads, that one stays where the last one on its threshold has it. Else it goes to its other side: it holds itself there. */
static void make_place(struct dalcs_positions *p, struct dalcs_several *of, bool *has_corners) {
    const int last = of->n - 1;
    bool is_on = false;
    dalcs_several_halve(of);
    const int tied = dalcs_several_find_tied(p, of, &is_on);
    *has_corners = tied >= 0;
    if (tied >= 0) {
        stay(p, of, tied, dalcs_turning_is_on_at(p, of->first[tied], true) == is_on);
    } else {
        stay(p, of, last, !p->sides.is_other[of->first[last]]);
    }
}

/* From those that slide in `of` and the sides of the rest: one that would be on a side for more than all of the time stays
 * there. One that stays, and that the mean contradicts, slides. *found: some slide, and the mean contradicts none. */
static enum dalcs_status search(struct dalcs_positions *p, const double *u, const double *y,
                                int n_groups, struct dalcs_several *of, bool *found) {
    bool has_corners = false;
    bool has_new = false; /* the last one of those that slide stood before */
    *found = false;
    for (int round = 0; round < ROUNDS_OF_EACH * n_groups; round++) {
        if (!has_corners) {
            DALCS_TRY(dalcs_corners_find(p, u, y, of->n, &has_corners));
        }
        if (has_new && has_corners && !dalcs_several_is_only_one(p, of)) {
            make_place(p, of, &has_corners);
            has_new = false;
            continue;
        }
        if (!has_corners || !dalcs_several_find_parts(p, of)) {
            return DALCS_OK;
        }
        const int outside = farthest_outside(of);
        if (outside >= 0) {
            stay(p, of, outside, of->part[outside] > 0.5);
            has_new = false;
            continue;
        }
        const int against = find_against(p, of);
        *found = against < 0 && of->n > 0 && dalcs_several_is_only_one(p, of);
        if (against < 0 || p->sides.group[against] >= 0 || of->n == DALCS_MOST_SEVERAL) {
            return DALCS_OK;
        }
        add(p, of, p->sides.kin[against]);
        has_new = true;
        has_corners = false;
    }
    return DALCS_OK;
}

/* Where few alternate all of them slide; else, and where that has no mean, all stay where they stood. */
static enum dalcs_status find_sliding(struct dalcs_positions *p, const double *u, const double *y,
                                      struct dalcs_several *of, bool *found) {
    const int n_groups = find_groups(p, y);
    *found = false;
    for (int all = n_groups <= DALCS_MOST_SEVERAL ? 1 : 0; all >= 0 && n_groups > 1 && !*found;
         all--) {
        *of = (struct dalcs_several){0};
        for (int i = 0; i < dalcs_turning_n(p); i++) {
            const int pair = dalcs_turning_pair(p, i);
            p->sides.group[i] = -1;
            p->sides.is_other[i] =
                i < p->n && dalcs_mode_has(p->first, pair) != dalcs_osnsp_is_on(p->osnsp, pair);
        }
        for (int i = 0; i < dalcs_turning_n(p) && all == 1; i++) {
            if (p->sides.kin[i] == i) {
                add(p, of, i);
            }
        }
        DALCS_TRY(search(p, u, y, n_groups, of, found));
    }
    return DALCS_OK;
}

/* Of the corners that the mean is of. A pair that is off in one of them turns, though it may be on in the two that differ in
 * all (sliding.h). */
static void put_mean(struct dalcs_positions *p, const struct dalcs_several *of, double *y,
                     struct dalcs_observed_sides *sides) {
    const struct dalcs_system *s = p->osnsp->system;
    *sides = (struct dalcs_observed_sides){0};
    memset(y, 0, (size_t)dalcs_system_n_columns(s) * sizeof(double));
    memset(p->osnsp->w, 0, (size_t)s->n_pairs * sizeof(double));
    memset(p->sides.conducted, 0, (size_t)p->osnsp->n_words * sizeof(uint64_t));
    memset(p->other, 0xff, (size_t)p->osnsp->n_words * sizeof(uint64_t));
    memcpy(p->osnsp->mode, dalcs_corner_mode(p, 0), (size_t)p->osnsp->n_words * sizeof(uint64_t));
    for (int corner = 0; corner < 1 << of->n; corner++) {
        const double weight = dalcs_several_weight(of, corner, -1);
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
    struct dalcs_several of;
    bool found;
    memcpy(p->sides.w_of_y, p->osnsp->w, (size_t)p->osnsp->system->n_pairs * sizeof(double));
    DALCS_TRY(find_sliding(p, u, y, &of, &found));
    *noise = 0.0;
    for (int g = 0; g < of.n && found; g++) {
        double own;
        (void)dalcs_turning_weight(p, of.first[g], y, &own);
        *noise = fmax(*noise, own);
    }
    if (found) {
        put_mean(p, &of, y, sides);
    }
    return DALCS_OK;
}
