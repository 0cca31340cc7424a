/* step_map.c - a small recurring mode as one dense matrix: (z+, lambda+) = map (x_k, s).
 *
 * Solving the mode for every column of R once turns a step into one dense product, a few times
 * cheaper than a sparse solve of the same size. The answer is certified like any other; where the
 * map's rounding is not good enough the factors are used instead.
 *
 * Rows: the n unknowns, then all pairs (zero where the mode blocks), padded to a multiple of 8;
 * stored by columns, so that each row is summed in the same order whatever the vector width. */
#include "osnsp_internal.h"

#include <stdlib.h>
#include <string.h>

/* Inputs up to which the dense product is worth its memory traffic. */
enum { MAX_MAP_COLUMNS = 48, UNKNOWN_ROUNDS = 3, PROXIMAL_ROUNDS = UNKNOWN_ROUNDS + 4 };

static int padded_rows(const struct dalcs_osnsp *p) {
    return (p->form[0]->n + p->form[0]->n_pairs + 7) / 8 * 8;
}

bool dalcs_step_map_pays(const struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->form[0];
    return f->n + f->n_pairs <= p->options.dense_limit && f->n_u <= MAX_MAP_COLUMNS;
}

/* p->scaled = the answer to the unit input u_j. */
static void solve_unit(struct dalcs_osnsp *p, const struct dalcs_mode_entry *e, int kind) {
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
    memset(p->centre, 0, n * sizeof(double));
    memset(p->centre_w, 0, (size_t)f->n_pairs * sizeof(double));
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
    double *map = aligned_alloc(64, size * sizeof(double));
    if (map == NULL) {
        return DALCS_E_NOMEM;
    }
    memset(map, 0, size * sizeof(double));
    int n = f->n + f->n_pairs;
    for (int j = 0; j < f->n_u; j++) {
        for (int i = 0; i < n; i++) {
            p->right[i] = 0.0;
            for (int k = f->R.p[i]; k < f->R.p[i + 1]; k++) {
                p->right[i] = f->R.j[k] == j ? f->R.x[k] : p->right[i];
            }
        }
        solve_unit(p, factors, kind);
        double *column = map + rows * (size_t)j;
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

typedef double vector4 __attribute__((vector_size(32), aligned(32)));

/* out[rows] = map u, eight rows at a time. The clones differ in vector width only: without
 * contraction every element is computed by the same operations in the same order. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
__attribute__((target_clones("avx2", "default")))
#endif
static void
multiply(int rows, int n_u, const double *restrict map, const double *restrict u,
         double *restrict out) {
    for (int i = 0; i < rows; i += 8) {
        vector4 a = {0.0};
        vector4 b = {0.0};
        const double *column = map + i;
        for (int j = 0; j < n_u; j++, column += rows) {
            const vector4 *m = (const vector4 *)column;
            vector4 v = {u[j], u[j], u[j], u[j]};
            a += m[0] * v;
            b += m[1] * v;
        }
        memcpy(out + i, &a, sizeof(a));
        memcpy(out + i + 4, &b, sizeof(b));
    }
}

void dalcs_step_map_apply(const struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry,
                          const double *u, double *y) {
    const struct dalcs_step_form *f = p->form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    multiply(padded_rows(p), f->n_u, entry->map, u, p->mapped);
    for (int i = 0; i < f->n; i++) {
        y[f->column_of[i]] = p->mapped[i];
    }
    memcpy(y + n_equations, p->mapped + f->n, (size_t)f->n_pairs * sizeof(double));
}
