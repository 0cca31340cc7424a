/* vectors.c - rows become columns. */
#include "vectors.h"

#include "names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Names ------------------------------------------------------------------------------------- */

/* Does the script hold this text? */
static bool names(const struct dalcs_vectors *v, const char *text) {
    return strstr(v->text, text) != NULL;
}

/* "v(out)" -> "out", "i(l1)" -> "l1"; an empty text when it is neither. */
static const char *inside_of(const char *name, char *text, size_t size) {
    size_t n = strlen(name);
    text[0] = '\0';
    if (n > 3 && name[1] == '(' && n - 3 < size) {
        memcpy(text, name + 2, n - 3);
        text[n - 3] = '\0';
    }
    return text;
}

bool dalcs_vectors_is_used(const struct dalcs_vectors *v, const char *name) {
    char inside[256];
    return v->keeps_all || names(v, name) ||
           (inside_of(name, inside, sizeof inside)[0] != '\0' && names(v, inside));
}

/* v1#branch, @v1[i] and @d1[id] are currents, a bare word is v(word). */
static const char *canonical(const char *name, char *text, size_t size) {
    const int n = (int)dalcs_names_current_of(name);
    const char *branch = strstr(name, "#branch");
    if (branch != NULL && branch[7] == '\0') {
        snprintf(text, size, "i(%.*s)", (int)(branch - name), name);
    } else if (n > 0) {
        snprintf(text, size, "i(%.*s)", n, name + 1);
    } else {
        snprintf(text, size, "v(%s)", name);
    }
    return text;
}

static struct dalcs_vector *find_in(const struct dalcs_plot_vectors *plot, const char *name) {
    for (size_t k = 0; k < plot->n; k++) {
        if (strcmp(plot->vector[k]->name, name) == 0) {
            return plot->vector[k];
        }
    }
    return NULL;
}

const struct dalcs_vector *dalcs_vectors_find_exactly(const struct dalcs_vectors *v,
                                                      const char *name) {
    const char *rest;
    const struct dalcs_plot_vectors *plot = dalcs_plots_split(v, name, &rest);
    const struct dalcs_vector *found = find_in(plot, rest);
    return found != NULL ? found : find_in(&v->own, name);
}

const struct dalcs_vector *dalcs_vectors_find_in(const struct dalcs_vectors *v,
                                                 const struct dalcs_plot_vectors *plot,
                                                 const char *name) {
    char other[DALCS_VECTOR_NAME];
    const struct dalcs_vector *found = find_in(plot, name);
    found = found != NULL ? found : find_in(&v->own, name);
    return found != NULL ? found : find_in(plot, canonical(name, other, sizeof other));
}

const struct dalcs_vector *dalcs_vectors_find(const struct dalcs_vectors *v, const char *name) {
    const char *rest;
    const struct dalcs_plot_vectors *plot = dalcs_plots_split(v, name, &rest);
    return dalcs_vectors_find_in(v, plot, rest);
}

const struct dalcs_vector *dalcs_vectors_scale(const struct dalcs_vectors *v) {
    return v->current != NULL ? v->current->scale : NULL;
}

/* ---- Receiving --------------------------------------------------------------------------------- */

static enum dalcs_status add(struct dalcs_plot_vectors *plot, const char *name,
                             struct dalcs_vector about) {
    enum dalcs_status status =
        dalcs_grow(&plot->vector, &plot->capacity, plot->n + 1, sizeof(struct dalcs_vector *));
    if (status != DALCS_OK) {
        return status;
    }
    struct dalcs_vector *vector = dalcs_alloc(1, sizeof *vector);
    if (vector == NULL) {
        return DALCS_E_NOMEM;
    }
    *vector = about;
    vector->name = dalcs_arena_copy(&plot->arena, name, strlen(name));
    if (vector->name == NULL) {
        free(vector);
        return DALCS_E_NOMEM;
    }
    plot->vector[plot->n++] = vector;
    return DALCS_OK;
}

/* Of its name and its words in ngspice. */
static enum dalcs_status make_plot(struct dalcs_vectors *v, const struct dalcs_plot *plot) {
    static const char *const known[DALCS_N_ANALYSES][2] = {
        [DALCS_OPERATING_POINT] = {"op", "Operating Point"},
        [DALCS_TRANSIENT] = {"tran", "Transient Analysis"},
        [DALCS_DC_SWEEP] = {"dc", "DC transfer characteristic"},
        [DALCS_AC] = {"ac", "AC Analysis"},
        [DALCS_PERIODIC] = {"pss", "Periodic Steady State"},
        [DALCS_TRANSFER] = {"tf", "Transfer Function"}};
    if (!v->keeps_plots) {
        dalcs_plots_destroy_all(v);
    } else if (plot->step > 0 && v->current != NULL) { /* of several steps the last one stays */
        dalcs_plots_destroy(v, v->current);
    }
    DALCS_TRY(dalcs_plots_make(v, known[plot->analysis][0], known[plot->analysis][1], plot->title));
    v->current->analysis = plot->analysis;
    if (plot->analysis == DALCS_TRANSIENT && v->session != NULL) {
        const struct dalcs_request asked = dalcs_session_request(v->session);
        v->current->grid = (struct dalcs_grid){asked.start, asked.step, asked.stop};
    }
    return DALCS_OK;
}

/* ngspice's word for the scale of a sweep. */
static const char *scale_of(const struct dalcs_plot *plot) {
    return plot->analysis != DALCS_DC_SWEEP   ? plot->scale
           : plot->scale_unit == DALCS_VOLT   ? "v-sweep"
           : plot->scale_unit == DALCS_AMPERE ? "i-sweep"
                                              : plot->scale;
}

enum dalcs_status dalcs_vectors_begin(struct dalcs_vectors *v, const struct dalcs_plot *plot) {
    const bool is_point = dalcs_analysis_is_point(plot->analysis);
    DALCS_TRY(make_plot(v, plot));
    v->row_capacity = 0;
    v->n_columns = 0;
    free(v->column);
    v->column = dalcs_alloc(plot->n_signals, sizeof *v->column);
    if (v->column == NULL) {
        return DALCS_E_NOMEM;
    }
    if (!is_point) {
        DALCS_TRY(
            add(v->current, scale_of(plot),
                (struct dalcs_vector){.unit = plot->scale_unit, .is_complex = plot->is_complex}));
        v->current->scale = v->current->vector[0];
    }
    for (size_t i = 0; i < plot->n_signals; i++) {
        if (is_point || dalcs_vectors_is_used(v, plot->name[i])) {
            DALCS_TRY(
                add(v->current, plot->name[i],
                    (struct dalcs_vector){.unit = plot->unit[i], .is_complex = plot->is_complex}));
            v->column[v->n_columns++] = i;
        }
    }
    if (is_point && v->current->n > 0) {
        v->current->scale = v->current->vector[0]; /* as ngspice has it */
    }
    return DALCS_OK;
}

/* Room for one more row in all vectors, which have equal lengths. */
static enum dalcs_status grow(struct dalcs_vectors *v) {
    size_t n = v->current->n > 0 ? v->current->vector[0]->n : 0;
    size_t capacity = v->row_capacity;
    for (size_t k = 0; k < v->current->n; k++) {
        capacity = v->row_capacity;
        enum dalcs_status status =
            dalcs_grow(&v->current->vector[k]->value, &capacity, n + 1, sizeof(double complex));
        if (status != DALCS_OK) {
            return status;
        }
    }
    v->row_capacity = capacity;
    return DALCS_OK;
}

enum dalcs_status dalcs_vectors_row(struct dalcs_vectors *v, double scale, const double *value) {
    size_t n_before = v->current->n - v->n_columns; /* the scale, or nothing */
    enum dalcs_status status = grow(v);
    if (status != DALCS_OK) {
        return status;
    }
    if (n_before > 0) {
        struct dalcs_vector *x = v->current->vector[0];
        x->value[x->n++] = scale;
    }
    for (size_t k = 0; k < v->n_columns; k++) {
        struct dalcs_vector *x = v->current->vector[n_before + k];
        size_t i = v->column[k];
        if (x->is_complex) { /* a complex number is its two parts side by side */
            memcpy(&x->value[x->n++], &value[2 * i], sizeof *x->value);
        } else {
            x->value[x->n++] = value[i];
        }
    }
    return DALCS_OK;
}

/* ---- let --------------------------------------------------------------------------------------- */

enum dalcs_status dalcs_plot_set(struct dalcs_plot_vectors *plot, const char *name,
                                 const struct dalcs_vector *value) {
    double complex *copy = dalcs_alloc(value->n, sizeof *copy);
    if (copy == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(copy, value->value, value->n * sizeof *copy);
    struct dalcs_vector *vector = find_in(plot, name);
    if (vector == NULL) {
        enum dalcs_status status = add(plot, name, (struct dalcs_vector){.unit = DALCS_UNIT_NONE});
        if (status != DALCS_OK) {
            free(copy);
            return status;
        }
        vector = plot->vector[plot->n - 1];
        plot->scale = plot->scale == NULL ? vector : plot->scale;
    }
    free(vector->value);
    vector->value = copy;
    vector->n = value->n;
    vector->unit = value->unit;
    vector->is_complex = value->is_complex;
    return DALCS_OK;
}

enum dalcs_status dalcs_vectors_let(struct dalcs_vectors *v, const char *name,
                                    const struct dalcs_vector *value) {
    const char *rest;
    const struct dalcs_plot_vectors *named = dalcs_plots_split(v, name, &rest);
    struct dalcs_plot_vectors *plot = v->current != NULL ? v->current : &v->own;
    if (rest == name && find_in(plot, name) == NULL && find_in(&v->own, name) != NULL) {
        plot = &v->own;
    }
    for (size_t k = 0; rest != name && k < v->n; k++) {
        plot = v->plot[k] == named ? v->plot[k] : plot;
    }
    plot = named == &v->own ? &v->own : plot;
    return dalcs_plot_set(plot, rest, value);
}

void dalcs_vectors_forget(struct dalcs_vectors *v) {
    dalcs_plots_destroy_all(v);
    dalcs_plot_forget(&v->own);
}

void dalcs_vectors_finish(struct dalcs_vectors *v) {
    dalcs_vectors_forget(v);
    free(v->column);
    *v = (struct dalcs_vectors){0};
}
