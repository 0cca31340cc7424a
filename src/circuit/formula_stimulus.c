/* formula_stimulus.c - which straight piece of its function a formula of sources is on, and until when.
 *
 * The times at which the argument passes a knot are computed (course.h), as those of switches that sources command are:
 * a comparison of a reference with a carrier is a pulse with such edges, and takes no part in any complementarity
 * problem, in which its vertical step would leave the mode open. */
#include "formula_stimulus.h"

#include "course.h"

#include <math.h>

/* Edges of the argument, or parts of a long way between two, looked at in one search. */
enum { STRETCHES_AT_A_TIME = 64 };

/* Between knot - 1 and knot, or resting on `knot` itself. */
struct place {
    int knot;
    bool rests;
};

static struct place place_of(const struct dalcs_stimulus *s, const struct dalcs_course *course) {
    const struct dalcs_piecewise *f = &s->u.formula.function;
    for (int k = 0; k < f->n; k++) {
        const int is = dalcs_course_side(course, f->knot[k].at);
        if (is <= 0) {
            return (struct place){k, is == 0};
        }
    }
    return (struct place){f->n, false};
}

static struct place find_place(const struct dalcs_stimulus *s, double t, enum dalcs_side side,
                               double *argument) {
    struct dalcs_stimulus_term term[DALCS_STIMULUS_MOST_TERMS];
    struct dalcs_course course;
    dalcs_course_look(&s->u.formula.argument, t, side, term, &course);
    *argument = course.value;
    return place_of(s, &course);
}

static double value_at(const struct dalcs_stimulus *s, struct place place, double argument) {
    const struct dalcs_piecewise *f = &s->u.formula.function;
    return place.rests ? f->knot[place.knot].value
                       : dalcs_piecewise_on_line(f, place.knot, argument);
}

double dalcs_formula_stimulus_value(const struct dalcs_stimulus *s, double t,
                                    enum dalcs_side side) {
    double argument;
    const struct place place = find_place(s, t, side, &argument);
    return value_at(s, place, argument);
}

double dalcs_formula_stimulus_operating_value(const struct dalcs_stimulus *s,
                                              bool transient_follows) {
    const struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    double argument = sum->constant;
    for (int k = 0; k < sum->n; k++) {
        argument += sum->part[k].factor *
                    dalcs_stimulus_operating_value(sum->part[k].of, transient_follows);
    }
    return transient_follows ? dalcs_formula_stimulus_value(s, 0.0, DALCS_LEFT)
                             : dalcs_piecewise_at(&s->u.formula.function, argument, 0);
}

/* When the argument leaves a place between two knots, up to an edge of it; *t is how far it was looked at. */
static bool leaves(const struct dalcs_stimulus *s, struct place place, double edge, double *t) {
    const struct dalcs_piecewise *f = &s->u.formula.function;
    const double from = *t;
    bool left = false;
    *t = edge;
    for (int k = 0; k < 2; k++) {
        const int knot = place.knot - k; /* above it, below it */
        double until = from;
        if (knot >= 0 && knot < f->n) {
            if (dalcs_course_passes(&s->u.formula.argument, k == 0 ? -1 : 1, f->knot[knot].at, *t,
                                    &until)) {
                left = true;
            } else if (until < *t) {
                left = false; /* not looked at as far as the other one has come */
            }
            *t = fmin(*t, until);
        }
    }
    return left;
}

double dalcs_formula_stimulus_next_edge(const struct dalcs_stimulus *s, double t) {
    const struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    double argument;
    const struct place place = find_place(s, t, DALCS_RIGHT, &argument);
    const bool is_flat =
        place.rests || dalcs_piecewise_slope(&s->u.formula.function, place.knot) == 0.0;
    double until = t;
    for (int k = 0; k < STRETCHES_AT_A_TIME; k++) {
        const double edge = dalcs_sum_next_edge(sum, until);
        if (place.rests) {
            until = edge;
        } else if (leaves(s, place, edge, &until)) {
            return until;
        }
        if (isinf(until)) {
            return until;
        }
        if (until < edge) {
            continue;
        }
        const struct place next = find_place(s, edge, DALCS_RIGHT, &argument);
        if (!is_flat || next.knot != place.knot || next.rests != place.rests) {
            return edge;
        }
    }
    return until;
}

int dalcs_formula_stimulus_n_terms(const struct dalcs_stimulus *s) {
    const struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    int n = 0;
    for (int k = 0; k < sum->n && !dalcs_piecewise_is_stepped(&s->u.formula.function); k++) {
        n += dalcs_stimulus_n_terms(sum->part[k].of);
    }
    return n;
}

void dalcs_formula_stimulus_piece(const struct dalcs_stimulus *s, double t,
                                  struct dalcs_stimulus_piece *piece) {
    struct dalcs_stimulus_term work[DALCS_STIMULUS_MOST_TERMS];
    struct dalcs_course course;
    dalcs_course_look(&s->u.formula.argument, t, DALCS_RIGHT,
                      piece->n_terms > 0 ? piece->term : work, &course);
    const struct place place = place_of(s, &course);
    const double slope =
        place.rests ? 0.0 : dalcs_piecewise_slope(&s->u.formula.function, place.knot);
    piece->level = value_at(s, place, course.straight);
    piece->slope = slope * course.rise;
    for (int i = 0; i < piece->n_terms; i++) {
        piece->term[i].cosine *= slope;
        piece->term[i].sine *= slope;
    }
}
