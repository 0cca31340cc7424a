/* giving.c - a motion to which the circuit gives energy: the witness against every P.
 *
 * With u exp(s t) at the diodes, Re s >= 0, what goes in is Re(y* u) exp(2 Re s t), y = H(s) u; a
 * passive circuit never makes that negative (H is positive real). Where to look: at the speeds of
 * the circuit's own motions, on both axes; the least eigenvalue of H + H* says with which u. */
#include "passivity.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

typedef double complex number;

/* Negative by more than rounding, in units in which the largest element of each row is 1. */
static const double significant = 1e-7;

struct search {
    const struct dalcs_lcs *l;
    struct dalcs_giving *giving;
    struct dalcs_arena *arena;
    number *resolvent; /* [n][n] */
    number *x;         /* [n][m] (s I - A)^-1 B */
    number *H, *sum;   /* [m][m] */
    double *unit, *value;
    lapack_int *pivot;
};

static enum dalcs_status allocate(struct search *q) {
    size_t n = (size_t)q->l->n + 1;
    size_t m = (size_t)q->l->m + 1;
    q->resolvent = dalcs_arena_alloc(q->arena, n * n, sizeof(number));
    q->x = dalcs_arena_alloc(q->arena, n * m, sizeof(number));
    q->H = dalcs_arena_alloc(q->arena, m * m, sizeof(number));
    q->sum = dalcs_arena_alloc(q->arena, m * m, sizeof(number));
    q->unit = dalcs_arena_alloc(q->arena, m, sizeof(double));
    q->value = dalcs_arena_alloc(q->arena, m, sizeof(double));
    q->pivot = dalcs_arena_alloc(q->arena, n, sizeof(*q->pivot));
    q->giving->u = dalcs_arena_alloc(q->arena, 2 * m, sizeof(double));
    q->giving->x = dalcs_arena_alloc(q->arena, 2 * n, sizeof(double));
    return q->resolvent == NULL || q->x == NULL || q->H == NULL || q->sum == NULL ||
                   q->unit == NULL || q->value == NULL || q->pivot == NULL ||
                   q->giving->u == NULL || q->giving->x == NULL
               ? DALCS_E_NOMEM
               : DALCS_OK;
}

/* H(s), and x; false at a pole. s = INFINITY: D. */
static enum dalcs_status respond(struct search *q, number s, bool *is_regular) {
    const struct dalcs_lcs *l = q->l;
    int n = l->n;
    int m = l->m;
    bool is_finite = isfinite(creal(s));
    *is_regular = true;
    memset(q->x, 0, (size_t)n * (size_t)m * sizeof(number));
    if (is_finite && n > 0) {
        for (int j = 0; j < n; j++) {
            for (int i = 0; i < n; i++) {
                q->resolvent[i + j * n] = (i == j ? s : 0.0) - *dalcs_at(&l->A, i, j);
            }
        }
        for (int j = 0; j < m; j++) {
            for (int i = 0; i < n; i++) {
                q->x[i + j * n] = *dalcs_at(&l->B, i, j);
            }
        }
        lapack_int info = LAPACKE_zgesv(LAPACK_COL_MAJOR, n, m, q->resolvent, n, q->pivot, q->x, n);
        if (info == LAPACK_WORK_MEMORY_ERROR) {
            return DALCS_E_NOMEM;
        }
        *is_regular = info == 0;
    }
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < m; i++) {
            number sum = *dalcs_at(&l->D, i, j);
            for (int k = 0; is_finite && k < n; k++) {
                sum += *dalcs_at(&l->C, i, k) * q->x[k + j * n];
            }
            q->H[i + j * m] = sum;
            *is_regular = *is_regular && isfinite(creal(sum)) && isfinite(cimag(sum));
        }
    }
    return DALCS_OK;
}

static void set_units(struct search *q) {
    int m = q->l->m;
    for (int i = 0; i < m; i++) {
        q->unit[i] = 1.0;
    }
    for (int sweep = 0; sweep < 10; sweep++) {
        for (int i = 0; i < m; i++) {
            double largest = 0.0;
            for (int j = 0; j < m; j++) {
                double size = fmax(cabs(q->H[i + j * m]), cabs(q->H[j + i * m]));
                largest = fmax(largest, size * q->unit[j] * (i == j ? q->unit[i] : 1.0));
            }
            largest *= q->unit[i];
            q->unit[i] = largest > 0.0 ? q->unit[i] / sqrt(sqrt(largest)) : q->unit[i];
        }
    }
}

static void keep(struct search *q, number s, double power, const number *u) {
    struct dalcs_giving *g = q->giving;
    int n = q->l->n;
    int m = q->l->m;
    g->is_found = true;
    g->s[0] = creal(s);
    g->s[1] = cimag(s);
    g->power = power;
    for (int i = 0; i < m; i++) {
        g->u[2 * i] = creal(u[i] * q->unit[i]);
        g->u[2 * i + 1] = cimag(u[i] * q->unit[i]);
    }
    for (int k = 0; k < n; k++) {
        number x = 0.0;
        for (int j = 0; j < m; j++) {
            x += q->x[k + j * n] * u[j] * q->unit[j];
        }
        g->x[2 * k] = creal(x);
        g->x[2 * k + 1] = cimag(x);
    }
}

/* Tries one s; keeps the most negative. */
static enum dalcs_status try_at(struct search *q, number s) {
    int m = q->l->m;
    bool is_regular;
    DALCS_TRY(respond(q, s, &is_regular));
    if (!is_regular || m == 0) {
        return DALCS_OK;
    }
    set_units(q);
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < m; i++) {
            q->sum[i + j * m] =
                0.5 * q->unit[i] * q->unit[j] * (q->H[i + j * m] + conj(q->H[j + i * m]));
        }
    }
    lapack_int info = LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', m, q->sum, m, q->value);
    if (info == LAPACK_WORK_MEMORY_ERROR) {
        return DALCS_E_NOMEM;
    }
    if (info == 0 && q->value[0] < -significant && q->value[0] < q->giving->power) {
        keep(q, s, q->value[0], q->sum);
    }
    return DALCS_OK;
}

/* The speeds at which D, C B / s and C A B / s^2 are as large as one another: A may have none. */
static enum dalcs_status speeds_of_pairs(struct search *q, double speed[3]) {
    struct dalcs_matrix ab;
    struct dalcs_matrix cb;
    struct dalcs_matrix cab;
    DALCS_TRY(dalcs_matrix_product(&ab, q->arena, &q->l->A, &q->l->B));
    DALCS_TRY(dalcs_matrix_product(&cb, q->arena, &q->l->C, &q->l->B));
    DALCS_TRY(dalcs_matrix_product(&cab, q->arena, &q->l->C, &ab));
    double size[3] = {dalcs_matrix_largest(&q->l->D), dalcs_matrix_largest(&cb),
                      dalcs_matrix_largest(&cab)};
    speed[0] = size[1] / size[0];
    speed[1] = sqrt(size[2] / size[0]);
    speed[2] = size[2] / size[1];
    return DALCS_OK;
}

enum dalcs_status dalcs_passivity_refute(const struct dalcs_lcs *l, struct dalcs_giving *giving,
                                         struct dalcs_arena *arena) {
    *giving = (struct dalcs_giving){0};
    struct search q = {.l = l, .giving = giving, .arena = arena};
    double *re = dalcs_arena_alloc(arena, (size_t)l->n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(arena, (size_t)l->n + 1, sizeof(double));
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(allocate(&q));
    DALCS_TRY(try_at(&q, INFINITY));
    if (giving->is_found) {
        return DALCS_OK; /* at once, whatever the states do */
    }
    DALCS_TRY(dalcs_matrix_eigen(&l->A, re, im, NULL, arena));
    double fastest = 0.0;
    for (int i = 0; i < l->n; i++) {
        fastest = fmax(fastest, hypot(re[i], im[i]));
    }
    const double unit = fastest > 0.0 ? fastest : 1.0;
    DALCS_TRY(try_at(&q, 0.0));
    DALCS_TRY(try_at(&q, 1e3 * unit));
    DALCS_TRY(try_at(&q, 1e3 * unit * I));
    double other[3];
    DALCS_TRY(speeds_of_pairs(&q, other));
    /* the larger the circuit, the fewer of its motions */
    int every = 1 + l->n / 100 * (l->n / 100);
    for (int i = -3; i < l->n; i += i < 0 ? 1 : every) {
        double speed = i < 0 ? other[-1 - i] : hypot(re[i], im[i]);
        if (!(speed > 1e-12 * fastest) || !isfinite(speed)) {
            continue;
        }
        static const double factor[] = {0.1, 0.5, 0.9, 1.0, 1.1, 2.0, 10.0};
        for (size_t k = 0; k < sizeof factor / sizeof factor[0]; k++) {
            DALCS_TRY(try_at(&q, factor[k] * speed));
            DALCS_TRY(try_at(&q, factor[k] * speed * I));
        }
        if (i >= 0 && im[i] != 0.0) {
            DALCS_TRY(try_at(&q, fmax(re[i], 0.0) * 1.01 + im[i] * I));
        }
    }
    return DALCS_OK;
}
