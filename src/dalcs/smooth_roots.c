/* smooth_roots.c - where the tangent of a root with the sign of its argument is taken.
 *
 * sgn(x) |x|^p, p < 1, has an infinite slope at 0, and tangents at what was read near there lead anywhere. Such a root rises
 * everywhere. Where the rest of the circuit lets its argument fall as its value rises, as a passive one does, the line of
 * that meets the root at one place. The tangent there is the next one: of one such root alone the next step of Newton's
 * method is the last (an elimination of what is nonlinear; X.-C. Cai and D. Keyes, Nonlinearly preconditioned inexact
 * Newton algorithms, 2002). */
#include "smooth_tangents.h"

#include <math.h>

/* By its value the argument is a power q = 1/p > 1, and Newton's method has a convex function to do with on either side of
 * 0: it is on the far side of the answer after one step, and from there each step takes at least the q-th part of what is
 * left. What is left after these is left to the steps of the whole. */
enum { MOST_STEPS = 64 };

double dalcs_smooth_root_exponent(const struct dalcs_smooth_input *of) {
    const bool is_number = of->n < 2 || of->column[1] < 0;
    const double exponent = of->kind == DALCS_SMOOTH_CBRT           ? 1.0 / 3.0
                            : of->kind == DALCS_SMOOTH_SIGNED_POWER ? of->number[1]
                                                                    : 0.0;
    return is_number && of->column[0] >= 0 && exponent > 0.0 && exponent < 1.0 ? exponent : 0.0;
}

/* w with factor[0] w + factor[1] w |w|^(power - 1) = right. */
static double meet(double w, double power, const double *factor, double right) {
    double before = INFINITY;
    for (int k = 0; k < MOST_STEPS && isfinite(w) && fabs(w - before) > 0x1p-40 * fabs(w); k++) {
        const double lever = pow(fabs(w), power - 1.0);
        before = w;
        w -= (factor[0] * w + factor[1] * w * lever - right) /
             (factor[0] + factor[1] * power * lever);
    }
    return w;
}

double dalcs_smooth_root_point(const struct dalcs_smooth_input *of, double share, double x,
                               double phi, double slope) {
    const double exponent = dalcs_smooth_root_exponent(of);
    const double line = dalcs_smooth_line(of, 0);
    const double factor[2] = {-share * slope, 1.0 + line * slope};
    const double right = factor[1] * x - slope * (line * x + phi);
    if (exponent == 0.0 || share == 0.0 || !(factor[0] > 0.0 && factor[1] >= 0.0) ||
        !isfinite(right)) {
        return x;
    }
    const double value = meet((line * x + phi) / share, 1.0 / exponent, factor, right);
    const double a = copysign(pow(fabs(value), 1.0 / exponent), value);
    return isfinite(a) ? a : x;
}
