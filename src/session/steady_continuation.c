/* steady_continuation.c - from far away: leaps of k periods, with k as large as helps.
 *
 * In the time n of periods the states of a run go by dx/dn = Phi(x) - x. A step of implicit Euler of k periods is
 *
 *     (1 + 1/k - M) d = Phi(x) - x,
 *
 * which is Newton's method for k without end, and a run for k small: pseudo-transient continuation (Kelley and Keyes,
 * SIAM J. Numer. Anal. 35, 1998), with k as far as Phi(x) - x falls (Mulder and van Leer, J. Comput. Phys. 59, 1985). A
 * long ladder of diodes and capacitors needs it: where the charge has not yet come to the load Newton's method
 * leads to where no capacitor can be. Plain periods behind each leap take back what the modes did not know: they cost
 * as much as M does.
 *
 * The period map of a passive circuit moves no two states away from each other, in units in which energies are alike:
 * so Phi(x) - x never grows along a run, and a leap behind which it has grown is none. In a circuit with a control, or with
 * impulses that M does not know from far away, many are none. So it ends behind more of them than the run has had periods
 * that did not help: what a search takes for leaps goes with what it takes for the run.
 *
 * The numbers below are no thresholds of an answer: each of them a tenth or ten times as large, multipliers of 10 to 40
 * stages take 10 to 28 steps and 50 to 435 periods. */
#include "steady_step.h"

#include <lapacke.h>
#include <math.h>

enum { MOST_LEAPS = 60 };

/* Periods: of the first leap; of one that is as good as a step of Newton's method. In a leap of k periods a quantity
 * that is conserved changes by its rounding times k: so that it stays within 1e-10, which a steady state may be off by. */
static const double first_leap = 4.0, longest = 1e6;

/* A leap that helps makes the next one longer by this factor, besides by how much it helped. */
static const double longer_by = 4.0;

/* Where a leap of that length leaves no more than this part, Newton's method has come near. */
static const double near = 0.1;

/* Columns of M that cost as much as a period: 40 periods for the 160 columns of a multiplier with 80 stages. */
enum { COLUMNS_OF_A_PERIOD = 4 };

/* Plain periods behind a leap, at most. A multiplier with 80 stages takes 40 passes with M for 2 of them, 33 for 5, 29 for
 * 11, 24 for 21, 24 for 41. */
enum { MOST_PLAIN = 21 };

double dalcs_steady_size(const struct dalcs_steady *st, const double *x) {
    double size = 0.0;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        for (int i = first; i < st->layout.first[k + 1]; i++) {
            size = hypot(size, dalcs_steady_unit(st, k, i - first) * x[i]);
        }
    }
    return size;
}

/* st->step = Phi(x) - x of the last pass. Returns its size. */
static double find_change(struct dalcs_steady *st) {
    for (int x = 0; x < st->layout.n_x; x++) {
        st->step[x] = st->then.x[x] - st->at.x[x];
    }
    return dalcs_steady_size(st, st->step);
}

/* A system's part of d: F, and then the leap. */
static enum dalcs_status leap_of(const struct dalcs_steady *st, int system, const double *M,
                                 double k, double *d, struct dalcs_arena *arena) {
    const int n = st->layout.first[system + 1] - st->layout.first[system];
    const size_t size = (size_t)n;
    double *A = dalcs_arena_alloc(arena, size * size + 1, sizeof(double));
    double *unit = dalcs_arena_alloc(arena, size + 1, sizeof(double));
    int *pivot = dalcs_arena_alloc(arena, size + 1, sizeof(int));
    if (A == NULL || unit == NULL || pivot == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < n; x++) {
        unit[x] = dalcs_steady_unit(st, system, x);
        d[x] *= unit[x];
    }
    for (int i = 0; i < n; i++) {
        for (int x = 0; x < n; x++) {
            A[i * n + x] = (x == i ? 1.0 + 1.0 / k : 0.0) - unit[x] * M[i * n + x] / unit[i];
        }
    }
    if (n > 0 && LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, A, n, pivot, d, n) != 0) {
        return DALCS_SINGULAR;
    }
    for (int x = 0; x < n; x++) {
        d[x] /= unit[x];
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_find_leap(const struct dalcs_steady *st, const double *M, double k,
                                         double *F) {
    const struct dalcs_steady_layout *l = &st->layout;
    struct dalcs_arena arena = {0};
    enum dalcs_status status = DALCS_OK;
    for (int s = 0; s < l->n_systems && status == DALCS_OK; s++) {
        status = leap_of(st, s, M + l->first_of_M[s], k, F + l->first[s], &arena);
    }
    dalcs_arena_finish(&arena);
    return status;
}

/* Of k periods from the last pass on, with plain ones behind it; the last pass is then with M. */
static enum dalcs_status leap(struct dalcs_steady *st, double k) {
    (void)find_change(st);
    DALCS_TRY(dalcs_steady_find_leap(st, st->pass.M, k, st->step));
    for (int x = 0; x < st->layout.n_x; x++) {
        st->then.x[x] = st->at.x[x] + st->step[x];
    }
    dalcs_steady_take(st);
    const int plain = 1 + st->layout.n_x / COLUMNS_OF_A_PERIOD;
    DALCS_TRY(dalcs_steady_pass(st, plain < MOST_PLAIN ? plain : MOST_PLAIN, DALCS_STEADY_PLAIN));
    dalcs_steady_take(st);
    st->n.newton++;
    return dalcs_steady_pass(st, 1, DALCS_STEADY_M);
}

/* k for the next leap, where this one, to what is left of Phi(x) - x, has been taken. */
static double next_length(double k, double left) {
    return fmin(longest, longer_by * k * fmax(1.0, 1.0 / left));
}

/* From the last pass on, with `before` as work, until more leaps than so many were none. */
static enum dalcs_status go(struct dalcs_steady *st, long most_failed,
                            struct dalcs_orbit_point *before, bool *is_near) {
    double k = first_leap;
    long n_failed = 0;
    for (int n = 0; n < MOST_LEAPS && !*is_near && k > 1.0 && n_failed <= most_failed; n++) {
        const double size = find_change(st);
        dalcs_steady_copy_point(st, before, &st->then);
        const enum dalcs_status status = leap(st, k);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        const double left = status == DALCS_OK ? find_change(st) / size : INFINITY;
        if (left <= 1.0) {
            *is_near = k >= longest && left <= near;
            k = next_length(k, left);
            continue;
        }
        n_failed++;
        k = k > 2.0 ? sqrt(k) : 1.0;
        dalcs_steady_copy_point(st, &st->at, before);
        DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_M));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_continue(struct dalcs_steady *st, long most_failed, bool *is_near) {
    struct dalcs_orbit_point before;
    *is_near = false;
    if (!dalcs_steady_make_point(st, &before)) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    status = status == DALCS_OK ? go(st, most_failed, &before, is_near) : status;
    return status < DALCS_OK ? status : DALCS_OK; /* a run that fails ends it, no more */
}
