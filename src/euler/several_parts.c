/* several_parts.c - the parts of the time of switches that slide at once, from the answers on all their sides. */
#include "several_parts.h"

#include "dense_solve.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

/* Newton's method: where what each reads goes on in a straight line with what each does, one of these does. */
enum { MOST_NEWTON = 16, ROWS = 4 * DALCS_MOST_SEVERAL };

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

/* How much each part of the time turns the first ones off. */
static void find_turning_off(const struct dalcs_positions *p, const struct dalcs_several *of,
                             double m[DALCS_MOST_SEVERAL][DALCS_MOST_SEVERAL]) {
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
 * does. */
bool dalcs_several_is_only_one(const struct dalcs_positions *p, const struct dalcs_several *of) {
    double m[DALCS_MOST_SEVERAL][DALCS_MOST_SEVERAL] = {{0}};
    find_turning_off(p, of, m);
    bool is = true;
    for (int g = 0; g < of->n; g++) {
        is = is && m[g][g] > 0.0;
        for (int k = 0; k < g; k++) {
            is = is && difference(m[g][g] * m[k][k], m[g][k] * m[k][g]) > 0.0;
        }
    }
    return is && (of->n < DALCS_MOST_SEVERAL ||
                  m[0][0] * difference(m[1][1] * m[2][2], m[1][2] * m[2][1]) -
                          m[0][1] * difference(m[1][0] * m[2][2], m[1][2] * m[2][0]) +
                          m[0][2] * difference(m[1][0] * m[2][1], m[1][1] * m[2][0]) >
                      0.0);
}

int dalcs_several_find_tied(const struct dalcs_positions *p, const struct dalcs_several *of,
                            bool *is_on) {
    const int last = of->n - 1;
    double m[DALCS_MOST_SEVERAL][DALCS_MOST_SEVERAL] = {{0}};
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
