/* stretch.h - signals between two times where nothing happens, as sums of Legendre polynomials.
 *
 * Between events and edges every signal is a polynomial of a degree of at most 9, a sinusoid over less
 * than a period or an exponential over a few time constants. Its values at the nodes of Gauss' rule
 * with 18 points give back all of these to rounding, the product of two polynomials and the integral of
 * the square of that exactly. The nodes lie inside, so that no side of an edge can be mistaken. */
#ifndef DALCS_STRETCH_H
#define DALCS_STRETCH_H

#include "signal_formula.h"
#include "status.h"

enum { DALCS_STRETCH_NODES = 18, DALCS_STRETCH_ROOM = 20 /* as many in whole quads */ };

struct dalcs_stretch_rule {
    double node[DALCS_STRETCH_NODES];                       /* in (-1, 1), ascending */
    double weight[DALCS_STRETCH_NODES];                     /* their sum is 1 */
    double expand[DALCS_STRETCH_NODES][DALCS_STRETCH_ROOM]; /* [node][coefficient], 0 beyond */
};

extern const struct dalcs_stretch_rule dalcs_stretch_rule;

/* value[NODES] at the nodes to coefficient[NODES], and to a value at x. */
void dalcs_stretch_expand(const struct dalcs_stretch_rule *rule, const double *value,
                          double *coefficient);
double dalcs_stretch_at(const double *coefficient, double x);

/* Of the derivative with respect to x; may not be coefficient itself. */
void dalcs_stretch_derive(const double *coefficient, double *derivative);

/* How far the sum can be from its first term. */
double dalcs_stretch_spread(const double *coefficient);

/* Signals from one time to another. */
struct dalcs_stretch {
    const struct dalcs_stretch_rule *rule;
    double from, to;
    int n_signals;
    double (*value)[DALCS_STRETCH_NODES];       /* [n_signals] at the nodes */
    double (*coefficient)[DALCS_STRETCH_NODES]; /* [n_signals] */
    double (*imaginary)[DALCS_STRETCH_NODES];   /* [n_signals], likewise, of an .ac; NULL: real */
    bool slides; /* some signals are means over the sides of a slide: of those that are kept */
    const double *result; /* of measurements that formulas may use, or NULL */
    const double *impulse,
        *left; /* [n_signals] V s or A s at its start, and the values before, NAN where they are not known; NULL: none */
};

/* A formula from one time to another, resolved. */
struct dalcs_span {
    double from, to;
    double value[DALCS_STRETCH_NODES], coefficient[DALCS_STRETCH_NODES];
    bool is_rough; /* a jump is in it, or noise: its polynomial goes beyond its values */
};

/* Hands spans that together make up [from, to] of the stretch to visit, in their order; false from visit
 * ends it. *scale is the largest magnitude of the formula so far, and becomes larger if need be. False
 * when the formula has no value somewhere. */
bool dalcs_stretch_visit(const struct dalcs_stretch *stretch,
                         const struct dalcs_signal_formula *formula, double from, double to,
                         double *scale, void *user,
                         bool (*visit)(void *user, const struct dalcs_span *span));

/* The formula at a time of the stretch, NAN where it has no value. */
double dalcs_stretch_value(const struct dalcs_stretch *stretch,
                           const struct dalcs_signal_formula *formula, double time);

/* The same so far off, where what the formula says of `time` itself goes on beyond the ends of the stretch. */
double dalcs_stretch_value_near(const struct dalcs_stretch *stretch,
                                const struct dalcs_signal_formula *formula, double time,
                                double off);

/* V s or A s, or what the formula makes of that, at the start of the stretch; NAN where it has no integral there: where it
 * is not linear in what has an impulse, or multiplies it by what jumps. */
double dalcs_stretch_impulse(const struct dalcs_stretch *stretch,
                             const struct dalcs_signal_formula *formula);

/* Of a signal. */
double dalcs_signal_part_of(enum dalcs_signal_part part, double re, double im);

/* Part of a span: x from a to b. */
void dalcs_span_cut(const struct dalcs_stretch_rule *rule, const struct dalcs_span *span, double a,
                    double b, struct dalcs_span *part);

#endif
