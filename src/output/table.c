/* table.c - one output file: opens at the first plot, hands rows to its format, closes under the
 * right name. Disk errors are noticed at the row that meets them. */
#include "table.h"

#include "memory.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

const struct dalcs_table_format *dalcs_table_find_format(const char *path) {
    static const struct dalcs_table_format *const all[] = {&dalcs_csv_format, &dalcs_raw_format};
    if (dalcs_is_standard_output(path)) {
        return &dalcs_csv_format;
    }
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        size_t length = strlen(path), n = strlen(all[i]->extension);
        if (length > n && strcasecmp(path + length - n, all[i]->extension) == 0) {
            return all[i];
        }
    }
    return NULL;
}

static int rank_of(enum dalcs_analysis analysis) {
    static const int rank[] = {
        [DALCS_OPERATING_POINT] = 0, [DALCS_TRANSFER] = 1, [DALCS_DC_SWEEP] = 2,
        [DALCS_PERIODIC] = 3,        [DALCS_AC] = 4,       [DALCS_TRANSIENT] = 5};
    return rank[analysis];
}

enum dalcs_status dalcs_table_init_as(struct dalcs_table *table, const char *path,
                                      const struct dalcs_table_format *format,
                                      enum dalcs_analysis main) {
    *table = (struct dalcs_table){.format = format, .path = path, .main = main};
    if (!table->format) {
        return DALCS_E_OPTION;
    }
    table->state = dalcs_alloc(1, table->format->state_size);
    return table->state ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_table_init(struct dalcs_table *table, const char *path,
                                   enum dalcs_analysis main) {
    return dalcs_table_init_as(table, path, dalcs_table_find_format(path), main);
}

/* The status for a stream that failed; the first errno is kept. */
static enum dalcs_status note_error(struct dalcs_table *table) {
    if (table->file.error == 0) {
        table->file.error = errno != 0 ? errno : EIO;
    }
    return DALCS_E_IO;
}

static enum dalcs_status check_stream(struct dalcs_table *table) {
    return ferror(table->file.stream) ? note_error(table) : DALCS_OK;
}

/* Has this file no room for the plot? */
static bool is_left_out(struct dalcs_table *table, const struct dalcs_plot *plot) {
    const bool is_main = rank_of(plot->analysis) >= rank_of(table->main);
    const bool is_next = plot->step > 0;
    table->skipping = false;
    if (table->format->one_plot) {
        const bool is_second = is_main && !is_next && table->has_plot;
        table->n_left_out += is_second ? 1 : 0;
        table->skipping = !is_main || is_second || (is_next && table->n_left_out > 0);
        table->has_plot = table->has_plot || is_main;
    }
    return table->skipping;
}

/* "a buck converter: r = 100" */
static const char *title_of_step(const struct dalcs_plot *plot, char *text, size_t size) {
    size_t n = (size_t)snprintf(text, size, "%s:", plot->title ? plot->title : "");
    for (size_t i = 0; i < plot->n_parameters && n < size; i++) {
        n += (size_t)snprintf(text + n, size - n, " %s = %.9g", plot->parameter[i],
                              plot->parameter_value[i]);
    }
    return text;
}

enum dalcs_status dalcs_table_end(struct dalcs_table *table) {
    if (table->skipping || !table->in_plot) {
        return DALCS_OK;
    }
    table->in_plot = false;
    table->format->end(table->state, table->file.stream);
    return check_stream(table);
}

enum dalcs_status dalcs_table_begin(struct dalcs_table *table, const struct dalcs_plot *plot) {
    DALCS_TRY(dalcs_table_end(table)); /* of a step that failed: its rows stay */
    if (is_left_out(table, plot)) {
        return DALCS_OK;
    }
    if (!table->file.stream) {
        enum dalcs_status status = dalcs_atomic_file_open(&table->file, table->path);
        if (status != DALCS_OK) {
            return status;
        }
    }
    errno = 0;
    char title[256];
    struct dalcs_plot single;
    if (table->splits_steps && plot->n_steps > 1) {
        single = *plot;
        single.step = 0;
        single.n_steps = 1;
        single.title = title_of_step(plot, title, sizeof title);
        plot = &single;
    }
    enum dalcs_status status = table->format->begin(table->state, table->file.stream, plot);
    table->in_plot = status == DALCS_OK;
    return status == DALCS_OK ? check_stream(table) : status;
}

enum dalcs_status dalcs_table_rows(struct dalcs_table *table, size_t n, const double *time,
                                   const double *value) {
    if (table->skipping) {
        return DALCS_OK;
    }
    table->format->rows(table->state, table->file.stream, n, time, value);
    table->n_rows += n;
    return check_stream(table);
}

enum dalcs_status dalcs_table_flush(struct dalcs_table *table) {
    if (!table->file.stream) {
        return DALCS_OK;
    }
    errno = 0;
    fflush(table->file.stream);
    return check_stream(table);
}

enum dalcs_status dalcs_table_commit(struct dalcs_table *table) {
    return table->file.stream ? dalcs_atomic_file_commit(&table->file) : DALCS_OK;
}

/* What is on a disk that took no more, cut after its last whole row. */
static enum dalcs_status keep_whole_rows(struct dalcs_table *table, char **left_at) {
    int descriptor = -1;
    off_t size = 0;
    DALCS_TRY(dalcs_atomic_file_recover(&table->file, &descriptor, &size));
    off_t whole = table->format->recover(table->state, descriptor, size);
    if (whole == 0 || ftruncate(descriptor, whole) != 0) {
        dalcs_atomic_file_discard(&table->file);
        return DALCS_E_IO;
    }
    return dalcs_atomic_file_keep(&table->file, left_at);
}

enum dalcs_status dalcs_table_keep(struct dalcs_table *table, char **left_at) {
    *left_at = NULL;
    if (!table->file.stream || table->n_rows == 0) {
        return DALCS_OK;
    }
    if (table->file.error == 0 && dalcs_table_end(table) == DALCS_OK &&
        dalcs_table_flush(table) == DALCS_OK) {
        return dalcs_atomic_file_keep(&table->file, left_at);
    }
    return keep_whole_rows(table, left_at);
}

void dalcs_table_finish(struct dalcs_table *table) {
    if (table->state) {
        table->format->finish(table->state);
    }
    free(table->state);
    dalcs_atomic_file_discard(&table->file);
    *table = (struct dalcs_table){0};
}
