/* step_blocks.c - the matrices of one step and their passivity. */
#include "step_blocks.h"

#include "coupling.h"
#include "passivity.h"
#include "storage.h"

#include <math.h>

struct dalcs_quadruple dalcs_model_quadruple(const struct dalcs_blocks *b) {
    return (struct dalcs_quadruple){b->B_II, b->L_II, b->C_II, b->D};
}

/* *sum = base + h left right */
static enum dalcs_status add_product(struct dalcs_matrix *sum, const struct dalcs_matrix *base,
                                     double h, const struct dalcs_matrix *left,
                                     const struct dalcs_matrix *right, struct dalcs_arena *arena) {
    struct dalcs_matrix product;
    DALCS_TRY(dalcs_matrix_product(&product, arena, left, right));
    DALCS_TRY(dalcs_matrix_copy(sum, arena, base));
    for (int j = 0; j < sum->columns; j++) {
        for (int i = 0; i < sum->rows; i++) {
            double *a = dalcs_at(sum, i, j);
            double add = h * *dalcs_at(&product, i, j);
            double size = fmax(fabs(*a), fabs(add));
            *a += add;
            *a = fabs(*a) < 1e-14 * size ? 0.0 : *a;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_step_quadruple(struct dalcs_quadruple *q, const struct dalcs_blocks *b,
                                       double h, struct dalcs_arena *arena) {
    struct dalcs_matrix step;
    struct dalcs_matrix z;
    struct dalcs_matrix lambda;
    DALCS_TRY(dalcs_matrix_copy(&step, arena, &b->P));
    dalcs_matrix_add(&step, -h, &b->A_I);
    DALCS_TRY(dalcs_matrix_copy(&z, arena, &b->B_I));
    DALCS_TRY(dalcs_matrix_copy(&lambda, arena, &b->L_I));
    DALCS_TRY(dalcs_matrix_solve(&step, &z, arena));
    DALCS_TRY(dalcs_matrix_solve(&step, &lambda, arena));
    DALCS_TRY(add_product(&q->A, &b->B_II, h, &b->A_II, &z, arena));
    DALCS_TRY(add_product(&q->B, &b->L_II, h, &b->A_II, &lambda, arena));
    DALCS_TRY(add_product(&q->C, &b->C_II, h, &b->C_I, &z, arena));
    return add_product(&q->D, &b->D, h, &b->C_I, &lambda, arena);
}

enum dalcs_status dalcs_quadruple_margin(const struct dalcs_quadruple *q,
                                         const struct dalcs_matrix *X, double *margin,
                                         struct dalcs_arena *arena) {
    int p = q->A.rows;
    int m = q->D.rows;
    struct dalcs_matrix xa;
    struct dalcs_matrix xb;
    struct dalcs_matrix M;
    struct dalcs_matrix size;
    DALCS_TRY(dalcs_matrix_product(&xa, arena, X, &q->A));
    DALCS_TRY(dalcs_matrix_product(&xb, arena, X, &q->B));
    DALCS_TRY(dalcs_matrix_new(&M, arena, p + m, p + m));
    DALCS_TRY(dalcs_matrix_new(&size, arena, p + m, p + m));
    for (int j = 0; j < p + m; j++) {
        for (int i = j; i < p + m; i++) {
            double first;
            double second;
            if (i < p) {
                first = -*dalcs_at(&xa, i, j);
                second = -*dalcs_at(&xa, j, i);
            } else if (j < p) {
                first = -*dalcs_at(&xb, j, i - p);
                second = *dalcs_at(&q->C, i - p, j);
            } else {
                first = *dalcs_at(&q->D, i - p, j - p);
                second = *dalcs_at(&q->D, j - p, i - p);
            }
            *dalcs_at(&M, i, j) = *dalcs_at(&M, j, i) = first + second;
            *dalcs_at(&size, i, j) = *dalcs_at(&size, j, i) = fabs(first) + fabs(second);
        }
    }
    return dalcs_scaled_least(&M, &size, margin, arena);
}

enum dalcs_status dalcs_block_diagonal(const struct dalcs_matrix *D, bool *holds, bool *is_second,
                                       struct dalcs_arena *arena) {
    int m = D->rows;
    int n = 0;
    double least;
    struct dalcs_matrix first;
    int *index = dalcs_arena_alloc(arena, (size_t)m + 1, sizeof(int));
    *holds = true;
    if (index == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < m; i++) {
        bool is_zero = true;
        for (int j = 0; j < m; j++) {
            is_zero = is_zero && *dalcs_at(D, i, j) == 0.0 && *dalcs_at(D, j, i) == 0.0;
            double apart = fabs(*dalcs_at(D, i, j) - *dalcs_at(D, j, i));
            *holds = *holds && apart <= 1e-10 * (fabs(*dalcs_at(D, i, j)) + apart);
        }
        is_second[i] = is_zero;
        if (!is_zero) {
            index[n++] = i;
        }
    }
    DALCS_TRY(dalcs_matrix_part(&first, arena, D, n, index, n, index));
    DALCS_TRY(dalcs_symmetric_part_least(&first, &least, arena));
    *holds = *holds && least > dalcs_definite;
    return DALCS_OK;
}

/* It is the least of the generalised eigenvalues of (-(XA + A'X)/2, X), which the units of z do not
 * change: those are chosen so that X has a diagonal of 1. */
enum dalcs_status dalcs_index_strength(const struct dalcs_matrix *A, const struct dalcs_matrix *X,
                                       double *strength, struct dalcs_arena *arena) {
    int p = A->rows;
    struct dalcs_matrix scaled;
    struct dalcs_matrix vector;
    struct dalcs_matrix xa;
    struct dalcs_matrix turned;
    struct dalcs_matrix half;
    struct dalcs_matrix product;
    double largest;
    double *value = dalcs_arena_alloc(arena, (size_t)p + 1, sizeof(double));
    double *unit = dalcs_arena_alloc(arena, (size_t)p + 1, sizeof(double));
    if (value == NULL || unit == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_product(&xa, arena, X, A));
    DALCS_TRY(dalcs_matrix_copy(&scaled, arena, X));
    for (int i = 0; i < p; i++) {
        unit[i] = *dalcs_at(X, i, i) > 0.0 ? 1.0 / sqrt(*dalcs_at(X, i, i)) : 1.0;
    }
    for (int j = 0; j < p; j++) {
        for (int i = 0; i < p; i++) {
            *dalcs_at(&scaled, i, j) *= unit[i] * unit[j];
            *dalcs_at(&xa, i, j) *= -unit[i] * unit[j];
        }
    }
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&scaled, value, &vector, arena));
    for (int j = 0; j < p; j++) {
        for (int i = 0; i < p; i++) {
            *dalcs_at(&vector, i, j) /= sqrt(fmax(value[j], 1e-16));
        }
    }
    DALCS_TRY(dalcs_matrix_transpose(&turned, arena, &vector));
    DALCS_TRY(dalcs_matrix_product(&half, arena, &turned, &xa));
    DALCS_TRY(dalcs_matrix_product(&product, arena, &half, &vector));
    DALCS_TRY(dalcs_matrix_symmetric_part(&product, strength, &largest, arena));
    *strength *= 0.5;
    return DALCS_OK;
}

/* ---- X -------------------------------------------------------------------------------------- */

struct search {
    const struct dalcs_quadruple *q;
    struct dalcs_passive_quadruple *found;
    struct dalcs_arena *arena;
};

static enum dalcs_status try_X(const struct search *s, const struct dalcs_matrix *base,
                               double factor, double *margin) {
    struct dalcs_arena work = {0};
    struct dalcs_matrix X;
    enum dalcs_status status = dalcs_matrix_copy(&X, &work, base);
    for (int i = 0; status == DALCS_OK && i < X.rows * X.columns; i++) {
        X.a[i] *= factor;
    }
    if (status == DALCS_OK) {
        status = dalcs_quadruple_margin(s->q, &X, margin, &work);
    }
    if (status == DALCS_OK && *margin > s->found->margin) {
        s->found->margin = *margin;
        status = dalcs_matrix_copy(&s->found->X, s->arena, &X);
    }
    dalcs_arena_finish(&work);
    return status;
}

/* Multiples of base around the best: a margin that is positive on an interval of factors. */
static enum dalcs_status try_multiples(const struct search *s, const struct dalcs_matrix *base) {
    double margin;
    DALCS_TRY(try_X(s, base, 1.0, &margin));
    int reach = s->q->A.rows > 60 ? 0 : s->q->A.rows > 20 ? 6 : 24;
    int best = 0;
    double highest = margin;
    for (int k = -reach; k <= reach; k++) {
        DALCS_TRY(try_X(s, base, pow(10.0, 0.5 * k), &margin));
        best = margin > highest ? k : best;
        highest = fmax(highest, margin);
    }
    double low = 0.5 * (best - 1);
    double high = 0.5 * (best + 1);
    for (int k = 0; reach > 0 && k < 30; k++) { /* a third at a time */
        double left;
        double right;
        DALCS_TRY(try_X(s, base, pow(10.0, low + (high - low) / 3.0), &left));
        DALCS_TRY(try_X(s, base, pow(10.0, high - (high - low) / 3.0), &right));
        *(left < right ? &low : &high) =
            left < right ? low + (high - low) / 3.0 : high - (high - low) / 3.0;
    }
    return DALCS_OK;
}

/* All X, where one could be better. */
static enum dalcs_status try_all(const struct search *s) {
    struct dalcs_passive_quadruple *found = s->found;
    struct dalcs_storage storage;
    double D_least;
    DALCS_TRY(dalcs_symmetric_part_least(&s->q->D, &D_least, s->arena));
    bool is_done = found->margin > (D_least > dalcs_definite ? 1.0 : -1.0) * dalcs_definite;
    found->is_exhaustive = found->is_exhaustive || D_least < -dalcs_definite;
    if (found->is_exhaustive || is_done) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_storage_find(s->q, &storage, s->arena));
    found->is_exhaustive = storage.is_refuted;
    found->why = storage.why;
    double margin;
    return storage.is_found ? try_X(s, &storage.P, 1.0, &margin) : DALCS_OK;
}

enum dalcs_status dalcs_quadruple_passive(const struct dalcs_quadruple *q,
                                          struct dalcs_passive_quadruple *found,
                                          struct dalcs_arena *arena) {
    const struct search s = {q, found, arena};
    int p = q->A.rows;
    int m = q->D.rows;
    bool *is_second = dalcs_arena_alloc(arena, (size_t)m + 1, sizeof(bool));
    int *index = dalcs_arena_alloc(arena, (size_t)m + 1, sizeof(int));
    struct dalcs_matrix base;
    bool holds;
    *found = (struct dalcs_passive_quadruple){.margin = -INFINITY, .is_exhaustive = p <= 1};
    DALCS_TRY(dalcs_matrix_new(&base, arena, p, p));
    found->X = base;
    if (is_second == NULL || index == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < p; i++) {
        *dalcs_at(&base, i, i) = 1.0;
    }
    DALCS_TRY(try_multiples(&s, &base));
    DALCS_TRY(dalcs_block_diagonal(&q->D, &holds, is_second, arena));
    int n = 0;
    for (int i = 0; i < m; i++) {
        index[n] = i;
        n += is_second[i] ? 1 : 0;
    }
    if (n > 0) {
        struct dalcs_matrix B;
        struct dalcs_matrix C;
        struct dalcs_matrix X;
        const char *why;
        double margin;
        DALCS_TRY(dalcs_matrix_part(&B, arena, &q->B, p, NULL, n, index));
        DALCS_TRY(dalcs_matrix_part(&C, arena, &q->C, n, index, p, NULL));
        DALCS_TRY(dalcs_coupling_find(&X, &holds, &why, &B, &C, arena));
        if (holds) {
            DALCS_TRY(try_X(&s, &X, 1.0, &margin));
        }
    }
    DALCS_TRY(try_all(&s));
    /* -XA - A'X >= 0 and > 0 need X > 0, which every candidate is */
    found->is_passive = found->margin > -dalcs_definite;
    found->is_strict = found->margin > dalcs_definite;
    return DALCS_OK;
}
