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
enum { MAX_MAP_COLUMNS = 48, UNKNOWN_ROUNDS = 3, PROXIMAL_ROUNDS = UNKNOWN_ROUNDS + 4 };

static int padded_rows(const struct dalcs_osnsp *p) {
    return dalcs_dense_map_rows(p->form[0]->n + p->form[0]->n_pairs);
}

bool dalcs_step_map_pays(const struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->form[0];
    return f->n + f->n_pairs <= p->options.dense_limit && f->n_u <= MAX_MAP_COLUMNS;
}

/* p->scaled = the answer to the unit input u_j. */
static void solve_unit(struct dalcs_osnsp *p, const struct dalcs_mode_entry *e, int kind, int j) {
    const struct dalcs_step_form *f = p->form[0];
    size_t n = (size_t)(f->n + f->n_pairs);
    memset(p->scaled, 0, n * sizeof(double));
    if (kind == DALCS_PLAIN) {
        memcpy(p->rhs, p->right, (size_t)f->n * sizeof(double));
        for (int k = 0; k < e->n_on; k++) {
            p->rhs[f->n + k] = p->right[f->n + e->on[k]];
        }
        dalcs_lu_solve(&e->lu, p->rhs);
        memcpy(p->scaled, p->rhs, (size_t)f->n * sizeof(double));
        for (int k = 0; k < e->n_on; k++) {
            p->scaled[f->n + e->on[k]] = p->rhs[f->n + k];
        }
        return;
    }
    dalcs_proximal_rest(p);
    if (j != p->system->n_x) { /* knees are multiples of the constant input */
        memset(p->centre_w, 0, (size_t)f->n_pairs * sizeof(double));
    }
    for (int round = 0; round < PROXIMAL_ROUNDS; round++) {
        dalcs_proximal_step(p, e, kind - 1);
        bool unknowns_only = round < UNKNOWN_ROUNDS;
        memcpy(p->centre, p->scaled, (unknowns_only ? (size_t)f->n : n) * sizeof(double));
        for (int d = 0; d < f->n_pairs && !unknowns_only; d++) {
            p->centre_w[d] = dalcs_proximal_scaled_w(p, d);
        }
    }
}

enum dalcs_status dalcs_step_map_build(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry,
                                       int kind) {
    const struct dalcs_step_form *f = p->form[0];
    struct dalcs_mode_entry *factors = entry;
    if (kind != DALCS_PLAIN) {
        DALCS_TRY(dalcs_modes_get(p, kind, &factors));
        if (factors->singular) {
            return DALCS_OK;
        }
        DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &entry)); /* most recent: not evicted below */
    }
    size_t rows = (size_t)padded_rows(p);
    size_t size = rows * (size_t)f->n_u;
    double *map = dalcs_dense_map_alloc(padded_rows(p), f->n_u);
    if (map == NULL) {
        return DALCS_E_NOMEM;
    }
    int n = f->n + f->n_pairs;
    for (int j = 0; j < f->n_u; j++) {
        for (int i = 0; i < n; i++) {
            p->right[i] = 0.0;
            for (int k = f->R.p[i]; k < f->R.p[i + 1]; k++) {
                p->right[i] = f->R.j[k] == j ? f->R.x[k] : p->right[i];
            }
        }
        solve_unit(p, factors, kind, j);
        double *column = map + rows * (size_t)j;
        memset(column, 0, rows * sizeof(double));
        for (int i = 0; i < n; i++) {
            column[i] = f->scale[i] * p->scaled[i];
        }
        for (int d = 0; d < f->n_pairs; d++) {
            column[f->n + d] = dalcs_osnsp_is_on(p, d) ? column[f->n + d] : 0.0;
        }
    }
    entry->map = map;
    dalcs_modes_grew(p, entry, size * sizeof(double));
    return DALCS_OK;
}

void dalcs_step_map_apply(const struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry,
                          const double *u, double *y) {
    const struct dalcs_step_form *f = p->form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    dalcs_dense_map_apply(padded_rows(p), f->n_u, entry->map, u, p->mapped);
    for (int i = 0; i < f->n; i++) {
        y[f->column_of[i]] = p->mapped[i];
    }
    memcpy(y + n_equations, p->mapped + f->n, (size_t)f->n_pairs * sizeof(double));
}
