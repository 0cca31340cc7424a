/* runs.c - see runs.h. */
#include "runs.h"

#include <stdlib.h>

/* The value of a column in row k. */
static double at(const struct dalcs_waveforms *w, size_t column, size_t k) {
    return w->value[k * w->n_columns + column];
}

static bool is_constant(const struct dalcs_waveforms *w, size_t column) {
    for (size_t k = 1; k < w->n_rows; k++) {
        if (at(w, column, k) != at(w, column, 0)) {
            return false;
        }
    }
    return true;
}

/* Is it what a run was made with? */
static bool is_parameter(const struct dalcs_runs *runs, size_t column) {
    bool differs = false;
    for (size_t r = 0; r < runs->n; r++) {
        const struct dalcs_waveforms *w = &runs->waveforms[r];
        if (!is_constant(w, column)) {
            return false;
        }
        differs = differs || at(w, column, 0) != at(&runs->waveforms[0], column, 0);
    }
    return differs;
}

static enum dalcs_status name_runs(struct dalcs_runs *runs) {
    const size_t n_columns = runs->waveforms[0].n_columns;
    for (size_t c = 1; c < n_columns; c++) {
        for (size_t r = 0; r < runs->n && (r > 0 || is_parameter(runs, c)); r++) {
            const struct dalcs_waveforms *w = &runs->waveforms[r];
            const char *before = runs->label[r];
            runs->label[r] = dalcs_arena_printf(&runs->arena, "%s%s%s = %.6g", before ? before : "",
                                                before ? ", " : "", w->name[c], at(w, c, 0));
            if (runs->label[r] == NULL) {
                return DALCS_E_NOMEM;
            }
        }
    }
    for (size_t r = 0; r < runs->n && runs->label[r] == NULL; r++) {
        runs->label[r] = dalcs_arena_printf(&runs->arena, "run %zu", r + 1);
        if (runs->label[r] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}

/* Row k begins another run: the axis turns back. */
static bool begins(const struct dalcs_waveforms *all, size_t k) {
    return k == 0 || at(all, 0, k) < at(all, 0, k - 1);
}

enum dalcs_status dalcs_runs_find(struct dalcs_runs *runs, const struct dalcs_waveforms *all) {
    size_t n = 0, r = 0;
    for (size_t k = 0; k < all->n_rows; k++) {
        n += begins(all, k) ? 1 : 0;
    }
    /* Of a sweep downwards each row would be one. */
    if (n < 2 || n > all->n_rows / 2) {
        return DALCS_OK;
    }
    runs->waveforms = dalcs_arena_alloc(&runs->arena, n, sizeof(*runs->waveforms));
    runs->label = dalcs_arena_alloc(&runs->arena, n, sizeof(*runs->label));
    if (runs->waveforms == NULL || runs->label == NULL) {
        return DALCS_E_NOMEM;
    }
    runs->n = n;
    for (size_t k = 0; k < all->n_rows; k++) {
        if (begins(all, k)) {
            runs->waveforms[r] = *all;
            runs->waveforms[r].value = all->value + k * all->n_columns;
            runs->waveforms[r++].n_rows = 0;
        }
        runs->waveforms[r - 1].n_rows++;
    }
    return name_runs(runs);
}

void dalcs_runs_finish(struct dalcs_runs *runs) {
    dalcs_arena_finish(&runs->arena);
    *runs = (struct dalcs_runs){0};
}
