/* storage_face.c - units, and the P that motions which neither gain nor lose leave. */
#include "storage_face.h"

#include <math.h>

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

enum dalcs_status dalcs_face_choose_units(struct dalcs_face *s) {
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
