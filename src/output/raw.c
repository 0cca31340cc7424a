/* raw.c - the raw file that ngspice, gaw, spicelib and others read: a text header, then native doubles
 * point after point, or text that gives the same doubles. Several plots follow one another.
 *
 * The number of points is not known while streaming: its field is padded and filled in at the end. Points
 * are gathered into a block, for a point is written in no time and a call to write it is not.
 * spicelib refuses a file without a Command line, by which it knows the dialect. ngspice writes one from version 44 on,
 * between Date and Plotname; versions up to 43 have none, run one when they load the file, where '*' makes it a comment,
 * and say that it is misplaced in front of the plot's name. Behind the flags it is read by all that look for keys, and
 * by spyci, whose pattern takes it for a part of the flags. Those who count lines need it left out (doc/output.md). */
#include "decimal.h"
#include "memory.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#define POINTS_FIELD "%-20zu"

enum { BLOCK_DOUBLES = 1 << 9 }; /* and of a large circuit one point */

enum { FEW_VALUES = 16 };

struct raw {
    size_t n_columns, n_points;
    bool has_scale, is_complex, is_ascii;
    off_t plot_at, points_at, rows_at; /* file positions: of the plot, of its number of points */
    size_t width; /* doubles of a point: n_columns, of pairs where it is complex; at least 1 */
    size_t n_before, n_values; /* of them, before the signals, and theirs */
    /* Points that the stream does not have yet, up to `next`; what steps leave as it is stands in all of
     * them, up to `end`. */
    double *block, *next, *end;
    bool is_stepped;
    size_t n_of_step;              /* rows, where it is stepped */
    struct dalcs_decimal *decimal; /* of text; heap */
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

static const char *type_of(enum dalcs_unit unit) {
    static const char *const type[] = {
        [DALCS_VOLT] = "voltage",     [DALCS_AMPERE] = "current",
        [DALCS_UNIT_SECOND] = "time", [DALCS_UNIT_HERTZ] = "frequency",
        [DALCS_UNIT_OHM] = "notype",  [DALCS_UNIT_NONE] = "notype"};
    return type[unit];
}

/* ngspice calls the scale of a sweep by its kind. */
static const char *scale_name(const struct dalcs_plot *plot) {
    if (plot->analysis != DALCS_DC_SWEEP) {
        return plot->scale;
    }
    return plot->scale_unit == DALCS_VOLT     ? "v-sweep"
           : plot->scale_unit == DALCS_AMPERE ? "i-sweep"
                                              : plot->scale;
}

static void write_header(struct raw *raw, FILE *stream, const struct dalcs_plot *plot) {
    static const char *const name[] = {[DALCS_OPERATING_POINT] = "Operating Point",
                                       [DALCS_TRANSIENT] = "Transient Analysis",
                                       [DALCS_PERIODIC] = "Periodic Steady State",
                                       [DALCS_DC_SWEEP] = "DC transfer characteristic",
                                       [DALCS_AC] = "AC Analysis",
                                       [DALCS_TRANSFER] = "Transfer Function"};
    raw->plot_at = ftello(stream);
    write_title(stream, plot->title ? plot->title : "");
    write_date(stream);
    fprintf(stream, "Plotname: %s\n", name[plot->analysis]);
    fprintf(stream, "Flags: %s%s\n", raw->is_complex ? "complex" : "real",
            plot->n_steps > 1 ? " stepped" : "");
    fprintf(stream, "Command: * ngspice-compatible, dalcs %s\n", dalcs_version());
    fprintf(stream, "No. Variables: %zu\nNo. Points: ", raw->n_columns);
    raw->points_at = ftello(stream);
    fprintf(stream, POINTS_FIELD "\nVariables:\n", raw->n_points);
    size_t column = 0;
    if (raw->has_scale) {
        fprintf(stream, "\t%zu\t%s\t%s\n", column++, scale_name(plot), type_of(plot->scale_unit));
    }
    for (size_t i = 0; i < plot->n_parameters; i++) {
        fprintf(stream, "\t%zu\t%s\tnotype\n", column++, plot->parameter[i]);
    }
    for (size_t i = 0; i < plot->n_signals; i++) {
        fprintf(stream, "\t%zu\t%s\t%s\n", column++, plot->name[i], type_of(plot->unit[i]));
    }
    fputs(raw->is_ascii ? "Values:\n" : "Binary:\n", stream);
    raw->rows_at = ftello(stream);
}

/* Empty, with the values of the step. */
static bool make_block(struct raw *raw, const struct dalcs_plot *plot) {
    const size_t stride = raw->is_complex ? 2 : 1;
    const size_t n_points = 1 + BLOCK_DOUBLES / raw->width;
    free(raw->block);
    raw->block = dalcs_alloc(n_points * raw->width, sizeof(double));
    raw->next = raw->block;
    raw->end = raw->block ? raw->block + n_points * raw->width : NULL;
    for (double *point = raw->block; point < raw->end; point += raw->width) {
        for (size_t i = 0; i < plot->n_parameters; i++) {
            point[((raw->has_scale ? 1 : 0) + i) * stride] = plot->parameter_value[i];
        }
    }
    return raw->block != NULL;
}

/* The steps of .step follow one another in one plot, whose scale starts again with each; the values of
 * the step are columns of their own. */
static enum dalcs_status begin(void *state, FILE *stream, const struct dalcs_plot *plot) {
    struct raw *raw = state;
    const bool has_scale = !dalcs_analysis_is_point(plot->analysis);
    const size_t n_columns = plot->n_signals + plot->n_parameters + (has_scale ? 1 : 0);
    const bool goes_on = plot->step > 0 && n_columns == raw->n_columns;
    raw->has_scale = has_scale;
    raw->is_complex = plot->is_complex;
    raw->n_columns = n_columns;
    raw->is_stepped = plot->n_steps > 1 && has_scale;
    raw->n_of_step = 0;
    raw->n_values = (plot->is_complex ? 2 : 1) * plot->n_signals;
    raw->n_before = (plot->is_complex ? 2 : 1) * n_columns - raw->n_values;
    raw->width = n_columns > 0 ? raw->n_before + raw->n_values : 1;
    if (!make_block(raw, plot)) {
        return DALCS_E_NOMEM;
    }
    if (!goes_on) {
        raw->n_points = 0;
        write_header(raw, stream, plot);
    }
    return DALCS_OK;
}

static enum dalcs_status begin_ascii(void *state, FILE *stream, const struct dalcs_plot *plot) {
    struct raw *raw = state;
    raw->is_ascii = true;
    if (raw->decimal == NULL) {
        raw->decimal = dalcs_alloc(1, sizeof *raw->decimal);
        if (raw->decimal == NULL) {
            return DALCS_E_NOMEM;
        }
        dalcs_decimal_init(raw->decimal);
    }
    return begin(state, stream, plot);
}

static void write_number(struct raw *raw, FILE *stream, double number) {
    char text[DALCS_DECIMAL_SIZE];
    size_t n = dalcs_decimal_write(raw->decimal, number, text);
    fwrite(text, 1, n, stream);
}

/* " 12\t1e-06\n\t5\n\t0.1\n\n": the number of the point, then a value on each line, "re,im" of a complex
 * one. */
static void write_text(struct raw *raw, FILE *stream, const double *point, size_t number) {
    fprintf(stream, " %zu", number);
    for (size_t i = 0; i < raw->n_columns; i++) {
        fputc('\t', stream);
        write_number(raw, stream, point[raw->is_complex ? 2 * i : i]);
        if (raw->is_complex) {
            fputc(',', stream);
            write_number(raw, stream, point[2 * i + 1]);
        }
        fputc('\n', stream);
    }
    fputc('\n', stream);
}

/* What is held goes into the stream. */
static void release(struct raw *raw, FILE *stream) {
    const size_t n_held = (size_t)(raw->next - raw->block) / raw->width;
    if (!raw->is_ascii) {
        fwrite(raw->block, raw->width * sizeof(double), raw->n_columns > 0 ? n_held : 0, stream);
    }
    for (size_t k = 0; k < n_held && raw->is_ascii; k++) {
        write_text(raw, stream, raw->block + k * raw->width, raw->n_points + k);
    }
    raw->n_points += n_held;
    raw->next = raw->block;
}

/* Readers count the steps by how often the scale is what it is at first. So of two rows there, before
 * and behind an edge at tstart, only the second one is written. The first is still held. */
static void add_row(struct raw *raw, FILE *stream, double time, const double *value) {
    if (raw->is_stepped && raw->n_of_step++ == 1 && raw->next[-(ptrdiff_t)raw->width] == time) {
        raw->next -= raw->width;
    } else if (raw->next == raw->end) {
        release(raw, stream);
    }
    double *point = raw->next;
    raw->next += raw->width;
    if (raw->has_scale) {
        point[0] = time;
    }
    memcpy(point + raw->n_before, value, raw->n_values * sizeof(double));
}

/* As many as there is room for. Column by column: few values are no work for a memcpy each. */
static size_t add_rows(struct raw *raw, FILE *stream, size_t n, const double *time,
                       const double *value) {
    if (raw->next == raw->end) {
        release(raw, stream);
    }
    const size_t room = (size_t)(raw->end - raw->next) / raw->width;
    const size_t n_added = n < room ? n : room;
    double *point = raw->next;
    for (size_t k = 0; k < n_added; k++) {
        point[k * raw->width] = time[k];
    }
    for (size_t i = 0; i < raw->n_values; i++) {
        for (size_t k = 0; k < n_added; k++) {
            point[k * raw->width + 1 + i] = value[k * raw->n_values + i];
        }
    }
    raw->next += n_added * raw->width;
    return n_added;
}

static void rows(void *state, FILE *stream, size_t n, const double *time, const double *value) {
    struct raw *raw = state;
    const bool is_simple = raw->has_scale && raw->n_before == 1 && !raw->is_stepped;
    for (size_t k = 0; k < n;) {
        const double *first = value + k * raw->n_values;
        if (is_simple && raw->n_values <= FEW_VALUES) {
            k += add_rows(raw, stream, n - k, time + k, first);
        } else {
            add_row(raw, stream, time[k], first);
            k++;
        }
    }
}

static bool write_points(const struct raw *raw, int descriptor, size_t n_points) {
    char text[32];
    const int length = snprintf(text, sizeof text, POINTS_FIELD, n_points);
    return pwrite(descriptor, text, (size_t)length, raw->points_at) == length;
}

/* Into the file behind the stream's back, for to seek in a stream is to read it. */
static void end(void *state, FILE *stream) {
    struct raw *raw = state;
    release(raw, stream);
    if (fflush(stream) == 0 && !write_points(raw, fileno(stream), raw->n_points) &&
        fseeko(stream, raw->points_at, SEEK_SET) == 0) {
        fprintf(stream, POINTS_FIELD, raw->n_points); /* notes the error, if it is one */
        fseeko(stream, 0, SEEK_END);
    }
}

/* Without a whole row of the last plot, the plots before it. */
static off_t recover(const void *state, int descriptor, off_t size) {
    const struct raw *raw = state;
    const off_t row_bytes = (off_t)((raw->is_complex ? 2 : 1) * raw->n_columns * sizeof(double));
    if (size < raw->rows_at + row_bytes) {
        return raw->plot_at <= size ? raw->plot_at : 0;
    }
    const off_t n_points = (size - raw->rows_at) / row_bytes;
    const bool written = write_points(raw, descriptor, (size_t)n_points);
    return written ? raw->rows_at + n_points * row_bytes : 0;
}

/* A point ends with an empty line. */
static off_t recover_ascii(const void *state, int descriptor, off_t size) {
    const struct raw *raw = state;
    char block[4096];
    char last = '\n';
    size_t n_points = 0;
    off_t whole = 0;
    for (off_t at = raw->rows_at; at < size;) {
        const ssize_t n = pread(descriptor, block, sizeof block, at);
        if (n <= 0) {
            return 0;
        }
        for (ssize_t i = 0; i < n && at + i < size; i++) {
            if (block[i] == '\n' && last == '\n' && at + i > raw->rows_at) {
                n_points++;
                whole = at + i + 1;
            }
            last = block[i];
        }
        at += n;
    }
    if (n_points == 0) {
        return raw->plot_at <= size ? raw->plot_at : 0;
    }
    return write_points(raw, descriptor, n_points) ? whole : 0;
}

static void finish(void *state) {
    struct raw *raw = state;
    free(raw->block);
    free(raw->decimal);
}

const struct dalcs_table_format dalcs_raw_format = {
    .extension = ".raw",
    .state_size = sizeof(struct raw),
    .begin = begin,
    .rows = rows,
    .end = end,
    .recover = recover,
    .finish = finish,
};

const struct dalcs_table_format dalcs_raw_ascii_format = {
    .extension = ".raw",
    .state_size = sizeof(struct raw),
    .begin = begin_ascii,
    .rows = rows,
    .end = end,
    .recover = recover_ascii,
    .finish = finish,
};
