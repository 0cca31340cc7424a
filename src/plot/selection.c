/* selection.c - signals into panels by their units; rows by the range. */
#include "selection.h"

#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 64 };

/* ---- Signals -------------------------------------------------------------------------------- */

static enum dalcs_status name_unit(struct dalcs_figure_panel *panel,
                                   struct dalcs_dimension dimension, struct dalcs_arena *arena) {
    char text[DALCS_DIMENSION_TEXT];
    const char *unit = dalcs_dimension_unit(text, dimension);
    *panel = (struct dalcs_figure_panel){.quantity = dalcs_dimension_quantity(dimension)};
    panel->unit = dalcs_arena_copy(arena, unit, strlen(unit));
    return panel->unit ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status add_panel(struct dalcs_selection *selection,
                                   struct dalcs_dimension dimension,
                                   struct dalcs_figure_panel **panel, struct dalcs_diag *diag) {
    if (selection->n_panels == DALCS_FIGURE_MAX_PANELS) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "draw fewer signals, or several pictures",
                       "the signals need more than %d panels", DALCS_FIGURE_MAX_PANELS);
        return DALCS_E_OPTION;
    }
    *panel = &selection->panel[selection->n_panels++];
    return name_unit(*panel, dimension, &selection->arena);
}

/* Signals [first, n) into panels of their units, in the order in which the units come; a panel that
 * is full is followed by another one. */
static enum dalcs_status place_group(struct dalcs_selection *selection, size_t first,
                                     struct dalcs_diag *diag) {
    for (size_t i = first; i < selection->n; i++) {
        struct dalcs_dimension unit = selection->signal[i].dimension;
        bool placed = false;
        for (size_t k = first; k < i && !placed; k++) {
            placed = dalcs_dimension_equal(selection->signal[k].dimension, unit);
        }
        struct dalcs_figure_panel *panel = NULL;
        for (size_t k = i; k < selection->n && !placed; k++) {
            if (!dalcs_dimension_equal(selection->signal[k].dimension, unit)) {
                continue;
            }
            if (!panel || panel->n == DALCS_FIGURE_MAX_CURVES) {
                DALCS_TRY(add_panel(selection, unit, &panel, diag));
            }
            panel->signal[panel->n++] = k;
        }
    }
    return DALCS_OK;
}

/* All columns; the most telling ones of each unit are drawn. */
static enum dalcs_status place_all(struct dalcs_selection *selection, struct dalcs_diag *diag) {
    int *group = dalcs_arena_alloc(&selection->arena, selection->n, sizeof *group);
    struct dalcs_dimension unit[DALCS_FIGURE_MAX_PANELS];
    int n = 0;
    if (!group) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < selection->n; i++) {
        int g = 0;
        while (g < n && !dalcs_dimension_equal(unit[g], selection->signal[i].dimension)) {
            g++;
        }
        if (g == n && n < DALCS_FIGURE_MAX_PANELS) {
            unit[n++] = selection->signal[i].dimension;
        }
        group[i] = g;
    }
    for (int g = 0; g < n; g++) {
        struct dalcs_figure_panel *panel = NULL;
        DALCS_TRY(add_panel(selection, unit[g], &panel, diag));
        dalcs_figure_choose(panel, selection->name, group, selection->n, g);
    }
    return DALCS_OK;
}

static enum dalcs_status take_all(struct dalcs_selection *selection) {
    const struct dalcs_waveforms *waveforms = selection->waveforms;
    size_t n = waveforms->n_columns - 1;
    selection->signal = dalcs_arena_alloc(&selection->arena, n, sizeof *selection->signal);
    if (!selection->signal) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        DALCS_TRY(
            dalcs_signal_of_column(&selection->signal[i], waveforms, i + 1, &selection->arena));
    }
    selection->n = n;
    return DALCS_OK;
}

static size_t count_items(const char *text) {
    size_t n = 1;
    for (const char *c = text; *c; c++) {
        n += *c == ',' ? 1 : 0;
    }
    return n;
}

/* The end of the first item of a list: a comma outside of parentheses. */
static const char *item_end(const char *text) {
    int depth = 0;
    const char *c = text;
    for (; *c && (*c != ',' || depth > 0); c++) {
        depth += *c == '(' ? 1 : *c == ')' ? -1 : 0;
    }
    return c;
}

static enum dalcs_status take_group(struct dalcs_selection *selection, const char *list,
                                    struct dalcs_diag *diag) {
    size_t first = selection->n;
    for (const char *at = list; at;) {
        const char *end = item_end(at);
        char *item = dalcs_arena_copy(&selection->arena, at, (size_t)(end - at));
        if (!item) {
            return DALCS_E_NOMEM;
        }
        DALCS_TRY(dalcs_signal_parse(&selection->signal[selection->n], selection->waveforms, item,
                                     &selection->arena, diag));
        selection->n++;
        at = *end ? end + 1 : NULL;
    }
    return place_group(selection, first, diag);
}

static enum dalcs_status take_groups(struct dalcs_selection *selection, const char *const *group,
                                     size_t n_groups, struct dalcs_diag *diag) {
    size_t most = 0;
    for (size_t g = 0; g < n_groups; g++) {
        most += count_items(group[g]);
    }
    selection->signal = dalcs_arena_alloc(&selection->arena, most, sizeof *selection->signal);
    if (!selection->signal) {
        return DALCS_E_NOMEM;
    }
    for (size_t g = 0; g < n_groups; g++) {
        DALCS_TRY(take_group(selection, group[g], diag));
    }
    return DALCS_OK;
}

static enum dalcs_status take_names(struct dalcs_selection *selection) {
    selection->name = dalcs_arena_alloc(&selection->arena, selection->n, sizeof *selection->name);
    for (size_t i = 0; selection->name && i < selection->n; i++) {
        selection->name[i] = selection->signal[i].text;
    }
    return selection->name ? DALCS_OK : DALCS_E_NOMEM;
}

/* ---- The range ------------------------------------------------------------------------------ */

static const double *row_of(const struct dalcs_selection *selection, size_t row) {
    return selection->waveforms->value + row * selection->waveforms->n_columns;
}

static enum dalcs_status find_range(struct dalcs_selection *selection, double from, double to,
                                    struct dalcs_diag *diag) {
    const struct dalcs_waveforms *waveforms = selection->waveforms;
    const char *unit = selection->axis.unit;
    char a[DALCS_QUANTITY_SIZE], b[DALCS_QUANTITY_SIZE];
    if (waveforms->n_rows < 2) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                       waveforms->n_rows == 0 ? "the file has no rows"
                                              : "the file has one row, which is no curve");
        return DALCS_E_OPTION;
    }
    double first = *row_of(selection, 0), last = *row_of(selection, waveforms->n_rows - 1);
    selection->start = fmax(isnan(from) ? first : from, first);
    selection->stop = fmin(isnan(to) ? last : to, last);
    if (selection->start < selection->stop && isfinite(selection->stop - selection->start)) {
        return DALCS_OK;
    }
    if (from >= to) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "the range is empty: from %s to %s",
                       dalcs_quantity_write(a, from, unit, 6),
                       dalcs_quantity_write(b, to, unit, 6));
    } else {
        dalcs_diag_add(
            diag, DALCS_ERROR, NULL, NULL, "the range has no rows: the file goes from %s to %s",
            dalcs_quantity_write(a, first, unit, 6), dalcs_quantity_write(b, last, unit, 6));
    }
    return DALCS_E_OPTION;
}

/* Frequencies over more than a decade. */
static void find_axis(struct dalcs_selection *selection) {
    const struct dalcs_waveforms *waveforms = selection->waveforms;
    char text[DALCS_DIMENSION_TEXT];
    struct dalcs_dimension dimension = waveforms->dimension[0];
    selection->axis.quantity = waveforms->name[0];
    selection->axis.unit = dalcs_dimension_unit(text, dimension);
    if (selection->axis.unit == text) {
        selection->axis.unit = "";
    }
}

enum dalcs_status dalcs_selection_make(struct dalcs_selection *selection,
                                       const struct dalcs_waveforms *waveforms,
                                       const char *const *group, size_t n_groups, double from,
                                       double to, struct dalcs_diag *diag) {
    *selection = (struct dalcs_selection){.waveforms = waveforms};
    if (waveforms->n_columns < 2) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "the file has no signals");
        return DALCS_E_OPTION;
    }
    find_axis(selection);
    enum dalcs_status status = find_range(selection, from, to, diag);
    if (status == DALCS_OK) {
        status = n_groups > 0 ? take_groups(selection, group, n_groups, diag) : take_all(selection);
    }
    if (status == DALCS_OK) {
        status = take_names(selection);
    }
    if (status == DALCS_OK && n_groups == 0) {
        status = place_all(selection, diag);
    }
    if (status != DALCS_OK) {
        dalcs_selection_finish(selection);
        return status;
    }
    selection->axis.logarithmic = waveforms->dimension[0].second == -1 && selection->start > 0.0 &&
                                  selection->stop > 10.0 * selection->start;
    return DALCS_OK;
}

/* ---- Rows ----------------------------------------------------------------------------------- */

static void evaluate_row(const struct dalcs_selection *selection, size_t row, double *value) {
    for (size_t i = 0; i < selection->n; i++) {
        value[i] = dalcs_signal_value(&selection->signal[i], row_of(selection, row));
    }
}

/* Each angle is the one of its like that is nearest to the one before. */
static void continue_angles(const struct dalcs_selection *selection, double *value,
                            double *before) {
    for (size_t i = 0; i < selection->n && selection->continues; i++) {
        if (selection->signal[i].dimension.degree) {
            const double turns = rint((value[i] - before[i]) / 360.0);
            value[i] -= isfinite(turns) && isfinite(before[i]) ? 360.0 * turns : 0.0;
            before[i] = isfinite(value[i]) ? value[i] : before[i];
        }
    }
}

/* The values at `at`, between a row and the next one. */
static void interpolate(const struct dalcs_selection *selection, size_t row, double at,
                        double *value, double *other) {
    double before = *row_of(selection, row), after = *row_of(selection, row + 1);
    double part = after > before ? (at - before) / (after - before) : 0.0;
    evaluate_row(selection, row, value);
    evaluate_row(selection, row + 1, other);
    for (size_t i = 0; i < selection->n; i++) {
        value[i] += part * (other[i] - value[i]);
    }
}

/* A discontinuity where a range begins or ends has one side in it. */
static bool is_within(const struct dalcs_selection *selection, size_t row) {
    double at = *row_of(selection, row);
    bool cut_before = selection->start > *row_of(selection, 0);
    size_t n = selection->waveforms->n_rows;
    bool cut_behind = selection->stop < *row_of(selection, n - 1);
    if (cut_before && at == selection->start) {
        return row + 1 == n || *row_of(selection, row + 1) > at;
    }
    if (cut_behind && at == selection->stop) {
        return row == 0 || *row_of(selection, row - 1) < at;
    }
    return at >= selection->start && at <= selection->stop;
}

enum dalcs_status dalcs_selection_each_row(const struct dalcs_selection *selection,
                                           enum dalcs_status (*row)(void *user, double at,
                                                                    const double *value),
                                           void *user) {
    double *value = dalcs_alloc(3 * selection->n, sizeof *value);
    enum dalcs_status status = value ? DALCS_OK : DALCS_E_NOMEM;
    double *last = value ? value + 2 * selection->n : NULL;
    for (size_t k = 0; status == DALCS_OK && k < selection->waveforms->n_rows; k++) {
        double at = *row_of(selection, k), before = k > 0 ? *row_of(selection, k - 1) : at;
        if (before < selection->start && at > selection->start) {
            interpolate(selection, k - 1, selection->start, value, value + selection->n);
            continue_angles(selection, value, last);
            status = row(user, selection->start, value);
        }
        if (status == DALCS_OK && is_within(selection, k)) {
            evaluate_row(selection, k, value);
            continue_angles(selection, value, last);
            status = row(user, at, value);
        }
        if (status == DALCS_OK && before < selection->stop && at > selection->stop) {
            interpolate(selection, k - 1, selection->stop, value, value + selection->n);
            continue_angles(selection, value, last);
            status = row(user, selection->stop, value);
        }
    }
    free(value);
    return status;
}

size_t dalcs_selection_count_rows(const struct dalcs_selection *selection) {
    size_t n = 0;
    for (size_t k = 0; k < selection->waveforms->n_rows; k++) {
        double at = *row_of(selection, k);
        n += at >= selection->start && at <= selection->stop ? 1 : 0;
    }
    return n;
}

void dalcs_selection_finish(struct dalcs_selection *selection) {
    dalcs_arena_finish(&selection->arena);
    *selection = (struct dalcs_selection){0};
}
