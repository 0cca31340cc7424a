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
    const struct dalcs_vector *found = find_in(&v->plot, name);
    return found != NULL ? found : find_in(&v->own, name);
}

const struct dalcs_vector *dalcs_vectors_find(const struct dalcs_vectors *v, const char *name) {
    char other[256];
    const struct dalcs_vector *found = dalcs_vectors_find_exactly(v, name);
    return found != NULL ? found : find_in(&v->plot, canonical(name, other, sizeof other));
}

const struct dalcs_vector *dalcs_vectors_scale(const struct dalcs_vectors *v) {
    return v->has_plot && v->plot.n > 0 ? v->plot.vector[0] : NULL;
}

/* ---- Receiving --------------------------------------------------------------------------------- */

static void forget(struct dalcs_plot_vectors *plot) {
    for (size_t k = 0; k < plot->n; k++) {
        free(plot->vector[k]->value);
        free(plot->vector[k]);
    }
    free(plot->vector);
    dalcs_arena_finish(&plot->arena);
    *plot = (struct dalcs_plot_vectors){0};
}

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

enum dalcs_status dalcs_vectors_begin(struct dalcs_vectors *v, const struct dalcs_plot *plot) {
    bool is_point = plot->analysis == DALCS_OPERATING_POINT;
    forget(&v->plot);
    v->has_plot = true;
    v->plot.analysis = plot->analysis;
    v->row_capacity = 0;
    v->n_columns = 0;
    free(v->column);
    v->column = dalcs_alloc(plot->n_signals, sizeof *v->column);
    v->plot.title = dalcs_arena_copy(&v->plot.arena, plot->title, strlen(plot->title));
    if (v->column == NULL || v->plot.title == NULL) {
        return DALCS_E_NOMEM;
    }
    if (!is_point) {
        const char *scale = plot->analysis != DALCS_DC_SWEEP   ? plot->scale
                            : plot->scale_unit == DALCS_VOLT   ? "v-sweep"
                            : plot->scale_unit == DALCS_AMPERE ? "i-sweep"
                                                               : plot->scale;
        enum dalcs_status status =
            add(&v->plot, scale,
                (struct dalcs_vector){.unit = plot->scale_unit, .is_complex = plot->is_complex});
        if (status != DALCS_OK) {
            return status;
        }
    }
    for (size_t i = 0; i < plot->n_signals; i++) {
        if (is_point || dalcs_vectors_is_used(v, plot->name[i])) {
            enum dalcs_status status =
                add(&v->plot, plot->name[i],
                    (struct dalcs_vector){.unit = plot->unit[i], .is_complex = plot->is_complex});
            if (status != DALCS_OK) {
                return status;
            }
            v->column[v->n_columns++] = i;
        }
    }
    return DALCS_OK;
}

/* Room for one more row in all vectors, which have equal lengths. */
static enum dalcs_status grow(struct dalcs_vectors *v) {
    size_t n = v->plot.n > 0 ? v->plot.vector[0]->n : 0;
    size_t capacity = v->row_capacity;
    for (size_t k = 0; k < v->plot.n; k++) {
        capacity = v->row_capacity;
        enum dalcs_status status =
            dalcs_grow(&v->plot.vector[k]->value, &capacity, n + 1, sizeof(double complex));
        if (status != DALCS_OK) {
            return status;
        }
    }
    v->row_capacity = capacity;
    return DALCS_OK;
}

enum dalcs_status dalcs_vectors_row(struct dalcs_vectors *v, double scale, const double *value) {
    size_t n_before = v->plot.n - v->n_columns; /* the scale, or nothing */
    enum dalcs_status status = grow(v);
    if (status != DALCS_OK) {
        return status;
    }
    if (n_before > 0) {
        struct dalcs_vector *x = v->plot.vector[0];
        x->value[x->n++] = scale;
    }
    for (size_t k = 0; k < v->n_columns; k++) {
        struct dalcs_vector *x = v->plot.vector[n_before + k];
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

enum dalcs_status dalcs_vectors_let(struct dalcs_vectors *v, const char *name,
                                    const struct dalcs_vector *value) {
    struct dalcs_plot_vectors *plot =
        !v->has_plot || find_in(&v->own, name) != NULL ? &v->own : &v->plot;
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
    }
    free(vector->value);
    vector->value = copy;
    vector->n = value->n;
    vector->unit = value->unit;
    vector->is_complex = value->is_complex;
    return DALCS_OK;
}

void dalcs_vectors_forget(struct dalcs_vectors *v) {
    forget(&v->plot);
    forget(&v->own);
    v->has_plot = false;
}

void dalcs_vectors_finish(struct dalcs_vectors *v) {
    dalcs_vectors_forget(v);
    free(v->column);
    *v = (struct dalcs_vectors){0};
}
