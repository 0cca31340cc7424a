/* smooth.c - one-step problems with smooth sources: Newton's method around the problem with given ones.
 *
 * For given values of these sources the problem is piecewise affine in them, and the slope of what they read is that of
 * the mode in which it was solved (a semismooth Newton method; Qi and Sun 1993). A refusal of such a problem says nothing
 * of the whole. */
#include "osnsp_internal.h"
#include "smooth_newton.h"

#include <math.h>

/* Newton's method doubles its digits with each step once it is near, and a limited exponential takes a step for each
 * e-fold that it is off: 700 of them are all that a double has. */
enum { MOST_STEPS = 1000 };

enum dalcs_status dalcs_osnsp_smooth_setup(struct dalcs_osnsp *p) {
    if (p->system->n_smooth == 0) {
        return DALCS_OK;
    }
    p->newton = dalcs_arena_alloc(&p->arena, 1, sizeof(*p->newton));
    p->given = dalcs_arena_alloc(&p->arena, (size_t)(p->system->n_x + p->system->n_inputs),
                                 sizeof(*p->given));
    return p->newton != NULL && p->given != NULL
               ? dalcs_smooth_newton_setup(p->newton, p->system, 1, &p->arena)
               : DALCS_E_NOMEM;
}

static void put_sources(const struct dalcs_osnsp *p, double *u) {
    const struct dalcs_system *s = p->system;
    for (int k = 0; k < s->n_smooth; k++) {
        u[s->n_x + s->smooth[k].input] = p->newton->phi[k];
    }
}

/* What a change of each source does to the arguments in the present mode: a difference, exact as all is affine there. */
static void find_slope(struct dalcs_osnsp *p, double *u, double *y) {
    const struct dalcs_system *s = p->system;
    struct dalcs_smooth_newton *n = p->newton;
    for (int k = 0; k < s->n_smooth; k++) {
        const double change = 1.0 + fabs(n->phi[k]);
        bool clash;
        u[s->n_x + s->smooth[k].input] += change;
        bool is_known = dalcs_osnsp_try_mode(p, u, y, &clash) == DALCS_OK;
        for (int q = 0; q < s->n_smooth; q++) {
            for (int j = 0; j < 2; j++) {
                const int column = j < s->smooth[q].n ? s->smooth[q].column[j] : -1;
                n->slope[(2 * q + j) * n->n + k] =
                    column >= 0 && is_known ? (y[column] - n->x[q][j]) / change : 0.0;
            }
        }
        u[s->n_x + s->smooth[k].input] = n->phi[k];
    }
}

enum dalcs_status dalcs_osnsp_solve_smooth(
    struct dalcs_osnsp *p, double sigma, const double *u, double *y,
    enum dalcs_status (*solve)(struct dalcs_osnsp *p, double sigma, const double *u, double *y)) {
    const struct dalcs_system *s = p->system;
    struct dalcs_smooth_newton *n = p->newton;
    double *given = p->given;
    memcpy(given, u, (size_t)(s->n_x + s->n_inputs) * sizeof(*given));
    dalcs_smooth_newton_begin(n);
    enum dalcs_status status = DALCS_NOT_CONVERGED;
    bool agrees = false;
    for (int step = 0; step < MOST_STEPS && !agrees; step++) {
        put_sources(p, given);
        status = solve(p, sigma, given, y);
        if (status != DALCS_OK) {
            break;
        }
        status = DALCS_NOT_CONVERGED;
        dalcs_smooth_newton_read(n, 0, y);
        bool repeats;
        bool is_done;
        if (!dalcs_smooth_newton_is_finite(n, &repeats)) {
            break;
        }
        agrees = !repeats &&
                 dalcs_smooth_newton_agrees(n, p->options.certificate_tolerance, &is_done) &&
                 is_done;
        if (!repeats && !agrees) {
            find_slope(p, given, y);
            if (!dalcs_smooth_newton_step(n)) {
                break;
            }
        }
    }
    return agrees ? DALCS_OK : status == DALCS_INFEASIBLE ? DALCS_NOT_CONVERGED : status;
}
