/* step_map.c - a small recurring mode as one dense matrix: (z+, lambda+) = map (x_k, s).
 *
 * Solving the mode for every column of R once turns a step into one dense product, a few times
 * cheaper than a sparse solve of the same size. The answer is certified like any other; where the
 * map's rounding is not good enough the factors are used instead.
 *
 * Rows: the n unknowns, then all pairs (zero where the mode blocks), padded: see
 * dense_map.h. */
#include "dense_map.h"
#include "osnsp_internal.h"

#include <stdlib.h>
#include <string.h>

/* Inputs up to which the dense product is worth its memory traffic. */
enum { MAX_MAP_COLUMNS = 48 };

static int padded_rows(const struct dalcs_osnsp *p) {
    return dalcs_dense_map_rows(p->cache.form[0]->n + p->cache.form[0]->n_pairs);
}

bool dalcs_step_map_pays(const struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    return f->n + f->n_pairs <= p->options.dense_limit && f->n_u <= MAX_MAP_COLUMNS;
}

/* y = the answer to the unit input u_j, without its states. */
static void solve_unit(struct dalcs_osnsp *p, const struct dalcs_mode_entry *e, double *unit, int j,
                       double *y) {
    const struct dalcs_step_form *f = p->cache.form[0];
    unit[j] = 1.0;
    if (e->whole != NULL) {
        dalcs_whole_solve(e->whole, unit, NULL, y);
    } else {
        dalcs_csr_multiply(&f->R, unit, p->work.right);
        memcpy(p->work.rhs, p->work.right, (size_t)f->n * sizeof(double));
        for (int k = 0; k < e->n_on; k++) {
            p->work.rhs[f->n + k] = p->work.right[f->n + e->on[k]];
        }
        dalcs_lu_solve(&e->lu, p->work.rhs);
        memset(p->work.scaled + f->n, 0, (size_t)f->n_pairs * sizeof(double));
        memcpy(p->work.scaled, p->work.rhs, (size_t)f->n * sizeof(double));
        for (int k = 0; k < e->n_on; k++) {
            p->work.scaled[f->n + e->on[k]] = p->work.rhs[f->n + k];
        }
        dalcs_osnsp_unscale(p, y);
    }
    unit[j] = 0.0;
}

enum dalcs_status dalcs_step_map_build(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry) {
    const struct dalcs_step_form *f = p->cache.form[0];
    size_t rows = (size_t)padded_rows(p);
    size_t n_columns = (size_t)dalcs_system_n_columns(p->system);
    double *unit = dalcs_alloc((size_t)f->n_u + n_columns, sizeof(double));
    double *map = dalcs_dense_map_alloc(padded_rows(p), f->n_u);
    if (unit == NULL || map == NULL) {
        free(unit);
        free(map);
        return DALCS_E_NOMEM;
    }
    double *y = unit + f->n_u;
    const double *lambda = y + dalcs_system_n_equations(p->system);
    for (int j = 0; j < f->n_u; j++) {
        solve_unit(p, entry, unit, j, y);
        double *column = map + rows * (size_t)j;
        memset(column, 0, rows * sizeof(double));
        for (int i = 0; i < f->n; i++) {
            column[i] = y[f->column_of[i]];
        }
        memcpy(column + f->n, lambda, (size_t)f->n_pairs * sizeof(double));
    }
    free(unit);
    entry->map = map;
    dalcs_modes_grew(p, entry, rows * (size_t)f->n_u * sizeof(double));
    return DALCS_OK;
}

void dalcs_step_map_apply(const struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry,
                          const double *u, double *y) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    dalcs_dense_map_apply(padded_rows(p), f->n_u, entry->map, u, p->work.mapped);
    for (int i = 0; i < f->n; i++) {
        y[f->column_of[i]] = p->work.mapped[i];
    }
    memcpy(y + n_equations, p->work.mapped + f->n, (size_t)f->n_pairs * sizeof(double));
}
