/* stretch.c - Gauss' rule and Legendre's polynomials; formulas cut until each part is resolved. */
#include "stretch.h"

#include "extremes.h"
#include "quads.h"
#include "stretch_rule.h" /* of make_stretch_rule.c */
#include "wide_vectors.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { N = DALCS_STRETCH_NODES, ROOM = DALCS_STRETCH_ROOM, N_QUADS = ROOM / DALCS_QUAD };

/* Last coefficients of this size over the formula's largest value are rounding. */
static const double resolved = 4e-14;

/* Halving that leaves this much of the last coefficients in both halves does not help: that is noise, nearly always, for
 * there they are about the same in any span. A kink is in one half only, and so is a jump; where there are several, as
 * many as a polynomial of degree 9 has zeros, they are apart after 4 halvings, and what oscillates is resolved after a
 * few more. */
static const double helps = 0.25;

/* Of the largest value, that a formula may be off its polynomial at an end. */
static const double unseen = 1e-11;

/* A polynomial that cannot be resolved goes beyond its values by about its last coefficients: by more than the usual
 * tolerance where they are above this, over the formula's largest value. */
static const double rough = 1e-6;

enum { MOST_HALVINGS = 50, MOST_IN_VAIN = 6, TAIL = 3 };

/* sum[ROOM], its k of expand[i][k] value[i]: node by node, so that coefficients are neighbours, and unrolled, so that the
 * sums stay in registers. */
DALCS_TWICE(void, sum_up,
            (const struct dalcs_stretch_rule *rule, const double *value, double *restrict sum),
            (rule, value, sum)) {
    dalcs_quad of[N_QUADS] = {{0.0}};
    for (int i = 0; i < N; i++) {
#pragma GCC unroll 5
        for (int k = 0; k < N_QUADS; k++) {
            dalcs_quad expand;
            dalcs_quad_load(&expand, &rule->expand[i][DALCS_QUAD * k]);
            of[k] += expand * value[i];
        }
    }
#pragma GCC unroll 5
    for (int k = 0; k < N_QUADS; k++) {
        dalcs_quad_store(sum + DALCS_QUAD * k, &of[k]);
    }
}

static double largest_of(const double *value) {
    double largest = 0.0;
    for (int i = 0; i < N; i++) {
        largest = dalcs_larger(largest, fabs(value[i]));
    }
    return largest;
}

void dalcs_stretch_expand(const struct dalcs_stretch_rule *rule, const double *value,
                          double *coefficient) {
    double largest = largest_of(value);
    double sum[ROOM];
    sum_up(rule, value, sum);
    for (int k = 0; k < N; k++) {
        /* What rounding leaves is nothing: a constant must not look like one that wriggles. */
        coefficient[k] = fabs(sum[k]) > (2 * k + 1) * DBL_EPSILON * largest ? sum[k] : 0.0;
    }
}

/* Clenshaw's recurrence, from the last coefficient that is not 0 on: those of polynomials are few. */
double dalcs_stretch_at(const double *coefficient, double x) {
    double b1 = 0.0;
    double b2 = 0.0;
    int degree = N - 1;
    while (degree > 0 && coefficient[degree] == 0.0) {
        degree--;
    }
    for (int k = degree; k > 0; k--) {
        double b = coefficient[k] + x * b1 * (2 * k + 1) / (k + 1) - b2 * (k + 1) / (k + 2);
        b2 = b1;
        b1 = b;
    }
    return coefficient[0] + x * b1 - 0.5 * b2;
}

/* P'_(k+1) - P'_(k-1) = (2 k + 1) P_k */
void dalcs_stretch_derive(const double *coefficient, double *derivative) {
    double sum[2] = {0.0, 0.0}; /* of the coefficients above, by parity */
    for (int k = N - 1; k >= 0; k--) {
        derivative[k] = (2 * k + 1) * sum[(k + 1) % 2];
        sum[k % 2] += coefficient[k];
    }
}

double dalcs_stretch_spread(const double *coefficient) {
    double sum = 0.0;
    for (int k = 1; k < N; k++) {
        sum += fabs(coefficient[k]);
    }
    return sum;
}

/* ---- Formulas --------------------------------------------------------------------------------- */

/* The place where a formula is evaluated: a node of the stretch, or else x. */
struct place {
    const struct dalcs_stretch *stretch;
    int node;
    double x;
};

double dalcs_signal_part_of(enum dalcs_signal_part part, double re, double im) {
    static const double degrees = 57.295779513082320877;
    switch (part) {
    case DALCS_PART_DECIBEL:
        return 20.0 * log10(hypot(re, im));
    case DALCS_PART_PHASE:
        return degrees * atan2(im, re);
    case DALCS_PART_REAL:
        return re;
    case DALCS_PART_IMAGINARY:
        return im;
    default:
        return hypot(re, im);
    }
}

static double signal_at(const struct dalcs_signal_formula_point *point, int index,
                        enum dalcs_signal_part part) {
    const struct place *place = point->user;
    const struct dalcs_stretch *stretch = place->stretch;
    double re = place->node >= 0 ? stretch->value[index][place->node]
                                 : dalcs_stretch_at(stretch->coefficient[index], place->x);
    double im =
        stretch->imaginary != NULL ? dalcs_stretch_at(stretch->imaginary[index], place->x) : 0.0;
    return stretch->imaginary == NULL && part == DALCS_PART_PLAIN
               ? re
               : dalcs_signal_part_of(part, re, im);
}

static double evaluate(const struct dalcs_stretch *stretch,
                       const struct dalcs_signal_formula *formula, int node, double x) {
    const struct place place = {stretch, node, x};
    const struct dalcs_signal_formula_point point = {
        .time = stretch->from + 0.5 * (1.0 + x) * (stretch->to - stretch->from),
        .user = &place,
        .signal = signal_at,
        .result = stretch->result};
    return dalcs_signal_formula_value(formula, &point);
}

/* Where a time is in the stretch: -1 to 1. */
static double place_of(const struct dalcs_stretch *stretch, double time) {
    double x = 2.0 * ((time - stretch->from) / (stretch->to - stretch->from)) - 1.0;
    return time == stretch->to ? 1.0 : fmax(-1.0, fmin(1.0, x));
}

double dalcs_stretch_value(const struct dalcs_stretch *stretch,
                           const struct dalcs_signal_formula *formula, double time) {
    return evaluate(stretch, formula, -1, place_of(stretch, time));
}

double dalcs_stretch_value_near(const struct dalcs_stretch *stretch,
                                const struct dalcs_signal_formula *formula, double time,
                                double off) {
    const struct place place = {stretch, -1, place_of(stretch, time + off)};
    const struct dalcs_signal_formula_point point = {
        .time = time + off, .user = &place, .signal = signal_at, .result = stretch->result};
    return dalcs_signal_formula_value(formula, &point);
}

/* ---- Spans ------------------------------------------------------------------------------------ */

struct visit {
    const struct dalcs_stretch *stretch;
    const struct dalcs_signal_formula *formula;
    double *scale;
    void *user;
    bool (*visit)(void *user, const struct dalcs_span *span);
    bool ended, has_no_value;
};

/* Is the formula one real signal, as most are? */
static bool is_signal(const struct visit *v) {
    const struct dalcs_signal_formula_step *step = v->formula->step;
    return v->formula->n == 1 && step->push == DALCS_PUT_SIGNAL && step->part == DALCS_PART_PLAIN &&
           v->stretch->imaginary == NULL;
}

/* The formula between x = a and x = b; whole: that is the stretch. */
static void fill(struct visit *v, double a, double b, bool whole, struct dalcs_span *span) {
    const struct dalcs_stretch *stretch = v->stretch;
    const double length = stretch->to - stretch->from;
    span->from = a == -1.0 ? stretch->from : stretch->from + 0.5 * (1.0 + a) * length;
    span->to = b == 1.0 ? stretch->to : stretch->from + 0.5 * (1.0 + b) * length;
    if (whole && is_signal(v)) {
        int index = v->formula->step->index;
        memcpy(span->value, stretch->value[index], sizeof(span->value));
        memcpy(span->coefficient, stretch->coefficient[index], sizeof(span->coefficient));
        *v->scale = dalcs_larger(*v->scale, largest_of(span->value));
        return;
    }
    for (int i = 0; i < N; i++) {
        double x = a + 0.5 * (1.0 + stretch->rule->node[i]) * (b - a);
        span->value[i] =
            whole ? evaluate(stretch, v->formula, i, x) : evaluate(stretch, v->formula, -1, x);
        v->has_no_value = v->has_no_value || isnan(span->value[i]);
        *v->scale = fmax(*v->scale, fabs(span->value[i]));
    }
    dalcs_stretch_expand(stretch->rule, span->value, span->coefficient);
}

static double tail_of(const struct dalcs_span *span) {
    double tail = 0.0;
    for (int k = N - TAIL; k < N; k++) {
        tail = fmax(tail, fabs(span->coefficient[k]));
    }
    return tail;
}

/* The nodes do not reach to the ends, so the polynomial is compared with the formula there. */
static bool meets_ends(const struct visit *v, double a, double b, const struct dalcs_span *span,
                       double noise) {
    const double apart = fmax(
        fabs(dalcs_stretch_at(span->coefficient, -1.0) - evaluate(v->stretch, v->formula, -1, a)),
        fabs(dalcs_stretch_at(span->coefficient, 1.0) - evaluate(v->stretch, v->formula, -1, b)));
    return !(apart > unseen * *v->scale + N * noise); /* all coefficients count there */
}

static void halve(struct visit *v, double a, double b, const struct dalcs_span *span, int depth,
                  int in_vain);

/* A span goes to the visitor when it is resolved, else its halves do. */
static void settle(struct visit *v, double a, double b, struct dalcs_span *span, int depth,
                   int in_vain) {
    double tail = tail_of(span);
    double t = fmax(fabs(span->from), fabs(span->to));
    double noise = resolved * *v->scale + DBL_EPSILON * dalcs_stretch_spread(span->coefficient) *
                                              t / (span->to - span->from);
    bool is_done = v->formula->is_affine || (tail <= noise && meets_ends(v, a, b, span, noise)) ||
                   depth == MOST_HALVINGS || in_vain == MOST_IN_VAIN || v->has_no_value ||
                   !(span->to - span->from > 8.0 * DBL_EPSILON * t);
    if (is_done) {
        span->is_rough = !v->formula->is_affine && tail > rough * *v->scale;
        v->ended = v->has_no_value || !v->visit(v->user, span);
    } else {
        halve(v, a, b, span, depth, in_vain);
    }
}

static void halve(struct visit *v, double a, double b, const struct dalcs_span *span, int depth,
                  int in_vain) {
    struct dalcs_span half[2];
    double middle = 0.5 * (a + b);
    fill(v, a, middle, false, &half[0]);
    fill(v, middle, b, false, &half[1]);
    double least = fmin(tail_of(&half[0]), tail_of(&half[1]));
    int next = in_vain + (least > helps * tail_of(span));
    settle(v, a, middle, &half[0], depth + 1, next);
    if (!v->ended) {
        settle(v, middle, b, &half[1], depth + 1, next);
    }
}

bool dalcs_stretch_visit(const struct dalcs_stretch *stretch,
                         const struct dalcs_signal_formula *formula, double from, double to,
                         double *scale, void *user,
                         bool (*visit)(void *user, const struct dalcs_span *span)) {
    struct visit v = {
        .stretch = stretch, .formula = formula, .scale = scale, .user = user, .visit = visit};
    double a = place_of(stretch, from);
    double b = place_of(stretch, to);
    struct dalcs_span span;
    if (b > a) {
        fill(&v, a, b, a == -1.0 && b == 1.0, &span);
        settle(&v, a, b, &span, 0, 0);
    }
    return !v.has_no_value;
}

void dalcs_span_cut(const struct dalcs_stretch_rule *rule, const struct dalcs_span *span, double a,
                    double b, struct dalcs_span *part) {
    part->is_rough = span->is_rough;
    part->from = a == -1.0 ? span->from : span->from + 0.5 * (1.0 + a) * (span->to - span->from);
    part->to = b == 1.0 ? span->to : span->from + 0.5 * (1.0 + b) * (span->to - span->from);
    for (int i = 0; i < N; i++) {
        part->value[i] =
            dalcs_stretch_at(span->coefficient, a + 0.5 * (1.0 + rule->node[i]) * (b - a));
    }
    dalcs_stretch_expand(rule, part->value, part->coefficient);
}
