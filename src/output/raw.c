/* raw.c - the binary raw file that ngspice, gaw, spicelib and others read: a text header, then
 * native doubles point after point. Several plots follow one another.
 *
 * The number of points is not known while streaming: its field is padded and filled in at the end.
 * ngspice runs a Command line when it loads the file; starting with '*' it is a comment there, and
 * spicelib still finds the word that it looks for. */
#include "memory.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#define POINTS_FIELD "%-20zu"

struct raw {
    size_t n_columns, n_points;
    bool has_time;
    off_t plot_at, points_at, rows_at; /* file positions: of the plot, of its number of points */
    double *point;                     /* [n_columns], and at least 1 */
};

/* SOURCE_DATE_EPOCH, where set, makes two runs give the same bytes. */
static void write_date(FILE *stream) {
    time_t now = time(NULL);
    struct tm parts;
    const char *epoch = getenv("SOURCE_DATE_EPOCH");
    char *rest = NULL;
    long long seconds = epoch ? strtoll(epoch, &rest, 10) : 0;
    if (epoch && *epoch && *rest == '\0') {
        now = (time_t)seconds;
        gmtime_r(&now, &parts);
    } else {
        localtime_r(&now, &parts);
    }
    char text[64];
    strftime(text, sizeof text, "%a %b %e %H:%M:%S %Y", &parts);
    fprintf(stream, "Date: %s\n", text);
}

/* A title must stay on its line. */
static void write_title(FILE *stream, const char *title) {
    fputs("Title: ", stream);
    for (const char *c = title; *c; c++) {
        fputc((unsigned char)*c < 0x20 ? ' ' : *c, stream);
    }
    fputc('\n', stream);
}

static enum dalcs_status begin(void *state, FILE *stream, const struct dalcs_plot *plot) {
    struct raw *raw = state;
    raw->has_time = plot->analysis == DALCS_TRANSIENT;
    raw->n_columns = plot->n_signals + (raw->has_time ? 1 : 0);
    raw->n_points = 0;
    free(raw->point);
    raw->point = dalcs_alloc(plot->n_signals + 1, sizeof(double));
    if (!raw->point) {
        return DALCS_E_NOMEM;
    }
    raw->plot_at = ftello(stream);
    write_title(stream, plot->title ? plot->title : "");
    write_date(stream);
    fprintf(stream, "Plotname: %s\n", raw->has_time ? "Transient Analysis" : "Operating Point");
    fputs("Flags: real\n", stream);
    fprintf(stream, "No. Variables: %zu\nNo. Points: ", raw->n_columns);
    raw->points_at = ftello(stream);
    fprintf(stream, POINTS_FIELD "\n", raw->n_points);
    fprintf(stream, "Command: * ngspice-compatible, dalcs %s\nVariables:\n", dalcs_version());
    size_t column = 0;
    if (raw->has_time) {
        fprintf(stream, "\t%zu\ttime\ttime\n", column++);
    }
    for (size_t i = 0; i < plot->n_signals; i++) {
        fprintf(stream, "\t%zu\t%s\t%s\n", column++, plot->name[i],
                plot->unit[i] == DALCS_VOLT ? "voltage" : "current");
    }
    fputs("Binary:\n", stream);
    raw->rows_at = ftello(stream);
    return DALCS_OK;
}

static void row(void *state, FILE *stream, double time, const double *value) {
    struct raw *raw = state;
    size_t n_before = raw->has_time ? 1 : 0;
    raw->point[0] = time;
    memcpy(raw->point + n_before, value, (raw->n_columns - n_before) * sizeof(double));
    fwrite(raw->point, sizeof(double), raw->n_columns, stream);
    raw->n_points++;
}

static void end(void *state, FILE *stream) {
    const struct raw *raw = state;
    if (fseeko(stream, raw->points_at, SEEK_SET) == 0) {
        fprintf(stream, POINTS_FIELD, raw->n_points);
        fseeko(stream, 0, SEEK_END);
    }
}

/* Without a whole row of the last plot, the plots before it. */
static off_t recover(const void *state, int descriptor, off_t size) {
    const struct raw *raw = state;
    const off_t row_bytes = (off_t)(raw->n_columns * sizeof(double));
    if (size < raw->rows_at + row_bytes) {
        return raw->plot_at <= size ? raw->plot_at : 0;
    }
    char text[32];
    off_t n_points = (size - raw->rows_at) / row_bytes;
    int length = snprintf(text, sizeof text, POINTS_FIELD, (size_t)n_points);
    bool written = pwrite(descriptor, text, (size_t)length, raw->points_at) == length;
    return written ? raw->rows_at + n_points * row_bytes : 0;
}

static void finish(void *state) {
    struct raw *raw = state;
    free(raw->point);
}

const struct dalcs_table_format dalcs_raw_format = {
    .extension = ".raw",
    .state_size = sizeof(struct raw),
    .begin = begin,
    .row = row,
    .end = end,
    .recover = recover,
    .finish = finish,
};
