/* family.c - runs of a file to curves with a value each. */
#include "family.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const double *row_at(const struct dalcs_waveforms *w, size_t row) {
    return w->value + row * w->n_columns;
}

/* The same value in all rows of each run, and not in all runs. */
static bool is_of_runs(const struct dalcs_waveforms *w, size_t n_runs, size_t column) {
    bool differs = false;
    for (size_t run = 1; run <= n_runs; run++) {
        size_t first;
        size_t end;
        (void)dalcs_waveforms_find_run(w, run, &first, &end);
        const double value = row_at(w, first)[column];
        for (size_t row = first; row < end; row++) {
            if (row_at(w, row)[column] != value) {
                return false;
            }
        }
        differs = differs || value != row_at(w, 0)[column];
    }
    return differs;
}

/* n_columns after a message. */
static size_t choose_column(const struct dalcs_waveforms *w, size_t n_runs, const char *by,
                            struct dalcs_diag *diag) {
    size_t k = 1;
    if (by[0] == '\0') {
        while (k < w->n_columns && !is_of_runs(w, n_runs, k)) {
            k++;
        }
        if (k >= w->n_columns) {
            dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                           "no column of the file differs between its %zu runs", n_runs);
        }
        return k;
    }
    while (k < w->n_columns && strcasecmp(w->name[k], by) != 0) {
        k++;
    }
    if (k >= w->n_columns || !is_of_runs(w, n_runs, k)) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                       k >= w->n_columns ? "the file has no column '%s'"
                                         : "'%s' does not have one value in each run",
                       by);
        return w->n_columns;
    }
    return k;
}

static enum dalcs_status add_row(void *user, double at, const double *value) {
    dalcs_curve_add(user, at, value[0]);
    return DALCS_OK;
}

/* What is asked for. */
struct request {
    const char *const *group;
    size_t n_groups;
    double from, to;
    struct dalcs_diag *diag;
};

/* Of the first run: what the curves have in common. */
static enum dalcs_status describe(struct dalcs_family *family, struct dalcs_arena *arena,
                                  const struct dalcs_selection *selection) {
    const char *unit = selection->panel[0].unit;
    family->signal = dalcs_arena_copy(arena, selection->name[0], strlen(selection->name[0]));
    family->unit = dalcs_arena_copy(arena, unit, strlen(unit));
    family->axis = selection->axis;
    family->axis.unit = dalcs_arena_copy(arena, selection->axis.unit, strlen(selection->axis.unit));
    return family->signal == NULL || family->unit == NULL || family->axis.unit == NULL
               ? DALCS_E_NOMEM
               : DALCS_OK;
}

static enum dalcs_status take_selected(struct dalcs_family *family, struct dalcs_arena *arena,
                                       const struct dalcs_selection *selection,
                                       struct dalcs_diag *diag) {
    if (selection->n != 1) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "choose it with -s",
                       "a family shows one signal, and these are %zu", selection->n);
        return DALCS_E_OPTION;
    }
    if (family->n == 0) {
        DALCS_TRY(describe(family, arena, selection));
    }
    struct dalcs_curve *curve = &family->curve[family->n];
    DALCS_TRY(dalcs_curve_init(curve, selection->start, selection->stop));
    family->n++;
    curve->logarithmic = selection->axis.logarithmic;
    return dalcs_selection_each_row(selection, add_row, curve);
}

static enum dalcs_status take_run(struct dalcs_family *family, struct dalcs_waveforms *all,
                                  size_t run, const struct request *request) {
    struct dalcs_waveforms one = *all; /* of its rows a part */
    struct dalcs_selection selection;
    size_t first;
    size_t end;
    (void)dalcs_waveforms_find_run(all, run, &first, &end);
    one.value = all->value + first * all->n_columns;
    one.n_rows = end - first;
    DALCS_TRY(dalcs_selection_make(&selection, &one, request->group, request->n_groups,
                                   request->from, request->to, request->diag));
    const enum dalcs_status status = take_selected(family, &all->arena, &selection, request->diag);
    dalcs_selection_finish(&selection);
    return status;
}

enum dalcs_status dalcs_family_make(struct dalcs_family *family, struct dalcs_waveforms *waveforms,
                                    const char *const *group, size_t n_groups, double from,
                                    double to, const char *by, struct dalcs_diag *diag) {
    const struct request request = {group, n_groups, from, to, diag};
    size_t first;
    size_t end;
    const size_t n_runs = dalcs_waveforms_find_run(waveforms, 1, &first, &end);
    if (n_runs < 2) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "write .step into the netlist, and run it with -o",
                       "a family needs several runs, and the file has %zu", n_runs);
        return DALCS_E_OPTION;
    }
    const size_t column = choose_column(waveforms, n_runs, by, diag);
    if (column >= waveforms->n_columns) {
        return DALCS_E_OPTION;
    }
    family->by = waveforms->name[column];
    family->value = dalcs_alloc(n_runs, sizeof *family->value);
    family->curve = dalcs_alloc(n_runs, sizeof *family->curve);
    enum dalcs_status status =
        family->value != NULL && family->curve != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (size_t run = 1; run <= n_runs && status == DALCS_OK; run++) {
        (void)dalcs_waveforms_find_run(waveforms, run, &first, &end);
        family->value[run - 1] = row_at(waveforms, first)[column];
        status = take_run(family, waveforms, run, &request);
    }
    if (status != DALCS_OK) {
        dalcs_family_finish(family);
    }
    return status;
}
