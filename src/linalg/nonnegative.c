/* nonnegative.c - the active set of least squares, on an orthonormal basis of its columns. */
#include "nonnegative.h"

#include <math.h>
#include <string.h>

/* A column of which the basis leaves no more than this depends on it. */
static const double dependent = 1e-10;

/* A column is used only if this part of the residual lies along it. */
static const double useful = 1e-12;

static double dot(const double *a, const double *b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* v less its part in the basis, which is added to part[k]; twice is enough (W. Kahan). */
static void project(const struct dalcs_nonnegative *p, double *v, double *part) {
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < p->k; i++) {
            const double *q = p->basis + (size_t)i * (size_t)p->m;
            double along = dot(q, v, p->m);
            part[i] += along;
            for (int row = 0; row < p->m; row++) {
                v[row] -= along * q[row];
            }
        }
    }
}

/* False: it depends on the others. */
static bool add(struct dalcs_nonnegative *p, int column) {
    size_t m = (size_t)p->m;
    if (p->k == p->m) {
        return false;
    }
    double *v = p->basis + (size_t)p->k * m;
    double *part = p->r + (size_t)p->k * m;
    memcpy(v, p->a + (size_t)column * m, m * sizeof(double));
    memset(part, 0, m * sizeof(double));
    project(p, v, part);
    double norm = sqrt(dot(v, v, p->m));
    if (!(norm > dependent * p->size[column])) {
        return false;
    }
    for (size_t i = 0; i < m; i++) {
        v[i] /= norm;
    }
    part[p->k] = norm;
    p->active[p->k++] = column;
    p->is_active[column] = true;
    return true;
}

/* z of the active columns: the least squares without signs. */
static void solve_active(struct dalcs_nonnegative *p) {
    for (int i = p->k - 1; i >= 0; i--) {
        double sum = dot(p->basis + (size_t)i * (size_t)p->m, p->b, p->m);
        for (int j = i + 1; j < p->k; j++) {
            sum -= p->r[(size_t)j * (size_t)p->m + (size_t)i] * p->z[j];
        }
        p->z[i] = sum / p->r[(size_t)i * (size_t)p->m + (size_t)i];
    }
}

/* The basis again, without the columns that are no more active. */
static void rebuild(struct dalcs_nonnegative *p) {
    int n = p->k;
    p->k = 0;
    for (int i = 0; i < n; i++) {
        int column = p->active[i];
        if (p->is_active[column] && !add(p, column)) {
            p->is_active[column] = false;
            p->q[column] = 0.0;
        }
    }
    memset(p->is_barred, 0, (size_t)p->n * sizeof(bool));
}

/* From q towards z as far as signs allow. True: all the way. */
static bool advance(struct dalcs_nonnegative *p) {
    double alpha = 1.0;
    int first = -1;
    for (int i = 0; i < p->k; i++) {
        int c = p->active[i];
        if (!p->is_free[c] && !(p->z[i] > 0.0)) {
            double limit = p->q[c] > 0.0 ? p->q[c] / (p->q[c] - p->z[i]) : 0.0;
            if (first < 0 || limit < alpha) {
                alpha = limit;
                first = c;
            }
        }
    }
    for (int i = 0; i < p->k; i++) {
        int c = p->active[i];
        p->q[c] = first < 0 ? p->z[i] : p->q[c] + alpha * (p->z[i] - p->q[c]);
        if (first >= 0 && !p->is_free[c] && (c == first || !(p->q[c] > 0.0))) {
            p->q[c] = 0.0;
            p->is_active[c] = false;
        }
    }
    return first < 0;
}

static void find_rest(struct dalcs_nonnegative *p) {
    memcpy(p->rest, p->b, (size_t)p->m * sizeof(double));
    project(p, p->rest, p->z);
}

/* The column with the largest component of the residual; -1: none. */
static int most_useful(const struct dalcs_nonnegative *p, int n) {
    int best = -1;
    double most = useful * sqrt(dot(p->b, p->b, p->m));
    for (int c = 0; c < n; c++) {
        if (p->is_free[c] || p->is_active[c] || p->is_barred[c] || p->size[c] == 0.0) {
            continue;
        }
        double along = dot(p->a + (size_t)c * (size_t)p->m, p->rest, p->m) / p->size[c];
        if (along > most) {
            most = along;
            best = c;
        }
    }
    return best;
}

void dalcs_nonnegative_solve(struct dalcs_nonnegative *p, int n) {
    p->k = 0;
    memset(p->q, 0, (size_t)p->n * sizeof(double));
    memset(p->is_active, 0, (size_t)p->n * sizeof(bool));
    memset(p->is_barred, 0, (size_t)p->n * sizeof(bool));
    for (int c = 0; c < n; c++) {
        const double *a = p->a + (size_t)c * (size_t)p->m;
        p->size[c] = sqrt(dot(a, a, p->m));
        if (p->is_free[c]) {
            (void)add(p, c);
        }
    }
    find_rest(p);
    int column = most_useful(p, n);
    for (int round = 0; round < 4 * n && column >= 0; round++) {
        if (add(p, column)) {
            solve_active(p);
            while (!advance(p)) {
                rebuild(p);
                solve_active(p);
            }
            find_rest(p);
        } else {
            p->is_barred[column] = true;
        }
        column = most_useful(p, n);
    }
    solve_active(p);
    for (int i = 0; i < p->k; i++) {
        p->q[p->active[i]] = p->z[i];
    }
    find_rest(p);
    project(p, p->rest, p->z);
}

enum dalcs_status dalcs_nonnegative_setup(struct dalcs_nonnegative *p, struct dalcs_arena *arena,
                                          int m, int n) {
    size_t rows = (size_t)m;
    size_t columns = (size_t)n;
    *p = (struct dalcs_nonnegative){
        .m = m,
        .n = n,
        .a = dalcs_arena_alloc(arena, rows * columns, sizeof(double)),
        .is_free = dalcs_arena_alloc(arena, columns, sizeof(bool)),
        .b = dalcs_arena_alloc(arena, rows, sizeof(double)),
        .q = dalcs_arena_alloc(arena, columns, sizeof(double)),
        .rest = dalcs_arena_alloc(arena, rows, sizeof(double)),
        .basis = dalcs_arena_alloc(arena, rows * rows, sizeof(double)),
        .r = dalcs_arena_alloc(arena, rows * rows, sizeof(double)),
        .size = dalcs_arena_alloc(arena, columns, sizeof(double)),
        .z = dalcs_arena_alloc(arena, rows, sizeof(double)),
        .active = dalcs_arena_alloc(arena, rows, sizeof(int)),
        .is_active = dalcs_arena_alloc(arena, columns, sizeof(bool)),
        .is_barred = dalcs_arena_alloc(arena, columns, sizeof(bool)),
    };
    bool complete = p->a != NULL && p->is_free != NULL && p->b != NULL && p->q != NULL &&
                    p->rest != NULL && p->basis != NULL && p->r != NULL && p->size != NULL &&
                    p->z != NULL && p->active != NULL && p->is_active != NULL &&
                    p->is_barred != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}
