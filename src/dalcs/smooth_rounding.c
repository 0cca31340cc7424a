/* smooth_rounding.c - what the rounding of its arguments leaves in the value of a smooth source. */
#include "rounding.h"
#include "smooth_newton.h"
#include "smooth_tangents.h"

#include <math.h>

double dalcs_smooth_share_rounding(const struct dalcs_smooth_input *of, double share,
                                   const double *x) {
    double gradient[2];
    double rounding = 0.0;
    dalcs_smooth_finite_gradient(of, x, gradient);
    for (int j = 0; j < of->n; j++) {
        const double slope =
            fabs(dalcs_smooth_share(share, gradient[j])) + fabs(dalcs_smooth_line(of, j));
        rounding += of->column[j] >= 0 ? dalcs_rounded * slope * fabs(x[j]) : 0.0;
    }
    return rounding;
}

double dalcs_smooth_rounding(const struct dalcs_smooth_input *of, double value, const double *x) {
    return dalcs_smooth_share_rounding(of, 1.0, x) + dalcs_rounded * fabs(value);
}

double dalcs_smooth_function_rounding(const struct dalcs_smooth_input *of, const double *x) {
    double gradient[2];
    double size = fabs(dalcs_smooth_value(of->kind, x));
    dalcs_smooth_finite_gradient(of, x, gradient);
    for (int j = 0; j < of->n; j++) {
        size += of->column[j] >= 0 ? fabs(gradient[j] * x[j]) : 0.0;
    }
    return dalcs_rounded * size;
}
