/* raw_writing.c - write: vectors into a raw file, or behind the plots that it has. */
#include "writing.h"

#include "table.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The columns of a file, in heap. */
struct columns {
    size_t n;
    const struct dalcs_vector **vector; /* [n] */
    const char **name;                  /* [n] each of the heap */
    enum dalcs_unit *unit;              /* [n] */
    double *value;                      /* [2 n] of a row */
};

/* As ngspice names it: v1#branch is i(v1). */
static char *name_in_file(const char *name) {
    static const char ending[] = "#branch";
    const size_t n = strlen(name), n_ending = sizeof ending - 1;
    if (n <= n_ending || strcmp(name + n - n_ending, ending) != 0) {
        return strdup(name);
    }
    const size_t size = n - n_ending + sizeof "i()";
    char *text = dalcs_alloc(size, 1);
    if (text != NULL) {
        (void)snprintf(text, size, "i(%.*s)", (int)(n - n_ending), name);
    }
    return text;
}

/* What stands beside the scale. Shorter vectors go on with their last value, as ngspice writes them. */
static bool is_column(const struct dalcs_vector *v, const struct dalcs_vector *scale,
                      size_t length) {
    const bool is_scale = scale != NULL && strcmp(v->name, scale->name) == 0;
    const bool is_beside = v->n == 1 || v->scale == NULL || v->scale == scale || scale == NULL;
    return v->n >= 1 && v->n <= length && !is_scale && is_beside;
}

static enum dalcs_status choose(struct columns *c, const struct dalcs_vector *scale, size_t length,
                                const struct dalcs_vector *const *vector, size_t n) {
    c->vector = dalcs_alloc(n, sizeof *c->vector);
    c->name = dalcs_alloc(n, sizeof *c->name);
    c->unit = dalcs_alloc(n, sizeof *c->unit);
    c->value = dalcs_alloc(2 * n, sizeof *c->value);
    if (c->vector == NULL || c->name == NULL || c->unit == NULL || c->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        if (is_column(vector[i], scale, length)) {
            c->vector[c->n] = vector[i];
            c->unit[c->n] = vector[i]->unit;
            c->name[c->n] = name_in_file(vector[i]->name);
            if (c->name[c->n++] == NULL) {
                return DALCS_E_NOMEM;
            }
        }
    }
    return DALCS_OK;
}

static void columns_finish(struct columns *c) {
    for (size_t i = 0; i < c->n; i++) {
        free((void *)c->name[i]);
    }
    free(c->vector);
    free(c->name);
    free(c->unit);
    free(c->value);
}

static void fill(const struct columns *c, size_t k, bool is_complex) {
    for (size_t i = 0; i < c->n; i++) {
        const struct dalcs_vector *v = c->vector[i];
        const double complex x = v->value[k < v->n ? k : v->n - 1];
        c->value[is_complex ? 2 * i : i] = creal(x);
        if (is_complex) {
            c->value[2 * i + 1] = cimag(x);
        }
    }
}

static enum dalcs_status write_table(struct dalcs_table *table, const struct dalcs_plot *plot,
                                     const struct dalcs_vector *scale, const struct columns *c,
                                     size_t length) {
    enum dalcs_status status = dalcs_table_begin(table, plot);
    for (size_t k = 0; k < length && status == DALCS_OK; k++) {
        fill(c, k, plot->is_complex);
        const double at = scale != NULL ? creal(scale->value[k]) : 0.0;
        status = dalcs_table_rows(table, 1, &at, c->value);
    }
    status = status == DALCS_OK ? dalcs_table_end(table) : status;
    return status == DALCS_OK ? dalcs_table_commit(table) : status;
}

/* The file `from` behind what is in `path`; returns an errno, 0: well. */
static int append_file(const char *path, const char *from) {
    char buffer[65536];
    FILE *in = fopen(from, "rb");
    FILE *out = fopen(path, "ab");
    int error = in == NULL || out == NULL ? errno : 0;
    for (size_t n = 1; error == 0 && n > 0;) {
        n = fread(buffer, 1, sizeof buffer, in);
        error = ferror(in) || fwrite(buffer, 1, n, out) < n ? EIO : 0;
    }
    if (out != NULL && fclose(out) != 0 && error == 0) {
        error = errno;
    }
    if (in != NULL) {
        fclose(in);
    }
    return error;
}

static enum dalcs_status write_file(const char *path, bool ascii, const struct dalcs_plot *plot,
                                    const struct dalcs_vector *scale, const struct columns *c,
                                    size_t length, int *error) {
    struct dalcs_table table = {.path = path,
                                .format = ascii ? &dalcs_raw_ascii_format : &dalcs_raw_format,
                                .main = plot->analysis};
    table.state = dalcs_alloc(1, table.format->state_size);
    if (table.state == NULL) {
        return DALCS_E_NOMEM;
    }
    const enum dalcs_status status = write_table(&table, plot, scale, c, length);
    *error = table.file.error;
    dalcs_table_finish(&table);
    return status;
}

/* A file of its own first: what fails on the way leaves the plots that are there as they are. */
static enum dalcs_status append_plot(const char *path, bool ascii, const struct dalcs_plot *plot,
                                     const struct dalcs_vector *scale, const struct columns *c,
                                     size_t length, int *error) {
    static const char ending[] = ".next";
    const size_t size = strlen(path) + sizeof ending;
    char *next = dalcs_alloc(size, 1);
    if (next == NULL) {
        return DALCS_E_NOMEM;
    }
    (void)snprintf(next, size, "%s%s", path, ending);
    enum dalcs_status status = write_file(next, ascii, plot, scale, c, length, error);
    if (status == DALCS_OK) {
        *error = append_file(path, next);
        status = *error == 0 ? DALCS_OK : DALCS_E_IO;
        (void)unlink(next);
    }
    free(next);
    return status;
}

enum dalcs_status dalcs_writing_raw(const char *path, const struct dalcs_writing *how,
                                    const struct dalcs_plot_vectors *plot,
                                    const struct dalcs_vector *scale,
                                    const struct dalcs_vector *const *vector, size_t n,
                                    int *error) {
    const bool is_point = dalcs_analysis_is_point(plot->analysis);
    const struct dalcs_vector *beside = is_point ? NULL : scale;
    const size_t length = is_point ? 1 : scale->n;
    struct columns c = {0};
    *error = 0;
    enum dalcs_status status = choose(&c, beside, length, vector, n);
    struct dalcs_plot about = {.analysis = plot->analysis,
                               .title = plot->title,
                               .scale = scale != NULL ? scale->name : "",
                               .scale_unit = scale != NULL ? scale->unit : DALCS_UNIT_NONE,
                               .n_signals = c.n,
                               .name = c.name,
                               .unit = c.unit,
                               /* as ngspice, and readers go by the name of the plot */
                               .is_complex = plot->analysis == DALCS_AC,
                               .n_steps = 1};
    for (size_t i = 0; i < c.n; i++) {
        about.is_complex = about.is_complex || c.vector[i]->is_complex;
    }
    if (status == DALCS_OK) {
        status = how->appends && access(path, F_OK) == 0
                     ? append_plot(path, how->ascii, &about, beside, &c, length, error)
                     : write_file(path, how->ascii, &about, beside, &c, length, error);
    }
    columns_finish(&c);
    return status;
}
