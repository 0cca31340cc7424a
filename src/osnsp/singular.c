/* singular.c - a singular mode answered by elimination, where the proximal iteration does not get there.
 *
 * Where conductances are far apart, as of a capacitor across a diode, the weights of the proximal problem
 * vanish by a few percent a round; its mode is the right one long before. In that mode the equations that
 * follow from others are replaced by a choice, orthogonal to what is open, and what comes out is
 * evaluated like any other answer: wrong signs change sides, and the certificate decides. */
#include "null_space.h"
#include "osnsp_internal.h"

#include <stdlib.h>
#include <string.h>

/* Changes of the mode, and how many of them all at once. */
enum { MOST_ROUNDS = 60, ROUNDS_AT_ONCE = 10 };

static enum dalcs_status find_null_space(const struct dalcs_columns *a,
                                         struct dalcs_null_space *space) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int c = 0; c < a->n; c++) {
        for (int k = a->p[c]; k < a->p[c + 1] && status == DALCS_OK; k++) {
            status = dalcs_triplets_add(&t, a->i[k], c, a->x[k]);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(space, a->n, a->n, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

/* *a without the redundant rows, which become the vectors[n_free][n]. */
static enum dalcs_status put_choices(struct dalcs_columns *a, const struct dalcs_null_space *space,
                                     const double *vectors) {
    size_t capacity = (size_t)a->p[a->n] + (size_t)space->n_free * (size_t)a->n;
    struct dalcs_columns b;
    DALCS_TRY(dalcs_columns_alloc(&b, a->n, capacity));
    bool *is_redundant = dalcs_alloc((size_t)a->n, sizeof(bool));
    if (is_redundant == NULL) {
        dalcs_columns_finish(&b);
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < space->n_redundant; k++) {
        is_redundant[space->redundant[k]] = true;
    }
    int out = 0;
    for (int c = 0; c < a->n; c++) {
        for (int k = a->p[c]; k < a->p[c + 1]; k++) {
            if (!is_redundant[a->i[k]]) {
                b.i[out] = a->i[k];
                b.x[out++] = a->x[k];
            }
        }
        for (int k = 0; k < space->n_free; k++) {
            if (vectors[k * a->n + c] != 0.0) {
                b.i[out] = space->redundant[k];
                b.x[out++] = vectors[k * a->n + c];
            }
        }
        b.p[c + 1] = out;
    }
    free(is_redundant);
    dalcs_columns_finish(a);
    *a = b;
    return DALCS_OK;
}

/* p->scaled solves the equations of *a that are left; b[n] is work. */
static enum dalcs_status solve(struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry,
                               const struct dalcs_null_space *space, struct dalcs_columns *a,
                               double *b) {
    int n = p->form[0]->n;
    klu_common common;
    struct dalcs_lu lu;
    dalcs_lu_common_init(&common);
    dalcs_lu_pivot_carefully(&common); /* the certificate asks for all digits */
    DALCS_TRY(dalcs_lu_factor(&lu, &common, a->n, a->p, a->i, a->x, NULL, 0.0));
    memcpy(b, p->right, (size_t)n * sizeof(double));
    for (int k = 0; k < entry->n_on; k++) {
        b[n + k] = p->right[n + entry->on[k]];
    }
    for (int k = 0; k < space->n_redundant; k++) {
        b[space->redundant[k]] = 0.0;
    }
    dalcs_lu_solve(&lu, b);
    dalcs_lu_finish(&lu);
    memcpy(p->scaled, b, (size_t)n * sizeof(double));
    memset(p->scaled + n, 0, (size_t)p->system->n_pairs * sizeof(double));
    for (int k = 0; k < entry->n_on; k++) {
        p->scaled[n + entry->on[k]] = b[n + k];
    }
    return DALCS_OK;
}

static enum dalcs_status solve_with(struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry,
                                    const struct dalcs_null_space *space, struct dalcs_columns *a) {
    if (space->n_free == 0) {
        return DALCS_SINGULAR;
    }
    double *vectors = dalcs_alloc((size_t)space->n_free * (size_t)a->n, sizeof(double));
    double *b = dalcs_alloc((size_t)a->n, sizeof(double));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (vectors != NULL && b != NULL) {
        for (int k = 0; k < space->n_free; k++) {
            dalcs_null_space_vector(space, k, vectors + (size_t)k * (size_t)a->n);
        }
        status = put_choices(a, space, vectors);
    }
    if (status == DALCS_OK) {
        status = solve(p, entry, space, a, b);
    }
    free(vectors);
    free(b);
    return status;
}

/* The answer of p->mode, which is singular, to p->scaled. */
static enum dalcs_status answer(struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry) {
    struct dalcs_columns a;
    struct dalcs_null_space space;
    DALCS_TRY(dalcs_modes_matrix(p, entry, &a));
    enum dalcs_status status = find_null_space(&a, &space);
    if (status == DALCS_OK) {
        status = solve_with(p, entry, &space, &a);
        dalcs_null_space_finish(&space);
    }
    dalcs_columns_finish(&a);
    return status;
}

/* Evaluates the answer of p->mode. */
static enum dalcs_status try_mode(struct dalcs_osnsp *p, const double *u, double *y,
                                  bool *sources_clash) {
    struct dalcs_mode_entry *entry;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &entry));
    p->least_norm = entry->singular;
    if (!entry->singular) {
        return dalcs_osnsp_try_mode(p, u, y, sources_clash);
    }
    dalcs_csr_multiply(&p->form[0]->R, u,
                       p->right); /* a regular mode's map leaves other things there */
    DALCS_TRY(answer(p, entry));
    dalcs_osnsp_unscale(p, y);
    dalcs_certificate_evaluate(p, u, y, sources_clash);
    return DALCS_OK;
}

/* From p->mode on. */
static enum dalcs_status pivot(struct dalcs_osnsp *p, const double *u, double *y) {
    for (int round = 0; round < MOST_ROUNDS; round++) {
        bool sources_clash;
        DALCS_TRY(try_mode(p, u, y, &sources_clash));
        if (dalcs_certificate_holds(p, sources_clash)) {
            return DALCS_OK;
        }
        if (p->n_violating == 0) {
            break;
        }
        dalcs_osnsp_flip_violating(p, round < ROUNDS_AT_ONCE);
        p->counters.pivots++;
    }
    return DALCS_NOT_CONVERGED;
}

enum dalcs_status dalcs_singular_solve(struct dalcs_osnsp *p, const double *u, double *y) {
    enum dalcs_status status = DALCS_NOT_CONVERGED;
    for (int rung = 0; rung < DALCS_N_WEIGHTS && status > DALCS_OK; rung++) {
        dalcs_proximal_begin(p, u);
        bool mode_changed;
        status = dalcs_proximal_pivot(p, rung, &mode_changed);
        if (status == DALCS_OK) {
            status = pivot(p, u, y);
        }
    }
    return status;
}

enum dalcs_status dalcs_least_norm_solve(struct dalcs_osnsp *p, const double *u, double *y) {
    enum dalcs_status status = dalcs_proximal_solve(p, u, y);
    if (status == DALCS_NOT_CONVERGED && p->is_passing && p->system->monotone) {
        enum dalcs_status exactly = dalcs_singular_solve(p, u, y);
        status = exactly <= DALCS_OK ? exactly : status;
    }
    return status;
}
