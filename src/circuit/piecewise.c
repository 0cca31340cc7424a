/* piecewise.c - sums, products and compositions of piecewise-linear functions, knot by knot. */
#include "piecewise.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Closer than this, two numbers differ by the rounding of how they were computed. */
static bool is_near(double a, double b) {
    return fabs(a - b) <= 8 * DBL_EPSILON * fmax(fabs(a), fabs(b));
}

static bool allocate(struct dalcs_arena *arena, size_t n, struct dalcs_piecewise *f) {
    *f = (struct dalcs_piecewise){.knot = dalcs_arena_alloc(arena, n, sizeof *f->knot)};
    return f->knot != NULL;
}

double dalcs_piecewise_slope(const struct dalcs_piecewise *f, int k) {
    if (k == 0 || k == f->n) {
        return k == 0 ? f->before : f->after;
    }
    const struct dalcs_knot *a = &f->knot[k - 1];
    const struct dalcs_knot *b = &f->knot[k];
    return b->left == a->right ? 0 : (b->left - a->right) / (b->at - a->at);
}

/* The knot at s, or else the first beyond it. */
static int find(const struct dalcs_piecewise *f, double s, bool *is_there) {
    int k = 0;
    for (int end = f->n; k < end;) {
        const int middle = k + (end - k) / 2;
        if (f->knot[middle].at < s) {
            k = middle + 1;
        } else {
            end = middle;
        }
    }
    while (k > 0 && is_near(f->knot[k - 1].at, s)) {
        k--;
    }
    *is_there = k < f->n && is_near(f->knot[k].at, s);
    return k;
}

double dalcs_piecewise_at(const struct dalcs_piecewise *f, double s, int side) {
    bool is_there;
    const int k = find(f, s, &is_there);
    if (is_there) {
        const struct dalcs_knot *knot = &f->knot[k];
        return side < 0 ? knot->left : side > 0 ? knot->right : knot->value;
    }
    return dalcs_piecewise_on_line(f, k, s);
}

/* The points that are known of the line before knot k: at most its two knots and f(0). */
static int points_of(const struct dalcs_piecewise *f, int k, double at[3], double value[3]) {
    int n = 0;
    if (k > 0) {
        at[n] = f->knot[k - 1].at;
        value[n++] = f->knot[k - 1].right;
    }
    if (k < f->n) {
        at[n] = f->knot[k].at;
        value[n++] = f->knot[k].left;
    }
    if (f->has_zero && (k == 0 || f->knot[k - 1].at < 0) && (k == f->n || f->knot[k].at > 0)) {
        at[n] = 0;
        value[n++] = f->zero;
    }
    return n;
}

/* Of n numbers the one next to x. */
static int nearest(const double *number, int n, double x) {
    int best = 0;
    for (int k = 1; k < n; k++) {
        best = fabs(number[k] - x) < fabs(number[best] - x) ? k : best;
    }
    return best;
}

double dalcs_piecewise_on_line(const struct dalcs_piecewise *f, int k, double s) {
    double at[3] = {0};
    double value[3] = {0};
    const int from = nearest(at, points_of(f, k, at, value), s);
    const double slope = dalcs_piecewise_slope(f, k);
    return slope == 0 ? value[from] : value[from] + slope * (s - at[from]);
}

/* The argument at which the line before knot k, which is not flat, has the value y. */
static double reaches(const struct dalcs_piecewise *f, int k, double y) {
    double at[3] = {0};
    double value[3] = {0};
    const int from = nearest(value, points_of(f, k, at, value), y);
    return at[from] + (y - value[from]) / dalcs_piecewise_slope(f, k);
}

static bool is_flat_at(const struct dalcs_knot *knot, double size) {
    return fabs(knot->right - knot->left) <= 8 * DBL_EPSILON * size;
}

/* What the rounding of the values at its ends makes of the slope before knot k. */
static double slope_rounding(const struct dalcs_piecewise *f, int k) {
    if (k == 0 || k == f->n) {
        return 0;
    }
    const struct dalcs_knot *a = &f->knot[k - 1];
    const struct dalcs_knot *b = &f->knot[k];
    return 8 * DBL_EPSILON * fmax(fabs(a->right), fabs(b->left)) / (b->at - a->at);
}

/* Takes away knots without a jump and without a change of slope, all but one. */
static void simplify(struct dalcs_piecewise *f) {
    double size = 0;
    for (int k = 0; k < f->n; k++) {
        size = fmax(size, fmax(fabs(f->knot[k].left), fabs(f->knot[k].right)));
    }
    int n = 0;
    double slope = f->before;
    double rounding_before = 0;
    for (int k = 0; k < f->n; k++) {
        const double next = dalcs_piecewise_slope(f, k + 1);
        struct dalcs_knot knot = f->knot[k];
        if (is_flat_at(&knot, size)) {
            /* The side on which the function is constant has its value without rounding. */
            knot.left = knot.right = next == 0 ? knot.right : knot.left;
            knot.value = knot.left;
        }
        const double rounding = slope_rounding(f, k + 1);
        const bool is_straight = knot.left == knot.right &&
                                 fabs(next - slope) <= fmax(0x1p-40 * fmax(fabs(next), fabs(slope)),
                                                            rounding_before + rounding);
        const bool is_last = k == f->n - 1 && n == 0;
        if (!is_straight || is_last) {
            f->knot[n++] = knot;
        }
        slope = next;
        rounding_before = rounding;
    }
    const bool is_line = n == 1 && f->knot[0].left == f->knot[0].right &&
                         fabs(f->after - f->before) <= 0x1p-40 * fabs(f->before);
    f->after = is_line ? f->before : f->after;
    f->n = n;
}

bool dalcs_piecewise_line(struct dalcs_arena *arena, double constant, double slope,
                          struct dalcs_piecewise *f) {
    if (!allocate(arena, 1, f)) {
        return false;
    }
    f->n = 1;
    f->knot[0] = (struct dalcs_knot){0, constant, constant, constant};
    f->before = f->after = slope;
    f->has_zero = true;
    f->zero = constant;
    return true;
}

bool dalcs_piecewise_is_line(const struct dalcs_piecewise *f) {
    return f->n == 1 && f->knot[0].left == f->knot[0].right && f->before == f->after;
}

bool dalcs_piecewise_is_stepped(const struct dalcs_piecewise *f) {
    bool is = f->before == 0 && f->after == 0;
    for (int k = 1; k < f->n; k++) {
        is = is && f->knot[k].left == f->knot[k - 1].right;
    }
    return is;
}

/* ---- Two functions of the same number ----------------------------------------------------------- */

static struct dalcs_knot joined(const struct dalcs_piecewise *a, const struct dalcs_piecewise *b,
                                double at, bool is_product) {
    const double x[3] = {dalcs_piecewise_at(a, at, -1), dalcs_piecewise_at(a, at, 0),
                         dalcs_piecewise_at(a, at, 1)};
    const double y[3] = {dalcs_piecewise_at(b, at, -1), dalcs_piecewise_at(b, at, 0),
                         dalcs_piecewise_at(b, at, 1)};
    if (is_product) {
        return (struct dalcs_knot){at, x[0] * y[0], x[1] * y[1], x[2] * y[2]};
    }
    return (struct dalcs_knot){at, x[0] + y[0], x[1] + y[1], x[2] + y[2]};
}

static bool join(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                 const struct dalcs_piecewise *b, bool is_product, struct dalcs_piecewise *f) {
    if (!allocate(arena, (size_t)a->n + (size_t)b->n, f)) {
        return false;
    }
    int i = 0;
    int j = 0;
    while (i < a->n || j < b->n) {
        const bool is_both = i < a->n && j < b->n && is_near(a->knot[i].at, b->knot[j].at);
        const bool is_first = j == b->n || (i < a->n && a->knot[i].at < b->knot[j].at);
        const double at = is_both || is_first ? a->knot[i].at : b->knot[j].at;
        i += is_both || is_first;
        j += is_both || !is_first;
        f->knot[f->n++] = joined(a, b, at, is_product);
    }
    f->before = a->before + b->before;
    f->after = a->after + b->after;
    if (is_product) {
        /* A factor without a slope is its outermost value. */
        f->before = a->knot[0].left * b->before + b->knot[0].left * a->before;
        f->after = a->knot[a->n - 1].right * b->after + b->knot[b->n - 1].right * a->after;
    }
    f->has_zero = true;
    f->zero = joined(a, b, 0, is_product).value;
    simplify(f);
    return true;
}

bool dalcs_piecewise_add(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                         const struct dalcs_piecewise *b, struct dalcs_piecewise *f) {
    return join(arena, a, b, false, f);
}

bool dalcs_piecewise_multiply(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                              const struct dalcs_piecewise *b, struct dalcs_piecewise *f) {
    return join(arena, a, b, true, f);
}

static bool copy(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                 struct dalcs_piecewise *f) {
    if (!allocate(arena, (size_t)a->n, f)) {
        return false;
    }
    memcpy(f->knot, a->knot, (size_t)a->n * sizeof *f->knot);
    f->n = a->n;
    f->before = a->before;
    f->after = a->after;
    f->has_zero = a->has_zero;
    f->zero = a->zero;
    return true;
}

bool dalcs_piecewise_scale(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                           double factor, struct dalcs_piecewise *f) {
    if (!copy(arena, a, f)) {
        return false;
    }
    f->before *= factor;
    f->after *= factor;
    f->zero *= factor;
    for (int k = 0; k < f->n; k++) {
        f->knot[k].left *= factor;
        f->knot[k].value *= factor;
        f->knot[k].right *= factor;
    }
    simplify(f);
    return true;
}

bool dalcs_piecewise_to_logic(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                              struct dalcs_piecewise *f) {
    if (!copy(arena, a, f)) {
        return false;
    }
    for (int k = 0; k < f->n; k++) {
        struct dalcs_knot *knot = &f->knot[k];
        *knot = (struct dalcs_knot){knot->at, knot->left != 0, knot->value != 0, knot->right != 0};
    }
    f->zero = f->zero != 0;
    simplify(f);
    return true;
}

/* ---- Composition -------------------------------------------------------------------------------- */

/* outer's limit at y, which inner reaches with this slope from the left (side -1) or leaves with it to
 * the right (side 1). */
static double limit(const struct dalcs_piecewise *outer, double y, double slope, int side) {
    return dalcs_piecewise_at(outer, y, slope == 0 ? 0 : (slope > 0) == (side > 0) ? 1 : -1);
}

/* Knots of outer that inner passes on piece k, strictly inside it. */
static void cross(const struct dalcs_piecewise *outer, const struct dalcs_piecewise *inner, int k,
                  struct dalcs_piecewise *f) {
    const double slope = dalcs_piecewise_slope(inner, k);
    const struct dalcs_knot *a = k > 0 ? &inner->knot[k - 1] : NULL;
    const struct dalcs_knot *b = k < inner->n ? &inner->knot[k] : NULL;
    for (int i = 0; i < outer->n && slope != 0; i++) {
        const struct dalcs_knot *knot = &outer->knot[slope > 0 ? i : outer->n - 1 - i];
        const double at = reaches(inner, k, knot->at);
        const bool is_after =
            a == NULL || (at > a->at && !is_near(at, a->at) && !is_near(knot->at, a->right));
        const bool is_before =
            b == NULL || (at < b->at && !is_near(at, b->at) && !is_near(knot->at, b->left));
        if (is_after && is_before) {
            f->knot[f->n++] = (struct dalcs_knot){at, limit(outer, knot->at, slope, -1),
                                                  knot->value, limit(outer, knot->at, slope, 1)};
        }
    }
}

/* The slope of outer(inner) far out where inner has this slope; side -1: to the left. */
static double far_slope(const struct dalcs_piecewise *outer, double slope, int side) {
    const bool is_up = (slope > 0) == (side > 0);
    return slope == 0 ? 0 : slope * (is_up ? outer->after : outer->before);
}

bool dalcs_piecewise_compose(struct dalcs_arena *arena, const struct dalcs_piecewise *outer,
                             const struct dalcs_piecewise *inner, struct dalcs_piecewise *f) {
    const size_t n = (size_t)inner->n;
    if (!allocate(arena, n + (n + 1) * (size_t)outer->n, f)) {
        return false;
    }
    for (int k = 0; k <= inner->n; k++) {
        cross(outer, inner, k, f);
        if (k < inner->n) {
            const struct dalcs_knot *knot = &inner->knot[k];
            f->knot[f->n++] = (struct dalcs_knot){
                knot->at, limit(outer, knot->left, dalcs_piecewise_slope(inner, k), -1),
                dalcs_piecewise_at(outer, knot->value, 0),
                limit(outer, knot->right, dalcs_piecewise_slope(inner, k + 1), 1)};
        }
    }
    f->before = far_slope(outer, inner->before, -1);
    f->after = far_slope(outer, inner->after, 1);
    f->has_zero = true;
    f->zero = dalcs_piecewise_at(outer, dalcs_piecewise_at(inner, 0, 0), 0);
    simplify(f);
    return true;
}
