/* vector_list.c - the vectors that print, plot, write and others are given. */
#include "script_internal.h"

#include <string.h>

/* A word at *text that stands for several vectors: all, allv, alli, ally, or tran1.all. *n_word: its length. */
static const struct dalcs_plot_vectors *plot_of_all(const struct dalcs_script *script,
                                                    const char *text, size_t *n_word, char *kind) {
    char word[DALCS_PLOT_TYPE + 8];
    const char *rest;
    const size_t n = strcspn(text, " \t,");
    if (n >= sizeof word) {
        return NULL;
    }
    memcpy(word, text, n);
    word[n] = '\0';
    const struct dalcs_plot_vectors *plot = dalcs_plots_split(&script->vectors, word, &rest);
    const bool is_all = strncmp(rest, "all", 3) == 0 &&
                        (rest[3] == '\0' || (strchr("viy", rest[3]) != NULL && rest[4] == '\0'));
    *n_word = n;
    *kind = is_all ? rest[3] : '\0';
    return is_all ? plot : NULL;
}

/* Vectors that grow in number. */
struct list {
    const struct dalcs_vector **vector; /* in the arena */
    size_t n, capacity;
};

static enum dalcs_status add(struct dalcs_script *script, struct list *list,
                             const struct dalcs_vector *v) {
    if (list->n == list->capacity) {
        const size_t capacity = 2 * list->capacity + 8;
        const struct dalcs_vector **more =
            dalcs_arena_alloc(&script->arena, capacity, sizeof(struct dalcs_vector *));
        if (more == NULL) {
            return DALCS_E_NOMEM;
        }
        if (list->n > 0) {
            memcpy(more, list->vector, list->n * sizeof(struct dalcs_vector *));
        }
        list->vector = more;
        list->capacity = capacity;
    }
    list->vector[list->n++] = v;
    return DALCS_OK;
}

/* All of a plot but its scale; an operating point has none. kind: 'v' of voltages, 'i' of currents. */
static enum dalcs_status add_all(struct dalcs_script *script, struct list *list,
                                 const struct dalcs_plot_vectors *plot, char kind) {
    for (size_t k = 0; k < plot->n; k++) {
        const struct dalcs_vector *v = plot->vector[k];
        const bool is_scale = !dalcs_analysis_is_point(plot->analysis) && v == plot->scale;
        const bool fits =
            (kind != 'v' || v->unit == DALCS_VOLT) && (kind != 'i' || v->unit == DALCS_AMPERE);
        if (fits && !is_scale) {
            struct dalcs_vector *copy = dalcs_arena_alloc(&script->arena, 1, sizeof *copy);
            if (copy == NULL) {
                return DALCS_E_NOMEM;
            }
            *copy = *v;
            copy->scale = plot->scale != NULL && plot->scale->n == v->n ? plot->scale : NULL;
            DALCS_TRY(add(script, list, copy));
        }
    }
    return DALCS_OK;
}

/* The word `vs`, and no vector of that name. */
static bool is_versus(const struct dalcs_script *script, const char *text) {
    return strncmp(text, "vs", 2) == 0 && (text[2] == ' ' || text[2] == '\t') &&
           dalcs_vectors_find(&script->vectors, "vs") == NULL;
}

/* What stands behind `vs` is the scale of those before it, up to the last vs. */
static enum dalcs_status add_versus(struct dalcs_script *script, const struct dalcs_statement *s,
                                    struct list *list, size_t first,
                                    struct dalcs_vector_formula *f) {
    f->at += 2;
    const struct dalcs_vector *scale = dalcs_vector_formula_next(f);
    if (scale == NULL) {
        return dalcs_script_refuse_formula(script, s, f);
    }
    for (size_t k = first; k < list->n; k++) {
        struct dalcs_vector *copy = dalcs_arena_alloc(&script->arena, 1, sizeof *copy);
        if (copy == NULL) {
            return DALCS_E_NOMEM;
        }
        if (list->vector[k]->n != scale->n) {
            return dalcs_script_refuse(script, s, NULL, "vectors of different lengths, %zu and %zu",
                                       list->vector[k]->n, scale->n);
        }
        *copy = *list->vector[k];
        copy->scale = scale;
        list->vector[k] = copy;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_script_vectors(struct dalcs_script *script, const struct dalcs_statement *s,
                                       const char *text, const struct dalcs_vector ***vector,
                                       size_t *n) {
    struct dalcs_vector_formula f = dalcs_script_formula(script, text);
    struct list list = {0};
    size_t first = 0; /* of those that no vs is behind yet */
    if (dalcs_vector_formula_at_end(&f)) {
        DALCS_TRY(add_all(script, &list, dalcs_plots_current(&script->vectors), '\0'));
    }
    while (!dalcs_vector_formula_at_end(&f)) {
        size_t n_word;
        char kind;
        const struct dalcs_plot_vectors *plot = plot_of_all(script, f.text + f.at, &n_word, &kind);
        if (plot != NULL) {
            DALCS_TRY(add_all(script, &list, plot, kind));
            f.at += n_word;
            continue;
        }
        if (list.n > first && is_versus(script, f.text + f.at)) {
            DALCS_TRY(add_versus(script, s, &list, first, &f));
            first = list.n;
            continue;
        }
        const struct dalcs_vector *v = dalcs_vector_formula_next(&f);
        if (v == NULL) {
            return dalcs_script_refuse_formula(script, s, &f);
        }
        DALCS_TRY(add(script, &list, v));
    }
    *vector = list.vector;
    *n = list.n;
    return DALCS_OK;
}
