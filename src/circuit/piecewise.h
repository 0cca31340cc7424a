/* piecewise.h - piecewise-linear functions of one number, which may jump.
 *
 * Straight lines between knots and beyond them. At a knot the function has a left and a right limit;
 * where they differ it is the whole interval between them, as a relay is. `value` is what it is where
 * its argument rests on the knot over a whole range, as that of sgn(max(v, 0)) does: sgn(0) is 0. */
#ifndef DALCS_PIECEWISE_H
#define DALCS_PIECEWISE_H

#include "memory.h"

struct dalcs_knot {
    double at;
    double left, value, right;
};

struct dalcs_piecewise {
    int n; /* at least 1 */
    struct dalcs_knot *knot;
    double before, after; /* slopes beyond the first and the last knot */
    bool has_zero;        /* is f(0) known? Knots far away tell it but to their own rounding */
    double zero;
};

/* The functions below make new ones in the arena, without knots that change nothing; false when out of
 * memory. */

/* constant + slope s */
bool dalcs_piecewise_line(struct dalcs_arena *arena, double constant, double slope,
                          struct dalcs_piecewise *f) DALCS_MUST_CHECK;

/* outer(inner(s)) */
bool dalcs_piecewise_compose(struct dalcs_arena *arena, const struct dalcs_piecewise *outer,
                             const struct dalcs_piecewise *inner,
                             struct dalcs_piecewise *f) DALCS_MUST_CHECK;

bool dalcs_piecewise_add(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                         const struct dalcs_piecewise *b,
                         struct dalcs_piecewise *f) DALCS_MUST_CHECK;

/* One of the two must be constant between its knots. */
bool dalcs_piecewise_multiply(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                              const struct dalcs_piecewise *b,
                              struct dalcs_piecewise *f) DALCS_MUST_CHECK;

/* factor f(s), or 1 where f(s) is not 0 and f is constant between its knots */
bool dalcs_piecewise_scale(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                           double factor, struct dalcs_piecewise *f) DALCS_MUST_CHECK;
bool dalcs_piecewise_to_logic(struct dalcs_arena *arena, const struct dalcs_piecewise *a,
                              struct dalcs_piecewise *f) DALCS_MUST_CHECK;

/* The slope before knot k (0..n: after the last). */
double dalcs_piecewise_slope(const struct dalcs_piecewise *f, int k);

bool dalcs_piecewise_is_line(const struct dalcs_piecewise *f);

/* Constant between its knots? */
bool dalcs_piecewise_is_stepped(const struct dalcs_piecewise *f);

/* Of the line before knot k, at s: on a flat one exact. */
double dalcs_piecewise_on_line(const struct dalcs_piecewise *f, int k, double s);

/* The limit at s from the left (side < 0) or the right (side > 0), or the value (0). */
double dalcs_piecewise_at(const struct dalcs_piecewise *f, double s, int side);

#endif
