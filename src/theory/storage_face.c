/* storage_face.c - units, the motions that neither gain nor lose, and the P that they leave. */
#include "storage_face.h"

#include <math.h>
#include <string.h>

/* Scaled eigenvalues below this are 0. */
static const double noise = 1e-10;

/* ---- Units ---------------------------------------------------------------------------------- */

static enum dalcs_status copy(struct dalcs_quadruple *to, const struct dalcs_quadruple *from,
                              struct dalcs_arena *arena) {
    DALCS_TRY(dalcs_matrix_copy(&to->A, arena, &from->A));
    DALCS_TRY(dalcs_matrix_copy(&to->B, arena, &from->B));
    DALCS_TRY(dalcs_matrix_copy(&to->C, arena, &from->C));
    return dalcs_matrix_copy(&to->D, arena, &from->D);
}

void dalcs_face_scale(struct dalcs_matrix *m, const double *left, bool inverse, const double *right,
                      double factor) {
    for (int j = 0; j < m->columns; j++) {
        for (int i = 0; i < m->rows; i++) {
            *dalcs_at(m, i, j) *= factor * right[j] * (inverse ? 1.0 / left[i] : left[i]);
        }
    }
}

static double largest_of(const struct dalcs_matrix *m, bool in_row, int which, int but) {
    double largest = 0.0;
    for (int k = 0; k < (in_row ? m->columns : m->rows); k++) {
        double value = in_row ? *dalcs_at(m, which, k) : *dalcs_at(m, k, which);
        largest = k == but ? largest : fmax(largest, fabs(value));
    }
    return largest;
}

/* States x -> x/unit so that what drives them is as large as what they drive, pairs u -> u/unit, y -> y
 * unit likewise, so that their power stays; then time so that A is 1. */
static enum dalcs_status choose_units(struct dalcs_face *s) {
    DALCS_TRY(copy(&s->q, s->given, s->arena));
    s->unit = dalcs_arena_alloc(s->arena, (size_t)(s->n + s->m) + 1, sizeof(double));
    if (s->unit == NULL) {
        return DALCS_E_NOMEM;
    }
    double *state = s->unit;
    double *pair = s->unit + s->n;
    double fastest = dalcs_matrix_largest(&s->q.A);
    s->time = fastest > 0.0 ? 1.0 / fastest : 1.0;
    for (int k = 0; k < s->n + s->m; k++) {
        s->unit[k] = 1.0;
    }
    for (int sweep = 0; sweep < 20; sweep++) {
        for (int i = 0; i < s->n; i++) {
            double row = fmax(s->time * largest_of(&s->q.A, true, i, i),
                              s->time * largest_of(&s->q.B, true, i, -1));
            double column =
                fmax(s->time * largest_of(&s->q.A, false, i, i), largest_of(&s->q.C, false, i, -1));
            state[i] *= row > 0.0 && column > 0.0 ? sqrt(row / column) : 1.0;
        }
        for (int j = 0; j < s->m; j++) {
            double size =
                fmax(s->time * largest_of(&s->q.B, false, j, -1), largest_of(&s->q.C, true, j, -1));
            size = fmax(size, sqrt(fabs(*dalcs_at(&s->q.D, j, j))));
            pair[j] /= size > 0.0 ? size : 1.0;
        }
        DALCS_TRY(copy(&s->q, s->given, s->arena));
        dalcs_face_scale(&s->q.A, state, true, state, 1.0);
        dalcs_face_scale(&s->q.B, state, true, pair, 1.0);
        dalcs_face_scale(&s->q.C, pair, false, state, 1.0);
        dalcs_face_scale(&s->q.D, pair, false, pair, 1.0);
        fastest = dalcs_matrix_largest(&s->q.A);
        s->time = fastest > 0.0 ? 1.0 / fastest : 1.0;
    }
    for (int i = 0; i < s->n; i++) {
        for (int j = 0; j < s->n; j++) {
            *dalcs_at(&s->q.A, i, j) *= s->time;
        }
        for (int j = 0; j < s->m; j++) {
            *dalcs_at(&s->q.B, i, j) *= s->time;
        }
    }
    return DALCS_OK;
}

/* ---- What is in the kernel of every Q(P) ------------------------------------------------------ */

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
    struct dalcs_matrix cb;
    struct dalcs_matrix where;
    DALCS_TRY(dalcs_matrix_product(&bu, s->arena, &s->q.B, &u));
    DALCS_TRY(dalcs_matrix_product(&abu, s->arena, &s->q.A, &bu));
    DALCS_TRY(dalcs_matrix_product(&rate, s->arena, &s->q.C, &abu));
    DALCS_TRY(dalcs_matrix_product(&cb, s->arena, &s->q.C, &s->q.B));
    DALCS_TRY(dalcs_matrix_new(&where, s->arena, s->n + s->m, u.columns + s->m));
    for (int j = 0; j < where.columns; j++) {
        for (int i = 0; i < s->n && j < u.columns; i++) {
            *dalcs_at(&where, i, j) = *dalcs_at(&bu, i, j);
        }
        if (j >= u.columns) {
            *dalcs_at(&where, s->n + j - u.columns, j) = 1.0;
        }
    }
    /* the form over (coefficients of u, v), put back onto vectors (x, u) */
    struct dalcs_matrix small;
    DALCS_TRY(dalcs_matrix_new(&small, s->arena, where.columns, where.columns));
    for (int i = 0; i < u.columns; i++) {
        for (int j = 0; j < u.columns; j++) {
            double value = 0.0;
            for (int k = 0; k < s->m; k++) {
                value -= *dalcs_at(&u, k, i) * *dalcs_at(&rate, k, j) +
                         *dalcs_at(&u, k, j) * *dalcs_at(&rate, k, i);
            }
            *dalcs_at(&small, i, j) = value;
        }
    }
    for (int i = 0; i < s->m; i++) {
        for (int j = 0; j < u.columns; j++) {
            double value = 0.0;
            for (int k = 0; k < s->m; k++) {
                value += (*dalcs_at(&cb, i, k) - *dalcs_at(&cb, k, i)) * *dalcs_at(&u, k, j);
            }
            *dalcs_at(&small, u.columns + i, j) = *dalcs_at(&small, j, u.columns + i) = value;
        }
        for (int j = 0; j < s->m; j++) {
            *dalcs_at(&small, u.columns + i, u.columns + j) =
                *dalcs_at(&s->q.D, i, j) + *dalcs_at(&s->q.D, j, i);
        }
    }
    double *value = dalcs_arena_alloc(s->arena, (size_t)small.rows + 1, sizeof(double));
    struct dalcs_matrix vector;
    struct dalcs_matrix zeros;
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&small, value, &vector, s->arena));
    vector.columns = 0;
    while (vector.columns < small.rows && value[vector.columns] < noise) {
        s->is_gaining = s->is_gaining || value[vector.columns] < -noise;
        vector.columns++;
    }
    DALCS_TRY(dalcs_matrix_product(&zeros, s->arena, &where, &vector));
    return append(s, &zeros);
}

enum dalcs_status dalcs_face_kernel(struct dalcs_face *s) {
    double *re = dalcs_arena_alloc(s->arena, (size_t)s->n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(s->arena, (size_t)s->n + 1, sizeof(double));
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(choose_units(s));
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

/* ---- P -------------------------------------------------------------------------------------- */

/* Adds `factor` times the matrix number k of the symmetric ones. */
static void add_basis(struct dalcs_matrix *P, int k, double factor) {
    int j = 0;
    while (k > j) {
        k -= ++j;
    }
    *dalcs_at(P, k, j) += k == j ? factor : factor * sqrt(0.5);
    if (k != j) {
        *dalcs_at(P, j, k) += factor * sqrt(0.5);
    }
}

enum dalcs_status dalcs_face_dissipation(const struct dalcs_face *s, const struct dalcs_matrix *P,
                                         bool with_constant, struct dalcs_matrix *Q,
                                         struct dalcs_arena *arena) {
    struct dalcs_matrix pa;
    struct dalcs_matrix pb;
    double constant = with_constant ? 1.0 : 0.0;
    DALCS_TRY(dalcs_matrix_product(&pa, arena, P, &s->q.A));
    DALCS_TRY(dalcs_matrix_product(&pb, arena, P, &s->q.B));
    DALCS_TRY(dalcs_matrix_new(Q, arena, s->n + s->m, s->n + s->m));
    for (int j = 0; j < s->n; j++) {
        for (int i = 0; i < s->n; i++) {
            *dalcs_at(Q, i, j) = -*dalcs_at(&pa, i, j) - *dalcs_at(&pa, j, i);
        }
        for (int i = 0; i < s->m; i++) {
            *dalcs_at(Q, j, s->n + i) = *dalcs_at(Q, s->n + i, j) =
                constant * *dalcs_at(&s->q.C, i, j) - *dalcs_at(&pb, j, i);
        }
    }
    for (int j = 0; j < s->m; j++) {
        for (int i = 0; i < s->m; i++) {
            *dalcs_at(Q, s->n + i, s->n + j) =
                constant * (*dalcs_at(&s->q.D, i, j) + *dalcs_at(&s->q.D, j, i));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_face_find(struct dalcs_face *s, bool *exists) {
    int n_P = s->n * (s->n + 1) / 2;
    int rows = s->n + s->m;
    struct dalcs_matrix equations;
    DALCS_TRY(dalcs_matrix_new(&equations, s->arena, rows * s->kernel.columns, n_P + 1));
    for (int k = 0; k <= n_P; k++) {
        struct dalcs_arena work = {0};
        struct dalcs_matrix P;
        struct dalcs_matrix Q;
        struct dalcs_matrix left;
        enum dalcs_status status = dalcs_matrix_new(&P, &work, s->n, s->n);
        if (status == DALCS_OK && k < n_P) {
            add_basis(&P, k, 1.0);
        }
        status = status == DALCS_OK ? dalcs_face_dissipation(s, &P, k == n_P, &Q, &work) : status;
        status = status == DALCS_OK ? dalcs_matrix_product(&left, &work, &Q, &s->kernel) : status;
        for (int i = 0; status == DALCS_OK && i < equations.rows; i++) {
            *dalcs_at(&equations, i, k) = left.a[i];
        }
        dalcs_arena_finish(&work);
        DALCS_TRY(status);
    }
    struct dalcs_matrix solutions;
    struct dalcs_matrix last;
    struct dalcs_matrix directions;
    int rank;
    double norm = 0.0;
    DALCS_TRY(dalcs_matrix_rank(&equations, &rank, &solutions, s->arena));
    DALCS_TRY(dalcs_matrix_new(&last, s->arena, 1, solutions.columns));
    for (int j = 0; j < solutions.columns; j++) {
        last.a[j] = *dalcs_at(&solutions, n_P, j);
        norm += last.a[j] * last.a[j];
    }
    *exists = norm > 1e-14;
    if (!*exists) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_matrix_new(&s->base, s->arena, s->n, s->n));
    for (int k = 0; k < n_P; k++) {
        double value = 0.0;
        for (int j = 0; j < solutions.columns; j++) {
            value += *dalcs_at(&solutions, k, j) * last.a[j] / norm;
        }
        add_basis(&s->base, k, value);
    }
    DALCS_TRY(dalcs_matrix_rank(&last, &rank, &directions, s->arena));
    DALCS_TRY(dalcs_matrix_product(&s->free, s->arena, &solutions, &directions));
    s->n_free = s->free.columns;
    return DALCS_OK;
}

enum dalcs_status dalcs_face_direction(const struct dalcs_face *s, int k, struct dalcs_matrix *P,
                                       struct dalcs_arena *arena) {
    DALCS_TRY(dalcs_matrix_new(P, arena, s->n, s->n));
    for (int i = 0; i < s->n * (s->n + 1) / 2; i++) {
        add_basis(P, i, *dalcs_at(&s->free, i, k));
    }
    return DALCS_OK;
}
