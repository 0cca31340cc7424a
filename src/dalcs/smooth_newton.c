/* smooth_newton.c - steps of Newton's method on smooth sources. */
#include "smooth_newton.h"

#include "extremes.h"
#include "magnitudes.h"
#include "rounding.h"
#include "smooth_tangents.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* 2^-60 of a step is no step. */
enum { MOST_HALVINGS = 60 };

enum dalcs_status dalcs_smooth_newton_setup(struct dalcs_smooth_newton *newton,
                                            const struct dalcs_system *system, int n_points,
                                            struct dalcs_arena *arena) {
    const size_t n = (size_t)n_points * (size_t)system->n_smooth;
    *newton = (struct dalcs_smooth_newton){
        .system = system, .n_points = n_points, .n = (int)n, .share = 1.0};
    newton->phi = dalcs_arena_alloc(arena, n, sizeof(double));
    newton->before = dalcs_arena_alloc(arena, n, sizeof(double));
    newton->x = dalcs_arena_alloc(arena, n, sizeof(*newton->x));
    newton->terms = dalcs_arena_alloc(arena, n, sizeof(*newton->terms));
    newton->tangent = dalcs_arena_alloc(arena, n, sizeof(*newton->tangent));
    newton->other = dalcs_arena_alloc(arena, 3 * (size_t)system->n_smooth, sizeof(*newton->other));
    newton->slope = dalcs_arena_alloc(arena, 2 * n * n, sizeof(double));
    newton->work.matrix = dalcs_arena_alloc(arena, n * n, sizeof(double));
    newton->work.step = dalcs_arena_alloc(arena, n, sizeof(double));
    newton->work.correction = dalcs_arena_alloc(arena, n, sizeof(double));
    newton->work.pivot = dalcs_arena_alloc(arena, n, sizeof(int));
    bool complete = newton->phi != NULL && newton->before != NULL && newton->x != NULL &&
                    newton->terms != NULL && newton->tangent != NULL && newton->other != NULL &&
                    newton->slope != NULL && newton->work.matrix != NULL &&
                    newton->work.step != NULL && newton->work.correction != NULL &&
                    newton->work.pivot != NULL;
    DALCS_TRY(complete ? DALCS_OK : DALCS_E_NOMEM);
    return dalcs_smooth_inner_setup(&newton->inner, system, (int)n, arena);
}

void dalcs_smooth_newton_begin(struct dalcs_smooth_newton *newton, const double (*x)[2]) {
    for (int q = 0; q < newton->n; q++) {
        newton->before[q] = newton->phi[q];
        memcpy(newton->tangent[q], x[q % newton->system->n_smooth], sizeof(newton->tangent[q]));
    }
    newton->volt = 0.0;
    newton->halved = newton->n_steps = 0;
    newton->limits = newton->outcome.at_pole = newton->is_damped = false;
    newton->outcome.defect = INFINITY;
}

void dalcs_smooth_newton_forget(struct dalcs_smooth_newton *newton) {
    memset(newton->slope, 0, 2 * (size_t)newton->n * (size_t)newton->n * sizeof(double));
}

static double over(double off, double size) {
    return off == 0.0 ? 0.0 : isfinite(size) ? off / size : INFINITY;
}

double dalcs_smooth_newton_terms(const struct dalcs_smooth_newton *newton, int q, int j) {
    const int n_smooth = newton->system->n_smooth;
    const double *slope = newton->slope + (size_t)(2 * q + j) * (size_t)newton->n;
    double most = 0.0;
    for (int p = 0; p < newton->n; p++) {
        const double alike = p % n_smooth == q % n_smooth ? newton->terms[p][j] : 0.0;
        most = dalcs_larger(most, dalcs_larger(alike, fabs(slope[p] * newton->phi[p])));
    }
    return most;
}

/* What argument j may be off by makes so much of the function, and of its line, which no root has from where it is steep. */
static double excused_by(const struct dalcs_smooth_newton *newton, int q, int j, double slope,
                         double tolerance) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    const double *x = newton->x[q];
    const double off = dalcs_answer_rounded * dalcs_smooth_newton_terms(newton, q, j);
    const double line = fabs(dalcs_smooth_line(of, j));
    double differs = slope * off;
    if (!(differs < tolerance * fabs(dalcs_smooth_value(of->kind, x)))) {
        differs = dalcs_smooth_variation(of->kind, x, j, off);
    }
    differs = fabs(dalcs_smooth_share(newton->share, differs));
    return differs + line * off + dalcs_answer_rounded * line * fabs(x[j]);
}

/* By how much a value is not the function's, and what the tolerance and its own terms allow. */
static double off_of(const struct dalcs_smooth_newton *newton, int q, double tolerance,
                     double *least) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    const double *x = newton->x[q];
    *least = tolerance * fabs(dalcs_smooth_share(newton->share, dalcs_smooth_value(of->kind, x))) +
             dalcs_smooth_share_rounding(of, newton->share, x);
    return fabs(dalcs_smooth_rest_of_share(of, newton->share, x) - newton->phi[q]);
}

/* Of a value that another step would not bring nearer. */
static bool is_excused(const struct dalcs_smooth_newton *newton, int q, double tolerance) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    double gradient[2];
    double most;
    const double off = off_of(newton, q, tolerance, &most);
    dalcs_smooth_finite_gradient(of, newton->x[q], gradient);
    for (int j = 0; j < of->n && !(off <= most); j++) {
        most += of->column[j] >= 0 ? excused_by(newton, q, j, fabs(gradient[j]), tolerance) : 0.0;
    }
    return over(off, most) <= 1.0;
}

bool dalcs_smooth_newton_agrees(struct dalcs_smooth_newton *newton, double tolerance,
                                bool *is_done) {
    newton->outcome.defect_before = newton->outcome.defect;
    newton->outcome.defect = 0.0;
    for (int q = 0; q < newton->n; q++) {
        double least;
        const double off = off_of(newton, q, tolerance, &least);
        const double defect = over(off, least);
        newton->outcome.worst =
            defect > newton->outcome.defect ? q % newton->system->n_smooth : newton->outcome.worst;
        newton->outcome.defect =
            defect <= newton->outcome.defect ? newton->outcome.defect : defect; /* NAN stays */
    }
    *is_done = newton->outcome.defect <= 1.0 ||
               !(newton->outcome.defect < 0.5 * newton->outcome.defect_before);
    bool agrees = *is_done && !newton->limits;
    for (int q = 0; q < newton->n && agrees && !(newton->outcome.defect <= 1.0); q++) {
        agrees = is_excused(newton, q, tolerance);
        newton->outcome.worst = agrees ? newton->outcome.worst : q % newton->system->n_smooth;
    }
    return agrees;
}

double dalcs_smooth_newton_excused(const struct dalcs_smooth_newton *newton, int q) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    double gradient[2];
    double by_line = 0.0;
    double by_tangent = fabs(dalcs_smooth_value(of->kind, newton->x[q]));
    dalcs_smooth_finite_gradient(of, newton->x[q], gradient);
    for (int j = 0; j < of->n; j++) {
        const bool is_read = of->column[j] >= 0;
        by_line += fabs(dalcs_smooth_line(of, j) * newton->x[q][j]);
        by_tangent += is_read ? fabs(gradient[j] * newton->x[q][j]) : 0.0;
    }
    const double off = fabs(dalcs_smooth_rest(of, newton->x[q]) - newton->phi[q]);
    return by_line > dalcs_beyond * by_tangent ? off + dalcs_answer_rounded * by_line : 0.0;
}

double dalcs_smooth_newton_tried(const struct dalcs_smooth_newton *newton, int q) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    return newton->phi[q] + dalcs_smooth_line(of, 0) * newton->x[q][0] +
           dalcs_smooth_line(of, 1) * newton->x[q][1];
}

/* Have all functions values there, and slopes? `newton->worst` has none. */
static bool is_finite(struct dalcs_smooth_newton *newton, bool *has_slopes) {
    bool is = true;
    *has_slopes = true;
    for (int q = 0; q < newton->n && is; q++) {
        const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
        double a[2];
        double gradient[2];
        for (int j = 0; j < 2; j++) {
            a[j] = dalcs_smooth_tangent_point(of->kind, newton->tangent[q][j], newton->x[q][j]);
        }
        dalcs_smooth_gradient(of->kind, a, gradient);
        const bool has = (isfinite(gradient[0]) || dalcs_smooth_root_exponent(of) > 0.0) &&
                         (of->column[1] < 0 || isfinite(gradient[1]));
        is = isfinite(dalcs_smooth_value(of->kind, a)) && !isnan(gradient[0]) &&
             (of->column[1] < 0 || !isnan(gradient[1]));
        *has_slopes = *has_slopes && has;
        newton->outcome.worst = is && has ? newton->outcome.worst : q % newton->system->n_smooth;
    }
    return is;
}

static void halve(struct dalcs_smooth_newton *newton) {
    newton->halved++;
    for (int q = 0; q < newton->n; q++) {
        newton->phi[q] = 0.5 * (newton->phi[q] + newton->before[q]);
    }
}

bool dalcs_smooth_newton_is_finite(struct dalcs_smooth_newton *newton, bool *repeats) {
    bool has_slopes;
    const bool is = is_finite(newton, &has_slopes) || newton->share == 0.0;
    has_slopes = has_slopes || newton->share == 0.0;
    const bool is_first = newton->n_steps == 0;
    *repeats = !(is && has_slopes) &&
               newton->halved < (is_first ? newton->system->n_smooth : MOST_HALVINGS);
    if (*repeats && !is_first) {
        halve(newton);
    }
    newton->halved += *repeats && is_first ? 1 : 0;
    for (int q = 0; q < newton->n && *repeats && is_first; q++) {
        dalcs_smooth_take_rest(dalcs_smooth_newton_input(newton, q), newton->x[q], &newton->phi[q]);
    }
    return is || *repeats;
}

/* Values against their own sizes: what the last factors make of what is left is to be less than the step was (the natural
 * monotonicity test; P. Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3). It has no units. */
bool dalcs_smooth_newton_overshoots(struct dalcs_smooth_newton *newton, double tolerance) {
    if (!newton->is_damped || newton->n_steps == 0 || newton->halved >= MOST_HALVINGS) {
        return false;
    }
    for (int q = 0; q < newton->n; q++) {
        newton->work.correction[q] =
            dalcs_smooth_rest_of_share(dalcs_smooth_newton_input(newton, q), newton->share,
                                       newton->x[q]) -
            newton->inner.next[q];
    }
    (void)LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'T', newton->n, 1, newton->work.matrix, newton->n,
                         newton->work.pivot, newton->work.correction, newton->n);
    double left = 0.0;
    double taken = 0.0;
    for (int q = 0; q < newton->n; q++) {
        const double size =
            is_excused(newton, q, tolerance)
                ? INFINITY
                : fabs(newton->before[q]) + fabs(newton->phi[q]) + fabs(newton->work.step[q]);
        left = size > 0.0 ? dalcs_larger(left, fabs(newton->work.correction[q]) / size) : left;
        taken = size > 0.0 ? dalcs_larger(taken, fabs(newton->work.step[q]) / size) : taken;
    }
    const bool overshoots = left > taken && taken > dalcs_small;
    if (overshoots) {
        halve(newton);
    }
    return overshoots;
}

void dalcs_smooth_newton_blame_pole(struct dalcs_smooth_newton *newton, int worst,
                                    const double *x) {
    newton->outcome.worst = worst;
    newton->outcome.at_pole = true;
    memcpy(newton->x[worst], x, sizeof(newton->x[worst]));
}

/* Row q of 1 - f'(a) S. */
static void put_row(struct dalcs_smooth_newton *newton, int q, const double *gradient) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    const int n = newton->n;
    double *row = newton->work.matrix + (size_t)q * (size_t)n;
    memset(row, 0, (size_t)n * sizeof(*row));
    row[q] = 1.0;
    for (int j = 0; j < of->n; j++) {
        const double *slope = newton->slope + (size_t)(2 * q + j) * (size_t)n;
        for (int p = 0; p < n && of->column[j] >= 0; p++) {
            row[p] -= gradient[j] * slope[p];
        }
    }
}

/* A row of a step, and what stands on its right. */
static void put_tangent(struct dalcs_smooth_newton *newton, int q) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    double *a = newton->tangent[q];
    double gradient[2];
    for (int j = 0; j < 2; j++) {
        a[j] = newton->is_damped ? newton->x[q][j]
                                 : dalcs_smooth_tangent_point(of->kind, a[j], newton->x[q][j]);
        newton->limits = newton->limits || a[j] != newton->x[q][j];
    }
    a[0] = dalcs_smooth_root_point(of, newton->share, a[0], newton->phi[q],
                                   newton->slope[(size_t)(2 * q) * (size_t)newton->n + (size_t)q]);
    dalcs_smooth_gradient_of_rest(of, newton->share, a, gradient);
    newton->work.step[q] = dalcs_smooth_rest_of_share(of, newton->share, a) - newton->phi[q];
    for (int j = 0; j < of->n; j++) {
        newton->work.step[q] += of->column[j] >= 0 ? gradient[j] * (newton->x[q][j] - a[j]) : 0.0;
    }
    put_row(newton, q, gradient);
}

/* The matrix has its rows one behind the other: its transpose by columns, for which LAPACKE needs no memory. */
static bool factor(struct dalcs_smooth_newton *newton) {
    return LAPACKE_dgetrf(LAPACK_COL_MAJOR, newton->n, newton->n, newton->work.matrix, newton->n,
                          newton->work.pivot) == 0;
}

/* What the others make of value q by its tangent, where it follows them by less than they move: to the rounding of its own
 * terms. The solution has it to the rounding of what it was before, of which a function that is flat has nothing: 0 behind
 * 1e-17 comes out as 1e-33. */
static double value_beside(const struct dalcs_smooth_newton *newton, int q) {
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    const double *a = newton->tangent[q];
    double gradient[2];
    double follows = 0.0;
    dalcs_smooth_gradient_of_rest(of, newton->share, a, gradient);
    double value = dalcs_smooth_rest_of_share(of, newton->share, a);
    for (int j = 0; j < of->n; j++) {
        const double *slope = newton->slope + (size_t)(2 * q + j) * (size_t)newton->n;
        value += of->column[j] >= 0 ? gradient[j] * (newton->x[q][j] - a[j]) : 0.0;
        for (int p = 0; p < newton->n && of->column[j] >= 0; p++) {
            value += gradient[j] * slope[p] * newton->work.step[p];
            follows += fabs(gradient[j] * slope[p]);
        }
    }
    return follows < 1.0 ? value : newton->before[q] + newton->work.step[q];
}

bool dalcs_smooth_newton_step(struct dalcs_smooth_newton *newton) {
    newton->limits = false;
    newton->halved = 0;
    newton->n_steps++;
    memcpy(newton->phi, newton->inner.next, (size_t)newton->n * sizeof(double));
    for (int q = 0; q < newton->n; q++) {
        put_tangent(newton, q);
    }
    bool is_solved =
        factor(newton) &&
        LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'T', newton->n, 1, newton->work.matrix, newton->n,
                       newton->work.pivot, newton->work.step, newton->n) == 0;
    memcpy(newton->before, newton->phi, (size_t)newton->n * sizeof(double));
    for (int q = 0; q < newton->n && is_solved; q++) {
        newton->phi[q] = value_beside(newton, q);
        is_solved = isfinite(newton->phi[q]);
    }
    return is_solved;
}

bool dalcs_smooth_newton_factor(struct dalcs_smooth_newton *newton) {
    for (int q = 0; q < newton->n; q++) {
        double gradient[2];
        dalcs_smooth_gradient_of_rest(dalcs_smooth_newton_input(newton, q), newton->share,
                                      newton->x[q], gradient);
        put_row(newton, q, gradient);
    }
    return factor(newton);
}

void dalcs_smooth_newton_vary(const struct dalcs_smooth_newton *newton, const double (*dx)[2],
                              double *change) {
    for (int q = 0; q < newton->n; q++) {
        const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
        double gradient[2];
        dalcs_smooth_gradient_of_rest(dalcs_smooth_newton_input(newton, q), newton->share,
                                      newton->x[q], gradient);
        change[q] = 0.0;
        for (int j = 0; j < of->n; j++) {
            change[q] += of->column[j] >= 0 ? gradient[j] * dx[q][j] : 0.0;
        }
    }
    (void)LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'T', newton->n, 1, newton->work.matrix, newton->n,
                         newton->work.pivot, change, newton->n);
}
