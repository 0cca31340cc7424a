/* several_parts.c - the parts of the time of switches that slide at once, from the answers on all their sides. */
#include "several_parts.h"

#include "dense_solve.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

/* Newton's method: where what each reads goes on in a straight line with what each does, one of these does. */
enum { MOST_NEWTON = 16, ROWS = 2 * DALCS_QUAD * DALCS_MOST_SEVERAL };

static double beyond(const struct dalcs_positions *p, int i, int corner) {
    return dalcs_turning_beyond(p, i, dalcs_corner_y(p, corner), dalcs_corner_w(p, corner));
}

double dalcs_several_weight(const struct dalcs_several *of, int corner, int but) {
    double weight = 1.0;
    for (int g = 0; g < of->n; g++) {
        weight *= g == but ? 1.0 : (corner >> g & 1) != 0 ? of->part[g] : 1.0 - of->part[g];
    }
    return weight;
}

double dalcs_several_beyond(const struct dalcs_positions *p, const struct dalcs_several *of, int i,
                            double *largest) {
    const double turn_on = i < p->n ? p->osnsp->system->pair[p->pair[i]].turn_on : 0.0;
    double sum = 0.0;
    *largest = 0.0;
    for (int corner = 0; corner < 1 << of->n; corner++) {
        const double at = beyond(p, i, corner);
        sum += dalcs_several_weight(of, corner, -1) * at;
        *largest += fabs(at + turn_on);
    }
    return sum;
}

/* In rows of a quad: how far each first one is beyond its threshold, behind how that changes with the parts of the time. */
static void fill_rows(const struct dalcs_positions *p, const struct dalcs_several *of, double *a) {
    const int row = dalcs_dense_row(of->n, 1);
    memset(a, 0, ROWS * sizeof(*a));
    for (int g = 0; g < of->n; g++) {
        double largest;
        for (int corner = 0; corner < 1 << of->n; corner++) {
            const double at = beyond(p, of->first[g], corner);
            for (int by = 0; by < of->n; by++) {
                const double sign = (corner >> by & 1) != 0 ? 1.0 : -1.0;
                a[g * row + by] += sign * dalcs_several_weight(of, corner, by) * at;
            }
        }
        a[g * row + of->n] = dalcs_several_beyond(p, of, of->first[g], &largest);
    }
}

typedef double turning_off[DALCS_MOST_SEVERAL][DALCS_MOST_SEVERAL];

/* How much each part of the time turns the first ones off. */
static void find_turning_off(const struct dalcs_positions *p, const struct dalcs_several *of,
                             turning_off m) {
    const int row = dalcs_dense_row(of->n, 1);
    double a[ROWS];
    fill_rows(p, of, a);
    for (int by = 0; by < of->n; by++) {
        const bool closes = dalcs_turning_is_on_at(p, of->first[by], true);
        for (int g = 0; g < of->n; g++) {
            m[g][by] = closes ? -a[g * row + by] : a[g * row + by];
        }
    }
}

/* Of two products, but for what rounding of answers leaves of them. */
static double difference(double one, double other) {
    const double rounding = dalcs_answer_rounded * (fabs(one) + fabs(other));
    const double of = one - other;
    return fabs(of) > rounding ? of : 0.0;
}

/* Where all principal minors are above 0 no other parts of the time do (Cottle, Pang and Stone, The Linear Complementarity
 * Problem, thm 3.3.7). Of switches that hold each other open, as in a flip-flop, two stay, and the mean is where neither
 * does. All are, where they are without the first row and column, and in the Schur complement of the first pivot (Tsatsomeros
 * and Li, Linear Multilinear Algebra 47, 2000). m[n][n] is from `first` on. */
static bool has_minors(const turning_off *m, int first, int n) {
    turning_off rest;
    bool is = first == n || (*m)[first][first] > 0.0;
    for (int i = first + 1; i < n && is; i++) {
        for (int k = first + 1; k < n; k++) {
            rest[i][k] =
                difference((*m)[i][k], (*m)[i][first] / (*m)[first][first] * (*m)[first][k]);
        }
    }
    return is && (first + 1 >= n || (has_minors(m, first + 1, n) &&
                                     has_minors((const turning_off *)&rest, first + 1, n)));
}

bool dalcs_several_is_only_one(const struct dalcs_positions *p, const struct dalcs_several *of) {
    turning_off m;
    find_turning_off(p, of, m);
    return has_minors((const turning_off *)&m, 0, of->n);
}

int dalcs_several_find_tied(const struct dalcs_positions *p, const struct dalcs_several *of,
                            bool *is_on) {
    const int last = of->n - 1;
    turning_off m;
    double largest;
    int tied = -1;
    find_turning_off(p, of, m);
    for (int k = 0; k < last && tied < 0 && m[last][last] > 0.0; k++) {
        const double minor = difference(m[k][k] * m[last][last], m[k][last] * m[last][k]);
        tied = m[k][k] > 0.0 && minor == 0.0 ? k : -1;
    }
    if (tied >= 0) {
        const double by_last = dalcs_several_beyond(p, of, of->first[last], &largest);
        const double along = m[tied][last] / m[last][last];
        *is_on = dalcs_several_beyond(p, of, of->first[tied], &largest) > along * by_last;
    }
    return tied;
}

void dalcs_several_halve(struct dalcs_several *of) {
    for (int g = 0; g < of->n; g++) {
        of->part[g] = 0.5;
    }
}

bool dalcs_several_find_parts(const struct dalcs_positions *p, struct dalcs_several *of) {
    const int row = dalcs_dense_row(of->n, 1);
    double moved = INFINITY;
    dalcs_several_halve(of);
    for (int k = 0; k < MOST_NEWTON && of->n > 0 && moved > dalcs_rounded; k++) {
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
