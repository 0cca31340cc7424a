/* steady_newton.c - a step of Newton's method for Phi(x) = x: (1 - M) d = Phi(x) - x, system by system.
 *
 * Where 1 - M is singular, M has a multiplier of 1. Its left vectors w are quantities that every period
 * leaves what they are, w'x, the charge of a floating node: if Phi(x) - x has no part of them, any amount of
 * them belongs to a steady state, and the step keeps the one there is, as a run would; else they grow from
 * period to period, and in this piece of the map there is no steady state. */
#include "steady.h"

#include <lapacke.h>
#include <math.h>

/* Singular values of 1 - M below this part of the largest, or of 1, are rounding: of M, with states in units in which
 * energies are alike, and of the tolerance that its run was held to. */
static const double is_singular = 1e-9;

/* A quantity grows if it makes up more than this part of the defect, in the same units. */
static const double grows = 1e-6;

/* One system's; [n] and [n][n] column after column. */
struct newton {
    int n;
    double *unit;       /* what states are multiplied by */
    double *A, *U, *Vt; /* 1 - M = U s Vt */
    double *s, *superb;
    double *F, *d;
    double *rest; /* of F without what grows each period */
    double *c;    /* [n + n^2] work */
    int *pivot;
};

static bool make_room(struct newton *w, struct dalcs_arena *arena) {
    const size_t n = (size_t)w->n;
    w->unit = dalcs_arena_alloc(arena, n, sizeof(double));
    w->A = dalcs_arena_alloc(arena, n * n, sizeof(double));
    w->U = dalcs_arena_alloc(arena, n * n, sizeof(double));
    w->Vt = dalcs_arena_alloc(arena, n * n, sizeof(double));
    w->s = dalcs_arena_alloc(arena, n, sizeof(double));
    w->superb = dalcs_arena_alloc(arena, n, sizeof(double));
    w->F = dalcs_arena_alloc(arena, n, sizeof(double));
    w->d = dalcs_arena_alloc(arena, n, sizeof(double));
    w->rest = dalcs_arena_alloc(arena, n, sizeof(double));
    w->c = dalcs_arena_alloc(arena, n + n * n, sizeof(double));
    w->pivot = dalcs_arena_alloc(arena, n, sizeof(int));
    return w->unit != NULL && w->A != NULL && w->U != NULL && w->Vt != NULL && w->s != NULL &&
           w->superb != NULL && w->F != NULL && w->d != NULL && w->rest != NULL && w->c != NULL &&
           w->pivot != NULL;
}

double dalcs_steady_unit(const struct dalcs_steady *st, int system, int x) {
    const struct dalcs_system *s = &st->run->s->network.system[system];
    const double scale = st->scale[st->layout.first[system] + x];
    double stored = 0.0;
    for (int k = s->storage.p[x]; k < s->storage.p[x + 1]; k++) {
        stored += s->storage.j[k] == x ? s->storage.x[k] : 0.0;
    }
    return stored > 0.0 ? sqrt(stored) : 1.0 / (scale > 0.0 ? scale : 1.0);
}

static double dot(const double *a, const double *b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* vector -= sum of the last m right vectors, such that the last m left vectors have no part of the rest. Returns
 * whether that can be. */
static bool part_conserved(struct newton *w, int m, double *vector) {
    const int first = w->n - m;
    double *c = w->c;
    double *G = w->c + w->n;
    for (int i = 0; i < m; i++) {
        const double *left = w->U + (size_t)(first + i) * (size_t)w->n;
        c[i] = dot(left, vector, w->n);
        for (int j = 0; j < m; j++) {
            G[j * m + i] = 0.0;
            for (int x = 0; x < w->n; x++) {
                G[j * m + i] += left[x] * w->Vt[x * w->n + first + j];
            }
        }
    }
    if (m == 0 || LAPACKE_dgesv(LAPACK_COL_MAJOR, m, 1, G, m, w->pivot, c, m) != 0) {
        return m == 0;
    }
    for (int j = 0; j < m; j++) {
        for (int x = 0; x < w->n; x++) {
            vector[x] -= c[j] * w->Vt[x * w->n + first + j];
        }
    }
    return true;
}

static enum dalcs_status note_conserved(struct dalcs_steady *st, int system, const struct newton *w,
                                        int vector) {
    struct dalcs_steady_conserved *c = &st->conserved[st->n_conserved];
    c->system = system;
    c->weight = dalcs_arena_alloc(&st->arena, (size_t)w->n, sizeof(double));
    if (c->weight == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < w->n; x++) {
        c->weight[x] = w->U[vector * w->n + x] * w->unit[x];
    }
    st->n_conserved++;
    return DALCS_OK;
}

static enum dalcs_status solve(struct dalcs_steady *st, int system, struct newton *w) {
    const int n = w->n;
    const int failed = LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'A', 'A', n, n, w->A, n, w->s, w->U, n,
                                      w->Vt, n, w->superb);
    if (failed != 0) {
        return failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM : DALCS_SINGULAR;
    }
    int m = 0;
    const double size = sqrt(dot(w->F, w->F, n));
    for (int k = 0; k < n; k++) {
        double part = dot(w->U + (size_t)k * (size_t)n, w->F, n);
        if (!(w->s[k] > is_singular * fmax(1.0, w->s[0]))) {
            m++;
            st->is_stuck = st->is_stuck || fabs(part) > grows * size;
            DALCS_TRY(note_conserved(st, system, w, k));
            continue;
        }
        for (int x = 0; x < n; x++) {
            w->d[x] += w->Vt[x * n + k] * part / w->s[k];
        }
    }
    (void)part_conserved(w, m, w->d);
    for (int x = 0; x < n; x++) {
        w->rest[x] = w->F[x];
    }
    (void)part_conserved(w, m, w->rest);
    return DALCS_OK;
}

static enum dalcs_status newton_of(struct dalcs_steady *st, int system, struct dalcs_arena *arena) {
    const struct dalcs_system *s = &st->run->s->network.system[system];
    const int first = st->layout.first[system];
    const double *M = st->M + st->layout.first_of_M[system];
    struct newton w = {.n = s->n_x};
    if (w.n == 0) {
        return DALCS_OK;
    }
    if (!make_room(&w, arena)) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < w.n; x++) {
        w.unit[x] = dalcs_steady_unit(st, system, x);
        w.F[x] = w.unit[x] * (st->then.x[first + x] - st->at.x[first + x]);
    }
    for (int k = 0; k < w.n; k++) {
        for (int x = 0; x < w.n; x++) {
            w.A[k * w.n + x] = (x == k ? 1.0 : 0.0) - w.unit[x] * M[k * w.n + x] / w.unit[k];
        }
    }
    DALCS_TRY(solve(st, system, &w));
    for (int x = 0; x < w.n; x++) {
        st->step[first + x] = w.d[x] / w.unit[x];
        st->drift[first + x] = (w.F[x] - w.rest[x]) / w.unit[x];
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_newton(struct dalcs_steady *st) {
    struct dalcs_arena arena = {0};
    enum dalcs_status status = DALCS_OK;
    st->is_stuck = false;
    st->n_conserved = 0;
    st->distance = 0.0;
    for (int k = 0; k < st->layout.n_systems && status == DALCS_OK; k++) {
        status = newton_of(st, k, &arena);
    }
    for (int x = 0; x < st->layout.n_x && status == DALCS_OK; x++) {
        double off = fabs(st->step[x]);
        st->distance = off > 0.0 ? fmax(st->distance, off / st->scale[x]) : st->distance;
    }
    dalcs_arena_finish(&arena);
    return status;
}
