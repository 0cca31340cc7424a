/* linearize_command.c - linearize: the vectors of a transient at equal distances. */
#include "row_grid.h"

#include <string.h>

size_t dalcs_grid_rows(const struct dalcs_grid *grid) {
    const double n = (grid->stop - grid->start) / grid->step + 1.5;
    return grid->step > 0.0 && n >= 2.0 && n <= DALCS_MOST_GRID_ROWS ? (size_t)n : 0;
}

double dalcs_grid_time(const struct dalcs_grid *grid, size_t k) {
    return grid->start + (double)k * grid->step;
}

/* What the run was asked for; the vectors lin-tstart, lin-tstop and lin-tstep come before that. */
static struct dalcs_grid grid_of(const struct dalcs_vectors *all,
                                 const struct dalcs_plot_vectors *plot) {
    struct dalcs_grid grid = plot->grid;
    const struct dalcs_vector *start = dalcs_vectors_find_exactly(all, "lin-tstart");
    const struct dalcs_vector *stop = dalcs_vectors_find_exactly(all, "lin-tstop");
    const struct dalcs_vector *step = dalcs_vectors_find_exactly(all, "lin-tstep");
    grid.start = start != NULL ? creal(start->value[0]) : grid.start;
    grid.stop = stop != NULL ? creal(stop->value[0]) : grid.stop;
    grid.step = step != NULL ? creal(step->value[0]) : grid.step;
    return grid;
}

double complex *dalcs_grid_sample(struct dalcs_script *script, const struct dalcs_vector *v,
                                  const struct dalcs_vector *scale, const struct dalcs_grid *grid,
                                  size_t n) {
    double complex *value = dalcs_arena_alloc(&script->arena, n, sizeof *value);
    for (size_t k = 0; value != NULL && k < n; k++) {
        value[k] =
            dalcs_calculus_interpolate(v->value, scale->value, scale->n, dalcs_grid_time(grid, k));
    }
    return value;
}

bool dalcs_plot_is_transient(const struct dalcs_plot_vectors *plot) {
    return plot->scale != NULL && plot->scale->unit == DALCS_UNIT_SECOND && plot->scale->n > 1;
}

enum dalcs_status dalcs_grid_refuse_plot(struct dalcs_script *script,
                                         const struct dalcs_statement *s) {
    return dalcs_script_refuse(script, s, "setplot tran1 chooses the plot of a tran",
                               "%s takes the rows of a transient, and the current plot has none",
                               s->word);
}

enum dalcs_status dalcs_grid_tell_made(struct dalcs_script *script) {
    const struct dalcs_script_host *host = script->host;
    DALCS_TRY(host->made != NULL ? host->made(host->user, script->vectors.current) : DALCS_OK);
    dalcs_script_name_plot(script);
    return DALCS_OK;
}

/* linearize [v(out) ...] */
enum dalcs_status dalcs_script_linearize(struct dalcs_script *script,
                                         const struct dalcs_statement *s) {
    struct dalcs_vectors *all = &script->vectors;
    const struct dalcs_plot_vectors *from = dalcs_plots_current(all);
    const struct dalcs_vector **vector;
    const char *text;
    size_t n_vectors;
    if (!dalcs_plot_is_transient(from)) {
        return dalcs_grid_refuse_plot(script, s);
    }
    const struct dalcs_grid grid = grid_of(all, from);
    const struct dalcs_vector *scale = from->scale;
    const size_t n = dalcs_grid_rows(&grid);
    if (n == 0) {
        return dalcs_script_refuse(script, s, "let lin-tstep = 1u sets the time between rows",
                                   "no rows lie every %g s from %g s to %g s", grid.step,
                                   grid.start, grid.stop);
    }
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    DALCS_TRY(dalcs_script_vectors(script, s, text, &vector, &n_vectors));
    struct dalcs_vector made = {.unit = DALCS_UNIT_SECOND, .n = n};
    made.value = dalcs_arena_alloc(&script->arena, n, sizeof *made.value);
    const char *kind = dalcs_arena_printf(&script->arena, "%s (linearized)", from->kind);
    if (made.value == NULL || kind == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        made.value[k] = dalcs_grid_time(&grid, k);
    }
    DALCS_TRY(dalcs_plots_make(all, "tran", kind, from->title));
    struct dalcs_plot_vectors *to = all->current;
    to->analysis = DALCS_TRANSIENT;
    to->grid = grid;
    DALCS_TRY(dalcs_plot_set(to, scale->name, &made));
    for (size_t k = 0; k < n_vectors; k++) {
        const struct dalcs_vector *v = vector[k];
        if (v->n == scale->n && strcmp(v->name, scale->name) != 0) {
            struct dalcs_vector straight = *v;
            straight.n = n;
            straight.value = dalcs_grid_sample(script, v, scale, &grid, n);
            DALCS_TRY(straight.value != NULL ? dalcs_plot_set(to, v->name, &straight)
                                             : DALCS_E_NOMEM);
        }
    }
    return dalcs_grid_tell_made(script);
}
