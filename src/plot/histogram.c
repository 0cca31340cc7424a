/* histogram.c - classes of equal width from the smallest to the largest value, twice the cube root of the number of
 * values: with fewer the shape is lost, with more it is noise (the rule of Rice University). */
#include "histogram.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CLASSES = 200 };

struct values {
    double *value; /* heap */
    size_t n, capacity;
};

static enum dalcs_status add_row(void *user, double at, const double *value) {
    struct values *v = user;
    (void)at;
    if (!isfinite(value[0])) {
        return DALCS_OK; /* a run that failed */
    }
    DALCS_TRY(dalcs_grow(&v->value, &v->capacity, v->n + 1, sizeof *v->value));
    v->value[v->n++] = value[0];
    return DALCS_OK;
}

static void put_row(struct dalcs_waveforms *histogram, double at, double count) {
    double *row = histogram->value + 2 * histogram->n_rows;
    row[0] = at;
    row[1] = count;
    histogram->n_rows++;
}

/* A staircase: each class has its count at both ends. */
static void put_classes(struct dalcs_waveforms *histogram, const struct values *v, double least,
                        double largest, size_t n) {
    double count[MOST_CLASSES] = {0};
    const double width = (largest - least) / (double)n;
    for (size_t k = 0; k < v->n; k++) {
        const size_t class = (size_t)((v->value[k] - least) / width);
        count[class < n ? class : n - 1] += 1.0;
    }
    put_row(histogram, least, 0.0);
    for (size_t k = 0; k < n; k++) {
        put_row(histogram, least + (double)k * width, count[k]);
        put_row(histogram, k + 1 < n ? least + (double)(k + 1) * width : largest, count[k]);
    }
    put_row(histogram, largest, 0.0);
}

static enum dalcs_status make_table(struct dalcs_waveforms *histogram,
                                    const struct dalcs_selection *selection, const struct values *v,
                                    struct dalcs_diag *diag) {
    double least = INFINITY;
    double largest = -INFINITY;
    for (size_t k = 0; k < v->n; k++) {
        least = fmin(least, v->value[k]);
        largest = fmax(largest, v->value[k]);
    }
    if (!(largest > least)) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                       v->n == 0 ? "'%s' has no values" : "all values of '%s' are the same",
                       selection->name[0]);
        return DALCS_E_OPTION;
    }
    size_t n = (size_t)ceil(2.0 * cbrt((double)v->n));
    n = n < MOST_CLASSES ? n : MOST_CLASSES;
    *histogram = (struct dalcs_waveforms){
        .title = selection->waveforms->title, .plot_name = "Histogram", .n_plots = 1, .plot = 1};
    DALCS_TRY(dalcs_waveforms_set_columns(histogram, 2));
    const char *name = selection->name[0];
    histogram->name[0] = dalcs_arena_copy(&histogram->arena, name, strlen(name));
    histogram->name[1] = "runs";
    histogram->dimension[0] = selection->signal[0].dimension;
    histogram->dimension[1] = (struct dalcs_dimension){0};
    histogram->value = dalcs_alloc(2 * (2 * n + 2), sizeof *histogram->value);
    if (histogram->name[0] == NULL || histogram->value == NULL) {
        return DALCS_E_NOMEM;
    }
    put_classes(histogram, v, least, largest, n);
    return DALCS_OK;
}

enum dalcs_status dalcs_histogram_make(struct dalcs_waveforms *histogram,
                                       const struct dalcs_selection *selection,
                                       struct dalcs_diag *diag) {
    struct values v = {0};
    if (selection->n != 1) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "choose it with -s",
                       "a histogram shows one signal, and these are %zu", selection->n);
        return DALCS_E_OPTION;
    }
    if (selection->waveforms->dimension[0].second != 0) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "--measures of 'dalcs run' writes such a table",
                       "a histogram shows a table with a row for each run, not waveforms");
        return DALCS_E_OPTION;
    }
    enum dalcs_status status = dalcs_selection_each_row(selection, add_row, &v);
    if (status == DALCS_OK) {
        status = make_table(histogram, selection, &v, diag);
        if (status != DALCS_OK) {
            dalcs_waveforms_finish(histogram);
        }
    }
    free(v.value);
    return status;
}
