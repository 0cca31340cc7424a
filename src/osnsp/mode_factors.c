/* mode_factors.c - the matrix of a mode, and its factors.
 *
 * Each mode has its own compressed matrix and its own analysis: diodes that block have no unknown,
 * and a pattern shared by all modes would cost several times the fill. */
#include "magnitudes.h"
#include "null_space.h"
#include "osnsp_internal.h"

#include <stdlib.h>
#include <string.h>

/* Where the equations and pairs of the form are in the mode's matrix; -1: nowhere. */
static void find_slots(const struct dalcs_step_form *f, const struct dalcs_mode_entry *e,
                       int *slot) {
    for (int i = 0; i < f->n; i++) {
        slot[i] = i;
    }
    for (int d = 0; d < f->n_pairs; d++) {
        slot[f->n + d] = -1;
    }
    for (int k = 0; k < e->n_on; k++) {
        slot[f->n + e->on[k]] = f->n + k;
    }
}

/* The other way round. */
static int index_of_slot(const struct dalcs_step_form *f, const struct dalcs_mode_entry *e,
                         int slot) {
    return slot < f->n ? slot : f->n + e->on[slot - f->n];
}

enum dalcs_status dalcs_columns_alloc(struct dalcs_columns *a, int n, size_t n_entries) {
    size_t n_starts = (size_t)n + 1;
    *a = (struct dalcs_columns){.n = n};
    a->x = malloc(n_entries * (sizeof(*a->x) + sizeof(*a->i)) + n_starts * sizeof(*a->p));
    if (a->x == NULL) {
        return DALCS_E_NOMEM;
    }
    a->p = (void *)(a->x + n_entries);
    a->i = a->p + n_starts;
    a->p[0] = 0;
    return DALCS_OK;
}

/* The plain matrix of the entry's mode in p->cache.form[0]: equations and the w rows of closed pairs. */
static enum dalcs_status fill_plain_matrix(const struct dalcs_osnsp *p,
                                           const struct dalcs_mode_entry *e,
                                           struct dalcs_columns *a) {
    const struct dalcs_step_form *f = p->cache.form[0];
    *a = (struct dalcs_columns){.n = f->n + e->n_on};
    int *slot = dalcs_alloc((size_t)(f->n + f->n_pairs), sizeof(*slot));
    if (slot == NULL) {
        return DALCS_E_NOMEM;
    }
    find_slots(f, e, slot);
    size_t n_entries = 0;
    for (int c = 0; c < f->n + f->n_pairs; c++) {
        n_entries += slot[c] >= 0 ? (size_t)(f->K.p[c + 1] - f->K.p[c]) : 0;
    }
    enum dalcs_status status = dalcs_columns_alloc(a, a->n, n_entries);
    if (status != DALCS_OK) {
        free(slot);
        return status;
    }
    int out = 0;
    for (int c = 0; c < f->n + f->n_pairs; c++) {
        if (slot[c] < 0) {
            continue;
        }
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            if (slot[f->K.j[k]] >= 0) {
                a->i[out] = slot[f->K.j[k]];
                a->x[out++] = f->K.x[k];
            }
        }
        a->p[slot[c] + 1] = out;
    }
    free(slot);
    return DALCS_OK;
}

void dalcs_columns_finish(struct dalcs_columns *a) {
    free(a->x);
    *a = (struct dalcs_columns){0};
}

/* Where the rows and unknowns of the factors are in R and in y, so that a step needs no copies. */
static enum dalcs_status order_rows(const struct dalcs_osnsp *p, struct dalcs_mode_entry *e) {
    const struct dalcs_step_form *f = p->cache.form[0];
    size_t order = (size_t)e->lu.n;
    e->scale_of = dalcs_alloc(order, sizeof(*e->scale_of) + 2 * sizeof(*e->row_of));
    if (e->scale_of == NULL) {
        return DALCS_E_NOMEM;
    }
    e->row_of = (void *)(e->scale_of + order);
    e->column_of = e->row_of + order;
    int n_equations = dalcs_system_n_equations(p->system);
    for (int i = 0; i < e->lu.n; i++) {
        int unknown = e->lu.to[i];
        int reduced = index_of_slot(f, e, unknown);
        e->row_of[i] = index_of_slot(f, e, e->lu.from[i]);
        e->column_of[i] = unknown < f->n ? f->column_of[unknown] : n_equations + reduced - f->n;
        e->scale_of[i] = f->scale[reduced];
    }
    return DALCS_OK;
}

/* A new mode differs from an earlier one in a few diodes, and so do the rows that can stand on the
 * diagonal. Small modes do without: there the search costs next to nothing. */
enum { LARGE_MODE = 128 };

/* Where nothing else finds an answer only the null space says which mode is singular. */
static double least_rcond(const struct dalcs_osnsp *p) {
    return p->asks.insists ? 0.0 : p->options.rcond_min;
}

static enum dalcs_status factor_large(struct dalcs_osnsp *p, struct dalcs_mode_entry *e,
                                      struct dalcs_columns *a) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n_all = f->n + f->n_pairs;
    if (p->cache.n_matched != n_all) { /* the forms of other sigma may be condensed otherwise */
        int *rows = realloc(p->cache.matched_row, (size_t)n_all * sizeof(*rows));
        if (rows == NULL) {
            return DALCS_E_NOMEM;
        }
        memset(rows, -1, (size_t)n_all * sizeof(*rows));
        p->cache.matched_row = rows;
        p->cache.n_matched = n_all;
    }
    int *slot = dalcs_alloc((size_t)n_all, sizeof(*slot));
    int *row_of_column = dalcs_alloc((size_t)a->n, sizeof(*row_of_column));
    enum dalcs_status status = slot != NULL && row_of_column != NULL ? DALCS_OK : DALCS_E_NOMEM;
    if (status == DALCS_OK) {
        find_slots(f, e, slot);
        for (int c = 0; c < a->n; c++) {
            int row = p->cache.matched_row[index_of_slot(f, e, c)];
            row_of_column[c] = row >= 0 ? slot[row] : -1;
        }
        status = dalcs_lu_factor(&e->lu, &p->cache.klu, a, row_of_column, least_rcond(p));
        for (int c = 0; c < a->n; c++) {
            int row = row_of_column[c];
            p->cache.matched_row[index_of_slot(f, e, c)] = row >= 0 ? index_of_slot(f, e, row) : -1;
        }
    }
    free(slot);
    free(row_of_column);
    return status;
}

enum dalcs_status dalcs_modes_factor_small(const struct dalcs_osnsp *p, struct dalcs_lu *lu,
                                           const struct dalcs_columns *a, double apart) {
    return p->asks.is_passing && a->n <= DALCS_LU_SMALL ? dalcs_lu_factor_small(lu, a, apart)
                                                        : DALCS_SINGULAR;
}

struct dalcs_lu_patterns *dalcs_modes_patterns(struct dalcs_osnsp *p) {
    return p->options.patterns != NULL ? p->options.patterns : &p->cache.patterns;
}

static enum dalcs_status factor(struct dalcs_osnsp *p, struct dalcs_mode_entry *e,
                                struct dalcs_columns *a) {
    if (a->n >= LARGE_MODE) {
        return factor_large(p, e, a);
    }
    enum dalcs_status status = dalcs_modes_factor_small(p, &e->lu, a, dalcs_nothing);
    return status > DALCS_OK ? dalcs_lu_factor_again(&e->lu, dalcs_modes_patterns(p), &p->cache.klu,
                                                     a, least_rcond(p))
                             : status;
}

/* Is the least pivot no more than rounding of what was subtracted in it? Columns far apart make the estimate of the
 * condition small as well, and the pivot of an island of 1 ohm that only 100 Mohm tie to nothing is 1e-8 of its column. */
static enum dalcs_status look_for_rounding(const struct dalcs_columns *a) {
    struct dalcs_triplets t = {0};
    struct dalcs_null_space space;
    enum dalcs_status status = DALCS_OK;
    for (int c = 0; c < a->n; c++) {
        for (int k = a->p[c]; k < a->p[c + 1] && status == DALCS_OK; k++) {
            status = dalcs_triplets_add(&t, a->i[k], c, a->x[k]);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(&space, a->n, a->n, &t);
    }
    dalcs_triplets_finish(&t);
    if (status == DALCS_OK) {
        status = space.n_free > 0 ? DALCS_SINGULAR : DALCS_OK;
        dalcs_null_space_finish(&space);
    }
    return status;
}

/* At rest capacitors block, and what they alone tie to the rest floats: the pivot of such an island is rounding of its
 * conductances, which may be far larger than rcond_min of another pivot. In a step it is told from rounding by the estimate
 * alone: with the states eliminated entries have lost digits, and of a leak more than it is may count as rounding. */
static bool may_be_singular(const struct dalcs_osnsp *p) {
    return p->cache.form[0]->sigma == 0.0 || p->cache.klu.rcond < p->options.rcond_min;
}

enum dalcs_status dalcs_modes_factor_plain(struct dalcs_osnsp *p, struct dalcs_mode_entry *e) {
    struct dalcs_columns a;
    DALCS_TRY(fill_plain_matrix(p, e, &a));
    p->cache.klu.rcond = 1.0; /* what small ones without KLU tell */
    enum dalcs_status status = factor(p, e, &a);
    if (status == DALCS_OK && may_be_singular(p)) {
        status = look_for_rounding(&a);
    }
    dalcs_columns_finish(&a);
    return status == DALCS_OK ? order_rows(p, e) : status;
}
