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
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        size_t length = strlen(path), n = strlen(all[i]->extension);
        if (length > n && strcasecmp(path + length - n, all[i]->extension) == 0) {
            return all[i];
        }
    }
    return NULL;
}

enum dalcs_status dalcs_table_init(struct dalcs_table *table, const char *path,
                                   bool transient_expected) {
    *table = (struct dalcs_table){.path = path, .transient_expected = transient_expected};
    table->format = dalcs_table_find_format(path);
    if (!table->format) {
        return DALCS_E_OPTION;
    }
    table->state = dalcs_alloc(1, table->format->state_size);
    return table->state ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status check_stream(struct dalcs_table *table) {
    if (!ferror(table->file.stream)) {
        return DALCS_OK;
    }
    if (table->file.error == 0) {
        table->file.error = errno != 0 ? errno : EIO;
    }
    return DALCS_E_IO;
}

enum dalcs_status dalcs_table_begin(struct dalcs_table *table, const struct dalcs_plot *plot) {
    table->skipping = table->format->one_plot && table->transient_expected &&
                      plot->analysis == DALCS_OPERATING_POINT;
    if (table->skipping) {
        return DALCS_OK;
    }
    if (!table->file.stream) {
        enum dalcs_status status = dalcs_atomic_file_open(&table->file, table->path);
        if (status != DALCS_OK) {
            return status;
        }
    }
    errno = 0;
    enum dalcs_status status = table->format->begin(table->state, table->file.stream, plot);
    table->in_plot = status == DALCS_OK;
    return status == DALCS_OK ? check_stream(table) : status;
}

enum dalcs_status dalcs_table_row(struct dalcs_table *table, double time, const double *value) {
    if (table->skipping) {
        return DALCS_OK;
    }
    table->format->row(table->state, table->file.stream, time, value);
    table->n_rows++;
    return check_stream(table);
}

enum dalcs_status dalcs_table_end(struct dalcs_table *table) {
    if (table->skipping || !table->in_plot) {
        return DALCS_OK;
    }
    table->in_plot = false;
    table->format->end(table->state, table->file.stream);
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
