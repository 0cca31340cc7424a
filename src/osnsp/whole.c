/* whole.c - the matrix of a mode with the states kept, its factors, and the rows that are left out. */
#include "whole.h"

#include "magnitudes.h"
#include "null_space.h"
#include "osnsp_internal.h"
#include "scales.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Places of the columns among the unknowns: x, z, then lambda of the pairs that may have current. */
static int place_columns(struct dalcs_whole *whole) {
    const struct dalcs_osnsp *p = whole->p;
    int n = dalcs_system_n_equations(p->system);
    for (int c = 0; c < n; c++) {
        whole->place[c] = c;
    }
    int *of_pair = whole->place + n;
    for (int d = 0; d < p->system->n_pairs; d++) {
        of_pair[d] = whole->resistance != NULL || dalcs_osnsp_is_on(p, d) ? n++ : -1;
    }
    return n;
}

static enum dalcs_status add_row(struct dalcs_triplets *t, const int *place,
                                 const struct dalcs_csr *a, int from, int to, double factor) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        if (place[a->j[k]] >= 0) {
            DALCS_TRY(dalcs_triplets_add(t, to, place[a->j[k]], factor * a->x[k]));
        }
    }
    return DALCS_OK;
}

/* (sigma P - A; C), and R of the lines. */
static enum dalcs_status fill(const struct dalcs_whole *whole, struct dalcs_triplets *t) {
    const struct dalcs_system *s = whole->p->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < n_equations; r++) {
        if (r < s->n_x && whole->sigma != 0.0) {
            DALCS_TRY(add_row(t, whole->place, &s->P, r, r, whole->sigma));
        }
        DALCS_TRY(add_row(t, whole->place, &s->A, r, r, -1.0));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        int row = whole->place[n_equations + d];
        if (row >= 0) {
            DALCS_TRY(add_row(t, whole->place, &s->C, d, row, 1.0));
        }
        if (whole->resistance != NULL) {
            DALCS_TRY(dalcs_triplets_add(t, row, row, whole->resistance[d]));
        }
    }
    return DALCS_OK;
}

/* The matrix by columns, with choices in the place of redundant rows. */
static enum dalcs_status put_columns(const struct dalcs_whole *whole,
                                     const struct dalcs_triplets *t, struct dalcs_csr *columns) {
    struct dalcs_triplets transposed = {0};
    int n_columns = dalcs_system_n_columns(whole->p->system);
    bool *is_redundant = dalcs_alloc((size_t)whole->n, sizeof(bool));
    enum dalcs_status status = is_redundant == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int k = 0; k < whole->n_choices && status == DALCS_OK; k++) {
        is_redundant[whole->redundant[k]] = true;
        for (int c = 0; c < n_columns && status == DALCS_OK; c++) {
            double value = whole->choice[(size_t)k * (size_t)n_columns + (size_t)c];
            if (value != 0.0 && whole->place[c] >= 0) {
                status =
                    dalcs_triplets_add(&transposed, whole->place[c], whole->redundant[k], value);
            }
        }
    }
    for (size_t k = 0; k < t->n && status == DALCS_OK; k++) {
        const struct dalcs_triplet *e = &t->entry[k];
        if (!is_redundant[e->row]) {
            status = dalcs_triplets_add(&transposed, e->column, e->row, e->value);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(columns, whole->n, whole->n, &transposed);
    }
    dalcs_triplets_finish(&transposed);
    free(is_redundant);
    return status;
}

static enum dalcs_status factor(struct dalcs_whole *whole, const struct dalcs_triplets *t) {
    struct dalcs_csr columns = {0};
    DALCS_TRY(put_columns(whole, t, &columns));
    const struct dalcs_columns a = {.n = whole->n, .p = columns.p, .i = columns.j, .x = columns.x};
    enum dalcs_status status = dalcs_modes_factor_small(whole->p, &whole->lu, &a, dalcs_nothing);
    if (status > DALCS_OK) {
        klu_common common;
        dalcs_lu_common_init(&common);
        dalcs_lu_pivot_carefully(&common);
        status = dalcs_lu_factor(&whole->lu, &common, &a, NULL, 0.0);
    }
    dalcs_csr_finish(&columns);
    return status;
}

/* The vectors that the mode maps to 0, and how far off an entry of any of them may be. */
static void take_open(struct dalcs_whole *whole, const struct dalcs_null_space *space,
                      double *error) {
    const int n_columns = dalcs_system_n_columns(whole->p->system);
    for (int k = 0; k < space->n_free; k++) {
        dalcs_null_space_vector(space, k, whole->residual);
        double *vector = whole->choice + (size_t)k * (size_t)n_columns;
        for (int c = 0; c < n_columns; c++) {
            const int place = whole->place[c];
            vector[c] = place >= 0 ? whole->residual[place] : 0.0;
            error[c] = fmax(error[c], place >= 0 ? space->error[place] : 0.0);
            whole->moves[c] = whole->moves[c] || vector[c] != 0.0;
        }
    }
}

static enum dalcs_status choose(struct dalcs_whole *whole, const struct dalcs_null_space *space) {
    const struct dalcs_system *s = whole->p->system;
    const size_t n_choices = (size_t)space->n_free;
    const size_t n_columns = (size_t)dalcs_system_n_columns(s);
    if (space->n_free > whole->p->options.max_outer) {
        return DALCS_SINGULAR;
    }
    struct dalcs_arena *arena = &whole->arena;
    whole->redundant = dalcs_arena_alloc(arena, n_choices, sizeof(int));
    whole->choice = dalcs_arena_alloc(arena, n_choices * n_columns, sizeof(double));
    whole->choice_w = dalcs_arena_alloc(arena, n_choices * (size_t)s->n_pairs, sizeof(double));
    whole->moves = dalcs_arena_alloc(arena, n_columns, sizeof(bool));
    double *error = dalcs_arena_alloc(arena, n_columns, sizeof(double));
    if (whole->redundant == NULL || whole->choice == NULL || whole->choice_w == NULL ||
        whole->moves == NULL || error == NULL) {
        return DALCS_E_NOMEM;
    }
    whole->n_choices = space->n_free;
    memcpy(whole->redundant, space->redundant, n_choices * sizeof(int));
    take_open(whole, space, error);
    return dalcs_choices_make(whole, error);
}

/* The rows that follow from others, chosen with voltages of one size, and currents of what the least conductance makes of it:
 * those of closed pairs may be no more. Lines of pairs, which are what is asked, stay. */
static enum dalcs_status choose_redundant(struct dalcs_whole *whole, struct dalcs_null_space *space,
                                          const struct dalcs_triplets *t) {
    const struct dalcs_system *s = whole->p->system;
    double *size = dalcs_arena_alloc(&space->arena, (size_t)whole->n, sizeof(double));
    if (size == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        if (whole->place[c] >= 0) {
            size[whole->place[c]] =
                s->column_is_current[c] ? whole->p->cache.form[0]->least_conductance : 1.0;
        }
    }
    DALCS_TRY(dalcs_dependencies_setup(&whole->dependencies, &whole->arena, space->n_redundant,
                                       whole->n));
    return dalcs_redundant_rows_choose(
        space, t, size, whole->resistance != NULL ? dalcs_system_n_equations(s) : whole->n,
        &whole->dependencies);
}

enum dalcs_status dalcs_whole_factor(struct dalcs_whole *whole, const struct dalcs_osnsp *p,
                                     const double *resistance) {
    *whole =
        (struct dalcs_whole){.p = p, .sigma = p->cache.form[0]->sigma, .resistance = resistance};
    size_t n_columns = (size_t)dalcs_system_n_columns(p->system);
    struct dalcs_triplets t = {0};
    struct dalcs_null_space space;
    whole->place = dalcs_arena_alloc(&whole->arena, n_columns, sizeof(int));
    whole->residual = dalcs_arena_alloc(&whole->arena, n_columns, sizeof(double));
    enum dalcs_status status =
        whole->place == NULL || whole->residual == NULL ? DALCS_E_NOMEM : DALCS_OK;
    if (status == DALCS_OK) {
        whole->n = place_columns(whole);
        status = fill(whole, &t);
    }
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(&space, whole->n, whole->n, &t);
    }
    if (status == DALCS_OK) {
        status = space.n_free > 0 ? choose_redundant(whole, &space, &t) : DALCS_OK;
        if (status == DALCS_OK) {
            status = choose(whole, &space);
        }
        dalcs_null_space_finish(&space);
    }
    if (status == DALCS_OK) {
        status = factor(whole, &t);
    }
    dalcs_triplets_finish(&t);
    if (status != DALCS_OK) {
        dalcs_whole_finish(whole);
    }
    return status;
}

enum dalcs_status dalcs_whole_null_space(const struct dalcs_osnsp *p, int *place,
                                         struct dalcs_null_space *space) {
    struct dalcs_whole whole = {.p = p, .sigma = p->cache.form[0]->sigma, .place = place};
    struct dalcs_triplets t = {0};
    whole.n = place_columns(&whole);
    enum dalcs_status status = fill(&whole, &t);
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(space, whole.n, whole.n, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

/* What the terms of each row add up to at y; of rows without terms what rounding of the whole may leave there. */
static void find_sizes(const struct dalcs_whole *whole, const double *u, const double *y) {
    const struct dalcs_osnsp *p = whole->p;
    const struct dalcs_system *s = p->system;
    const struct dalcs_scales scale = {p->certificate.volt, p->certificate.ampere};
    const int n_equations = dalcs_system_n_equations(s);
    double *size = whole->dependencies.size;
    for (int r = 0; r < n_equations; r++) {
        size[r] = dalcs_scales_terms(s, u, y, r) +
                  DBL_EPSILON * dalcs_scales_norm(p->cache.form[0], scale, r);
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            const int x = s->P.j[k];
            size[r] += whole->sigma * fabs(s->P.x[k]) * (fabs(u[x]) + fabs(y[x]));
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        const int row = whole->place[n_equations + d];
        if (row >= 0) {
            size[row] = dalcs_scales_pair_terms(p, u, y, d) + DBL_EPSILON * scale.volt;
        }
    }
}

enum dalcs_status dalcs_whole_leave_largest(struct dalcs_whole *whole, const double *u,
                                            const double *y, bool *changed) {
    struct dalcs_triplets t = {0};
    struct dalcs_lu lu = whole->lu;
    *changed = false;
    if (whole->n_choices == 0) {
        return DALCS_OK;
    }
    find_sizes(whole, u, y);
    if (!dalcs_dependencies_choose(&whole->dependencies, whole->n)) {
        return DALCS_OK;
    }
    int *other = whole->dependencies.chosen;
    whole->dependencies.chosen = whole->redundant;
    whole->redundant = other;
    whole->lu = (struct dalcs_lu){0};
    enum dalcs_status status = fill(whole, &t);
    status = status == DALCS_OK ? factor(whole, &t) : status;
    dalcs_triplets_finish(&t);
    *changed = status == DALCS_OK;
    if (*changed) {
        dalcs_lu_finish(&lu);
        return DALCS_OK;
    }
    other = whole->dependencies.chosen;
    whole->dependencies.chosen = whole->redundant;
    whole->redundant = other;
    whole->lu = lu;
    return status < DALCS_OK ? status : DALCS_OK;
}

size_t dalcs_whole_bytes(const struct dalcs_whole *whole) {
    size_t n_columns = (size_t)dalcs_system_n_columns(whole->p->system);
    size_t n_choices = (size_t)whole->n_choices;
    return sizeof(*whole) + dalcs_lu_bytes(&whole->lu) +
           n_columns * (sizeof(int) + sizeof(bool) + (3 + 4 * n_choices) * sizeof(double));
}

void dalcs_whole_finish(struct dalcs_whole *whole) {
    dalcs_lu_finish(&whole->lu);
    dalcs_arena_finish(&whole->arena);
    *whole = (struct dalcs_whole){0};
}
