/* whole.c - the matrix of a mode with the states kept, its factors and its refinement. */
#include "whole.h"

#include "magnitudes.h"
#include "null_space.h"
#include "osnsp_internal.h"
#include "redundant_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Each gains the digits that the factors have; two more than a condition of 1e12 asks for. */
enum { REFINEMENTS = 4 };

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
    return dalcs_redundant_rows_choose(
        space, t, size, whole->resistance != NULL ? dalcs_system_n_equations(s) : whole->n);
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

static long double row_times(const struct dalcs_csr *a, int row, const double *v) {
    long double sum = 0.0L;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        sum += (long double)a->x[k] * v[a->j[k]];
    }
    return sum;
}

/* What is missing at y: sigma P (x_k - x) + A y + E s, and t - (C y + F s) - R lambda of the pairs. */
static void find_residual(const struct dalcs_whole *whole, const double *u, const double *line,
                          const double *y) {
    const struct dalcs_system *s = whole->p->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < n_equations; r++) {
        long double sum = row_times(&s->A, r, y) + row_times(&s->E, r, u + s->n_x);
        sum += s->A_rest.p != NULL ? row_times(&s->A_rest, r, y) : 0.0L;
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            int x = s->P.j[k];
            sum += whole->sigma * (long double)s->P.x[k] * ((long double)u[x] - y[x]);
        }
        whole->residual[r] = (double)sum;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        int row = whole->place[n_equations + d];
        if (row >= 0) {
            long double sum = row_times(&s->C, d, y) + row_times(&s->F, d, u + s->n_x);
            if (whole->resistance != NULL) {
                sum += (long double)whole->resistance[d] * y[n_equations + d] - line[d];
            }
            whole->residual[row] = (double)-sum;
        }
    }
}

/* The same of the choices, in the rows that they stand in for. */
static void find_residual_of_choices(const struct dalcs_whole *whole, const double *u,
                                     const double *y) {
    const struct dalcs_system *s = whole->p->system;
    int n_columns = dalcs_system_n_columns(s);
    for (int k = 0; k < whole->n_choices; k++) {
        const double *choice = whole->choice + (size_t)k * (size_t)n_columns;
        const double *of_w = whole->choice_w + (size_t)k * (size_t)s->n_pairs;
        long double sum = 0.0L;
        for (int c = 0; c < n_columns; c++) {
            sum += (long double)choice[c] * y[c];
        }
        for (int d = 0; d < s->n_pairs; d++) {
            if (of_w[d] != 0.0) {
                long double knee = (long double)dalcs_system_knee(s, d) * u[s->n_x];
                sum += of_w[d] * (row_times(&s->F, d, u + s->n_x) - knee);
            }
        }
        whole->residual[whole->redundant[k]] = (double)-sum;
    }
}

static void add_correction(const struct dalcs_whole *whole, double *y) {
    for (int c = 0; c < dalcs_system_n_columns(whole->p->system); c++) {
        y[c] += whole->place[c] >= 0 ? whole->residual[whole->place[c]] : 0.0;
    }
}

void dalcs_whole_solve(const struct dalcs_whole *whole, const double *u, const double *line,
                       double *y) {
    int n_columns = dalcs_system_n_columns(whole->p->system);
    memset(y, 0, (size_t)n_columns * sizeof(*y));
    for (int round = 0; round <= REFINEMENTS; round++) {
        find_residual(whole, u, line, y);
        find_residual_of_choices(whole, u, y);
        dalcs_lu_solve(&whole->lu, whole->residual);
        add_correction(whole, y);
    }
}

void dalcs_whole_refine(const struct dalcs_whole *whole, const double *u, double *y) {
    for (int round = 0; round < REFINEMENTS; round++) {
        find_residual(whole, u, NULL, y);
        for (int k = 0; k < whole->n_choices; k++) {
            whole->residual[whole->redundant[k]] = 0.0;
        }
        dalcs_lu_solve(&whole->lu, whole->residual);
        add_correction(whole, y);
    }
}

void dalcs_whole_direction(const struct dalcs_whole *whole, int k, double *y) {
    memset(whole->residual, 0, (size_t)whole->n * sizeof(double));
    whole->residual[whole->redundant[k]] = 1.0;
    dalcs_lu_solve(&whole->lu, whole->residual);
    for (int c = 0; c < dalcs_system_n_columns(whole->p->system); c++) {
        y[c] = whole->moves[c] ? whole->residual[whole->place[c]] : 0.0;
    }
}

size_t dalcs_whole_bytes(const struct dalcs_whole *whole) {
    size_t n_columns = (size_t)dalcs_system_n_columns(whole->p->system);
    size_t n_choices = (size_t)whole->n_choices;
    return sizeof(*whole) + dalcs_lu_bytes(&whole->lu) +
           n_columns * (sizeof(int) + sizeof(bool) + (2 + 2 * n_choices) * sizeof(double));
}

void dalcs_whole_finish(struct dalcs_whole *whole) {
    dalcs_lu_finish(&whole->lu);
    dalcs_arena_finish(&whole->arena);
    *whole = (struct dalcs_whole){0};
}
