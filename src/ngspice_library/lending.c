/* lending.c - vectors go to the interpreter of commands, and what it made comes back. */
#include "library.h"
#include "vectors.h"

#include <stdlib.h>
#include <string.h>

/* As the interpreter has them: complex all. */
static enum dalcs_status lend(struct dalcs_vectors *to, const struct ng_vector *v,
                              const char *name) {
    struct dalcs_vector copy = {
        .name = name, .unit = v->unit, .n = v->n, .is_complex = v->is_complex};
    copy.value = dalcs_alloc(v->n, sizeof *copy.value);
    if (copy.value == NULL) {
        return DALCS_E_NOMEM;
    }
    if (v->is_complex) { /* a complex number is its two parts side by side */
        memcpy(copy.value, v->block->value, v->n * sizeof *copy.value);
    }
    for (size_t k = 0; !v->is_complex && k < v->n; k++) {
        copy.value[k] = v->block->value[k];
    }
    const enum dalcs_status status = dalcs_vectors_let(to, name, &copy);
    free(copy.value);
    return status;
}

static const char *name_there(const struct ng_vector *v) {
    return v->is_own ? v->name : v->signal;
}

static enum dalcs_status lend_constants(const struct ng_library *l, struct dalcs_vectors *to) {
    const struct ng_plot *constants = l->plots.plot[0];
    const struct ng_plot *plot = ng_plots_current(&l->plots);
    for (size_t k = 0; k < constants->n; k++) {
        const struct ng_vector *v = constants->vector[k];
        const struct ng_vector *nearer = plot != constants ? ng_plot_vector(plot, v->name) : NULL;
        if (dalcs_vectors_is_used(to, v->name) && (nearer == NULL || !nearer->is_own)) {
            DALCS_TRY(lend(to, v, v->name));
        }
    }
    return DALCS_OK;
}

enum dalcs_status ng_lend_vectors(struct ng_library *l) {
    struct dalcs_vectors *to = dalcs_script_vectors_of(l->script);
    const struct ng_plot *plot = ng_plots_current(&l->plots);
    dalcs_vectors_forget(to);
    DALCS_TRY(lend_constants(l, to));
    if (plot == l->plots.plot[0]) {
        return DALCS_OK;
    }
    const struct ng_vector *scale = plot->has_scale ? plot->vector[0] : NULL;
    DALCS_TRY(dalcs_vectors_begin(
        to, &(struct dalcs_plot){.analysis = plot->analysis,
                                 .title = plot->title,
                                 .scale = scale != NULL ? scale->name : "",
                                 .scale_unit = scale != NULL ? scale->unit : DALCS_UNIT_NONE,
                                 .is_complex = scale != NULL && scale->is_complex}));
    bool any = scale != NULL && dalcs_vectors_is_used(to, scale->name);
    for (size_t k = plot->has_scale ? 1 : 0; k < plot->n; k++) {
        const char *name = name_there(plot->vector[k]);
        if (dalcs_vectors_is_used(to, name)) {
            any = true;
            DALCS_TRY(lend(to, plot->vector[k], name));
        }
    }
    return any && scale != NULL ? lend(to, scale, scale->name) : DALCS_OK;
}

/* Is it as it was lent? */
static bool is_same(const struct ng_vector *v, const struct dalcs_vector *now) {
    bool same = v->n == now->n && v->is_complex == now->is_complex;
    for (size_t k = 0; same && k < v->n; k++) {
        const double *own = v->block->value + (v->is_complex ? 2 * k : k);
        same = own[0] == creal(now->value[k]) && (!v->is_complex || own[1] == cimag(now->value[k]));
    }
    return same;
}

static enum dalcs_status take_one(struct ng_library *l, struct ng_plot *plot,
                                  const struct dalcs_vector *v) {
    struct ng_vector *known = ng_plot_vector(plot, v->name);
    if (known != NULL && !known->is_own && strcmp(known->signal, v->name) == 0) {
        return DALCS_OK; /* a signal of the run */
    }
    if (known != NULL && known->is_own && is_same(known, v)) {
        return DALCS_OK;
    }
    double *value = dalcs_alloc(v->n, 2 * sizeof *value);
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    const size_t each = v->is_complex ? 2 : 1;
    for (size_t k = 0; k < v->n; k++) {
        value[each * k] = creal(v->value[k]);
        if (v->is_complex) {
            value[2 * k + 1] = cimag(v->value[k]);
        }
    }
    const enum dalcs_status status =
        ng_plots_set(&l->plots, plot, v->name, v->unit, v->is_complex, v->n, value);
    free(value);
    return status;
}

enum dalcs_status ng_take_vectors(struct ng_library *l) {
    const struct dalcs_vectors *from = dalcs_script_vectors_of(l->script);
    for (size_t k = 0; k < from->own.n; k++) {
        DALCS_TRY(take_one(l, l->plots.plot[0], from->own.vector[k]));
    }
    for (size_t k = 0; from->current != NULL && k < from->current->n; k++) {
        DALCS_TRY(take_one(l, ng_plots_current(&l->plots), from->current->vector[k]));
    }
    return DALCS_OK;
}
