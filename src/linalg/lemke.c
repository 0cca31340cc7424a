/* lemke.c - a tableau, and pivots in it. */
#include "lemke.h"

#include <float.h>
#include <math.h>
#include <string.h>

static size_t width_of(const struct dalcs_lemke *l) {
    return 2 * (size_t)l->n + 2;
}

static long double *row_of(const struct dalcs_lemke *l, int i) {
    return l->tableau + (size_t)i * width_of(l);
}

enum dalcs_status dalcs_lemke_setup(struct dalcs_lemke *l, int n) {
    size_t m = (size_t)n;
    *l = (struct dalcs_lemke){.n = n};
    l->law = dalcs_arena_alloc(&l->arena, m, sizeof(*l->law));
    l->S = dalcs_arena_alloc(&l->arena, m * m, sizeof(double));
    l->h = dalcs_arena_alloc(&l->arena, m, sizeof(double));
    l->is_a = dalcs_arena_alloc(&l->arena, m, sizeof(bool));
    l->basic = dalcs_arena_alloc(&l->arena, m, sizeof(int));
    l->tableau = dalcs_arena_alloc(&l->arena, m * width_of(l), sizeof(long double));
    if (l->law == NULL || l->S == NULL || l->h == NULL || l->is_a == NULL || l->basic == NULL ||
        l->tableau == NULL) {
        dalcs_lemke_finish(l);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_lemke_finish(struct dalcs_lemke *l) {
    dalcs_arena_finish(&l->arena);
    *l = (struct dalcs_lemke){0};
}

/* (1 - S) a - (1 + S) b = h */
static void fill(const struct dalcs_lemke *l) {
    for (int i = 0; i < l->n; i++) {
        long double *row = row_of(l, i);
        const double *S = l->S + (size_t)i * (size_t)l->n;
        for (int k = 0; k < l->n; k++) {
            row[k] = (i == k ? 1.0L : 0.0L) - S[k];
            row[l->n + k] = (i == k ? -1.0L : 0.0L) - S[k];
        }
        row[2 * l->n] = 0.0L;
        row[2 * l->n + 1] = l->h[i];
    }
}

static void pivot(const struct dalcs_lemke *l, int row, int column) {
    size_t width = width_of(l);
    long double *source = row_of(l, row);
    long double inverse = 1.0L / source[column];
    for (size_t k = 0; k < width; k++) {
        source[k] *= inverse;
    }
    source[column] = 1.0L;
    for (int i = 0; i < l->n; i++) {
        long double *target = row_of(l, i);
        long double factor = target[column];
        if (i == row || factor == 0.0L) {
            continue;
        }
        for (size_t k = 0; k < width; k++) {
            target[k] -= factor * source[k];
        }
        target[column] = 0.0L;
    }
    l->basic[row] = column;
}

static enum dalcs_status find_basis(const struct dalcs_lemke *l) {
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < l->n; k++) {
            bool is_free = l->law[k] != DALCS_LEMKE_EITHER;
            if (is_free != (pass == 0)) {
                continue;
            }
            const long double *row = row_of(l, k);
            bool takes_a =
                is_free ? l->law[k] == DALCS_LEMKE_A_FREE : fabsl(row[k]) >= fabsl(row[l->n + k]);
            int column = takes_a ? k : l->n + k;
            if (row[column] == 0.0L) {
                return DALCS_SINGULAR;
            }
            pivot(l, k, column);
        }
    }
    return DALCS_OK;
}

/* Is row i's ratio to its entry in `column` lexicographically less than that of row j? The columns of the first
 * basis follow the right-hand side. */
static bool is_less(const struct dalcs_lemke *l, const int *first, int column, int i, int j) {
    const long double *a = row_of(l, i);
    const long double *b = row_of(l, j);
    for (int k = -1; k < l->n; k++) {
        int of = k < 0 ? 2 * l->n + 1 : first[k];
        long double left = a[of] / a[column];
        long double right = b[of] / b[column];
        if (fabsl(left - right) > DBL_EPSILON * fmaxl(fabsl(left), fabsl(right))) {
            return left < right;
        }
    }
    return false;
}

/* The row that bounds what enters; -1: none does. A row whose entry is rounding beside the others bounds
 * nothing. */
static int leaving_row(const struct dalcs_lemke *l, const int *first, int column) {
    long double most = 0.0L;
    for (int i = 0; i < l->n; i++) {
        most = fmaxl(most, fabsl(row_of(l, i)[column]));
    }
    int best = -1;
    for (int i = 0; i < l->n; i++) {
        bool bounds = l->law[i] == DALCS_LEMKE_EITHER && row_of(l, i)[column] > DBL_EPSILON * most;
        if (bounds && (best < 0 || is_less(l, first, column, i, best))) {
            best = i;
        }
    }
    return best;
}

/* The cover enters, where the right-hand side is most negative. False: it is nowhere. */
static bool cover(struct dalcs_lemke *l, int *leaving) {
    int worst = -1;
    for (int i = 0; i < l->n; i++) {
        long double *row = row_of(l, i);
        if (l->law[i] == DALCS_LEMKE_EITHER) {
            row[2 * l->n] = -1.0L;
            if (row[2 * l->n + 1] < 0.0L &&
                (worst < 0 || row[2 * l->n + 1] < row_of(l, worst)[2 * l->n + 1])) {
                worst = i;
            }
        }
    }
    if (worst >= 0) {
        *leaving = l->basic[worst];
        pivot(l, worst, 2 * l->n);
    }
    return worst >= 0;
}

static enum dalcs_status follow(struct dalcs_lemke *l, const int *first, int limit) {
    int leaving;
    if (!cover(l, &leaving)) {
        return DALCS_OK;
    }
    for (int k = 0; k < limit; k++) {
        int entering = leaving < l->n ? leaving + l->n : leaving - l->n;
        int row = leaving_row(l, first, entering);
        if (row < 0) {
            break;
        }
        leaving = l->basic[row];
        pivot(l, row, entering);
        if (leaving == 2 * l->n) {
            return DALCS_OK;
        }
    }
    return DALCS_NOT_CONVERGED;
}

enum dalcs_status dalcs_lemke_solve(struct dalcs_lemke *l, int limit) {
    int *first = dalcs_arena_alloc(&l->arena, (size_t)l->n, sizeof(int));
    if (first == NULL) {
        return DALCS_E_NOMEM;
    }
    fill(l);
    DALCS_TRY(find_basis(l));
    memcpy(first, l->basic, (size_t)l->n * sizeof(int));
    enum dalcs_status status = follow(l, first, limit);
    memset(l->is_a, 0, (size_t)l->n * sizeof(bool));
    for (int i = 0; i < l->n; i++) {
        if (l->basic[i] < l->n) {
            l->is_a[l->basic[i]] = true;
        }
    }
    return status;
}
