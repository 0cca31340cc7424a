/* writing.c - print, wrdata and write. */
#include "writing.h"

#include "table.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* ---- print ---------------------------------------------------------------------------------------- */

static void print_number(FILE *out, const struct dalcs_vector *v, size_t k, int digits) {
    fprintf(out, "%.*e", digits, creal(v->value[k]));
    if (v->is_complex) {
        fprintf(out, ",%.*e", digits, cimag(v->value[k]));
    }
}

static void print_table(FILE *out, int digits, const struct dalcs_vector *scale,
                        const struct dalcs_vector *const *vector, size_t n, size_t length) {
    fputs("Index", out);
    if (scale != NULL) {
        fprintf(out, "\t%s", scale->name);
    }
    for (size_t i = 0; i < n; i++) {
        if (vector[i]->n == length) {
            fprintf(out, "\t%s", vector[i]->name);
        }
    }
    fputc('\n', out);
    for (size_t k = 0; k < length; k++) {
        fprintf(out, "%zu", k);
        if (scale != NULL) {
            fprintf(out, "\t%.*e", digits, creal(scale->value[k]));
        }
        for (size_t i = 0; i < n; i++) {
            if (vector[i]->n == length) {
                fputc('\t', out);
                print_number(out, vector[i], k, digits);
            }
        }
        fputc('\n', out);
    }
}

void dalcs_writing_print(FILE *out, const struct dalcs_writing *how,
                         const struct dalcs_vector *scale, const struct dalcs_vector *const *vector,
                         size_t n) {
    const int digits = how->digits > 0 ? how->digits : 6;
    size_t done = 1; /* lengths up to this one are written */
    for (size_t i = 0; i < n; i++) {
        if (vector[i]->n <= 1) {
            fprintf(out, "%s = ", vector[i]->name);
            if (vector[i]->n == 1) {
                print_number(out, vector[i], 0, digits);
            }
            fputc('\n', out);
        }
    }
    for (;;) {
        size_t next = 0;
        for (size_t i = 0; i < n; i++) {
            if (vector[i]->n > done && (next == 0 || vector[i]->n < next)) {
                next = vector[i]->n;
            }
        }
        if (next == 0) {
            return;
        }
        print_table(out, digits, scale != NULL && scale->n == next ? scale : NULL, vector, n, next);
        done = next;
    }
}

/* ---- wrdata --------------------------------------------------------------------------------------- */

static void write_name(FILE *file, const char *name) {
    fprintf(file, " %-15s", name);
}

static void write_number(FILE *file, double value) {
    fprintf(file, "% .8e ", value);
}

static void write_names(FILE *file, bool single, const struct dalcs_vector *scale,
                        const struct dalcs_vector *const *vector, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (i == 0 || !single) {
            write_name(file, scale->name);
        }
        write_name(file, vector[i]->name);
        if (vector[i]->is_complex) {
            write_name(file, vector[i]->name);
        }
    }
    fputc('\n', file);
}

static void write_rows(FILE *file, bool single, const struct dalcs_vector *scale,
                       const struct dalcs_vector *const *vector, size_t n) {
    size_t length = 0;
    for (size_t i = 0; i < n; i++) {
        length = vector[i]->n > length ? vector[i]->n : length;
    }
    for (size_t k = 0; k < length; k++) {
        for (size_t i = 0; i < n; i++) {
            const struct dalcs_vector *v = vector[i];
            const size_t at = k < v->n ? k : v->n - 1;
            if (i == 0 || !single) {
                write_number(file, creal(scale->value[k < scale->n ? k : scale->n - 1]));
            }
            write_number(file, creal(v->value[at]));
            if (v->is_complex) {
                write_number(file, cimag(v->value[at]));
            }
        }
        fputc('\n', file);
    }
}

enum dalcs_status dalcs_writing_data(const char *path, const struct dalcs_writing *how,
                                     const struct dalcs_vector *scale,
                                     const struct dalcs_vector *const *vector, size_t n,
                                     int *error) {
    struct dalcs_atomic_file file = {0};
    FILE *stream = NULL;
    *error = 0;
    if (how->appends) {
        stream = fopen(path, "a");
        *error = stream == NULL ? errno : 0;
    } else {
        enum dalcs_status status = dalcs_atomic_file_open(&file, path);
        if (status != DALCS_OK && status != DALCS_E_IO) {
            return status;
        }
        stream = file.stream;
        *error = file.error;
    }
    if (stream == NULL) {
        return DALCS_E_IO;
    }
    if (how->with_names) {
        write_names(stream, how->single_scale, scale, vector, n);
    }
    write_rows(stream, how->single_scale, scale, vector, n);
    if (!how->appends) {
        enum dalcs_status status = dalcs_atomic_file_commit(&file);
        *error = file.error;
        return status;
    }
    const bool failed = ferror(stream) != 0;
    if (fclose(stream) != 0 || failed) {
        *error = errno != 0 ? errno : EIO;
        return DALCS_E_IO;
    }
    return DALCS_OK;
}

/* ---- write ---------------------------------------------------------------------------------------- */

struct row {
    const struct dalcs_vector *const *vector;
    size_t n;
    double *value;
};

static void fill(const struct row *row, size_t k, bool is_complex) {
    for (size_t i = 0; i < row->n; i++) {
        const double complex x = row->vector[i]->value[k];
        row->value[is_complex ? 2 * i : i] = creal(x);
        if (is_complex) {
            row->value[2 * i + 1] = cimag(x);
        }
    }
}

static enum dalcs_status write_table(struct dalcs_table *table, const struct dalcs_plot *plot,
                                     const struct dalcs_vector *scale, const struct row *row,
                                     size_t length) {
    enum dalcs_status status = dalcs_table_begin(table, plot);
    for (size_t k = 0; k < length && status == DALCS_OK; k++) {
        fill(row, k, plot->is_complex);
        const double at = scale != NULL ? creal(scale->value[k]) : 0.0;
        status = dalcs_table_rows(table, 1, &at, row->value);
    }
    status = status == DALCS_OK ? dalcs_table_end(table) : status;
    return status == DALCS_OK ? dalcs_table_commit(table) : status;
}

enum dalcs_status dalcs_writing_raw(const char *path, const struct dalcs_writing *how,
                                    const struct dalcs_plot_vectors *plot,
                                    const struct dalcs_vector *scale,
                                    const struct dalcs_vector *const *vector, size_t n,
                                    int *error) {
    const bool is_point = plot->analysis == DALCS_OPERATING_POINT;
    const size_t length = is_point ? 1 : scale->n;
    const struct dalcs_vector **kept = dalcs_alloc(n, sizeof *kept);
    const char **name = dalcs_alloc(n, sizeof *name);
    enum dalcs_unit *unit = dalcs_alloc(n, sizeof *unit);
    double *value = dalcs_alloc(2 * n, sizeof *value);
    struct dalcs_table table = {.path = path,
                                .format = how->ascii ? &dalcs_raw_ascii_format : &dalcs_raw_format,
                                .main = plot->analysis};
    table.state = dalcs_alloc(1, table.format->state_size);
    enum dalcs_status status = DALCS_E_NOMEM;
    if (kept != NULL && name != NULL && unit != NULL && value != NULL && table.state != NULL) {
        struct dalcs_plot about = {.analysis = plot->analysis,
                                   .title = plot->title,
                                   .scale = scale != NULL ? scale->name : "",
                                   .scale_unit = scale != NULL ? scale->unit : DALCS_UNIT_NONE,
                                   .name = name,
                                   .unit = unit,
                                   /* as ngspice, and readers go by the name of the plot */
                                   .is_complex = plot->analysis == DALCS_AC,
                                   .n_steps = 1};
        for (size_t i = 0; i < n; i++) {
            if (vector[i]->n == length && (is_point || strcmp(vector[i]->name, scale->name) != 0)) {
                kept[about.n_signals] = vector[i];
                name[about.n_signals] = vector[i]->name;
                unit[about.n_signals++] = vector[i]->unit;
                about.is_complex = about.is_complex || vector[i]->is_complex;
            }
        }
        const struct row row = {kept, about.n_signals, value};
        status = write_table(&table, &about, is_point ? NULL : scale, &row, length);
    }
    *error = table.file.error;
    if (table.state != NULL) {
        dalcs_table_finish(&table);
    }
    free(kept);
    free(name);
    free(unit);
    free(value);
    return status;
}
