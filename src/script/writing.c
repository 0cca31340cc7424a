/* writing.c - print and wrdata. */
#include "writing.h"

#include "atomic_file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- print ---------------------------------------------------------------------------------------- */

enum { WIDTH = 80, COLUMN = 16 };

/* As ngspice: the sign takes the place of a digit. */
static void print_real(FILE *out, double value, int digits) {
    fprintf(out, "%.*e", signbit(value) && digits > 1 ? digits - 1 : digits, value);
}

static void print_number(FILE *out, const struct dalcs_vector *v, size_t k, int digits,
                         const char *between) {
    print_real(out, creal(v->value[k]), digits);
    if (v->is_complex) {
        fputs(between, out);
        print_real(out, cimag(v->value[k]), digits);
    }
}

static void print_line(FILE *out, const struct dalcs_vector *v, int digits) {
    fprintf(out, "%s = ", v->name);
    if (v->n != 1) {
        fputs("(  ", out);
    }
    for (size_t k = 0; k < v->n; k++) {
        print_number(out, v, k, digits, ",");
        fputs(v->n != 1 ? "\t" : "", out);
    }
    fputs(v->n != 1 ? ")\n" : "\n", out);
}

static void print_rule(FILE *out) {
    for (int k = 0; k < WIDTH; k++) {
        fputc('-', out);
    }
    fputc('\n', out);
}

static void print_heading(FILE *out, const struct dalcs_plot_vectors *plot) {
    const char *title = plot->title != NULL ? plot->title : "Constant values";
    const size_t length = strlen(title);
    const int indent = length < WIDTH ? (int)(WIDTH - length) / 2 : 0;
    fprintf(out, "%*s%s\n%*s%s\n", indent, "", title, indent, "",
            plot->kind != NULL ? plot->kind : "constants");
    print_rule(out);
}

/* Vectors of one length beside one scale: a table. */
struct group {
    const struct dalcs_vector *scale; /* NULL: none */
    size_t length;
};

static struct group group_of(const struct dalcs_plot_vectors *plot, const struct dalcs_vector *v) {
    const bool has_own = !dalcs_analysis_is_point(plot->analysis) && plot->scale != NULL &&
                         plot->scale->n == v->n && v->n > 1;
    return (struct group){v->scale != NULL ? v->scale : has_own ? plot->scale : NULL, v->n};
}

/* Two runs over the same times or frequencies stand side by side. */
static bool is_same(const struct group *a, const struct group *b) {
    bool same = a->length == b->length && (a->scale == NULL) == (b->scale == NULL);
    for (size_t k = 0; same && a->scale != b->scale && k < a->length; k++) {
        same = a->scale->value[k] == b->scale->value[k];
    }
    return same;
}

/* The scale stands in the first column already. */
static bool is_in(const struct group *group, const struct dalcs_plot_vectors *plot,
                  const struct dalcs_vector *v) {
    const struct group own = group_of(plot, v);
    return is_same(&own, group) &&
           (group->scale == NULL || strcmp(group->scale->name, v->name) != 0);
}

static void print_table(FILE *out, int digits, const struct dalcs_plot_vectors *plot,
                        const struct group *group, const struct dalcs_vector *const *vector,
                        size_t n) {
    print_heading(out, plot);
    fputs("Index   ", out);
    if (group->scale != NULL) {
        fprintf(out, "%-*s ", COLUMN - 1, group->scale->name);
    }
    for (size_t i = 0; i < n; i++) {
        if (is_in(group, plot, vector[i])) {
            fprintf(out, "%-*s ", (vector[i]->is_complex ? 2 * COLUMN : COLUMN) - 1,
                    vector[i]->name);
        }
    }
    fputc('\n', out);
    print_rule(out);
    for (size_t k = 0; k < group->length; k++) {
        fprintf(out, "%zu\t", k);
        if (group->scale != NULL) {
            print_real(out, creal(group->scale->value[k]), digits);
            fputc('\t', out);
        }
        for (size_t i = 0; i < n; i++) {
            if (is_in(group, plot, vector[i])) {
                print_number(out, vector[i], k, digits, ",\t");
                fputc('\t', out);
            }
        }
        fputc('\n', out);
    }
}

void dalcs_writing_print(FILE *out, const struct dalcs_writing *how,
                         const struct dalcs_plot_vectors *plot,
                         const struct dalcs_vector *const *vector, size_t n) {
    const int digits = how->digits > 0 ? how->digits : 6;
    for (size_t i = 0; i < n; i++) {
        const bool is_line = how->as_lines || (vector[i]->n <= 1 && !how->as_columns);
        if (is_line && vector[i]->n == 0) {
            fprintf(out, "%s =\n", vector[i]->name);
        } else if (is_line) {
            print_line(out, vector[i], digits);
        }
    }
    for (size_t i = 0; i < n; i++) {
        const struct group group = group_of(plot, vector[i]);
        bool is_first = !how->as_lines && (vector[i]->n > 1 || how->as_columns);
        for (size_t k = 0; k < i && is_first; k++) {
            const struct group before = group_of(plot, vector[k]);
            is_first = !is_same(&before, &group);
        }
        if (is_first) {
            print_table(out, digits, plot, &group, vector, n);
        }
    }
}

/* ---- wrdata --------------------------------------------------------------------------------------- */

static void write_name(FILE *file, const char *name) {
    fprintf(file, " %-15s", name);
}

static void write_number(FILE *file, double value) {
    fprintf(file, "% .8e ", value);
}

static const struct dalcs_vector *scale_of(const struct dalcs_vector *v,
                                           const struct dalcs_vector *scale) {
    return v->scale != NULL ? v->scale : scale;
}

static void write_names(FILE *file, bool single, const struct dalcs_vector *scale,
                        const struct dalcs_vector *const *vector, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (i == 0 || !single) {
            write_name(file, scale_of(vector[i], scale)->name);
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
                const struct dalcs_vector *own = scale_of(v, scale);
                write_number(file, creal(own->value[k < own->n ? k : own->n - 1]));
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
