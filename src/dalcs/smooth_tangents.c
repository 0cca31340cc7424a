/* smooth_tangents.c - the lines that smooth sources have in the equations. */
#include "smooth_tangents.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

double dalcs_smooth_line(const struct dalcs_smooth_input *of, int j) {
    return of->entry[j] != NULL ? -*of->entry[j] : 0.0;
}

double dalcs_smooth_rest_of_share(const struct dalcs_smooth_input *of, double share,
                                  const double *x) {
    return dalcs_smooth_share(share, dalcs_smooth_value(of->kind, x)) -
           dalcs_smooth_line(of, 0) * x[0] - dalcs_smooth_line(of, 1) * x[1];
}

double dalcs_smooth_rest(const struct dalcs_smooth_input *of, const double *x) {
    return dalcs_smooth_rest_of_share(of, 1.0, x);
}

void dalcs_smooth_finite_gradient(const struct dalcs_smooth_input *of, const double *x,
                                  double *gradient) {
    static const double steepest = 0x1p+511;
    dalcs_smooth_gradient(of->kind, x, gradient);
    for (int j = 0; j < 2; j++) {
        gradient[j] = isinf(gradient[j]) ? copysign(steepest, gradient[j]) : gradient[j];
    }
}

void dalcs_smooth_gradient_of_rest(const struct dalcs_smooth_input *of, double share,
                                   const double *x, double *gradient) {
    dalcs_smooth_finite_gradient(of, x, gradient);
    for (int j = 0; j < 2; j++) {
        gradient[j] = dalcs_smooth_share(share, gradient[j]) - dalcs_smooth_line(of, j);
    }
}

/* The lines of the tangent at x; an argument that both read has one line. */
static void find_lines(const struct dalcs_smooth_input *of, const double *gradient, double *line) {
    const bool is_one = of->n > 1 && of->column[0] >= 0 && of->column[0] == of->column[1];
    line[0] = gradient[0] + (is_one ? gradient[1] : 0.0);
    line[1] = is_one ? 0.0 : gradient[1];
}

/* What argument j is made of: a part of a formula of its own terms, a signal of the circuit of the largest of its unit. */
static double made_of(const struct dalcs_system *s, const struct dalcs_smooth_seen *seen, int k,
                      int j) {
    const int column = s->smooth[k].column[j];
    const bool has_terms = column >= 0 && s->is_part[column] && seen->terms != NULL;
    return column < 0  ? 0.0
           : has_terms ? seen->terms[k][j]
                       : seen->largest[s->column_is_current[column]];
}

/* Those at x, as far as they are finite and not 0, else the present ones. Returns by how much the steepest is steeper; of
 * a product also by how much it is flatter: i R, of a resistance that falls, is next to the line of the R before a small
 * difference of large numbers. A diode that blocks is flat as well, but there nothing else is as small. A root's is no steeper
 * than at 1: near 0 its tangent is steep for no longer than it is near. One of what is rounding beside the largest
 * V is one of 0. A product has its other factor for a line, but none that is rounding beside what that is made of. */
static double find_tangent(const struct dalcs_system *s, const struct dalcs_smooth_seen *seen,
                           int k, double *line) {
    const struct dalcs_smooth_input *of = &s->smooth[k];
    const double *x = seen->x[k];
    double gradient[2];
    double steeper = 0.0;
    dalcs_smooth_gradient(of->kind, (const double[]){0.0, x[1]}, gradient);
    if (!isinf(gradient[0]) || fabs(x[0]) > dalcs_rounded * seen->largest[0]) {
        dalcs_smooth_gradient(of->kind, x, gradient);
    }
    const double exponent = dalcs_smooth_root_exponent(of);
    gradient[0] = exponent > 0.0 ? fmin(gradient[0], exponent) : gradient[0];
    find_lines(of, gradient, line);
    for (int j = 0; j < 2; j++) {
        const double present = dalcs_smooth_line(of, j);
        const bool is_product = of->kind == DALCS_SMOOTH_PRODUCT;
        const bool is_rounding =
            is_product && fabs(line[j]) <= dalcs_rounded * made_of(s, seen, k, 1 - j);
        const bool is_one =
            of->entry[j] != NULL && isfinite(line[j]) && line[j] != 0.0 && !is_rounding;
        const bool counts_flatter = is_one && is_product;
        steeper = is_one ? fmax(steeper, fabs(line[j] / present)) : steeper;
        steeper = counts_flatter ? fmax(steeper, fabs(present / line[j])) : steeper;
        line[j] = is_one ? line[j] : present;
    }
    return steeper;
}

static void put_lines(const struct dalcs_smooth_input *of, const double *line) {
    for (int j = 0; j < 2; j++) {
        if (of->entry[j] != NULL) {
            *of->entry[j] = -line[j];
        }
    }
}

void dalcs_smooth_take_rest(const struct dalcs_smooth_input *of, const double *x, double *phi) {
    const double rest = dalcs_smooth_rest(of, x);
    *phi = isfinite(rest) ? rest : *phi;
}

/* Is rounding of the present line more than six digits of the function allow, where the function is something beside
 * `scale`, the largest of its unit, and the line that its tangent has is far flatter? */
static bool is_hidden(const struct dalcs_smooth_input *of, const double *x, const double *line,
                      double scale) {
    double steeper = 0.0;
    const double f = fabs(dalcs_smooth_value(of->kind, x));
    for (int j = 0; j < 2; j++) {
        const double present = fabs(dalcs_smooth_line(of, j));
        steeper += present > dalcs_beyond * fabs(line[j]) ? present * fabs(x[j]) : 0.0;
    }
    return f > dalcs_nothing * scale && dalcs_answer_rounded * steeper > dalcs_nothing * f;
}

bool dalcs_smooth_retangent(const struct dalcs_system *system, const struct dalcs_smooth_seen *seen,
                            const double *scale, double *phi) {
    double line[2];
    bool is_due = false;
    for (int k = 0; k < system->n_smooth && !is_due; k++) {
        const struct dalcs_smooth_input *of = &system->smooth[k];
        is_due = find_tangent(system, seen, k, line) > dalcs_beyond ||
                 is_hidden(of, seen->x[k], line, scale[system->row_is_current[of->row]]);
    }
    for (int k = 0; k < system->n_smooth && is_due; k++) {
        const struct dalcs_smooth_input *of = &system->smooth[k];
        (void)find_tangent(system, seen, k, line);
        put_lines(of, line);
        dalcs_smooth_take_rest(of, seen->x[k], &phi[k]);
    }
    return is_due;
}

static void put_nominal_line(const struct dalcs_smooth_input *of) {
    const bool is_number[2] = {of->column[0] < 0, of->n < 2 || of->column[1] < 0};
    double gradient[2];
    double line[2];
    dalcs_smooth_nominal_gradient(of->kind, of->number, is_number, gradient);
    find_lines(of, gradient, line);
    put_lines(of, line);
}

void dalcs_smooth_nominal_tangents(const struct dalcs_system *system) {
    for (int k = 0; k < system->n_smooth; k++) {
        put_nominal_line(&system->smooth[k]);
    }
}

bool dalcs_smooth_starts_on_lines(const struct dalcs_system *system) {
    bool starts = false;
    for (int k = 0; k < system->n_smooth && !starts; k++) {
        starts = system->smooth[k].starts_on_line;
    }
    return starts;
}

void dalcs_smooth_starting_tangents(const struct dalcs_system *system, double (*x)[2],
                                    double *phi) {
    const struct dalcs_smooth_seen seen = {.x = (const double(*)[2])x};
    double line[2];
    for (int k = 0; k < system->n_smooth; k++) {
        const struct dalcs_smooth_input *of = &system->smooth[k];
        if (of->starts_on_line) {
            put_nominal_line(of);
            memcpy(x[k], of->start, sizeof(of->start));
            (void)find_tangent(system, &seen, k, line);
            put_lines(of, line);
            dalcs_smooth_take_rest(of, x[k], &phi[k]);
        }
    }
}

void dalcs_smooth_scale_tangents(const struct dalcs_system *system, double factor,
                                 const double (*x)[2], double *phi) {
    for (int k = 0; k < system->n_smooth; k++) {
        const struct dalcs_smooth_input *of = &system->smooth[k];
        const double line[2] = {factor * dalcs_smooth_line(of, 0),
                                factor * dalcs_smooth_line(of, 1)};
        put_lines(of, line);
        dalcs_smooth_take_rest(of, x[k], &phi[k]);
    }
}

void dalcs_smooth_drop_tangents(const struct dalcs_system *system) {
    for (int k = 0; k < system->n_smooth; k++) {
        put_lines(&system->smooth[k], (const double[]){0.0, 0.0});
    }
}
