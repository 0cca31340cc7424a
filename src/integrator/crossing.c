/* crossing.c - subdivision in Bernstein's basis, then a bracketed secant. */
#include "crossing.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Halvings of the step before a cluster of roots counts as one. */
enum { MAX_DEPTH = 48, ROOT_ROUNDS = 60 };

/* The polynomial on [0, split] and on [split, 1] (de Casteljau). left may be coefficient itself. */
static void subdivide(int n, const double *coefficient, double split, double *left, double *right) {
    double work[DALCS_MAX_NODES];
    memcpy(work, coefficient, (size_t)n * sizeof(*work));
    for (int level = 0; level < n; level++) {
        left[level] = work[0];
        right[n - 1 - level] = work[n - 1 - level];
        for (int i = 0; i < n - 1 - level; i++) {
            work[i] += split * (work[i + 1] - work[i]);
        }
    }
}

/* Horner's scheme in Bernstein's basis: all weights are positive, nothing cancels that did not before. */
static double evaluate(int n, const double *coefficient, double theta) {
    double other = 1.0 - theta;
    double weight = 1.0; /* of coefficient i, but for a power of `other` */
    double sum = coefficient[0];
    for (int i = 1; i < n; i++) {
        weight *= theta * (n - i) / i;
        sum = sum * other + weight * coefficient[i];
    }
    return sum;
}

static int sign_changes(int n, const double *coefficient) {
    int changes = 0;
    bool negative = coefficient[0] < 0.0;
    for (int i = 1; i < n; i++) {
        changes += (coefficient[i] < 0.0) != negative ? 1 : 0;
        negative = coefficient[i] < 0.0;
    }
    return changes;
}

/* The one root on [0, 1], where the ends have different signs: secants that keep the bracket
 * (Illinois). */
static double only_root(int n, const double *coefficient) {
    double a = 0.0;
    double b = 1.0;
    double at_a = coefficient[0];
    double at_b = coefficient[n - 1];
    if (at_a == 0.0) {
        int next = 1; /* which way does it leave? */
        while (next < n - 1 && coefficient[next] == 0.0) {
            next++;
        }
        if (coefficient[next] <= 0.0) {
            return 0.0;
        }
    }
    int side = 0;
    for (int round = 0; round < ROOT_ROUNDS && at_b != 0.0 && b - a > DBL_EPSILON * b; round++) {
        double x = a + (b - a) * (at_a / (at_a - at_b));
        if (!(x > a && x < b)) {
            x = 0.5 * (a + b);
        }
        if (x == a || x == b) {
            break;
        }
        double at_x = evaluate(n, coefficient, x);
        if ((at_x < 0.0) == (at_b < 0.0)) {
            double moved = b - x;
            b = x;
            at_b = at_x;
            at_a *= side < 0 ? 0.5 : 1.0;
            side = -1;
            if (moved <= DBL_EPSILON * b) {
                break;
            }
        } else {
            double moved = x - a;
            a = x;
            at_a = at_x;
            at_b *= side > 0 ? 0.5 : 1.0;
            side = 1;
            if (moved <= DBL_EPSILON * b) {
                break;
            }
        }
    }
    return fabs(at_a) < fabs(at_b) ? a : b;
}

/* The first (or last) root on [from, from + length], or -1. */
static double find_root(int n, const double *coefficient, double from, double length, bool first,
                        int depth) {
    int changes = sign_changes(n, coefficient);
    if (changes == 0) {
        return -1.0;
    }
    if (changes == 1 || depth == 0) {
        bool differ = (coefficient[0] < 0.0) != (coefficient[n - 1] < 0.0);
        return differ ? from + length * only_root(n, coefficient) : changes == 1 ? from : -1.0;
    }
    double half[2][DALCS_MAX_NODES];
    subdivide(n, coefficient, 0.5, half[0], half[1]);
    for (int k = 0; k < 2; k++) {
        int side = first ? k : 1 - k;
        double root = find_root(n, half[side], from + 0.5 * (double)side * length, 0.5 * length,
                                first, depth - 1);
        if (root >= 0.0) {
            return root;
        }
    }
    return -1.0;
}

/* Is that clear from the straight line between the ends and how far the values are from it? What
 * remains is 0 at the ends, and a polynomial's coefficients leave the range of its values by little. */
static bool stays_above(const struct dalcs_collocation *c, const double *value, int stride,
                        double depth) {
    double first = value[0];
    double rise = value[c->s * stride] - first;
    double farthest = 0.0;
    for (int k = 1; k < c->s; k++) {
        double off = fabs(value[k * stride] - first - c->node[k] * rise);
        farthest = off > farthest ? off : farthest;
    }
    double rounding = 4.0 * DBL_EPSILON * (fabs(first) + fabs(rise));
    double least = rise < 0.0 ? first + rise : first;
    return least - (1.0 + 2.0 * c->bernstein_spread) * (farthest + rounding) >= -depth;
}

struct dalcs_crossing dalcs_crossing_find(const struct dalcs_collocation *c, const double *value,
                                          int stride, double end, double depth) {
    int n = c->s + 1;
    struct dalcs_crossing found = {.falls = false};
    if (stays_above(c, value, stride, depth)) {
        return found;
    }
    double b[DALCS_MAX_NODES] = {0.0};
    double largest = 0.0;
    for (int k = 0; k < n; k++) {
        double v = value[k * stride];
        largest = fabs(v) > largest ? fabs(v) : largest;
        for (int i = 0; i < DALCS_MAX_NODES; i++) { /* all, for the sake of vectors */
            b[i] += c->to_bernstein[k][i] * v;
        }
    }
    double rounding = 4.0 * DBL_EPSILON * (1.0 + c->bernstein_spread) * largest;
    depth = depth > rounding ? depth : rounding;
    double least = b[0];
    for (int i = 1; i < n; i++) {
        least = b[i] < least ? b[i] : least;
    }
    if (least >= -depth) {
        return found;
    }
    double rest[DALCS_MAX_NODES];
    if (end < 1.0) {
        subdivide(n, b, end, b, rest);
    }
    double shifted[DALCS_MAX_NODES] = {0.0};
    for (int i = 0; i < n; i++) {
        shifted[i] = b[i] + depth;
    }
    double below = shifted[0] < 0.0 ? 0.0 : find_root(n, shifted, 0.0, 1.0, true, MAX_DEPTH);
    if (below < 0.0) {
        return found;
    }
    found.falls = true;
    double root = -1.0;
    if (below > 0.0) {
        double before[DALCS_MAX_NODES];
        subdivide(n, b, below, before, rest);
        root = find_root(n, before, 0.0, below, false, MAX_DEPTH);
        for (int i = 0; i < n; i++) {
            found.peak = fmax(found.peak, before[i]);
        }
    }
    found.at_once = root < 0.0;
    found.theta = found.at_once ? 0.0 : root * end;
    return found;
}
