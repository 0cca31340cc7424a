/* csv.c - comma-separated values: one header line, then numbers that are read back exactly, the decimal point a
 * point whatever the locale. An operating point alone is one row at time 0. The values of a .step come
 * first, then the scale; of complex signals the real and the imaginary part. */
#include "decimal.h"
#include "memory.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct csv {
    struct dalcs_decimal decimal;
    size_t n_parameters, n_values; /* before and after the scale */
    double *parameter;             /* [n_parameters] of this step */
    char *line;                    /* room for one row */
    off_t rows_at;                 /* file position of the first row */
};

/* Names with a comma or a quote, v(a,b), are quoted as RFC 4180 says. */
static void write_name(FILE *stream, const char *name) {
    if (!strpbrk(name, ",\"")) {
        fputs(name, stream);
        return;
    }
    fputc('"', stream);
    for (const char *c = name; *c; c++) {
        if (*c == '"') {
            fputc('"', stream);
        }
        fputc(*c, stream);
    }
    fputc('"', stream);
}

static void write_part(FILE *stream, const char *part, const char *name) {
    const bool quotes = strpbrk(name, ",\"") != NULL;
    fprintf(stream, quotes ? ",\"%s(" : ",%s(", part);
    for (const char *c = name; *c; c++) {
        fputs(*c == '"' ? "\"" : "", stream);
        fputc(*c, stream);
    }
    fputs(quotes ? ")\"" : ")", stream);
}

static void write_header(FILE *stream, const struct dalcs_plot *plot) {
    for (size_t i = 0; i < plot->n_parameters; i++) {
        write_name(stream, plot->parameter[i]);
        fputc(',', stream);
    }
    write_name(stream, plot->scale);
    for (size_t i = 0; i < plot->n_signals; i++) {
        if (plot->is_complex) {
            write_part(stream, "re", plot->name[i]);
            write_part(stream, "im", plot->name[i]);
        } else {
            fputc(',', stream);
            write_name(stream, plot->name[i]);
        }
    }
    fputc('\n', stream);
}

/* The steps of .step follow one another below one header. */
static enum dalcs_status begin(void *state, FILE *stream, const struct dalcs_plot *plot) {
    struct csv *csv = state;
    const size_t n_values = plot->is_complex ? 2 * plot->n_signals : plot->n_signals;
    const bool goes_on = plot->step > 0 && csv->n_values == n_values;
    dalcs_decimal_init(&csv->decimal);
    csv->n_values = n_values;
    csv->n_parameters = plot->n_parameters;
    free(csv->line);
    free(csv->parameter);
    csv->line = dalcs_alloc(plot->n_parameters + n_values + 1, DALCS_DECIMAL_SIZE);
    csv->parameter = dalcs_alloc(plot->n_parameters, sizeof(double));
    if (!csv->line || !csv->parameter) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < plot->n_parameters; i++) {
        csv->parameter[i] = plot->parameter_value[i];
    }
    if (!goes_on) {
        write_header(stream, plot);
        csv->rows_at = ftello(stream);
    }
    return DALCS_OK;
}

static void write_row(const struct csv *csv, FILE *stream, double time, const double *value) {
    char *c = csv->line;
    for (size_t i = 0; i < csv->n_parameters; i++) {
        c += dalcs_decimal_write(&csv->decimal, csv->parameter[i], c);
        *c++ = ',';
    }
    c += dalcs_decimal_write(&csv->decimal, time, c);
    for (size_t i = 0; i < csv->n_values; i++) {
        *c++ = ',';
        c += dalcs_decimal_write(&csv->decimal, value[i], c);
    }
    *c++ = '\n';
    fwrite(csv->line, 1, (size_t)(c - csv->line), stream);
}

static void rows(void *state, FILE *stream, size_t n, const double *time, const double *value) {
    const struct csv *csv = state;
    for (size_t k = 0; k < n; k++) {
        write_row(csv, stream, time[k], value + k * csv->n_values);
    }
}

static void end(void *state, FILE *stream) {
    (void)state;
    (void)stream;
}

/* Up to the last newline but that of the header. */
static off_t recover(const void *state, int descriptor, off_t size) {
    const struct csv *csv = state;
    char block[4096];
    while (size > csv->rows_at) {
        off_t start =
            size > csv->rows_at + (off_t)sizeof block ? size - (off_t)sizeof block : csv->rows_at;
        if (pread(descriptor, block, (size_t)(size - start), start) != size - start) {
            return 0;
        }
        for (; size > start; size--) {
            if (block[size - start - 1] == '\n') {
                return size;
            }
        }
    }
    return 0;
}

static void finish(void *state) {
    struct csv *csv = state;
    free(csv->line);
    free(csv->parameter);
}

const struct dalcs_table_format dalcs_csv_format = {
    .extension = ".csv",
    .state_size = sizeof(struct csv),
    .one_plot = true,
    .begin = begin,
    .rows = rows,
    .end = end,
    .recover = recover,
    .finish = finish,
};
