/* lending.c - vectors go to the interpreter of commands, and what it made comes back. */
#include "library.h"
#include "signal_name.h"
#include "vectors.h"

#include <stdlib.h>
#include <string.h>

/* As the interpreter has them: complex all. */
static enum dalcs_status lend(struct dalcs_plot_vectors *to, const struct ng_vector *v,
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
    const enum dalcs_status status = dalcs_plot_set(to, name, &copy);
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
            DALCS_TRY(lend(&to->own, v, v->name));
        }
    }
    return DALCS_OK;
}

/* With its vectors that may be named, and then with its scale. */
static enum dalcs_status lend_plot(struct dalcs_vectors *to, const struct ng_plot *plot) {
    DALCS_TRY(dalcs_plots_make(to, "lent", plot->kind, plot->title));
    struct dalcs_plot_vectors *lent = to->current;
    snprintf(lent->type, sizeof lent->type, "%.31s", plot->type);
    lent->analysis = plot->analysis;
    lent->grid = plot->grid;
    const size_t first = plot->has_scale ? 1 : 0;
    bool any = false;
    for (size_t k = 0; k < plot->n && !any; k++) {
        const struct ng_vector *v = plot->vector[k];
        any = dalcs_vectors_is_used(to, k < first ? v->name : name_there(v));
    }
    if (any && first > 0) {
        DALCS_TRY(lend(lent, plot->vector[0], plot->vector[0]->name));
    }
    for (size_t k = first; k < plot->n; k++) {
        const char *name = name_there(plot->vector[k]);
        if (dalcs_vectors_is_used(to, name)) {
            DALCS_TRY(lend(lent, plot->vector[k], name));
        }
    }
    return DALCS_OK;
}

/* Do the lines name one of its vectors, "tran1.out"? */
static bool is_named(const struct dalcs_vectors *to, const struct ng_plot *plot) {
    const size_t n = strlen(plot->type);
    bool found = false;
    for (const char *p = to->text; !found && (p = strstr(p, plot->type)) != NULL; p += n) {
        found = p[n] == '.';
    }
    return found;
}

enum dalcs_status ng_lend_vectors(struct ng_library *l) {
    struct dalcs_vectors *to = dalcs_script_vectors_of(l->script);
    const struct ng_plot *current = ng_plots_current(&l->plots);
    dalcs_vectors_forget(to);
    DALCS_TRY(lend_constants(l, to));
    for (size_t k = 1; k < l->plots.n; k++) {
        const struct ng_plot *plot = l->plots.plot[k];
        if (plot != current && is_named(to, plot)) {
            DALCS_TRY(lend_plot(to, plot));
        }
    }
    if (current == l->plots.plot[0]) {
        dalcs_plots_choose(to, &to->own);
        return DALCS_OK;
    }
    return lend_plot(to, current);
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

static enum dalcs_status take_plot(struct ng_library *l, struct ng_plot *to,
                                   const struct dalcs_plot_vectors *from) {
    for (size_t k = 0; to != NULL && k < from->n; k++) {
        DALCS_TRY(take_one(l, to, from->vector[k]));
    }
    return DALCS_OK;
}

enum dalcs_status ng_take_vectors(struct ng_library *l) {
    const struct dalcs_vectors *from = dalcs_script_vectors_of(l->script);
    DALCS_TRY(take_plot(l, l->plots.plot[0], &from->own));
    for (size_t k = 0; k < from->n; k++) {
        DALCS_TRY(take_plot(l, ng_plots_find(&l->plots, from->plot[k]->type), from->plot[k]));
    }
    return DALCS_OK;
}

/* Its vectors are signals under ngspice's names where they are called as signals: out is v(out). */
static enum dalcs_status keep_made(struct ng_library *l, struct ng_plot *plot,
                                   const struct dalcs_plot_vectors *from) {
    for (size_t k = 0; k < from->n; k++) {
        char name[NG_NAME_SIZE];
        const size_t n_before = plot->n;
        DALCS_TRY(take_one(l, plot, from->vector[k]));
        if (plot->n == n_before || from->analysis != DALCS_TRANSIENT) {
            continue; /* ngspice calls spectra as they were written */
        }
        ng_signal_name(from->vector[k]->name, name);
        struct ng_vector *v = plot->vector[plot->n - 1];
        char *own = ng_copy_of(name);
        char *signal = ng_copy_of(v->name);
        if (own == NULL || signal == NULL) {
            free(own);
            free(signal);
            return DALCS_E_NOMEM;
        }
        free(v->name);
        free(v->signal);
        v->name = own;
        v->signal = signal;
        v->is_own = strcmp(own, signal) == 0 && k > 0; /* let has made it */
    }
    return DALCS_OK;
}

enum dalcs_status ng_take_plot(void *user, const struct dalcs_plot_vectors *made) {
    struct ng_library *l = user;
    const bool is_transient = made->analysis == DALCS_TRANSIENT;
    const char *kind = is_transient                     ? "Transient Analysis (linearized)"
                       : strcmp(made->kind, "PSD") == 0 ? "PSD"
                                                        : "Spectrum";
    DALCS_TRY(ng_plots_make(&l->plots, is_transient ? "tran" : "sp", kind, made->title));
    struct ng_plot *plot = ng_plots_current(&l->plots);
    plot->analysis = made->analysis;
    plot->grid = made->grid;
    plot->has_scale = true;
    return keep_made(l, plot, made);
}

const char *ng_name_of_plot(void *user) {
    const struct ng_library *l = user;
    return ng_plots_current(&l->plots)->type;
}
