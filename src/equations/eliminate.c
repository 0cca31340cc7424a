/* eliminate.c - B_II z = -(A_II x + Bbar_II lambda + E_II) solved for z, densely. Where B_II is singular, the
 * null vector says which unknowns the equations II leave open. */
#include "eliminate.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Unknowns up to which z is eliminated densely. */
enum { MOST_UNKNOWNS = 1000 };

/* A B_II, balanced, whose reciprocal condition is smaller is singular. */
static const double least_rcond = 1e-14;

/* Powers of 2 that make rows and then columns of m[n][n] of size 1. */
static void balance(double *m, size_t n, double *row, double *column) {
    for (int by_column = 0; by_column < 2; by_column++) {
        for (size_t i = 0; i < n; i++) {
            double largest = 0.0;
            for (size_t j = 0; j < n; j++) {
                largest = fmax(largest, fabs(m[by_column ? j * n + i : i * n + j]));
            }
            int power = 0;
            (void)frexp(largest, &power);
            double scale = largest > 0.0 ? ldexp(1.0, -power) : 1.0;
            (by_column ? column : row)[i] = scale;
            for (size_t j = 0; j < n; j++) {
                m[by_column ? j * n + i : i * n + j] *= scale;
            }
        }
    }
}

/* The right side -(A_II, Bbar_II, E_II), scaled as the rows. */
static void fill_right(struct dalcs_elimination *z, const double *row) {
    const struct dalcs_system *s = z->from;
    for (size_t i = 0; i < z->n_z; i++) {
        int r = s->n_x + (int)i;
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            int c = s->A.j[k];
            if (c < s->n_x || c >= dalcs_system_n_equations(s)) {
                size_t to = (size_t)(c < s->n_x ? c : c - s->n_z);
                z->Z[i * z->n_right + to] = -row[i] * s->A.x[k];
            }
        }
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            z->Z[i * z->n_right + (size_t)(s->n_x + s->n_pairs + s->E.j[k])] = -row[i] * s->E.x[k];
        }
    }
}

/* The names that a null vector of B_II has. */
static const char *name_open(const struct dalcs_elimination *z, const double *null,
                             const double *column, struct dalcs_arena *arena) {
    const struct dalcs_system *s = z->from;
    const char *list = NULL;
    double largest = 0.0;
    int n = 0;
    for (size_t i = 0; i < z->n_z; i++) {
        largest = fmax(largest, fabs(null[i] * column[i]));
    }
    for (size_t i = 0; i < z->n_z; i++) {
        int c = s->n_x + (int)i;
        if (fabs(null[i] * column[i]) < 1e-6 * largest || ++n > 6) {
            continue;
        }
        const char *what = s->column_is_current[c] ? "i" : "v";
        list = list == NULL
                   ? dalcs_arena_printf(arena, "%s(%s)", what, s->column[c].element)
                   : dalcs_arena_printf(arena, "%s, %s(%s)", list, what, s->column[c].element);
        if (list == NULL) {
            return NULL;
        }
    }
    return n > 6 ? dalcs_arena_printf(arena, "%s and %d more", list, n - 6) : list;
}

static enum dalcs_status explain_singular(struct dalcs_elimination *z, double *m,
                                          const double *column, struct dalcs_arena *arena) {
    size_t n = z->n_z;
    double *value = dalcs_alloc(n, sizeof *value);
    double *vt = dalcs_alloc(n * n, sizeof *vt);
    double *work = dalcs_alloc(n, sizeof *work);
    enum dalcs_status status = DALCS_E_NOMEM;
    if (value != NULL && vt != NULL && work != NULL) {
        double unused;
        lapack_int info =
            LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'A', (lapack_int)n, (lapack_int)n, m,
                           (lapack_int)n, value, &unused, 1, vt, (lapack_int)n, work);
        const char *names = info == 0 ? name_open(z, vt + (n - 1) * n, column, arena) : NULL;
        z->because = dalcs_arena_printf(
            arena, "B_II is singular: the equations without complementarity leave %s open",
            names == NULL ? "something" : names);
        status = z->because == NULL ? DALCS_E_NOMEM : DALCS_OK;
    }
    free(value);
    free(vt);
    free(work);
    return status;
}

struct workspace {
    double *m, *copy, *row, *column;
    lapack_int *pivot;
};

double dalcs_dense_one_norm(const double *m, size_t n) {
    double norm = 0.0;
    for (size_t j = 0; j < n; j++) {
        double sum = 0.0;
        for (size_t i = 0; i < n; i++) {
            sum += fabs(m[i * n + j]);
        }
        norm = fmax(norm, sum);
    }
    return norm;
}

static enum dalcs_status solve_for_z(struct dalcs_elimination *z, struct workspace *w,
                                     struct dalcs_arena *arena) {
    const struct dalcs_system *s = z->from;
    const size_t n = z->n_z;
    for (size_t i = 0; i < n; i++) {
        int r = s->n_x + (int)i;
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            int c = s->A.j[k] - s->n_x;
            if (c >= 0 && c < s->n_z) {
                w->m[i * n + (size_t)c] = s->A.x[k];
            }
        }
    }
    balance(w->m, n, w->row, w->column);
    memcpy(w->copy, w->m, n * n * sizeof *w->m);
    double norm = dalcs_dense_one_norm(w->m, n);
    double rcond = 0.0;
    lapack_int info = LAPACKE_dgetrf(LAPACK_ROW_MAJOR, (lapack_int)n, (lapack_int)n, w->m,
                                     (lapack_int)n, w->pivot);
    if (info == 0) {
        info =
            LAPACKE_dgecon(LAPACK_ROW_MAJOR, '1', (lapack_int)n, w->m, (lapack_int)n, norm, &rcond);
    }
    if (info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR) {
        return DALCS_E_NOMEM;
    }
    if (info != 0 || rcond < least_rcond) {
        return explain_singular(z, w->copy, w->column, arena);
    }
    fill_right(z, w->row);
    if (LAPACKE_dgetrs(LAPACK_ROW_MAJOR, 'N', (lapack_int)n, (lapack_int)z->n_right, w->m,
                       (lapack_int)n, w->pivot, z->Z, (lapack_int)z->n_right) != 0) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < z->n_right; j++) {
            z->Z[i * z->n_right + j] *= w->column[i];
        }
    }
    z->is_regular = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_eliminate(struct dalcs_elimination *z, const struct dalcs_system *from,
                                  struct dalcs_arena *arena) {
    *z =
        (struct dalcs_elimination){.from = from,
                                   .n_z = (size_t)from->n_z,
                                   .n_right = (size_t)(from->n_x + from->n_pairs + from->n_inputs)};
    if (from->n_z > MOST_UNKNOWNS) {
        z->because =
            dalcs_arena_printf(arena, "more than %d unknowns are not eliminated", MOST_UNKNOWNS);
        return z->because == NULL ? DALCS_E_NOMEM : DALCS_OK;
    }
    const size_t n = z->n_z;
    struct workspace w = {.m = dalcs_alloc(n * n, sizeof *w.m),
                          .copy = dalcs_alloc(n * n, sizeof *w.copy),
                          .row = dalcs_alloc(n, sizeof *w.row),
                          .column = dalcs_alloc(n, sizeof *w.column),
                          .pivot = dalcs_alloc(n, sizeof *w.pivot)};
    z->Z = dalcs_alloc(n * z->n_right, sizeof *z->Z);
    enum dalcs_status status = DALCS_E_NOMEM;
    if (w.m != NULL && w.copy != NULL && w.row != NULL && w.column != NULL && w.pivot != NULL &&
        z->Z != NULL) {
        z->is_regular = n == 0;
        status = n == 0 ? DALCS_OK : solve_for_z(z, &w, arena);
    }
    free(w.m);
    free(w.copy);
    free(w.row);
    free(w.column);
    free(w.pivot);
    return status;
}
