/* measuring_extremes.c - the largest and the least value of a span: cut until its slope changes its sign once. */
#include "measuring_extremes.h"

#include <float.h>
#include <math.h>

enum { N = DALCS_STRETCH_NODES, MOST_CUTS = 60, MOST_ROUNDS = 80 };

/* Of an extreme, over the largest value. */
static const double rounding = 1e-14, same = 4e-15;

void dalcs_climb_to(const struct dalcs_climb *c, double value, double time) {
    double higher = c->sign * (value - *c->best);
    if (higher > same * c->scale) {
        *c->where = time;
    }
    if (higher > 0.0) {
        *c->best = value;
    }
}

/* The zero of a slope that changes its sign once between x = -1 and 1, and never bends back: Newton's method, and the
 * middle of what is left where that would leave it. */
static double flat_at(const double *slope, const double *bend) {
    double a = -1.0;
    double b = 1.0;
    const bool rises = dalcs_stretch_at(slope, a) < 0.0;
    double x = 0.0;
    for (int round = 0; round < MOST_ROUNDS && b - a > DBL_EPSILON; round++) {
        const double value = dalcs_stretch_at(slope, x);
        if ((value < 0.0) == rises) {
            a = x;
        } else {
            b = x;
        }
        double next = x - value / dalcs_stretch_at(bend, x);
        next = next > a && next < b ? next : 0.5 * (a + b);
        const bool is_there = fabs(next - x) <= DBL_EPSILON;
        x = next;
        if (is_there) {
            break;
        }
    }
    return x;
}

/* Between x = -1 and 1 the slope changes its sign, if at all, once. What is sought is there only where the curve bends
 * the right way, and not above the point where its tangents at both ends meet. */
static void climb_bow(const struct dalcs_climb *c, const struct dalcs_span *span,
                      const double *slope, const double *bend, const double *end) {
    const double first = c->sign * dalcs_stretch_at(slope, -1.0);
    const double last = c->sign * dalcs_stretch_at(slope, 1.0);
    if (!(first > 0.0 && last < 0.0)) {
        return;
    }
    const double rise = c->sign * (end[1] - end[0]);
    const double summit = c->sign * end[0] + first * (rise - 2.0 * last) / (first - last);
    if (summit > c->sign * *c->best) {
        const double x = flat_at(slope, bend);
        dalcs_climb_to(c, dalcs_stretch_at(span->coefficient, x),
                       span->from + 0.5 * (1.0 + x) * (span->to - span->from));
    }
}

/* Of one with a jump in it nothing is known but its values. */
static void climb_values(const struct dalcs_climb *c, const struct dalcs_span *span) {
    for (int i = 0; i < N; i++) {
        dalcs_climb_to(c, span->value[i],
                       span->from + 0.5 * (1.0 + c->rule->node[i]) * (span->to - span->from));
    }
}

static void climb(const struct dalcs_climb *c, const struct dalcs_span *span, int depth) {
    if (span->is_rough) {
        climb_values(c, span);
        return;
    }
    double top = c->sign * span->coefficient[0] + dalcs_stretch_spread(span->coefficient);
    if (top <= c->sign * *c->best) {
        return;
    }
    const double end[2] = {dalcs_stretch_at(span->coefficient, -1.0),
                           dalcs_stretch_at(span->coefficient, 1.0)};
    dalcs_climb_to(c, end[0], span->from);
    dalcs_climb_to(c, end[1], span->to);
    double slope[N];
    double bend[N];
    dalcs_stretch_derive(span->coefficient, slope);
    if (fabs(slope[0]) >= dalcs_stretch_spread(slope)) {
        return;
    }
    dalcs_stretch_derive(slope, bend);
    if (fabs(bend[0]) >= dalcs_stretch_spread(bend) || depth == MOST_CUTS) {
        climb_bow(c, span, slope, bend, end);
        return;
    }
    if (top <= c->sign * *c->best + rounding * c->scale) {
        return;
    }
    struct dalcs_span half;
    dalcs_span_cut(c->rule, span, -1.0, 0.0, &half);
    climb(c, &half, depth + 1);
    dalcs_span_cut(c->rule, span, 0.0, 1.0, &half);
    climb(c, &half, depth + 1);
}

void dalcs_climb(const struct dalcs_climb *c, const struct dalcs_span *span) {
    climb(c, span, 0);
}
