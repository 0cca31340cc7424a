/* step_form.c - condensing the OSNSP: what is left when the states are eliminated, in balance. */
#include "step_form.h"

#include "elimination.h"
#include "extremes.h"
#include "step_measures.h"

#include <math.h>
#include <string.h>

/* By half the powers of 2 in the largest entry. False: there are none. */
static bool lower_scale(double *scale, double largest) {
    int powers = largest > 0.0 ? (int)lrint(0.5 * log2(largest)) : 0;
    if (powers != 0) {
        *scale = ldexp(*scale, -powers);
    }
    return powers != 0;
}

/* Equilibration by powers of 2 (Ruiz 2001): exact, and it makes a conductance of 1e9 S next to one of
 * 1e-12 S, or volts next to amperes, look alike to KLU's pivoting and to rcond. Rows and columns
 * have their own scales: the KCL of a floating group of capacitors, summed over the group, has none
 * of the large companion conductances that its voltages see elsewhere. */
static enum dalcs_status balance(struct dalcs_step_form *f, struct dalcs_elimination *e) {
    int n = f->n + f->n_pairs;
    double *largest = dalcs_arena_alloc(&e->work, 2 * (size_t)n, sizeof(*largest));
    if (largest == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n; i++) {
        f->scale[i] = 1.0;
        f->row_scale[i] = 1.0;
    }
    bool changed = true;
    for (int pass = 0; pass < 8 && changed; pass++) {
        changed = false;
        memset(largest, 0, 2 * (size_t)n * sizeof(*largest));
        for (int c = 0; c < n; c++) {
            for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
                int r = f->K.j[k];
                double a = fabs(f->K.x[k]) * f->scale[c] * f->row_scale[r];
                largest[c] = dalcs_larger(largest[c], a);
                largest[n + r] = dalcs_larger(largest[n + r], a);
            }
        }
        for (int i = 0; i < n; i++) {
            changed = lower_scale(&f->scale[i], largest[i]) || changed;
            changed = lower_scale(&f->row_scale[i], largest[n + i]) || changed;
        }
    }
    double sum = 0.0;
    for (int d = 0; d < f->n_pairs; d++) {
        sum += log2(f->scale[f->n + d]) + log2(f->row_scale[f->n + d]);
    }
    f->pair_conductance = f->n_pairs > 0 ? exp2(rint(sum / f->n_pairs)) : 1.0;
    for (int c = 0; c < n; c++) {
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            f->K.x[k] *= f->scale[c] * f->row_scale[f->K.j[k]];
        }
        for (int k = f->R.p[c]; k < f->R.p[c + 1]; k++) {
            f->R.x[k] *= f->row_scale[c];
        }
    }
    for (int d = 0; d < f->n_pairs; d++) {
        for (int k = f->W.p[d]; k < f->W.p[d + 1]; k++) {
            f->W.x[k] *= f->row_scale[f->n + d] * f->scale[f->W.j[k]];
        }
    }
    return DALCS_OK;
}

/* What was collected becomes *a, and t is empty again. */
static enum dalcs_status compress(struct dalcs_csr *a, int n_rows, int n_columns,
                                  struct dalcs_triplets *t) {
    DALCS_TRY(dalcs_csr_compress(a, n_rows, n_columns, t));
    t->n = 0;
    return DALCS_OK;
}

static enum dalcs_status copy_row(struct dalcs_triplets *t, int row, const struct dalcs_csr *a,
                                  int i, int first_column, double sign) {
    for (int k = a->p[i]; k < a->p[i + 1]; k++) {
        DALCS_TRY(dalcs_triplets_add(t, row, first_column + a->j[k], sign * a->x[k]));
    }
    return DALCS_OK;
}

/* The rows that a certificate evaluates, in one matrix: its loop is a good part of a step. */
static enum dalcs_status gather_checked_rows(struct dalcs_step_form *f,
                                             const struct dalcs_system *s,
                                             struct dalcs_triplets *t) {
    int n_columns = dalcs_system_n_columns(s);
    for (int i = 0; i < f->checks.n; i++) {
        int r = f->checks.row[i];
        if (r < s->n_x) {
            DALCS_TRY(copy_row(t, i, &s->P, r, 0, -1.0));
        }
        DALCS_TRY(copy_row(t, i, &s->A, r, s->n_x, 1.0));
        DALCS_TRY(copy_row(t, i, &s->E, r, s->n_x + n_columns, 1.0));
    }
    return compress(&f->checks.form, f->checks.n, s->n_x + n_columns + s->n_inputs, t);
}

/* x = v(a) - v(b) with unit coefficients leaves nothing to check: evaluating the row again would repeat
 * the very same subtraction. */
static bool is_definition(const struct dalcs_elimination *e, int i) {
    const struct dalcs_csr *A = &e->s->A;
    bool defines = e->is_pivot[i] && i >= e->s->n_x && A->p[i + 1] - A->p[i] <= 3;
    for (int k = A->p[i]; k < A->p[i + 1]; k++) {
        defines = defines && fabs(A->x[k]) == 1.0;
    }
    for (int k = 0; k < e->row[i].n; k++) {
        defines = defines && e->row[i].column[k] < e->n_left;
    }
    return defines;
}

static enum dalcs_status make_room_for_form(struct dalcs_step_form *f,
                                            const struct dalcs_elimination *e) {
    size_t n_equations = (size_t)dalcs_system_n_equations(e->s);
    f->column_of = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->column_of));
    f->checks.row = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->checks.row));
    f->scale = dalcs_arena_alloc(&f->arena, (size_t)e->n_rows, sizeof(*f->scale));
    f->row_scale = dalcs_arena_alloc(&f->arena, (size_t)e->n_rows, sizeof(*f->row_scale));
    f->checks.volts = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->checks.volts));
    f->checks.amperes = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->checks.amperes));
    f->state.ends = dalcs_arena_alloc(&f->arena, 2 * (size_t)e->s->n_x, sizeof(*f->state.ends));
    bool complete = f->column_of != NULL && f->checks.row != NULL && f->scale != NULL &&
                    f->row_scale != NULL && f->checks.volts != NULL && f->checks.amperes != NULL &&
                    f->state.ends != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* The column of K that each of the system's is, in e->work; NULL when out of memory. */
static int *number_unknowns(struct dalcs_step_form *f, struct dalcs_elimination *e) {
    const struct dalcs_system *s = e->s;
    int n_equations = dalcs_system_n_equations(s);
    int *reduced = dalcs_arena_alloc(&e->work, (size_t)e->n_left, sizeof(*reduced));
    if (reduced == NULL) {
        return NULL;
    }
    for (int c = s->n_x; c < n_equations; c++) {
        f->column_of[f->n++] = c;
    }
    for (int x = 0; x < s->n_x; x++) {
        if (e->pivot_row[x] < 0) {
            f->column_of[f->n++] = x;
        }
    }
    for (int i = 0; i < f->n; i++) {
        reduced[f->column_of[i]] = i;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        reduced[n_equations + d] = f->n + d;
    }
    return reduced;
}

/* Rows [first, last) of what is left: their unknowns, by `reduced`, or else (NULL) their right-hand sides. */
static enum dalcs_status collect_rows(const struct dalcs_step_form *f,
                                      const struct dalcs_elimination *e, int first, int last,
                                      const int *reduced, struct dalcs_triplets *t) {
    int n_equations = dalcs_system_n_equations(e->s);
    for (int i = first; i < last; i++) {
        const struct dalcs_elimination_row *r =
            &e->row[i < f->n ? e->row_of_dual[f->column_of[i]] : n_equations + i - f->n];
        for (int k = 0; k < r->n; k++) {
            int column = r->column[k];
            if ((column < e->n_left) == (reduced != NULL)) {
                column = reduced != NULL ? reduced[column] : column - e->n_left;
                DALCS_TRY(dalcs_triplets_add(t, i - first, column, r->value[k]));
            }
        }
    }
    return DALCS_OK;
}

static void transpose(struct dalcs_triplets *t) {
    for (size_t k = 0; k < t->n; k++) {
        int row = t->entry[k].row;
        t->entry[k].row = t->entry[k].column;
        t->entry[k].column = row;
    }
}

/* What x+ is made of: unknowns, or else right-hand sides. */
static enum dalcs_status collect_states(const struct dalcs_elimination *e, bool of_unknowns,
                                        struct dalcs_triplets *t) {
    for (int x = 0; x < e->s->n_x; x++) {
        if (e->pivot_row[x] < 0) {
            DALCS_TRY(of_unknowns ? dalcs_triplets_add(t, x, x, 1.0) : DALCS_OK);
            continue;
        }
        const struct dalcs_elimination_row *r = &e->row[e->pivot_row[x]];
        double pivot = *dalcs_elimination_find(r, x);
        for (int k = 0; k < r->n; k++) {
            int column = r->column[k];
            if (of_unknowns && column < e->n_left && column != x) {
                DALCS_TRY(dalcs_triplets_add(t, x, column, -r->value[k] / pivot));
            } else if (!of_unknowns && column >= e->n_left) {
                DALCS_TRY(dalcs_triplets_add(t, x, column - e->n_left, r->value[k] / pivot));
            }
        }
    }
    return DALCS_OK;
}

/* Splits the rows into K, R, X and Xu. */
static enum dalcs_status collect_all(struct dalcs_step_form *f, struct dalcs_elimination *e,
                                     struct dalcs_triplets *t) {
    const struct dalcs_system *s = e->s;
    DALCS_TRY(make_room_for_form(f, e));
    const int *reduced = number_unknowns(f, e);
    if (reduced == NULL) {
        return DALCS_E_NOMEM;
    }
    int n = f->n + f->n_pairs;
    DALCS_TRY(collect_rows(f, e, 0, n, reduced, t));
    transpose(t);
    DALCS_TRY(compress(&f->K, n, n, t));
    DALCS_TRY(collect_rows(f, e, f->n, n, reduced, t));
    DALCS_TRY(compress(&f->W, f->n_pairs, n, t));
    DALCS_TRY(collect_rows(f, e, 0, n, NULL, t));
    DALCS_TRY(compress(&f->R, n, f->n_u, t));
    DALCS_TRY(collect_states(e, true, t));
    DALCS_TRY(compress(&f->state.X, s->n_x, e->n_left, t));
    DALCS_TRY(collect_states(e, false, t));
    DALCS_TRY(compress(&f->state.Xu, s->n_x, f->n_u, t));
    for (int x = 0; x < s->n_x; x++) {
        dalcs_csr_row_difference(&f->state.X, x, &f->state.ends[2 * x]);
        if (f->state.Xu.p[x] != f->state.Xu.p[x + 1]) {
            f->state.ends[2 * x] = -1;
        }
    }
    for (int i = 0; i < dalcs_system_n_equations(s); i++) {
        if (!is_definition(e, i)) {
            f->checks.row[f->checks.n++] = i;
        }
    }
    DALCS_TRY(gather_checked_rows(f, s, t));
    dalcs_step_form_measure(f, s);
    return balance(f, e);
}

static enum dalcs_status collect(struct dalcs_step_form *f, struct dalcs_elimination *e) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = collect_all(f, e, &t);
    dalcs_triplets_finish(&t);
    return status;
}

enum dalcs_status dalcs_step_form_build(struct dalcs_step_form *form,
                                        const struct dalcs_system *system, double sigma) {
    *form = (struct dalcs_step_form){
        .sigma = sigma, .n_pairs = system->n_pairs, .n_u = system->n_x + system->n_inputs};
    struct dalcs_elimination e;
    enum dalcs_status status = dalcs_elimination_run(&e, system, sigma);
    if (status == DALCS_OK) {
        status = collect(form, &e);
    }
    dalcs_elimination_finish(&e);
    if (status != DALCS_OK) {
        dalcs_step_form_finish(form);
    }
    return status;
}

static size_t bytes_of(const struct dalcs_csr *a) {
    const size_t entries = a->p != NULL ? (size_t)a->p[a->n_rows] : 0;
    return ((size_t)a->n_rows + 1) * sizeof(*a->p) + entries * (sizeof(*a->j) + sizeof(*a->x));
}

size_t dalcs_step_form_bytes(const struct dalcs_step_form *form) {
    const size_t n_rows = (size_t)form->n + (size_t)form->n_pairs;
    return sizeof(*form) + n_rows * (4 * sizeof(double) + 2 * sizeof(int)) + bytes_of(&form->K) +
           bytes_of(&form->W) + bytes_of(&form->R) + bytes_of(&form->state.X) +
           bytes_of(&form->state.Xu) + bytes_of(&form->checks.form);
}

void dalcs_step_form_finish(struct dalcs_step_form *form) {
    dalcs_arena_finish(&form->arena);
    dalcs_csr_finish(&form->K);
    dalcs_csr_finish(&form->checks.form);
    dalcs_csr_finish(&form->W);
    dalcs_csr_finish(&form->R);
    dalcs_csr_finish(&form->state.X);
    dalcs_csr_finish(&form->state.Xu);
    *form = (struct dalcs_step_form){0};
}
