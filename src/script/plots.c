/* plots.c - plots of vectors: made, named, found, chosen and destroyed. */
#include "vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char CONSTANTS[] = "const";

const struct dalcs_plot_vectors *dalcs_plots_current(const struct dalcs_vectors *v) {
    return v->current != NULL ? v->current : &v->own;
}

static const struct dalcs_plot_vectors *find_exactly(const struct dalcs_vectors *v,
                                                     const char *type) {
    for (size_t k = v->n; k > 0; k--) {
        if (strcmp(v->plot[k - 1]->type, type) == 0) {
            return v->plot[k - 1];
        }
    }
    return strcmp(type, CONSTANTS) == 0 ? &v->own : NULL;
}

const struct dalcs_plot_vectors *dalcs_plots_find(const struct dalcs_vectors *v, const char *type) {
    const struct dalcs_plot_vectors *found = find_exactly(v, type);
    const size_t length = strlen(type);
    for (size_t k = v->n; k > 0 && found == NULL && length > 0; k--) {
        const char *own = v->plot[k - 1]->type;
        const char *digits = own + length;
        if (strncmp(own, type, length) == 0 && *digits != '\0' &&
            digits[strspn(digits, "0123456789")] == '\0') {
            found = v->plot[k - 1];
        }
    }
    return found;
}

const struct dalcs_plot_vectors *dalcs_plots_split(const struct dalcs_vectors *v, const char *name,
                                                   const char **rest) {
    char type[DALCS_PLOT_TYPE];
    const size_t n = strcspn(name, ".");
    *rest = name;
    if (n < sizeof type && name[n] == '.') {
        memcpy(type, name, n);
        type[n] = '\0';
        const struct dalcs_plot_vectors *plot = dalcs_plots_find(v, type);
        if (plot != NULL) {
            *rest = name + n + 1;
            return plot;
        }
    }
    return dalcs_plots_current(v);
}

/* ngspice's rule, on which scripts rely: one number for all kinds, raised where the name is taken. */
static void choose_type(struct dalcs_vectors *v, const char *word, char type[DALCS_PLOT_TYPE]) {
    v->number += v->number == 0;
    snprintf(type, DALCS_PLOT_TYPE, "%.16s%d", word, v->number);
    while (find_exactly(v, type) != NULL) {
        snprintf(type, DALCS_PLOT_TYPE, "%.16s%d", word, ++v->number);
    }
}

enum dalcs_status dalcs_plots_make(struct dalcs_vectors *v, const char *word, const char *kind,
                                   const char *title) {
    DALCS_TRY(dalcs_grow(&v->plot, &v->capacity, v->n + 1, sizeof(struct dalcs_plot_vectors *)));
    struct dalcs_plot_vectors *plot = dalcs_alloc(1, sizeof *plot);
    if (plot == NULL) {
        return DALCS_E_NOMEM;
    }
    choose_type(v, word, plot->type);
    plot->analysis = DALCS_OPERATING_POINT; /* of which a plot has no scale */
    plot->kind = dalcs_arena_copy(&plot->arena, kind, strlen(kind));
    plot->title = dalcs_arena_copy(&plot->arena, title, strlen(title));
    if (plot->kind == NULL || plot->title == NULL) {
        dalcs_plot_forget(plot);
        free(plot);
        return DALCS_E_NOMEM;
    }
    v->plot[v->n++] = plot;
    v->current = plot;
    return DALCS_OK;
}

void dalcs_plots_choose(struct dalcs_vectors *v, const struct dalcs_plot_vectors *plot) {
    v->current = NULL;
    for (size_t k = 0; k < v->n; k++) {
        v->current = v->plot[k] == plot ? v->plot[k] : v->current;
    }
}

static void destroy_vector(struct dalcs_vector *vector) {
    free(vector->value);
    free(vector);
}

void dalcs_plot_forget(struct dalcs_plot_vectors *plot) {
    for (size_t k = 0; k < plot->n; k++) {
        destroy_vector(plot->vector[k]);
    }
    free(plot->vector);
    dalcs_arena_finish(&plot->arena);
    *plot = (struct dalcs_plot_vectors){0};
}

void dalcs_plots_destroy(struct dalcs_vectors *v, const struct dalcs_plot_vectors *plot) {
    for (size_t k = 0; k < v->n; k++) {
        if (v->plot[k] == plot) {
            struct dalcs_plot_vectors *gone = v->plot[k];
            memmove(&v->plot[k], &v->plot[k + 1],
                    (v->n - k - 1) * sizeof(struct dalcs_plot_vectors *));
            v->n--;
            if (v->current == gone) { /* the newest of the others becomes the current one */
                v->current = v->n > 0 ? v->plot[v->n - 1] : NULL;
            }
            dalcs_plot_forget(gone);
            free(gone);
            return;
        }
    }
}

void dalcs_plots_destroy_all(struct dalcs_vectors *v) {
    while (v->n > 0) {
        dalcs_plots_destroy(v, v->plot[v->n - 1]);
    }
    free(v->plot);
    v->plot = NULL;
    v->capacity = 0;
    v->number = 0;
}

static bool unlet_in(struct dalcs_plot_vectors *plot, const char *name) {
    for (size_t k = 0; plot != NULL && k < plot->n; k++) {
        struct dalcs_vector *vector = plot->vector[k];
        if (strcmp(vector->name, name) == 0) {
            plot->scale = plot->scale == vector ? NULL : plot->scale;
            memmove(&plot->vector[k], &plot->vector[k + 1],
                    (plot->n - k - 1) * sizeof(struct dalcs_vector *));
            plot->n--;
            destroy_vector(vector);
            return true;
        }
    }
    return false;
}

bool dalcs_plots_unlet(struct dalcs_vectors *v, const char *name) {
    return unlet_in(v->current, name) || unlet_in(&v->own, name);
}
