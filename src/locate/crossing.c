/* crossing.c - subdivision in Bernstein's basis, then Newton's method in a bracket. */
#include "crossing.h"

#include "extremes.h"
#include "magnitudes.h"
#include "quads.h"
#include "rounding.h"
#include "wide_vectors.h"

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

/* A polynomial and its derivative in Bernstein's basis, coefficients times their binomials. */
struct weighted {
    int n;
    double value[DALCS_MAX_NODES], slope[DALCS_MAX_NODES];
};

static void weigh(const struct dalcs_collocation *c, const double *coefficient,
                  struct weighted *p) {
    p->n = c->s + 1;
    p->value[0] = coefficient[0];
    for (int i = 0; i < c->s; i++) {
        p->value[i + 1] = c->bernstein.binomial[i + 1] * coefficient[i + 1];
        p->slope[i] = c->bernstein.binomial[i] * (c->s - i) * (coefficient[i + 1] - coefficient[i]);
    }
}

/* Horner's scheme: all weights are positive, nothing cancels that did not before. */
static double evaluate(const struct weighted *p, double theta, double *slope) {
    double other = 1.0 - theta;
    double power = theta;
    double value = p->value[0];
    double rate = 0.0;
    double before = 1.0;
    for (int i = 1; i < p->n; i++) {
        value = value * other + power * p->value[i];
        rate = rate * other + before * p->slope[i - 1];
        before = power;
        power *= theta;
    }
    *slope = rate;
    return value;
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

/* Where the polygon of the coefficients, which change sign once, is 0: near the root. */
static double polygon_root(int n, const double *coefficient) {
    bool negative = coefficient[0] < 0.0;
    int i = 1;
    while (i < n - 1 && (coefficient[i] < 0.0) == negative) {
        i++;
    }
    double before = coefficient[i - 1];
    return (i - 1 + before / (before - coefficient[i])) / (n - 1);
}

/* The one root on [0, 1], where the ends have different signs: Newton's method from `guess`, if that lies
 * between them, and by halves where a step leaves the bracket or gains nothing. */
static double only_root(const struct dalcs_collocation *c, const double *coefficient,
                        double guess) {
    int n = c->s + 1;
    if (coefficient[0] == 0.0) {
        int next = 1; /* which way does it leave? */
        while (next < n - 1 && coefficient[next] == 0.0) {
            next++;
        }
        if (coefficient[next] <= 0.0) {
            return 0.0;
        }
    }
    struct weighted p;
    weigh(c, coefficient, &p);
    bool begins_negative = coefficient[0] < 0.0;
    double low = 0.0;
    double high = 1.0;
    double theta = guess > low && guess < high ? guess : polygon_root(n, coefficient);
    double least = INFINITY;
    for (int round = 0; round < ROOT_ROUNDS; round++) {
        double slope;
        double value = evaluate(&p, theta, &slope);
        double size = fabs(value);
        double move = value / slope;
        bool gains = 2.0 * size < least;
        if (size == 0.0 || fabs(move) <= DBL_EPSILON || (!gains && fabs(move) < dalcs_alike)) {
            break;
        }
        least = size < least ? size : least;
        if ((value < 0.0) == begins_negative) {
            low = theta;
        } else {
            high = theta;
        }
        double next = theta - move;
        theta = gains && next > low && next < high ? next : 0.5 * (low + high);
    }
    return theta;
}

/* The first (or last) root on [from, from + length], or -1. */
static double find_root(const struct dalcs_collocation *c, const double *coefficient, double from,
                        double length, bool first, int depth) {
    int n = c->s + 1;
    int changes = sign_changes(n, coefficient);
    if (changes == 0) {
        return -1.0;
    }
    if (changes == 1 || depth == 0) {
        bool differ = (coefficient[0] < 0.0) != (coefficient[n - 1] < 0.0);
        return differ ? from + length * only_root(c, coefficient, 0.0) : changes == 1 ? from : -1.0;
    }
    double half[2][DALCS_MAX_NODES];
    subdivide(n, coefficient, 0.5, half[0], half[1]);
    for (int k = 0; k < 2; k++) {
        int side = first ? k : 1 - k;
        double root = find_root(c, half[side], from + 0.5 * (double)side * length, 0.5 * length,
                                first, depth - 1);
        if (root >= 0.0) {
            return root;
        }
    }
    return -1.0;
}

/* By the straight line between the ends and how far the values are from it: what remains is 0 at the
 * ends, and leaves the range of its values by little. */
DALCS_TWICE(void, bound_below,
            (const struct dalcs_collocation *c, int n, const double *value, int stride,
             double *bound),
            (c, n, value, stride, bound)) {
    for (int i = 0; i < n; i += DALCS_QUAD) {
        dalcs_quad first;
        dalcs_quad rise;
        dalcs_quad_load(&first, value + i);
        dalcs_quad_load(&rise, value + c->s * stride + i);
        rise -= first;
        dalcs_quad lowest = {0.0};
        dalcs_quad highest = {0.0};
        for (int k = 1; k < c->s; k++) {
            dalcs_quad off;
            dalcs_quad_load(&off, value + k * stride + i);
            off = off - first - c->node[k] * rise;
            dalcs_quad_lower(&lowest, &off);
            dalcs_quad_raise(&highest, &off);
        }
        dalcs_quad least = first + rise;
        dalcs_quad_lower(&least, &first);
        dalcs_quad_unsign(&first);
        dalcs_quad_unsign(&rise);
        double rounding = dalcs_rounded * (1.0 + 2.0 * c->spread);
        least += lowest - c->spread * (highest - lowest) - rounding * (first + rise);
        dalcs_quad_store(bound + i, &least);
    }
}

void dalcs_crossing_bounds(const struct dalcs_collocation *c, int n, const double *value,
                           int stride, double *bound) {
    bound_below(c, n, value, stride, bound);
}

/* In Bernstein's basis. All of them, for the sake of vectors. */
DALCS_TWICE(void, find_coefficients,
            (const struct dalcs_collocation *c, const double *value, int stride,
             double *coefficient),
            (c, value, stride, coefficient)) {
    dalcs_quad sum[DALCS_MAX_NODES / DALCS_QUAD] = {{0.0}};
    for (int k = 0; k <= c->s; k++) {
        for (int i = 0; i < DALCS_MAX_NODES / DALCS_QUAD; i++) {
            dalcs_quad of_node;
            dalcs_quad_load(&of_node, c->bernstein.from_nodes[k] + i * DALCS_QUAD);
            sum[i] += value[k * stride] * of_node;
        }
    }
    memcpy(coefficient, sum, sizeof(sum));
}

/* Of the coefficients that values at the nodes have. */
static double rounding_of(const struct dalcs_collocation *c, const double *value, int stride) {
    double largest = 0.0;
    for (int k = 0; k <= c->s; k++) {
        largest = dalcs_larger(largest, fabs(value[k * stride]));
    }
    return dalcs_rounded * (1.0 + c->bernstein.spread) * largest;
}

/* The largest coefficient above 0, which the polynomial does not exceed. */
static double peak_of(int n, const double *b) {
    double peak = 0.0;
    for (int i = 0; i < n; i++) {
        peak = b[i] > peak ? b[i] : peak;
    }
    return peak;
}

struct dalcs_crossing dalcs_crossing_find(const struct dalcs_collocation *c, const double *value,
                                          int stride, double end, double depth, double guess) {
    int n = c->s + 1;
    struct dalcs_crossing found = {.falls = false};
    double b[DALCS_MAX_NODES];
    find_coefficients(c, value, stride, b);
    depth = dalcs_larger(depth, rounding_of(c, value, stride));
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
    if (b[n - 1] < -depth && b[0] > 0.0 && sign_changes(n, b) == 1) {
        double theta = only_root(c, b, guess / end) * end;
        if (theta > dalcs_small) { /* else it matters how far it was above 0 before */
            return (struct dalcs_crossing){.falls = true, .theta = theta, .peak = peak_of(n, b)};
        }
    }
    double shifted[DALCS_MAX_NODES] = {0.0};
    for (int i = 0; i < n; i++) {
        shifted[i] = b[i] + depth;
    }
    double below = shifted[0] < 0.0 ? 0.0 : find_root(c, shifted, 0.0, 1.0, true, MAX_DEPTH);
    if (below < 0.0) {
        return found;
    }
    found.falls = true;
    double root = -1.0;
    if (below > 0.0) {
        double before[DALCS_MAX_NODES];
        subdivide(n, b, below, before, rest);
        root = find_root(c, before, 0.0, below, false, MAX_DEPTH);
        found.peak = peak_of(n, before);
    }
    found.at_once = root < 0.0;
    found.theta = found.at_once ? 0.0 : root * end;
    return found;
}

double dalcs_crossing_only(const struct dalcs_collocation *c, const double *coefficient, double end,
                           double depth) {
    int n = c->s + 1;
    if (!(coefficient[n - 1] < -depth) || sign_changes(n, coefficient) != 1) {
        return INFINITY;
    }
    double theta = only_root(c, coefficient, 0.0);
    if (!(theta > dalcs_small && theta < end)) {
        return INFINITY;
    }
    if (end < 1.0) {
        struct weighted p;
        double slope;
        weigh(c, coefficient, &p);
        return evaluate(&p, end, &slope) < -depth ? theta : INFINITY;
    }
    return theta;
}
