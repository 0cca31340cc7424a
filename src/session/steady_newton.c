/* steady_newton.c - a step of Newton's method for Phi(x) = x: (1 - M) d = Phi(x) - x, system by system.
 *
 * Where 1 - M is singular, M has a multiplier of 1. Its left vectors w are quantities that every period
 * leaves what they are, w'x, the charge of a floating node: if Phi(x) - x has no part of them, any amount of
 * them belongs to a steady state, and the step keeps the one there is, as a run would; else they grow from
 * period to period, and in this piece of the map there is no steady state. */
#include "steady_step.h"

#include "magnitudes.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

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
    if (st->layout.memory.n_numbers > 0) { /* times and voltages of gates have no energies */
        return 1.0 / (scale > 0.0 ? scale : 1.0);
    }
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
 * whether that can be: not in a Jordan block, as of two integrators in a row, where they are at right angles. */
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
    bool can = m == 0 || LAPACKE_dgesv(LAPACK_COL_MAJOR, m, 1, G, m, w->pivot, c, m) == 0;
    for (int i = 0; i < m; i++) {
        can = can && fabs(G[i * m + i]) > is_singular;
    }
    for (int j = 0; j < m && can; j++) {
        for (int x = 0; x < w->n; x++) {
            vector[x] -= c[j] * w->Vt[x * w->n + first + j];
        }
    }
    return can;
}

/* How much of the vector is along a left vector; 0: no more than rounding. */
static double part_of(const struct newton *w, int k, const double *vector) {
    const double part = dot(w->U + (size_t)k * (size_t)w->n, vector, w->n);
    return fabs(part) > grows * sqrt(dot(vector, vector, w->n)) ? part : 0.0;
}

static enum dalcs_status note_conserved(struct dalcs_steady *st, int system, const struct newton *w,
                                        int vector) {
    struct dalcs_steady_conserved *c = &st->kept.of[st->kept.n];
    c->system = system;
    c->growth = part_of(w, vector, w->F);
    c->weight = dalcs_arena_alloc(&st->arena, (size_t)w->n, sizeof(double));
    if (c->weight == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < w->n; x++) {
        c->weight[x] = w->U[vector * w->n + x] * w->unit[x];
    }
    st->kept.n++;
    return DALCS_OK;
}

/* w->A = M in the units. */
static void put_map(struct newton *w, const double *M) {
    for (int k = 0; k < w->n; k++) {
        for (int x = 0; x < w->n; x++) {
            w->A[k * w->n + x] = w->unit[x] * M[k * w->n + x] / w->unit[k];
        }
    }
}

/* 1 - M = U s Vt, of M in w->A. */
static enum dalcs_status decompose(struct newton *w) {
    const int n = w->n;
    for (int k = 0; k < n; k++) {
        for (int x = 0; x < n; x++) {
            w->A[k * n + x] = (x == k ? 1.0 : 0.0) - w->A[k * n + x];
        }
    }
    const int failed = LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'A', 'A', n, n, w->A, n, w->s, w->U, n,
                                      w->Vt, n, w->superb);
    return failed == 0                          ? DALCS_OK
           : failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM
                                                : DALCS_SINGULAR;
}

/* The number of singular values that are rounding: the last ones. */
static int count_rounding(const struct newton *w) {
    int m = 0;
    while (m < w->n && !(w->s[w->n - 1 - m] > is_singular * fmax(1.0, w->s[0]))) {
        m++;
    }
    return m;
}

enum dalcs_status dalcs_steady_balance(int n, const double *M, double *unit, double *work) {
    double *A = work + n;
    double largest = 0.0;
    int low;
    int high;
    for (int k = 0; k < n; k++) {
        for (int x = 0; x < n; x++) {
            A[k * n + x] = unit[x] * M[k * n + x] / unit[k];
            largest = fmax(largest, fabs(A[k * n + x]));
        }
    }
    for (int i = 0; i < n * n; i++) {
        A[i] = fabs(A[i]) > DBL_EPSILON * largest ? A[i] : 0.0;
    }
    if (LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, A, n, &low, &high, work) != 0) {
        return DALCS_SINGULAR;
    }
    for (int k = 0; k < n; k++) {
        unit[k] /= work[k];
    }
    return DALCS_OK;
}

/* Energies of a state of a control and of what it commands have nothing to do with each other: M is far from normal, and
 * a slow control looks like a conserved quantity. What is conserved is so in units that balance M, too; else those are
 * taken. */
static enum dalcs_status look_closer(struct newton *w, const double *M) {
    const int m = count_rounding(w);
    double *before = w->rest; /* not in use yet */
    memcpy(before, w->unit, (size_t)w->n * sizeof(double));
    DALCS_TRY(dalcs_steady_balance(w->n, M, w->unit, w->c));
    put_map(w, M);
    DALCS_TRY(decompose(w));
    if (count_rounding(w) < m) {
        return DALCS_OK;
    }
    memcpy(w->unit, before, (size_t)w->n * sizeof(double));
    put_map(w, M);
    return decompose(w);
}

/* F = Phi(x) - x in the units. */
static void find_defect(const struct dalcs_steady *st, int system, struct newton *w) {
    const int first = st->layout.first[system];
    for (int x = 0; x < w->n; x++) {
        w->F[x] = w->unit[x] * (st->then.x[first + x] - st->at.x[first + x]);
    }
}

/* Have the last m left vectors a part of the vector? */
static bool has_conserved(const struct newton *w, int m, const double *vector) {
    bool has = false;
    for (int k = w->n - m; k < w->n; k++) {
        has = has || part_of(w, k, vector) != 0.0;
    }
    return has;
}

/* (1 - M) d = w->rest, F but for what grows each period: that goes on along right vectors, which M leaves what they are. Of d
 * what is conserved has no part; where that cannot be, nothing periodic has what the run has. */
static enum dalcs_status solve(struct dalcs_steady *st, int system, struct newton *w) {
    const int n = w->n;
    const int m = count_rounding(w);
    for (int x = 0; x < n; x++) {
        w->rest[x] = w->F[x];
    }
    (void)part_conserved(w, m, w->rest);
    for (int k = 0; k < n - m; k++) {
        const double part = dot(w->U + (size_t)k * (size_t)n, w->rest, n);
        for (int x = 0; x < n; x++) {
            w->d[x] += w->Vt[x * n + k] * part / w->s[k];
        }
    }
    for (int k = n - m; k < n; k++) {
        DALCS_TRY(note_conserved(st, system, w, k));
    }
    const bool is_kept = part_conserved(w, m, w->d) || !has_conserved(w, m, w->d);
    st->kept.is_stuck = st->kept.is_stuck || !is_kept || has_conserved(w, m, w->F);
    return DALCS_OK;
}

/* The largest sum of magnitudes of a column, or with the steps the other way round of a row. */
static double largest_sum(const double *A, int n, int to_next, int within) {
    double largest = 0.0;
    for (int k = 0; k < n; k++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++) {
            sum += fabs(A[k * to_next + i * within]);
        }
        largest = fmax(largest, sum);
    }
    return largest;
}

/* Triangles of 1 - M, of M in w->A, into w->U. Are all singular values above rounding? They lie between the roots of
 * |A|_1 |A|_inf of 1 - M and of its inverse, estimated (N. J. Higham, ACM Trans. Math. Softw. 14, 1988). Where the answer
 * is no, singular values tell, which take ten times as long. */
static bool is_regular(struct newton *w) {
    const int n = w->n;
    double *A = w->U;
    double rcond[2] = {0.0, 0.0};
    for (int i = 0; i < n * n; i++) {
        A[i] = (i % (n + 1) == 0 ? 1.0 : 0.0) - w->A[i];
    }
    const double one = largest_sum(A, n, n, 1);
    const double all = largest_sum(A, n, 1, n);
    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, A, n, w->pivot) != 0 ||
        LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', n, A, n, one, &rcond[0]) != 0 ||
        LAPACKE_dgecon(LAPACK_COL_MAJOR, 'I', n, A, n, all, &rcond[1]) != 0) {
        return false;
    }
    const double largest = sqrt(one * all);
    const double least = sqrt(rcond[0] * one * rcond[1] * all) / dalcs_beyond;
    return least > is_singular * fmax(1.0, largest);
}

/* d = (1 - M)^-1 F, by triangles where these do. */
static enum dalcs_status solve_or_part(struct dalcs_steady *st, int system, struct newton *w,
                                       const double *M) {
    const size_t n = (size_t)w->n;
    if (is_regular(w)) {
        memcpy(w->d, w->F, n * sizeof(double));
        memcpy(w->rest, w->F, n * sizeof(double));
        return LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', w->n, 1, w->U, w->n, w->pivot, w->d, w->n) == 0
                   ? DALCS_OK
                   : DALCS_SINGULAR;
    }
    DALCS_TRY(decompose(w));
    if (count_rounding(w) > 0) {
        DALCS_TRY(look_closer(w, M));
        find_defect(st, system, w);
    }
    return solve(st, system, w);
}

static enum dalcs_status newton_of(struct dalcs_steady *st, int system, struct dalcs_arena *arena) {
    const int first = st->layout.first[system];
    const double *M = st->pass.M + st->layout.first_of_M[system];
    struct newton w = {.n = st->layout.first[system + 1] - first};
    if (w.n == 0) {
        return DALCS_OK;
    }
    if (!make_room(&w, arena)) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < w.n; x++) {
        w.unit[x] = dalcs_steady_unit(st, system, x);
    }
    put_map(&w, M);
    find_defect(st, system, &w);
    DALCS_TRY(solve_or_part(st, system, &w, M));
    for (int x = 0; x < w.n; x++) {
        st->step[first + x] = w.d[x] / w.unit[x];
        st->kept.drift[first + x] = (w.F[x] - w.rest[x]) / w.unit[x];
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_newton(struct dalcs_steady *st) {
    struct dalcs_arena arena = {0};
    enum dalcs_status status = DALCS_OK;
    st->kept.is_stuck = false;
    st->kept.n = 0;
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

bool dalcs_steady_has_drift(const struct dalcs_steady *st) {
    bool has = false;
    for (int x = 0; x < st->layout.n_x; x++) {
        has = has || st->kept.drift[x] != 0.0;
    }
    return has;
}
