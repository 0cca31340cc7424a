/* storage_ends.c - smooth laws of flux and charge that fall, or do not rise any more, from some argument on.
 *
 * Where one is flat, as a tanh, the state tells nothing of the argument: what a coil carries is known from the
 * derivative of a flux that rounding holds, and in a step of length h the rounding of that flux over h is a voltage. So a
 * slope is left. */
#include "formula_writer.h"
#include "storage.h"

#include "rounding.h"

#include <math.h>

enum { DECADES = 9, PER_DECADE = 16 };

double dalcs_storage_find_fall(const struct dalcs_builder *builder,
                               const struct dalcs_storage_function *f, double sign) {
    double before = dalcs_storage_formula_at(builder, f->formula, 0);
    for (int k = -DECADES * PER_DECADE; k <= DECADES * PER_DECADE; k++) {
        const double x = sign * pow(10, (double)k / PER_DECADE);
        const double value = dalcs_storage_formula_at(builder, f->formula, x);
        const double rise = sign * (value - before);
        if (!isfinite(value)) {
            return 0;
        }
        if (rise < -1e-12 * fmax(fabs(value), fabs(before))) {
            return x;
        }
        before = value;
    }
    return 0;
}

/* Over the slope around 0. Rounding of a flux makes DBL_EPSILON over this of the current around the knee, 2e-8 of it, which no
 * audit sees beside what flows in saturation; and at a hundred times the current of the knee the flux is a millionth larger. */
static const double SLOPE_LEFT = 1e-8;

/* A or V: a law that still rises there does so by a power of its argument, and keeps its slopes. The second is as far as any
 * circuit goes. */
static const double LAST_END = 1e6;
static const double FARTHEST = 1e9;

/* Does the law change by no more from x on, to one side, than an answer is known to? */
static bool is_flat(const struct dalcs_builder *builder, const struct dalcs_storage_function *f,
                    double x) {
    const double there = dalcs_storage_function_at(builder, f, copysign(FARTHEST, x));
    const double here = dalcs_storage_function_at(builder, f, x);
    return fabs(there - here) <= dalcs_answer_rounded * fabs(there);
}

/* The argument from which on the law is flat to one side; INFINITY: nowhere. */
static double find_end(const struct dalcs_builder *builder, const struct dalcs_storage_function *f,
                       double sign) {
    double low = 0;
    double high = LAST_END;
    if (!is_flat(builder, f, sign * high)) {
        return (double)INFINITY;
    }
    for (double middle = high / 2; middle > low && middle < high; middle = (low + high) / 2) {
        const bool flat = is_flat(builder, f, sign * middle);
        low = flat ? low : middle;
        high = flat ? middle : high;
    }
    return high;
}

void dalcs_storage_keep_slope(struct dalcs_formula_writer *w, const struct dalcs_token *place,
                              bool is_flux, struct dalcs_storage_function *f) {
    struct dalcs_builder *builder = w->builder;
    const double below = find_end(builder, f, -1);
    const double above = find_end(builder, f, 1);
    const double slope = SLOPE_LEFT * f->unit;
    if (isinf(below) && isinf(above)) {
        return;
    }
    const struct dalcs_formula *x = dalcs_formula_signal(w, DALCS_FORMULA_TIME, NULL, NULL);
    const struct dalcs_formula *line =
        dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, slope), x);
    f->formula = dalcs_formula_operation(w, DALCS_ADD, f->formula, line);
    f->unit += slope;
    dalcs_builder_note(
        builder, place,
        dalcs_builder_hint(builder, "write what is left there yourself: ...+%g*x", 100 * slope),
        "the %s stays the same beyond a %s of about %.3g %s: %g %s, %g of its slope around 0, is "
        "added to it, for else nothing tells the %s there",
        is_flux ? "flux" : "charge", is_flux ? "current" : "voltage", fmin(below, above),
        is_flux ? "A" : "V", slope, is_flux ? "H" : "F", SLOPE_LEFT,
        is_flux ? "current" : "voltage");
}
