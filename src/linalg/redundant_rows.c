/* redundant_rows.c - the largest rows of the dependencies, by Gaussian elimination with complete pivoting. */
#include "redundant_rows.h"

#include <math.h>
#include <string.h>

/* Weights of rows, times what the row's terms add up to. */
struct dependencies {
    int n, n_rows;
    double *weight; /* [n][n_rows] */
    double *size;   /* [n_rows] */
};

static double *weights_of(const struct dependencies *d, int k) {
    return d->weight + (size_t)k * (size_t)d->n_rows;
}

/* The largest weight from dependency `first` on, which is brought there; returns its row. */
static int bring_largest(const struct dependencies *d, int first) {
    int row = 0;
    int largest = first;
    for (int k = first; k < d->n; k++) {
        for (int r = 0; r < d->n_rows; r++) {
            if (fabs(weights_of(d, k)[r]) > fabs(weights_of(d, largest)[row])) {
                largest = k;
                row = r;
            }
        }
    }
    for (int r = 0; r < d->n_rows; r++) {
        const double swap = weights_of(d, first)[r];
        weights_of(d, first)[r] = weights_of(d, largest)[r];
        weights_of(d, largest)[r] = swap;
    }
    return row;
}

/* False: one is of rows alone that may not be left out. */
static bool choose(const struct dependencies *d, int *redundant) {
    for (int k = 0; k < d->n; k++) {
        const int row = bring_largest(d, k);
        const double *by = weights_of(d, k);
        if (!(fabs(by[row]) > 0.0)) {
            return false;
        }
        redundant[k] = row;
        for (int other = k + 1; other < d->n; other++) {
            double *of = weights_of(d, other);
            const double factor = of[redundant[k]] / by[redundant[k]];
            for (int r = 0; r < d->n_rows; r++) {
                of[r] -= factor * by[r];
            }
            of[redundant[k]] = 0.0;
        }
    }
    return true;
}

static enum dalcs_status find(struct dalcs_null_space *space, const struct dalcs_null_space *rows,
                              const struct dalcs_triplets *t, const double *size,
                              int n_candidates) {
    const size_t n_rows = (size_t)space->n_rows;
    struct dependencies d = {.n = rows->n_free, .n_rows = space->n_rows};
    d.weight = dalcs_arena_alloc(&space->arena, (size_t)d.n * n_rows, sizeof(double));
    d.size = dalcs_arena_alloc(&space->arena, n_rows, sizeof(double));
    int *chosen = dalcs_arena_alloc(&space->arena, (size_t)d.n, sizeof(int));
    if (d.weight == NULL || d.size == NULL || chosen == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < t->n; k++) {
        d.size[t->entry[k].row] += fabs(t->entry[k].value) * size[t->entry[k].column];
    }
    for (int k = 0; k < d.n; k++) {
        dalcs_null_space_vector(rows, k, weights_of(&d, k));
        for (size_t r = 0; r < n_rows; r++) {
            const double own = d.size[r] > 0.0 ? d.size[r] : 1.0; /* an empty row depends alone */
            weights_of(&d, k)[r] *= r < (size_t)n_candidates ? own : 0.0;
        }
    }
    if (choose(&d, chosen)) {
        memcpy(space->redundant, chosen, (size_t)d.n * sizeof(int));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_redundant_rows_choose(struct dalcs_null_space *space,
                                              const struct dalcs_triplets *t, const double *size,
                                              int n_candidates) {
    struct dalcs_triplets transposed = {0};
    struct dalcs_null_space rows;
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < t->n && status == DALCS_OK; k++) {
        const struct dalcs_triplet *e = &t->entry[k];
        status = dalcs_triplets_add(&transposed, e->column, e->row, e->value);
    }
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(&rows, space->n_columns, space->n_rows, &transposed);
    }
    if (status == DALCS_OK) {
        if (rows.n_free == space->n_redundant) {
            status = find(space, &rows, t, size, n_candidates);
        }
        dalcs_null_space_finish(&rows);
    }
    dalcs_triplets_finish(&transposed);
    return status;
}
