/* steady_free.c - a step of Newton's method for a state and a period: Phi(x, T) = x of a circuit that has no clock.
 *
 * Where the sources are constant an orbit may begin anywhere on itself, and M has the multiplier 1 of its flow: M f = f.
 * So a step d is to leave the first event of the pass, at t1, where it is, and the period takes the place of what that
 * leaves out:
 *
 *     (1 - M) d - f- dT = Phi(x, T) - x,     dt1/dx d = 0
 *
 * with the derivatives f- of the states where the pass ends. What is slow may be far away: the step is long then, but it
 * stays between the same events, where one that is orthogonal to the flow would leave them along it. Without an event d
 * is orthogonal to the flow, in units in which energies are alike. Either is regular where 1 is a simple multiplier;
 * where it is not, a quantity is conserved, and the least step keeps it nearly. */
#include "steady_step.h"

#include <lapacke.h>
#include <math.h>

/* As in steady_newton.c. */
static const double is_singular = 1e-9;

/* No step changes the period by more than this part of it: farther away Phi is another one. */
static const double most_change = 0.3;

struct bordered {
    int n;         /* states and the period */
    double *unit;  /* [n - 1] what states are multiplied by */
    double *A, *b; /* [n][n] column after column, [n] */
    double *s;     /* [n] work */
    double *work;  /* [n + n^2] */
};

static bool make_room(struct bordered *w, struct dalcs_arena *arena) {
    const size_t n = (size_t)w->n;
    w->unit = dalcs_arena_alloc(arena, n, sizeof(double));
    w->A = dalcs_arena_alloc(arena, n * n, sizeof(double));
    w->b = dalcs_arena_alloc(arena, n, sizeof(double));
    w->s = dalcs_arena_alloc(arena, n, sizeof(double));
    w->work = dalcs_arena_alloc(arena, n + n * n, sizeof(double));
    return w->unit != NULL && w->A != NULL && w->b != NULL && w->s != NULL && w->work != NULL;
}

static void fill_system(const struct dalcs_steady *st, int system, struct bordered *w) {
    const int first = st->layout.first[system];
    const int n = st->layout.first[system + 1] - first;
    const double *M = st->pass.M + st->layout.first_of_M[system];
    for (int k = 0; k < n; k++) {
        for (int x = 0; x < n; x++) {
            w->A[(first + k) * w->n + first + x] =
                (x == k ? 1.0 : 0.0) - w->unit[first + x] * M[k * n + x] / w->unit[first + k];
        }
    }
}

/* The row of the phase is of length 1, the column of the period that of its change over the period. */
static bool fill_border(const struct dalcs_steady *st, struct bordered *w) {
    const int n = w->n - 1;
    double size = 0.0;
    double of_event = 0.0;
    for (int x = 0; x < n; x++) {
        size = hypot(size, w->unit[x] * st->pass.first[x]);
        of_event = hypot(of_event, st->pass.phase[x] / w->unit[x]);
        w->b[x] = w->unit[x] * (st->then.x[x] - st->at.x[x]);
        w->A[n * w->n + x] = -w->unit[x] * st->pass.last[x] * st->period;
    }
    for (int x = 0; x < n && size > 0.0; x++) {
        w->A[x * w->n + n] = of_event > 0.0 ? st->pass.phase[x] / w->unit[x] / of_event
                                            : w->unit[x] * st->pass.first[x] / size;
    }
    return size > 0.0;
}

/* The step into w->b. */
static enum dalcs_status solve_in_units(const struct dalcs_steady *st, struct bordered *w,
                                        int *rank) {
    for (int k = 0; k < st->layout.n_systems; k++) {
        fill_system(st, k, w);
    }
    if (!fill_border(st, w)) {
        return DALCS_SINGULAR; /* nothing moves */
    }
    const int failed = LAPACKE_dgelss(LAPACK_COL_MAJOR, w->n, w->n, 1, w->A, w->n, w->b, w->n, w->s,
                                      is_singular, rank);
    return failed == 0                          ? DALCS_OK
           : failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM
                                                : DALCS_SINGULAR;
}

static void take_energies(const struct dalcs_steady *st, struct bordered *w) {
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        for (int x = first; x < st->layout.first[k + 1]; x++) {
            w->unit[x] = dalcs_steady_unit(st, k, x - first);
        }
    }
}

/* As in steady_newton.c, what is conserved is so in units that balance M, too; else those are taken. */
static enum dalcs_status look_closer(const struct dalcs_steady *st, struct bordered *w, int *rank) {
    const int before = *rank;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        DALCS_TRY(dalcs_steady_balance(st->layout.first[k + 1] - first,
                                       st->pass.M + st->layout.first_of_M[k], w->unit + first,
                                       w->work));
    }
    DALCS_TRY(solve_in_units(st, w, rank));
    if (*rank > before) {
        return DALCS_OK;
    }
    take_energies(st, w);
    return solve_in_units(st, w, rank);
}

static enum dalcs_status solve(struct dalcs_steady *st, struct bordered *w, double *by) {
    const int n = w->n - 1;
    int rank;
    take_energies(st, w);
    DALCS_TRY(solve_in_units(st, w, &rank));
    if (rank < w->n) {
        DALCS_TRY(look_closer(st, w, &rank));
    }
    const double factor = fmin(1.0, most_change / fabs(w->b[n]));
    st->own.n = w->n - rank;
    *by = factor * w->b[n] * st->period;
    st->distance = fabs(w->b[n]);
    for (int x = 0; x < n; x++) {
        st->step[x] = factor * w->b[x] / w->unit[x];
        const double off = fabs(st->step[x]);
        st->distance = off > 0.0 ? fmax(st->distance, off / st->scale[x]) : st->distance;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_newton_free(struct dalcs_steady *st, double *by) {
    struct dalcs_arena arena = {0};
    struct bordered w = {.n = st->layout.n_x + 1};
    enum dalcs_status status = make_room(&w, &arena) ? solve(st, &w, by) : DALCS_E_NOMEM;
    dalcs_arena_finish(&arena);
    return status;
}
