/* redundant_rows.c - the largest rows of the dependencies, by Gaussian elimination with complete pivoting. */
#include "redundant_rows.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_dependencies_setup(struct dalcs_dependencies *d, struct dalcs_arena *arena,
                                           int n, int n_rows) {
    *d = (struct dalcs_dependencies){.n = n, .n_rows = n_rows};
    d->weight = dalcs_arena_alloc(arena, (size_t)n * (size_t)n_rows, sizeof(double));
    d->scaled = dalcs_arena_alloc(arena, (size_t)n * (size_t)n_rows, sizeof(double));
    d->size = dalcs_arena_alloc(arena, (size_t)n_rows, sizeof(double));
    d->chosen = dalcs_arena_alloc(arena, (size_t)n, sizeof(int));
    d->largest = dalcs_arena_alloc(arena, (size_t)n, sizeof(int));
    bool complete = d->weight != NULL && d->scaled != NULL && d->size != NULL &&
                    d->chosen != NULL && d->largest != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* Weights of rows, times what the row's terms add up to. */
static double *scaled_of(const struct dalcs_dependencies *d, int k) {
    return d->scaled + (size_t)k * (size_t)d->n_rows;
}

static int largest_of(const struct dalcs_dependencies *d, int k) {
    const double *weight = scaled_of(d, k);
    int row = 0;
    for (int r = 1; r < d->n_rows; r++) {
        row = fabs(weight[r]) > fabs(weight[row]) ? r : row;
    }
    return row;
}

/* The dependency with the largest weight from `first` on is brought there; returns the row of that. */
static int bring_largest(const struct dalcs_dependencies *d, int first) {
    int largest = first;
    for (int k = first + 1; k < d->n; k++) {
        const double weight = fabs(scaled_of(d, k)[d->largest[k]]);
        largest = weight > fabs(scaled_of(d, largest)[d->largest[largest]]) ? k : largest;
    }
    const int row = d->largest[largest];
    d->largest[largest] = d->largest[first];
    for (int r = 0; r < d->n_rows && largest != first; r++) {
        const double swap = scaled_of(d, first)[r];
        scaled_of(d, first)[r] = scaled_of(d, largest)[r];
        scaled_of(d, largest)[r] = swap;
    }
    return row;
}

/* False: one is of rows alone that may not be left out. Those of islands apart have no row in common, so that most have
 * nothing of another one to lose. */
static bool choose(const struct dalcs_dependencies *d) {
    for (int k = 0; k < d->n; k++) {
        d->largest[k] = largest_of(d, k);
    }
    for (int k = 0; k < d->n; k++) {
        const int row = bring_largest(d, k);
        const double *by = scaled_of(d, k);
        if (!(fabs(by[row]) > 0.0)) {
            return false;
        }
        d->chosen[k] = row;
        for (int other = k + 1; other < d->n; other++) {
            double *of = scaled_of(d, other);
            if (of[row] == 0.0) {
                continue;
            }
            const double factor = of[row] / by[row];
            for (int r = 0; r < d->n_rows; r++) {
                of[r] -= factor * by[r];
            }
            of[row] = 0.0;
            d->largest[other] = largest_of(d, other);
        }
    }
    return true;
}

bool dalcs_dependencies_choose(const struct dalcs_dependencies *d, int n_candidates) {
    for (int k = 0; k < d->n; k++) {
        const double *weight = d->weight + (size_t)k * (size_t)d->n_rows;
        double *scaled = scaled_of(d, k);
        for (int r = 0; r < d->n_rows; r++) {
            scaled[r] = r < n_candidates ? weight[r] * d->size[r] : 0.0;
        }
    }
    return choose(d);
}

static void find(struct dalcs_null_space *space, struct dalcs_null_space *rows,
                 const struct dalcs_triplets *t, const double *size, int n_candidates,
                 struct dalcs_dependencies *d) {
    for (size_t k = 0; k < t->n; k++) {
        d->size[t->entry[k].row] += fabs(t->entry[k].value) * size[t->entry[k].column];
    }
    for (int r = 0; r < d->n_rows; r++) {
        d->size[r] = d->size[r] > 0.0 ? d->size[r] : 1.0; /* an empty row depends alone */
    }
    for (int k = 0; k < d->n; k++) {
        dalcs_null_space_vector(rows, k, d->weight + (size_t)k * (size_t)d->n_rows);
    }
    if (dalcs_dependencies_choose(d, n_candidates)) {
        memcpy(space->redundant, d->chosen, (size_t)d->n * sizeof(int));
    }
}

enum dalcs_status dalcs_redundant_rows_choose(struct dalcs_null_space *space,
                                              const struct dalcs_triplets *t, const double *size,
                                              int n_candidates, struct dalcs_dependencies *d) {
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
            find(space, &rows, t, size, n_candidates, d);
        }
        dalcs_null_space_finish(&rows);
    }
    dalcs_triplets_finish(&transposed);
    return status;
}
