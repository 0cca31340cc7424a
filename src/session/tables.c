/* tables.c - a sink that keeps every row, for languages in which a callback for each costs more than the
 * run. */
#include "session_internal.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_ROWS = 256 };

struct growing {
    struct dalcs_row_table table;
    double *scale, *value; /* heap; the table's */
    size_t scale_capacity, value_capacity;
    size_t n_values; /* in a row */
};

struct dalcs_tables {
    struct growing *item;
    size_t n, capacity;
    struct dalcs_arena arena; /* the plots' names */
    enum dalcs_status (*progress)(void *user, double time, double stop);
    void *user;
};

static const char *const *copy_names(struct dalcs_arena *arena, const char *const *name, size_t n) {
    const char **copy = dalcs_arena_alloc(arena, n + 1, sizeof *copy);
    for (size_t k = 0; copy != NULL && k < n; k++) {
        copy[k] = dalcs_arena_copy(arena, name[k], strlen(name[k]));
        if (copy[k] == NULL) {
            return NULL;
        }
    }
    return copy;
}

/* The session that made it may be gone before the table. */
static enum dalcs_status copy_plot(struct dalcs_arena *arena, struct dalcs_plot *copy,
                                   const struct dalcs_plot *plot) {
    *copy = *plot;
    copy->title = dalcs_arena_copy(arena, plot->title, strlen(plot->title));
    copy->scale = dalcs_arena_copy(arena, plot->scale, strlen(plot->scale));
    copy->name = copy_names(arena, plot->name, plot->n_signals);
    copy->parameter = copy_names(arena, plot->parameter, plot->n_parameters);
    enum dalcs_unit *unit = dalcs_arena_alloc(arena, plot->n_signals + 1, sizeof *unit);
    double *value = dalcs_arena_alloc(arena, plot->n_parameters + 1, sizeof *value);
    if (copy->title == NULL || copy->scale == NULL || copy->name == NULL ||
        copy->parameter == NULL || unit == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < plot->n_signals; k++) {
        unit[k] = plot->unit[k];
    }
    for (size_t k = 0; k < plot->n_parameters; k++) {
        value[k] = plot->parameter_value[k];
    }
    copy->unit = unit;
    copy->parameter_value = value;
    return DALCS_OK;
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_tables *t = user;
    DALCS_TRY(dalcs_grow(&t->item, &t->capacity, t->n + 1, sizeof *t->item));
    struct growing *g = &t->item[t->n];
    *g = (struct growing){.n_values = plot->n_signals * (plot->is_complex ? 2 : 1)};
    DALCS_TRY(copy_plot(&t->arena, &g->table.plot, plot));
    t->n++;
    return DALCS_OK;
}

/* Room for so many rows in all. dalcs_grow would fill it with zeros first, a tenth of the time of a short run. */
static enum dalcs_status reserve(double **array, size_t *capacity, size_t need) {
    if (need <= *capacity) {
        return DALCS_OK;
    }
    const size_t wanted = need + need / 2 + FIRST_ROWS;
    double *grown =
        wanted < SIZE_MAX / sizeof **array ? realloc(*array, wanted * sizeof **array) : NULL;
    if (grown == NULL) {
        return DALCS_E_NOMEM;
    }
    *array = grown;
    *capacity = wanted;
    return DALCS_OK;
}

static enum dalcs_status take_rows(void *user, size_t n, const double *time, const double *value) {
    struct dalcs_tables *t = user;
    struct growing *g = &t->item[t->n - 1];
    const size_t n_rows = g->table.n_rows;
    DALCS_TRY(reserve(&g->scale, &g->scale_capacity, n_rows + n));
    DALCS_TRY(reserve(&g->value, &g->value_capacity, (n_rows + n) * g->n_values));
    memcpy(g->scale + n_rows, time, n * sizeof(double));
    if (g->n_values > 0) {
        memcpy(g->value + n_rows * g->n_values, value, n * g->n_values * sizeof(double));
    }
    g->table.n_rows += n;
    g->table.scale = g->scale;
    g->table.value = g->value;
    return DALCS_OK;
}

static enum dalcs_status take_row(void *user, double time, const double *value) {
    return take_rows(user, 1, &time, value);
}

static enum dalcs_status tell_progress(void *user, double time, double stop) {
    const struct dalcs_tables *t = user;
    return t->progress != NULL ? t->progress(t->user, time, stop) : DALCS_OK;
}

enum dalcs_status
dalcs_session_run_tables(struct dalcs_session *session, const struct dalcs_run_options *options,
                         enum dalcs_status (*progress)(void *user, double time, double stop),
                         void *user, struct dalcs_tables **tables) {
    *tables = dalcs_alloc(1, sizeof **tables);
    if (*tables == NULL) {
        return DALCS_E_NOMEM;
    }
    (*tables)->progress = progress;
    (*tables)->user = user;
    return dalcs_session_run(session, options,
                             &(struct dalcs_sink){.user = *tables,
                                                  .begin = begin,
                                                  .row = take_row,
                                                  .rows = take_rows,
                                                  .progress = tell_progress});
}

size_t dalcs_tables_count(const struct dalcs_tables *tables) {
    return tables->n;
}

const struct dalcs_row_table *dalcs_tables_get(const struct dalcs_tables *tables, size_t index) {
    return index < tables->n ? &tables->item[index].table : NULL;
}

void dalcs_tables_destroy(struct dalcs_tables *tables) {
    if (tables == NULL) {
        return;
    }
    for (size_t k = 0; k < tables->n; k++) {
        free(tables->item[k].scale);
        free(tables->item[k].value);
    }
    free(tables->item);
    dalcs_arena_finish(&tables->arena);
    free(tables);
}
