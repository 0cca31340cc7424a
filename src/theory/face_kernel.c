/* face_kernel.c - the motions that neither gain nor lose: the kernel of every Q(P). */
#include "storage_face.h"

#include <math.h>
#include <string.h>

/* Scaled eigenvalues below this are 0. */
static const double noise = 1e-10;

static enum dalcs_status append(struct dalcs_face *s, const struct dalcs_matrix *more) {
    struct dalcs_matrix both;
    int rows = s->n + s->m;
    DALCS_TRY(dalcs_matrix_new(&both, s->arena, rows, s->kernel.columns + more->columns));
    memcpy(both.a, s->kernel.a, (size_t)rows * (size_t)s->kernel.columns * sizeof(double));
    memcpy(both.a + (size_t)rows * (size_t)s->kernel.columns, more->a,
           (size_t)rows * (size_t)more->columns * sizeof(double));
    s->kernel = both;
    return DALCS_OK;
}

/* The columns of `where` on which the form, >= 0 for a passive system, is 0; each is n_parts vectors
 * (x, u) below one another. */
static enum dalcs_status append_zeros(struct dalcs_face *s, const struct dalcs_matrix *form,
                                      const struct dalcs_matrix *where, int n_parts) {
    struct dalcs_matrix turned;
    struct dalcs_matrix half;
    struct dalcs_matrix within;
    struct dalcs_matrix vector;
    struct dalcs_matrix zeros;
    int rows = s->n + s->m;
    double *value = dalcs_arena_alloc(s->arena, (size_t)where->columns + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_transpose(&turned, s->arena, where));
    DALCS_TRY(dalcs_matrix_product(&half, s->arena, &turned, form));
    DALCS_TRY(dalcs_matrix_product(&within, s->arena, &half, where));
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&within, value, &vector, s->arena));
    int n_zeros = 0;
    double size = fmax(1.0, dalcs_matrix_largest(form));
    while (n_zeros < where->columns && value[n_zeros] < noise * size) {
        n_zeros++;
    }
    if (n_zeros > 0 && value[0] < -noise * size && !s->is_gaining) {
        s->is_gaining = true;
        vector.columns = 1;
        DALCS_TRY(dalcs_matrix_product(&zeros, s->arena, where, &vector));
        s->gaining = (struct dalcs_matrix){rows, n_parts, zeros.a};
    }
    vector.columns = n_zeros; /* the first ones: by columns */
    DALCS_TRY(dalcs_matrix_product(&zeros, s->arena, where, &vector));
    struct dalcs_matrix parts;
    DALCS_TRY(dalcs_matrix_new(&parts, s->arena, rows, n_parts * n_zeros));
    memcpy(parts.a, zeros.a, (size_t)rows * (size_t)parts.columns * sizeof(double));
    return append(s, &parts);
}

/* The power u'y + y'u of (x, u), n_parts times along the diagonal. */
static enum dalcs_status power_form(const struct dalcs_face *s, int n_parts,
                                    struct dalcs_matrix *form) {
    int rows = s->n + s->m;
    DALCS_TRY(dalcs_matrix_new(form, s->arena, n_parts * rows, n_parts * rows));
    for (int part = 0; part < n_parts; part++) {
        int at = part * rows;
        for (int i = 0; i < s->m; i++) {
            for (int k = 0; k < s->n; k++) {
                double c = *dalcs_at(&s->q.C, i, k);
                *dalcs_at(form, at + s->n + i, at + k) = *dalcs_at(form, at + k, at + s->n + i) = c;
            }
            for (int j = 0; j < s->m; j++) {
                *dalcs_at(form, at + s->n + i, at + s->n + j) =
                    *dalcs_at(&s->q.D, i, j) + *dalcs_at(&s->q.D, j, i);
            }
        }
    }
    return DALCS_OK;
}

/* Motions exp(j omega t): A x + B u = j omega x. */
static enum dalcs_status look_at(struct dalcs_face *s, double omega) {
    int n_parts = omega == 0.0 ? 1 : 2;
    int rows = s->n + s->m;
    struct dalcs_matrix motion;
    struct dalcs_matrix where;
    struct dalcs_matrix form;
    int rank;
    DALCS_TRY(dalcs_matrix_new(&motion, s->arena, n_parts * s->n, n_parts * rows));
    for (int part = 0; part < n_parts; part++) {
        for (int i = 0; i < s->n; i++) {
            int row = part * s->n + i;
            for (int k = 0; k < rows; k++) {
                *dalcs_at(&motion, row, part * rows + k) =
                    k < s->n ? *dalcs_at(&s->q.A, i, k) : *dalcs_at(&s->q.B, i, k - s->n);
            }
            if (n_parts == 2) {
                *dalcs_at(&motion, row, (1 - part) * rows + i) = part == 0 ? omega : -omega;
            }
        }
    }
    DALCS_TRY(dalcs_matrix_rank(&motion, &rank, &where, s->arena));
    DALCS_TRY(power_form(s, n_parts, &form));
    return append_zeros(s, &form, &where, n_parts);
}

/* The vectors (B u, v), by their coefficients of u and v. */
static enum dalcs_status spread_rates(struct dalcs_face *s, const struct dalcs_matrix *bu,
                                      struct dalcs_matrix *where) {
    DALCS_TRY(dalcs_matrix_new(where, s->arena, s->n + s->m, bu->columns + s->m));
    for (int j = 0; j < where->columns; j++) {
        for (int i = 0; i < s->n && j < bu->columns; i++) {
            *dalcs_at(where, i, j) = *dalcs_at(bu, i, j);
        }
        if (j >= bu->columns) {
            *dalcs_at(where, s->n + j - bu->columns, j) = 1.0;
        }
    }
    return DALCS_OK;
}

/* -u'CABu - u'CBv + v'CBu + v'Dv over (coefficients of u, v); rate = CABu. */
static enum dalcs_status rate_form(struct dalcs_face *s, const struct dalcs_matrix *u,
                                   const struct dalcs_matrix *rate, struct dalcs_matrix *form) {
    struct dalcs_matrix cb;
    DALCS_TRY(dalcs_matrix_product(&cb, s->arena, &s->q.C, &s->q.B));
    DALCS_TRY(dalcs_matrix_new(form, s->arena, u->columns + s->m, u->columns + s->m));
    for (int i = 0; i < u->columns; i++) {
        for (int j = 0; j < u->columns; j++) {
            double value = 0.0;
            for (int k = 0; k < s->m; k++) {
                value -= *dalcs_at(u, k, i) * *dalcs_at(rate, k, j) +
                         *dalcs_at(u, k, j) * *dalcs_at(rate, k, i);
            }
            *dalcs_at(form, i, j) = value;
        }
    }
    for (int i = 0; i < s->m; i++) {
        for (int j = 0; j < u->columns; j++) {
            double value = 0.0;
            for (int k = 0; k < s->m; k++) {
                value += (*dalcs_at(&cb, i, k) - *dalcs_at(&cb, k, i)) * *dalcs_at(u, k, j);
            }
            *dalcs_at(form, u->columns + i, j) = *dalcs_at(form, j, u->columns + i) = value;
        }
        for (int j = 0; j < s->m; j++) {
            *dalcs_at(form, u->columns + i, u->columns + j) =
                *dalcs_at(&s->q.D, i, j) + *dalcs_at(&s->q.D, j, i);
        }
    }
    return DALCS_OK;
}

/* Where a form over the columns of `where` is 0, or below it. */
static enum dalcs_status append_zeros_of(struct dalcs_face *s, const struct dalcs_matrix *form,
                                         const struct dalcs_matrix *where) {
    double *value = dalcs_arena_alloc(s->arena, (size_t)form->rows + 1, sizeof(double));
    struct dalcs_matrix vector;
    struct dalcs_matrix zeros;
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_symmetric_eigen(form, value, &vector, s->arena));
    vector.columns = 0;
    while (vector.columns < form->rows && value[vector.columns] < noise) {
        s->is_gaining = s->is_gaining || value[vector.columns] < -noise;
        vector.columns++;
    }
    DALCS_TRY(dalcs_matrix_product(&zeros, s->arena, where, &vector));
    return append(s, &zeros);
}

/* Large s: (0, u) with (D + D') u = 0, hence P B u = C'u; and, one order below, (B u, v) with
 * -u'CABu - u'CBv + v'CBu + v'Dv = 0. */
static enum dalcs_status look_at_infinity(struct dalcs_face *s) {
    struct dalcs_matrix at_once;
    struct dalcs_matrix first;
    struct dalcs_matrix form;
    struct dalcs_matrix u;
    int rank;
    DALCS_TRY(dalcs_matrix_new(&first, s->arena, s->n, s->n + s->m));
    for (int i = 0; i < s->n; i++) {
        *dalcs_at(&first, i, i) = 1.0;
    }
    DALCS_TRY(dalcs_matrix_rank(&first, &rank, &at_once, s->arena));
    DALCS_TRY(power_form(s, 1, &form));
    DALCS_TRY(append_zeros(s, &form, &at_once, 1));
    DALCS_TRY(dalcs_matrix_new(&u, s->arena, s->m, s->kernel.columns));
    for (int j = 0; j < u.columns; j++) {
        for (int i = 0; i < s->m; i++) {
            *dalcs_at(&u, i, j) = *dalcs_at(&s->kernel, s->n + i, j);
        }
    }
    struct dalcs_matrix bu;
    struct dalcs_matrix abu;
    struct dalcs_matrix rate;
    struct dalcs_matrix where;
    DALCS_TRY(dalcs_matrix_product(&bu, s->arena, &s->q.B, &u));
    DALCS_TRY(dalcs_matrix_product(&abu, s->arena, &s->q.A, &bu));
    DALCS_TRY(dalcs_matrix_product(&rate, s->arena, &s->q.C, &abu));
    DALCS_TRY(spread_rates(s, &bu, &where));
    DALCS_TRY(rate_form(s, &u, &rate, &form));
    return append_zeros_of(s, &form, &where); /* put back onto vectors (x, u) */
}

enum dalcs_status dalcs_face_kernel(struct dalcs_face *s) {
    double *re = dalcs_arena_alloc(s->arena, (size_t)s->n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(s->arena, (size_t)s->n + 1, sizeof(double));
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_face_choose_units(s));
    DALCS_TRY(dalcs_matrix_new(&s->kernel, s->arena, s->n + s->m, 0));
    DALCS_TRY(look_at_infinity(s));
    DALCS_TRY(look_at(s, 0.0));
    DALCS_TRY(dalcs_matrix_eigen(&s->q.A, re, im, NULL, s->arena));
    for (int i = 0; i < s->n; i++) {
        if (im[i] > noise && fabs(re[i]) < noise) {
            DALCS_TRY(look_at(s, im[i]));
        }
    }
    struct dalcs_matrix turned;
    struct dalcs_matrix right;
    int rank;
    DALCS_TRY(dalcs_matrix_transpose(&turned, s->arena, &s->kernel));
    DALCS_TRY(dalcs_matrix_rank(&turned, &rank, &s->complement, s->arena));
    rank = dalcs_matrix_largest(&turned) > 0.0 ? rank : 0;
    DALCS_TRY(dalcs_matrix_transpose(&turned, s->arena, &s->complement));
    DALCS_TRY(dalcs_matrix_rank(&turned, &rank, &right, s->arena));
    s->kernel = right; /* orthonormal */
    return DALCS_OK;
}
