/* whole.c - a mode solved on the equations as they stand, where condensing costs too many digits.
 *
 * With the states eliminated, the currents of strongly coupled coils are differences of voltages over
 * (1 - k) L / h: of a flyback that has run empty, 1e-5 A of amperes. With the states kept, KCL adds up
 * currents, and iterative refinement with residuals in extended precision does the rest. Equations that
 * follow from others give their place to a choice, orthogonal to what is open (singular.c). */
#include "null_space.h"
#include "osnsp_internal.h"

#include <stdlib.h>
#include <string.h>

/* Changes of the mode, how many of them all at once, and refinements. */
enum { MOST_ROUNDS = 60, ROUNDS_AT_ONCE = 10, REFINEMENTS = 4 };

/* Places of the columns among the unknowns: x, z, then lambda of the closed pairs; -1 of open ones. */
static int place_columns(const struct dalcs_osnsp *p, int *place) {
    int n = dalcs_system_n_equations(p->system);
    for (int c = 0; c < n; c++) {
        place[c] = c;
    }
    int *of_pair = place + n;
    for (int d = 0; d < p->system->n_pairs; d++) {
        of_pair[d] = dalcs_osnsp_is_on(p, d) ? n++ : -1;
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

/* (sigma P - A; C) of p->mode. */
static enum dalcs_status fill(const struct dalcs_osnsp *p, const int *place,
                              struct dalcs_triplets *t) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    double sigma = p->form[0]->sigma;
    for (int r = 0; r < n_equations; r++) {
        if (r < s->n_x && sigma != 0.0) {
            DALCS_TRY(add_row(t, place, &s->P, r, r, sigma));
        }
        DALCS_TRY(add_row(t, place, &s->A, r, r, -1.0));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (place[n_equations + d] >= 0) {
            DALCS_TRY(add_row(t, place, &s->C, d, place[n_equations + d], 1.0));
        }
    }
    return DALCS_OK;
}

static long double row_times(const struct dalcs_csr *a, int row, const double *v) {
    long double sum = 0.0L;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        sum += (long double)a->x[k] * v[a->j[k]];
    }
    return sum;
}

/* What is missing at y: sigma P (x_k - x) + A y + E s, and -(C y + F s) of closed pairs. */
static void find_residual(const struct dalcs_osnsp *p, const int *place, const double *u,
                          const double *y, double *residual) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < n_equations; r++) {
        long double sum = row_times(&s->A, r, y) + row_times(&s->E, r, u + s->n_x);
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            int x = s->P.j[k];
            sum += p->form[0]->sigma * (long double)s->P.x[k] * ((long double)u[x] - y[x]);
        }
        residual[r] = (double)sum;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        int row = place[n_equations + d];
        if (row >= 0) {
            residual[row] = (double)-(row_times(&s->C, d, y) + row_times(&s->F, d, u + s->n_x));
        }
    }
}

/* What a mode leaves open: row redundant[k] of its equations is replaced by vector[k][n]. */
struct choices {
    int n;
    const int *redundant;
    const double *vector;
};

/* The answer of p->mode to y, by factors. */
static void refine(struct dalcs_osnsp *p, const struct dalcs_lu *lu, const struct choices *choices,
                   const int *place, const double *u, double *y, double *residual) {
    int n_columns = dalcs_system_n_columns(p->system);
    memset(y, 0, (size_t)n_columns * sizeof(*y));
    for (int round = 0; round <= REFINEMENTS; round++) {
        find_residual(p, place, u, y, residual);
        for (int k = 0; k < choices->n; k++) {
            const double *vector = choices->vector + (size_t)k * (size_t)lu->n;
            long double sum = 0.0L;
            for (int c = 0; c < n_columns; c++) {
                sum += place[c] >= 0 ? (long double)vector[place[c]] * y[c] : 0.0L;
            }
            residual[choices->redundant[k]] = (double)-sum;
        }
        dalcs_lu_solve(lu, residual);
        for (int c = 0; c < n_columns; c++) {
            y[c] += place[c] >= 0 ? residual[place[c]] : 0.0;
        }
    }
}

/* The matrix by columns, with choices in the place of redundant rows. */
static enum dalcs_status put_columns(const struct dalcs_triplets *t, int n,
                                     const struct choices *choices, struct dalcs_csr *columns) {
    struct dalcs_triplets transposed = {0};
    bool *is_redundant = dalcs_alloc((size_t)n, sizeof(bool));
    enum dalcs_status status = is_redundant == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int k = 0; k < choices->n && status == DALCS_OK; k++) {
        is_redundant[choices->redundant[k]] = true;
        for (int c = 0; c < n && status == DALCS_OK; c++) {
            double value = choices->vector[(size_t)k * (size_t)n + (size_t)c];
            if (value != 0.0) {
                status = dalcs_triplets_add(&transposed, c, choices->redundant[k], value);
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
        status = dalcs_csr_compress(columns, n, n, &transposed);
    }
    dalcs_triplets_finish(&transposed);
    free(is_redundant);
    return status;
}

static enum dalcs_status factor_and_refine(struct dalcs_osnsp *p, const struct dalcs_triplets *t,
                                           int n, const struct choices *choices, const int *place,
                                           const double *u, double *y, double *residual) {
    struct dalcs_csr columns = {0};
    klu_common common;
    struct dalcs_lu lu;
    enum dalcs_status status = put_columns(t, n, choices, &columns);
    if (status == DALCS_OK) {
        dalcs_lu_common_init(&common);
        dalcs_lu_pivot_carefully(&common);
        status = dalcs_lu_factor(&lu, &common, n, columns.p, columns.j, columns.x, NULL, 0.0);
    }
    if (status == DALCS_OK) {
        refine(p, &lu, choices, place, u, y, residual);
        dalcs_lu_finish(&lu);
    }
    dalcs_csr_finish(&columns);
    return status;
}

/* The same where what is open has been found. */
static enum dalcs_status choose(struct dalcs_osnsp *p, const struct dalcs_triplets *t, int n,
                                const struct dalcs_null_space *space, const int *place,
                                const double *u, double *y, double *residual) {
    double *vector = dalcs_alloc((size_t)space->n_free * (size_t)n, sizeof(*vector));
    if (vector == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < space->n_free; k++) {
        dalcs_null_space_vector(space, k, vector + (size_t)k * (size_t)n);
    }
    const struct choices choices = {space->n_free, space->redundant, vector};
    p->least_norm = space->n_free > 0;
    enum dalcs_status status = factor_and_refine(p, t, n, &choices, place, u, y, residual);
    free(vector);
    return status;
}

/* chooses: the mode is singular. Else it is tried as a regular one. */
static enum dalcs_status answer(struct dalcs_osnsp *p, int *place, bool chooses, const double *u,
                                double *y) {
    int n = place_columns(p, place);
    struct dalcs_triplets t = {0};
    struct dalcs_null_space space;
    double *residual = dalcs_alloc((size_t)n, sizeof(*residual));
    enum dalcs_status status = residual == NULL ? DALCS_E_NOMEM : fill(p, place, &t);
    if (status == DALCS_OK && !chooses) {
        const struct choices none = {0};
        p->least_norm = false;
        status = factor_and_refine(p, &t, n, &none, place, u, y, residual);
    } else if (status == DALCS_OK) {
        status = dalcs_null_space_find(&space, n, n, &t);
        if (status == DALCS_OK) {
            status = choose(p, &t, n, &space, place, u, y, residual);
            dalcs_null_space_finish(&space);
        }
    }
    dalcs_triplets_finish(&t);
    free(residual);
    return status;
}

/* Evaluates the answer of p->mode. DALCS_OK: it is certified. */
static enum dalcs_status try_mode(struct dalcs_osnsp *p, int *place, bool chooses, const double *u,
                                  double *y) {
    bool sources_clash;
    DALCS_TRY(answer(p, place, chooses, u, y));
    dalcs_certificate_evaluate(p, u, y, &sources_clash);
    return dalcs_certificate_holds(p, sources_clash) ? DALCS_OK : DALCS_NOT_CONVERGED;
}

/* From p->mode on. */
static enum dalcs_status pivot(struct dalcs_osnsp *p, int *place, const double *u, double *y) {
    for (int round = 0; round < MOST_ROUNDS; round++) {
        enum dalcs_status status = try_mode(p, place, false, u, y);
        if (status == DALCS_SINGULAR || (status == DALCS_NOT_CONVERGED && p->n_violating == 0)) {
            status = try_mode(p, place, true, u, y);
        }
        if (status != DALCS_NOT_CONVERGED) {
            return status == DALCS_SINGULAR ? DALCS_NOT_CONVERGED : status;
        }
        if (p->n_violating == 0) {
            break;
        }
        dalcs_osnsp_flip_violating(p, round < ROUNDS_AT_ONCE);
        p->counters.pivots++;
    }
    return DALCS_NOT_CONVERGED;
}

enum dalcs_status dalcs_whole_solve(struct dalcs_osnsp *p, const double *u, double *y) {
    int *place = dalcs_alloc((size_t)dalcs_system_n_columns(p->system), sizeof(*place));
    if (place == NULL) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = DALCS_NOT_CONVERGED;
    for (int rung = 0; rung < DALCS_N_WEIGHTS && status > DALCS_OK; rung++) {
        bool mode_changed;
        for (int d = 0; d < p->system->n_pairs; d++) {
            if (p->is_diode[d]) { /* whatever was tried before */
                dalcs_osnsp_command(p, d, false);
            }
        }
        dalcs_proximal_begin(p, u);
        status = dalcs_proximal_pivot(p, rung, &mode_changed);
        p->keeps_states = true;
        status = status == DALCS_OK ? pivot(p, place, u, y) : status;
        p->keeps_states = false;
    }
    free(place);
    return status;
}
