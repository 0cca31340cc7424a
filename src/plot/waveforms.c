/* waveforms.c - the table itself; raw_reader.c and csv_reader.c fill it. */
#include "waveforms.h"

#include "text_file.h"
#include "utf16.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* More than a run of an hour writes, and less than what makes a machine swap for long. */
static const size_t most_bytes = (size_t)4 << 30;

/* Equal distances are there because the axis is right, however few digits it has: rounding would show in them. */
static bool has_equal_distances(const struct dalcs_waveforms *w) {
    const double first = w->n_rows > 0 ? w->value[0] : 0.0;
    const double last = w->n_rows > 0 ? w->value[(w->n_rows - 1) * w->n_columns] : 0.0;
    const double distance = w->n_rows > 1 ? (last - first) / (double)(w->n_rows - 1) : 0.0;
    double worst = 0.0;
    for (size_t k = 0; k < w->n_rows; k++) {
        worst = fmax(worst, fabs(w->value[k * w->n_columns] - first - (double)k * distance));
    }
    return w->n_rows > 2 && worst <= 1e-6 * fabs(distance);
}

/* Waveforms of many runs have the values of .step before the axis: it comes first. What was measured in them, with
 * reasons in the last column, has none. */
static void put_axis_first(struct dalcs_waveforms *w) {
    size_t at = 0;
    if (strcmp(w->name[w->n_columns - 1], "error") == 0) {
        return;
    }
    for (size_t k = w->n_columns; k-- > 1;) {
        const bool is =
            strcasecmp(w->name[k], "time") == 0 || strcasecmp(w->name[k], "frequency") == 0;
        at = is && strcasecmp(w->name[0], w->name[k]) != 0 ? k : at;
    }
    const char *name = w->name[at];
    const struct dalcs_dimension dimension = w->dimension[at];
    const struct dalcs_digits digits = w->digits[at];
    for (size_t k = at; k > 0; k--) {
        w->name[k] = w->name[k - 1];
        w->dimension[k] = w->dimension[k - 1];
        w->digits[k] = w->digits[k - 1];
    }
    w->name[0] = name;
    w->dimension[0] = dimension;
    w->digits[0] = digits;
    for (size_t row = 0; row < w->n_rows && at > 0; row++) {
        double *cell = w->value + row * w->n_columns;
        const double axis = cell[at];
        memmove(cell + 1, cell, at * sizeof *cell);
        cell[0] = axis;
    }
}

static enum dalcs_status read_plain(struct dalcs_waveforms *waveforms, const char *path,
                                    const char *text, size_t length, size_t plot,
                                    struct dalcs_diag *diag) {
    *waveforms = (struct dalcs_waveforms){.title = "", .plot_name = ""};
    enum dalcs_status status =
        dalcs_waveforms_is_raw(text, length)
            ? dalcs_waveforms_read_raw(waveforms, path, text, length, plot, diag)
            : dalcs_waveforms_read_csv(waveforms, path, text, length, diag);
    if (status == DALCS_OK && plot > waveforms->n_plots) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s' has 1 plot: there is no plot %zu", path,
                       plot);
        status = DALCS_E_OPTION;
    }
    if (status != DALCS_OK) {
        dalcs_waveforms_finish(waveforms);
        return status;
    }
    if (!dalcs_waveforms_is_raw(text, length)) {
        put_axis_first(waveforms);
    }
    dalcs_digits_judge(waveforms->digits, waveforms->n_columns, waveforms->precision);
    if (has_equal_distances(waveforms)) {
        waveforms->precision[0] = (struct dalcs_precision){.relative = 0x1p-53};
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_waveforms_read_text(struct dalcs_waveforms *waveforms, const char *path,
                                            const char *text, size_t length, size_t plot,
                                            struct dalcs_diag *diag) {
    if (!dalcs_utf16_is_header(text, length)) {
        return read_plain(waveforms, path, text, length, plot, diag);
    }
    size_t plain_length;
    char *plain = dalcs_utf16_to_plain(text, length, &plain_length);
    *waveforms = (struct dalcs_waveforms){0};
    enum dalcs_status status =
        plain ? read_plain(waveforms, path, plain, plain_length, plot, diag) : DALCS_E_NOMEM;
    free(plain);
    return status;
}

enum dalcs_status dalcs_waveforms_read_file(struct dalcs_waveforms *waveforms, const char *path,
                                            size_t plot, struct dalcs_diag *diag) {
    char *text = NULL;
    size_t length = 0;
    *waveforms = (struct dalcs_waveforms){0};
    const char *from = strcmp(path, "-") == 0 ? "/dev/stdin" : path;
    DALCS_TRY(dalcs_text_file_read(from, most_bytes, &text, &length, NULL, diag));
    if (length > most_bytes) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s' is larger than 4 GiB", path);
        free(text);
        return DALCS_E_LIMIT;
    }
    char *ended = realloc(text, length + 1);
    if (!ended) {
        free(text);
        return DALCS_E_NOMEM;
    }
    ended[length] = '\0';
    if (!dalcs_waveforms_is_raw(ended, length) && !dalcs_utf16_is_header(ended, length)) {
        dalcs_text_end_lines(ended, length);
    }
    enum dalcs_status status =
        dalcs_waveforms_read_text(waveforms, path, ended, length, plot, diag);
    free(ended);
    return status;
}

enum dalcs_status dalcs_waveforms_set_columns(struct dalcs_waveforms *waveforms, size_t n_columns) {
    waveforms->name = dalcs_arena_alloc(&waveforms->arena, n_columns, sizeof *waveforms->name);
    waveforms->dimension =
        dalcs_arena_alloc(&waveforms->arena, n_columns, sizeof *waveforms->dimension);
    waveforms->precision =
        dalcs_arena_alloc(&waveforms->arena, n_columns, sizeof *waveforms->precision);
    waveforms->digits = dalcs_arena_alloc(&waveforms->arena, n_columns, sizeof *waveforms->digits);
    waveforms->n_columns = n_columns;
    bool complete = waveforms->name && waveforms->dimension && waveforms->precision;
    return complete && waveforms->digits ? DALCS_OK : DALCS_E_NOMEM;
}

static double axis_at(const struct dalcs_waveforms *waveforms, size_t row) {
    return waveforms->value[row * waveforms->n_columns];
}

size_t dalcs_waveforms_find_run(const struct dalcs_waveforms *waveforms, size_t run, size_t *first,
                                size_t *end) {
    size_t n = 0, start = 0;
    int direction = 0; /* not known where all rows so far have one place */
    *first = *end = 0;
    for (size_t row = 1; row <= waveforms->n_rows; row++) {
        bool last = row == waveforms->n_rows;
        double step = last ? 0.0 : axis_at(waveforms, row) - axis_at(waveforms, row - 1);
        if (last || step * direction < 0.0) {
            n++;
            if (n == run) {
                *first = start;
                *end = row;
            }
            start = row;
            direction = 0;
        } else if (direction == 0) {
            direction = step > 0.0 ? 1 : step < 0.0 ? -1 : 0;
        }
    }
    return n;
}

static void swap_rows(double *a, double *b, size_t n) {
    for (size_t i = 0; i < n; i++) {
        double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

void dalcs_waveforms_keep_rows(struct dalcs_waveforms *waveforms, size_t first, size_t end) {
    size_t n = waveforms->n_columns;
    waveforms->n_rows = end - first;
    if (end > first) { /* without rows there is no room for any */
        memmove(waveforms->value, waveforms->value + first * n, (end - first) * n * sizeof(double));
    }
    if (end - first < 2 || axis_at(waveforms, 0) <= axis_at(waveforms, end - first - 1)) {
        return;
    }
    for (size_t i = 0, j = waveforms->n_rows - 1; i < j; i++, j--) {
        swap_rows(waveforms->value + i * n, waveforms->value + j * n, n);
    }
}

void dalcs_waveforms_finish(struct dalcs_waveforms *waveforms) {
    free(waveforms->value);
    dalcs_arena_finish(&waveforms->arena);
    *waveforms = (struct dalcs_waveforms){0};
}
