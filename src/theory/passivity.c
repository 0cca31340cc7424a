/* passivity.c - the dissipation inequality for a given P. */
#include "passivity.h"

#include <math.h>

/* Q = -[A'P + PA + eps P, PB - C'; B'P - C, -(D + D')], and the size of what each element is made of. */
static enum dalcs_status dissipation(const struct dalcs_lcs *l, const struct dalcs_matrix *P,
                                     double eps, struct dalcs_matrix *Q, struct dalcs_matrix *size,
                                     struct dalcs_arena *arena) {
    int n = l->n;
    int m = l->m;
    struct dalcs_matrix pa;
    struct dalcs_matrix pb;
    DALCS_TRY(dalcs_matrix_new(Q, arena, n + m, n + m));
    DALCS_TRY(dalcs_matrix_new(size, arena, n + m, n + m));
    DALCS_TRY(dalcs_matrix_product(&pa, arena, P, &l->A));
    DALCS_TRY(dalcs_matrix_product(&pb, arena, P, &l->B));
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            double a = *dalcs_at(&pa, i, j);
            double b = *dalcs_at(&pa, j, i);
            *dalcs_at(Q, i, j) = -(a + b + eps * *dalcs_at(P, i, j));
            *dalcs_at(size, i, j) = fabs(a) + fabs(b);
        }
    }
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < n; i++) {
            double a = *dalcs_at(&pb, i, j);
            double b = *dalcs_at(&l->C, j, i);
            *dalcs_at(Q, i, n + j) = *dalcs_at(Q, n + j, i) = b - a;
            *dalcs_at(size, i, n + j) = *dalcs_at(size, n + j, i) = fabs(a) + fabs(b);
        }
        for (int i = 0; i < m; i++) {
            double a = *dalcs_at(&l->D, i, j);
            double b = *dalcs_at(&l->D, j, i);
            *dalcs_at(Q, n + i, n + j) = a + b;
            *dalcs_at(size, n + i, n + j) = fabs(a) + fabs(b);
        }
    }
    return DALCS_OK;
}

/* Units in which no element of `size` is above 1 and each row has one near it. */
static void equilibrate(const struct dalcs_matrix *size, double *unit) {
    int n = size->rows;
    for (int i = 0; i < n; i++) {
        unit[i] = 1.0;
    }
    for (int sweep = 0; sweep < 20; sweep++) {
        for (int i = 0; i < n; i++) {
            double largest = 0.0;
            for (int j = 0; j < n; j++) {
                largest = fmax(largest, *dalcs_at(size, i, j) * unit[j] * (i == j ? unit[i] : 1.0));
            }
            largest *= unit[i];
            unit[i] = largest > 0.0 ? unit[i] / sqrt(sqrt(largest)) : unit[i];
        }
    }
}

static void congruence(struct dalcs_matrix *m, const double *unit) {
    for (int j = 0; j < m->columns; j++) {
        for (int i = 0; i < m->rows; i++) {
            *dalcs_at(m, i, j) *= unit[i] * unit[j];
        }
    }
}

enum dalcs_status dalcs_scaled_least(const struct dalcs_matrix *Q, const struct dalcs_matrix *size,
                                     double *least, struct dalcs_arena *arena) {
    struct dalcs_matrix scaled;
    double *unit = dalcs_arena_alloc(arena, (size_t)Q->rows + 1, sizeof(double));
    *least = INFINITY;
    if (unit == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_copy(&scaled, arena, Q));
    equilibrate(size, unit);
    congruence(&scaled, unit);
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&scaled, unit, NULL, arena));
    *least = Q->rows > 0 ? unit[0] : INFINITY;
    return DALCS_OK;
}

enum dalcs_status dalcs_symmetric_part_least(const struct dalcs_matrix *M, double *least,
                                             struct dalcs_arena *arena) {
    struct dalcs_matrix sum;
    struct dalcs_matrix size;
    DALCS_TRY(dalcs_matrix_transpose(&sum, arena, M));
    DALCS_TRY(dalcs_matrix_copy(&size, arena, &sum));
    for (int j = 0; j < M->rows; j++) {
        for (int i = 0; i < M->rows; i++) {
            double own = *dalcs_at(M, i, j);
            *dalcs_at(&size, i, j) = fabs(*dalcs_at(&sum, i, j)) + fabs(own);
            *dalcs_at(&sum, i, j) += own;
        }
    }
    return dalcs_scaled_least(&sum, &size, least, arena);
}

/* Q in units in which it is of order 1; *unit is [n + m]. */
static enum dalcs_status scaled_dissipation(const struct dalcs_lcs *l, const struct dalcs_matrix *P,
                                            double eps, struct dalcs_matrix *Q, double **unit,
                                            struct dalcs_arena *arena) {
    struct dalcs_matrix size;
    DALCS_TRY(dissipation(l, P, eps, Q, &size, arena));
    *unit = dalcs_arena_alloc(arena, (size_t)Q->rows + 1, sizeof(double));
    if (*unit == NULL) {
        return DALCS_E_NOMEM;
    }
    equilibrate(&size, *unit);
    congruence(Q, *unit);
    return DALCS_OK;
}

enum dalcs_status dalcs_passivity_excess(const struct dalcs_lcs *l, const struct dalcs_matrix *P,
                                         double eps, double *excess, struct dalcs_arena *arena) {
    struct dalcs_matrix Q;
    double *unit;
    DALCS_TRY(scaled_dissipation(l, P, eps, &Q, &unit, arena));
    double *value = dalcs_arena_alloc(arena, (size_t)Q.rows + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&Q, value, NULL, arena));
    *excess = Q.rows > 0 ? -value[0] : 0.0;
    return DALCS_OK;
}

enum dalcs_status dalcs_is_positive_definite(const struct dalcs_matrix *P, bool *is,
                                             struct dalcs_arena *arena) {
    struct dalcs_matrix scaled;
    int n = P->rows;
    double *value = dalcs_arena_alloc(arena, (size_t)n + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n; i++) {
        value[i] = *dalcs_at(P, i, i) > 0.0 ? 1.0 / sqrt(*dalcs_at(P, i, i)) : 0.0;
    }
    DALCS_TRY(dalcs_matrix_copy(&scaled, arena, P));
    congruence(&scaled, value);
    return dalcs_matrix_is_positive(&scaled, -1e-13, is, arena);
}

/* ---- How fast ------------------------------------------------------------------------------- */

enum dalcs_status dalcs_passivity_rate(const struct dalcs_lcs *l, const struct dalcs_matrix *P,
                                       double *eps, struct dalcs_arena *arena) {
    /* eps is monotone in the inequality: bisected, from the rate that A alone allows */
    double *re = dalcs_arena_alloc(arena, (size_t)l->n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(arena, (size_t)l->n + 1, sizeof(double));
    *eps = 0.0;
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_eigen(&l->A, re, im, NULL, arena));
    double high = INFINITY;
    for (int i = 0; i < l->n; i++) {
        high = fmin(high, -2.0 * re[i]);
    }
    if (l->n == 0 || high <= 0.0) {
        return DALCS_OK;
    }
    const double start = high;
    for (int step = 0; step < 40 && (*eps == 0.0 || high > *eps * 1.0001); step++) {
        double middle = step == 0 ? high : *eps > 0.0 ? sqrt(*eps * high) : 0.1 * high;
        struct dalcs_arena work = {0};
        bool is_positive = false;
        if (middle < 1e-6 * start) {
            break;
        }
        struct dalcs_matrix Q;
        double *unit;
        enum dalcs_status status = scaled_dissipation(l, P, middle, &Q, &unit, &work);
        if (status == DALCS_OK) {
            status = dalcs_matrix_is_positive(&Q, 1e-12 * (double)Q.rows, &is_positive, &work);
        }
        dalcs_arena_finish(&work);
        DALCS_TRY(status);
        if (is_positive) {
            *eps = middle;
        } else {
            high = middle;
        }
    }
    return DALCS_OK;
}

/* ---- What dissipates nothing ---------------------------------------------------------------- */

/* A basis of the column space of m, as the rows of its complement: *rows v = 0 exactly for v in it. */
static enum dalcs_status complement(const struct dalcs_matrix *m, struct dalcs_matrix *rows,
                                    struct dalcs_arena *arena) {
    struct dalcs_matrix transposed;
    struct dalcs_matrix null;
    int rank;
    DALCS_TRY(dalcs_matrix_transpose(&transposed, arena, m));
    DALCS_TRY(dalcs_matrix_rank(&transposed, &rank, &null, arena));
    return dalcs_matrix_transpose(rows, arena, &null);
}

/* The rows first..first+n-1 of m. */
static enum dalcs_status take_rows(const struct dalcs_matrix *m, int first, int n,
                                   struct dalcs_matrix *rows, struct dalcs_arena *arena) {
    DALCS_TRY(dalcs_matrix_new(rows, arena, n, m->columns));
    for (int j = 0; j < m->columns; j++) {
        for (int i = 0; i < n; i++) {
            *dalcs_at(rows, i, j) = *dalcs_at(m, first + i, j);
        }
    }
    return DALCS_OK;
}

/* Elements of motion times unit vectors that are below the rounding of their sums. */
static void drop_rounding(struct dalcs_matrix *rate, const struct dalcs_matrix *motion) {
    for (int i = 0; i < rate->rows; i++) {
        double size = 0.0;
        for (int k = 0; k < motion->columns; k++) {
            size += fabs(*dalcs_at(motion, i, k));
        }
        for (int j = 0; j < rate->columns; j++) {
            double *a = dalcs_at(rate, i, j);
            *a = fabs(*a) < 1e-10 * size ? 0.0 : *a;
        }
    }
}

/* x' of (x, u), both in these units. */
static enum dalcs_status scaled_motion(const struct dalcs_lcs *l, const double *unit,
                                       struct dalcs_matrix *motion, struct dalcs_arena *arena) {
    const int n = l->n;
    DALCS_TRY(dalcs_matrix_new(motion, arena, n, n + l->m));
    for (int j = 0; j < n + l->m; j++) {
        for (int i = 0; i < n; i++) {
            double a = j < n ? *dalcs_at(&l->A, i, j) : *dalcs_at(&l->B, i, j - n);
            *dalcs_at(motion, i, j) = a * unit[j] / unit[i];
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_passivity_lossless(const struct dalcs_lcs *l, const struct dalcs_matrix *P,
                                           double noise, int *dimension,
                                           struct dalcs_arena *arena) {
    struct dalcs_matrix Q;
    struct dalcs_matrix still; /* (x, u) that dissipate nothing and stay, scaled */
    struct dalcs_matrix motion;
    double *unit;
    int rank;
    int n = l->n;
    DALCS_TRY(scaled_dissipation(l, P, 0.0, &Q, &unit, arena));
    double *value = dalcs_arena_alloc(arena, (size_t)Q.rows + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&Q, value, &still, arena));
    still.columns = 0;
    while (still.columns < Q.rows && value[still.columns] < noise) {
        still.columns++;
    }
    DALCS_TRY(scaled_motion(l, unit, &motion, arena));
    *dimension = n;
    for (int last = n + 1; *dimension < last;) {
        struct dalcs_matrix x;
        struct dalcs_matrix rate;
        struct dalcs_matrix rows;
        struct dalcs_matrix leaving;
        struct dalcs_matrix staying;
        last = *dimension;
        DALCS_TRY(take_rows(&still, 0, n, &x, arena));
        DALCS_TRY(dalcs_matrix_rank(&x, &rank, NULL, arena));
        DALCS_TRY(complement(&x, &rows, arena));
        DALCS_TRY(dalcs_matrix_product(&rate, arena, &motion, &still));
        drop_rounding(&rate, &motion);
        DALCS_TRY(dalcs_matrix_product(&leaving, arena, &rows, &rate));
        *dimension = dalcs_matrix_largest(&x) < 1e-10 ? 0 : rank;
        if (*dimension == 0) {
            break;
        }
        DALCS_TRY(dalcs_matrix_rank(&leaving, &rank, &staying, arena));
        if (dalcs_matrix_largest(&leaving) <= 1e-9 * dalcs_matrix_largest(&rate)) {
            break; /* nothing leaves */
        }
        struct dalcs_matrix next;
        DALCS_TRY(dalcs_matrix_product(&next, arena, &still, &staying));
        still = next;
    }
    return DALCS_OK;
}
