/* smooth_read.c - the arguments of smooth sources, from an answer. */
#include "extremes.h"
#include "magnitudes.h"
#include "rounding.h"
#include "smooth_newton.h"
#include "smooth_tangents.h"

#include <math.h>
#include <string.h>

void dalcs_smooth_arguments(const struct dalcs_system *system, const double *y, double (*x)[2]) {
    for (int k = 0; k < system->n_smooth; k++) {
        const struct dalcs_smooth_input *of = &system->smooth[k];
        for (int j = 0; j < 2; j++) {
            x[k][j] = j < of->n && of->column[j] >= 0 ? y[of->column[j]] : of->number[j];
        }
    }
}

static double largest_voltage(const struct dalcs_system *s, const double *y) {
    double volt = 0.0;
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        bool counts = !s->column_is_current[c] && !s->is_part[c];
        volt = counts ? dalcs_larger(volt, fabs(y[c])) : volt;
    }
    return volt;
}

/* What the lambda of a pair is made of: its own row, less itself, over its own part in that. Where a kink leaves 0 that is
 * the difference of what it reads. */
static double terms_of_pair(const struct dalcs_system *s, int pair, const double *y) {
    const int own = dalcs_system_n_equations(s) + pair;
    double most = 0.0;
    double part = 0.0;
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        const double size = fabs(s->C.x[k]);
        part = s->C.j[k] == own ? size : part;
        most = s->C.j[k] < own - pair ? dalcs_larger(most, size * fabs(y[s->C.j[k]])) : most;
    }
    return part > 0.0 ? most / part : 0.0;
}

static double largest_term(const struct dalcs_system *s, int row, const double *y) {
    const int n_equations = dalcs_system_n_equations(s);
    double most = 0.0;
    for (int k = s->A.p[row]; k < s->A.p[row + 1]; k++) {
        const int pair = s->A.j[k] - n_equations;
        const double size = pair >= 0 ? dalcs_larger(terms_of_pair(s, pair, y), fabs(y[s->A.j[k]]))
                                      : fabs(y[s->A.j[k]]);
        most = dalcs_larger(most, fabs(s->A.x[k]) * size);
    }
    return most;
}

/* Is the tangent of value q where its argument is? */
static bool is_near(const struct dalcs_smooth_newton *newton, int q) {
    const enum dalcs_smooth_kind kind = dalcs_smooth_newton_input(newton, q)->kind;
    const double *from = newton->tangent[q];
    const double *x = newton->x[q];
    return dalcs_smooth_tangent_point(kind, from[0], x[0]) == x[0] &&
           dalcs_smooth_tangent_point(kind, from[1], x[1]) == x[1];
}

/* Of a function that only functions read: the value that it has, and the arguments of those that read it. What these put out
 * stays, their lines included. `at` is the first of its links. */
static void settle(struct dalcs_smooth_newton *newton, int q, const double *y, int at) {
    struct dalcs_smooth_inner *inner = &newton->inner;
    const int k = q % newton->system->n_smooth;
    const struct dalcs_smooth_input *of = dalcs_smooth_newton_input(newton, q);
    const double value =
        dalcs_smooth_share(newton->share, dalcs_smooth_value(of->kind, newton->x[q]));
    const double rest = dalcs_smooth_rest_of_share(of, newton->share, newton->x[q]);
    if (inner->column[k] < 0 || !isfinite(value) || !isfinite(rest) ||
        !(newton->is_damped || is_near(newton, q))) {
        return;
    }
    inner->next[q] = rest;
    for (; at < inner->n_links && inner->link[at].k == k; at++) {
        const struct dalcs_smooth_link *link = &inner->link[at];
        const int reader = q - k + link->of;
        const double change = link->factor * (value - y[inner->column[k]]);
        newton->x[reader][link->j] += change;
        inner->next[reader] -=
            dalcs_smooth_line(dalcs_smooth_newton_input(newton, reader), link->j) * change;
    }
}

/* Arguments as functions have them that have a value within rounding alone, and as those that are read have values. */
static void hold(struct dalcs_smooth_newton *newton, int first, const double *y) {
    const struct dalcs_smooth_inner *inner = &newton->inner;
    int at = 0;
    memcpy(inner->next + first, newton->phi + first,
           (size_t)newton->system->n_smooth * sizeof(double));
    for (int k = 0; k < newton->system->n_smooth; k++) {
        /* What reads 0 alone has no terms but itself: it is known to the rounding of the voltages. */
        const int q = first + k;
        const double off =
            dalcs_larger(dalcs_alike * newton->terms[q][0], dalcs_rounded * newton->volt);
        newton->x[q][0] =
            dalcs_smooth_held(dalcs_smooth_newton_input(newton, q)->kind, newton->x[q], off);
        if (inner->n_links > 0) {
            settle(newton, q, y, at);
        }
        for (; at < inner->n_links && inner->link[at].k == k; at++) {
        }
    }
}

void dalcs_smooth_newton_read(struct dalcs_smooth_newton *newton, int point, const double *y) {
    const struct dalcs_system *s = newton->system;
    const int first = point * s->n_smooth;
    const double volt = largest_voltage(s, y);
    newton->volt = dalcs_larger(newton->volt, volt);
    dalcs_smooth_arguments(s, y, newton->x + first);
    for (int k = 0; k < s->n_smooth; k++) {
        const struct dalcs_smooth_input *of = &s->smooth[k];
        for (int j = 0; j < of->n; j++) {
            const bool is_part = of->column[j] >= 0 && s->is_part[of->column[j]];
            newton->terms[first + k][j] = of->column[j] < 0    ? 0.0
                                          : of->row_of[j] >= 0 ? largest_term(s, of->row_of[j], y)
                                          : is_part            ? fabs(newton->x[first + k][j])
                                                               : volt;
        }
    }
    hold(newton, first, y);
}
