/* plots.c - plots are made, grow, are found and destroyed. */
#include "plots.h"

#include "lower_case.h"
#include "signal_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

static enum dalcs_status add_vector(struct ng_plot *plot, const char *name, const char *signal,
                                    struct ng_vector about) {
    DALCS_TRY(dalcs_grow(&plot->vector, &plot->capacity, plot->n + 1, sizeof(struct ng_vector *)));
    struct ng_vector *v = dalcs_alloc(1, sizeof *v);
    if (v == NULL) {
        return DALCS_E_NOMEM;
    }
    *v = about;
    v->name = ng_copy_of(name);
    v->signal = ng_copy_of(signal);
    if (v->name == NULL || v->signal == NULL || ng_vector_reserve(v, 1, true) != DALCS_OK) {
        ng_vector_destroy(v);
        return DALCS_E_NOMEM;
    }
    plot->vector[plot->n++] = v;
    return DALCS_OK;
}

/* ---- Plots -------------------------------------------------------------------------------------- */

static void destroy_plot(struct ng_plot *plot) {
    for (size_t k = 0; k < plot->n; k++) {
        ng_vector_destroy(plot->vector[k]);
    }
    free(plot->vector);
    free(plot->type);
    free(plot->title);
    free(plot->date);
    free(plot);
}

static enum dalcs_status add_plot(struct ng_plots *plots, const char *type, const char *kind,
                                  const char *title, struct ng_plot **made) {
    char date[64];
    struct tm now;
    const time_t seconds = time(NULL);
    if (localtime_r(&seconds, &now) == NULL || strftime(date, sizeof date, "%c", &now) == 0) {
        date[0] = '\0';
    }
    DALCS_TRY(dalcs_grow(&plots->plot, &plots->capacity, plots->n + 1, sizeof(struct ng_plot *)));
    struct ng_plot *plot = dalcs_alloc(1, sizeof *plot);
    if (plot == NULL) {
        return DALCS_E_NOMEM;
    }
    plot->kind = kind;
    plot->type = ng_copy_of(type);
    plot->title = ng_copy_of(title);
    plot->date = ng_copy_of(date);
    if (plot->type == NULL || plot->title == NULL || plot->date == NULL) {
        destroy_plot(plot);
        return DALCS_E_NOMEM;
    }
    plots->plot[plots->n++] = plot;
    *made = plot;
    return DALCS_OK;
}

/* The plot that is there before any run. */
static enum dalcs_status add_constants(struct ng_plots *plots) {
    static const struct {
        const char *name;
        double value;
    } constant[] = {{"planck", 6.62607015e-34},
                    {"boltz", 1.380649e-23},
                    {"echarge", 1.602176634e-19},
                    {"kelvin", -273.15},
                    {"c", 299792458.0},
                    {"e", 2.718281828459045},
                    {"pi", 3.141592653589793},
                    {"no", 0.0},
                    {"false", 0.0},
                    {"yes", 1.0},
                    {"true", 1.0}};

    struct ng_plot *plot;
    DALCS_TRY(add_plot(plots, "const", "Constant values", "Constant values", &plot));
    for (size_t k = 0; k < sizeof constant / sizeof constant[0]; k++) {
        DALCS_TRY(ng_plots_set(plots, plot, constant[k].name, DALCS_UNIT_NONE, false, 1,
                               &constant[k].value));
    }
    return DALCS_OK;
}

enum dalcs_status ng_plots_open(struct ng_plots *plots) {
    /* a program may hold it, by ngSpice_LockRealloc, while it reads vectors */
    pthread_mutexattr_t attributes;
    bool made = pthread_mutexattr_init(&attributes) == 0;
    if (made) {
        pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
        made = pthread_mutex_init(&plots->lock, &attributes) == 0;
        pthread_mutexattr_destroy(&attributes);
    }
    return made ? add_constants(plots) : DALCS_E_NOMEM;
}

void ng_plots_close(struct ng_plots *plots) {
    for (size_t k = 0; k < plots->n; k++) {
        destroy_plot(plots->plot[k]);
    }
    free(plots->plot);
    free(plots->name);
    pthread_mutex_destroy(&plots->lock);
    *plots = (struct ng_plots){0};
}

static size_t index_of(const struct ng_plots *plots, const char *type) {
    size_t k = 0;
    while (k < plots->n && strcasecmp(plots->plot[k]->type, type) != 0) {
        k++;
    }
    return k;
}

/* ngspice's rule, on which programs rely: one number for all kinds, raised where the name is taken. */
static void choose_type(struct ng_plots *plots, const char *kind, char *type, size_t size) {
    plots->number += plots->number == 0;
    snprintf(type, size, "%s%d", kind, plots->number);
    while (index_of(plots, type) < plots->n) {
        snprintf(type, size, "%s%d", kind, ++plots->number);
    }
}

/* ngspice's word for the scale of a sweep. */
static const char *scale_of(const struct dalcs_plot *about) {
    return about->analysis != DALCS_DC_SWEEP   ? about->scale
           : about->scale_unit == DALCS_VOLT   ? "v-sweep"
           : about->scale_unit == DALCS_AMPERE ? "i-sweep"
                                               : about->scale;
}

static enum dalcs_status add_signals(struct ng_plot *plot, const struct dalcs_plot *about) {
    char name[NG_NAME_SIZE];
    if (plot->has_scale) {
        const char *scale = scale_of(about);
        DALCS_TRY(add_vector(
            plot, scale, scale,
            (struct ng_vector){.unit = about->scale_unit, .is_complex = about->is_complex}));
    }
    for (size_t k = 0; k < about->n_signals; k++) {
        ng_signal_name(about->name[k], name);
        DALCS_TRY(add_vector(
            plot, name, about->name[k],
            (struct ng_vector){.unit = about->unit[k], .is_complex = about->is_complex}));
    }
    return DALCS_OK;
}

enum dalcs_status ng_plots_begin(struct ng_plots *plots, const struct dalcs_plot *about) {
    static const char *const known[DALCS_N_ANALYSES][2] = {
        [DALCS_OPERATING_POINT] = {"op", "Operating Point"},
        [DALCS_TRANSIENT] = {"tran", "Transient Analysis"},
        [DALCS_DC_SWEEP] = {"dc", "DC transfer characteristic"},
        [DALCS_AC] = {"ac", "AC Analysis"},
        [DALCS_PERIODIC] = {"pss", "Periodic Steady State"},
        [DALCS_TRANSFER] = {"tf", "Transfer Function"}};
    const enum dalcs_analysis analysis = about->analysis;
    char type[24];
    struct ng_plot *plot = NULL;
    choose_type(plots, known[analysis][0], type, sizeof type);
    pthread_mutex_lock(&plots->lock);
    enum dalcs_status status = add_plot(plots, type, known[analysis][1], about->title, &plot);
    if (status == DALCS_OK) {
        plot->analysis = analysis;
        plot->has_scale = !dalcs_analysis_is_point(analysis);
        plots->current = plots->n - 1;
        status = add_signals(plot, about);
    }
    pthread_mutex_unlock(&plots->lock);
    return status;
}

enum dalcs_status ng_plots_make(struct ng_plots *plots, const char *word, const char *kind,
                                const char *title) {
    char type[24];
    struct ng_plot *plot = NULL;
    choose_type(plots, word, type, sizeof type);
    pthread_mutex_lock(&plots->lock);
    const enum dalcs_status status = add_plot(plots, type, kind, title, &plot);
    if (status == DALCS_OK) {
        plot->analysis = DALCS_OPERATING_POINT; /* of which a plot has no scale */
        plots->current = plots->n - 1;
    }
    pthread_mutex_unlock(&plots->lock);
    return status;
}

enum dalcs_status ng_plots_add_rows(struct ng_plots *plots, size_t n, const double *scale,
                                    const double *value) {
    struct ng_plot *plot = ng_plots_current(plots);
    const size_t first = plot->has_scale ? 1 : 0;
    size_t stride = 0;
    enum dalcs_status status = DALCS_OK;
    for (size_t k = first; k < plot->n; k++) {
        stride += plot->vector[k]->is_complex ? 2 : 1;
    }
    pthread_mutex_lock(&plots->lock);
    for (size_t k = 0; k < plot->n && status == DALCS_OK; k++) {
        status = ng_vector_reserve(plot->vector[k], plot->vector[k]->n + n, plots->is_shared);
    }
    if (status == DALCS_OK) {
        const double *from = value;
        for (size_t k = first; k < plot->n; k++) {
            ng_vector_append(plot->vector[k], n, from, stride);
            from += plot->vector[k]->is_complex ? 2 : 1;
        }
        if (first > 0) { /* last: a vector is never shorter than its scale */
            ng_vector_append_scale(plot->vector[0], n, scale);
        }
    }
    pthread_mutex_unlock(&plots->lock);
    return status;
}

struct ng_plot *ng_plots_current(const struct ng_plots *plots) {
    return plots->plot[plots->current];
}

/* ---- Finding ------------------------------------------------------------------------------------ */

struct ng_plot *ng_plots_find(const struct ng_plots *plots, const char *type) {
    const size_t k = index_of(plots, type);
    return k < plots->n ? plots->plot[k] : NULL;
}

bool ng_plots_choose(struct ng_plots *plots, const char *type) {
    const size_t k = index_of(plots, type);
    plots->current = k < plots->n ? k : plots->current;
    return k < plots->n;
}

/* ---- Changing ----------------------------------------------------------------------------------- */

static void remove_at(struct ng_plots *plots, size_t k) {
    destroy_plot(plots->plot[k]);
    memmove(plots->plot + k, plots->plot + k + 1, (plots->n - k - 1) * sizeof(struct ng_plot *));
    plots->n--;
    if (plots->current >= k) { /* the one before it becomes the current one */
        plots->current -= plots->current > 0;
    }
}

bool ng_plots_destroy(struct ng_plots *plots, const char *type) {
    const size_t k = index_of(plots, type);
    const bool is_there = k > 0 && k < plots->n;
    if (is_there) {
        pthread_mutex_lock(&plots->lock);
        remove_at(plots, k);
        pthread_mutex_unlock(&plots->lock);
    }
    return is_there;
}

void ng_plots_destroy_all(struct ng_plots *plots) {
    pthread_mutex_lock(&plots->lock);
    while (plots->n > 1) {
        remove_at(plots, plots->n - 1);
    }
    plots->current = 0;
    plots->number = 0;
    pthread_mutex_unlock(&plots->lock);
}

bool ng_plots_unlet(struct ng_plots *plots, struct ng_plot *plot, const char *name) {
    struct ng_vector *v = ng_plot_vector(plot, name);
    size_t k = 0;
    while (k < plot->n && plot->vector[k] != v) {
        k++;
    }
    if (v == NULL || (k == 0 && plot->has_scale)) {
        return false;
    }
    pthread_mutex_lock(&plots->lock);
    memmove(&plot->vector[k], &plot->vector[k + 1], (plot->n - k - 1) * sizeof(struct ng_vector *));
    plot->n--;
    ng_vector_destroy(v);
    pthread_mutex_unlock(&plots->lock);
    return true;
}

enum dalcs_status ng_plots_set(struct ng_plots *plots, struct ng_plot *plot, const char *name,
                               enum dalcs_unit unit, bool is_complex, size_t n,
                               const double *value) {
    struct ng_vector *v = NULL;
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < plot->n && v == NULL; k++) {
        v = plot->vector[k]->is_own && strcmp(plot->vector[k]->name, name) == 0 ? plot->vector[k]
                                                                                : NULL;
    }
    pthread_mutex_lock(&plots->lock);
    if (v == NULL) {
        status = add_vector(plot, name, "", (struct ng_vector){.is_own = true});
        v = status == DALCS_OK ? plot->vector[plot->n - 1] : NULL;
    }
    if (v != NULL) {
        v->n = 0;
        v->capacity = 0; /* a new block: programs may hold the old one */
        v->is_complex = is_complex;
        v->unit = unit;
        status = ng_vector_reserve(v, n > 0 ? n : 1, true);
    }
    if (status == DALCS_OK && n > 0) {
        ng_vector_append(v, n, value, is_complex ? 2 : 1);
    }
    pthread_mutex_unlock(&plots->lock);
    return status;
}
