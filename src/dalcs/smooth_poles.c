/* smooth_poles.c - poles of smooth functions. */
#include "smooth_poles.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>

/* The argument that is 0 at a pole, of these arguments; -1: there is none. */
static int pole_argument(const struct dalcs_smooth_input *of, const double *x) {
    switch (of->kind) {
    case DALCS_SMOOTH_QUOTIENT:
        return 1;
    case DALCS_SMOOTH_TAN:
        return 0;
    case DALCS_SMOOTH_POWER:
    case DALCS_SMOOTH_MAGNITUDE_POWER:
    case DALCS_SMOOTH_SIGNED_POWER:
        return x[1] < 0.0 ? 0 : -1;
    default:
        return -1;
    }
}

/* Is the function 0 where an argument is? */
static bool is_zero_with_it(const struct dalcs_smooth_input *of, int j, const double *x) {
    switch (of->kind) {
    case DALCS_SMOOTH_PRODUCT:
    case DALCS_SMOOTH_SQUARE:
        return true;
    case DALCS_SMOOTH_POWER:
    case DALCS_SMOOTH_MAGNITUDE_POWER:
    case DALCS_SMOOTH_SIGNED_POWER:
        return j == 0 && x[1] > 0.0;
    default:
        return false;
    }
}

bool dalcs_smooth_may_have_poles(const struct dalcs_system *system) {
    static const double negative[2] = {-1.0, -1.0};
    bool may = false;
    for (int k = 0; k < system->n_smooth && !may; k++) {
        const struct dalcs_smooth_input *of = &system->smooth[k];
        const int j = pole_argument(of, of->n > 1 && of->column[1] < 0 ? of->number : negative);
        may = j >= 0 && of->column[j] >= 0;
    }
    return may;
}

double dalcs_smooth_zero(const struct dalcs_smooth_input *of, int j, const double *x) {
    return of->kind == DALCS_SMOOTH_TAN ? cos(x[j]) : x[j];
}

bool dalcs_smooth_turns(const struct dalcs_smooth_input *of, int j, const double *before,
                        const double *after) {
    const double a = j < of->n && of->column[j] >= 0 ? dalcs_smooth_zero(of, j, before) : 0.0;
    const double b = a != 0.0 ? dalcs_smooth_zero(of, j, after) : 0.0;
    return (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0);
}

/* Of numbers that are answers, and of others up to `most`. */
static bool is_alike(double a, double b, double most) {
    return fabs(a - b) <= dalcs_alike * fabs(b) + dalcs_answer_rounded * most;
}

/* Does source m divide by what source k is, on both sides? */
static bool divides_by(const struct dalcs_system *system, int m, int k,
                       const struct dalcs_smooth_places *p) {
    const enum dalcs_smooth_kind kind = system->smooth[k].kind;
    return system->smooth[m].kind == DALCS_SMOOTH_QUOTIENT &&
           is_alike(p->before[m][1], dalcs_smooth_value(kind, p->before[k]), p->most[m][1]) &&
           is_alike(p->after[m][1], dalcs_smooth_value(kind, p->after[k]), p->most[m][1]);
}

/* Is what source m divides something there? */
static bool is_something(const struct dalcs_system *system, int m,
                         const struct dalcs_smooth_places *p) {
    return system->smooth[m].kind != DALCS_SMOOTH_QUOTIENT ||
           fabs(p->at[m][0]) > p->tolerance * p->most[m][0];
}

int dalcs_smooth_pole(const struct dalcs_system *system, int k, int j,
                      const struct dalcs_smooth_places *p) {
    const struct dalcs_smooth_input *of = &system->smooth[k];
    if (pole_argument(of, p->at[k]) == j) {
        return is_something(system, k, p) ? k : -1;
    }
    int found = -1;
    for (int m = 0; m < system->n_smooth && found < 0 && is_zero_with_it(of, j, p->at[k]); m++) {
        found = divides_by(system, m, k, p) && is_something(system, m, p) ? m : -1;
    }
    return found;
}
