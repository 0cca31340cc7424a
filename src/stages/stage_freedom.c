/* stage_freedom.c - pieces of the equations without derivatives, searched out and eliminated. */
#include "stage_freedom.h"

#include "extended.h"
#include "stage_matrix.h"
#include "stages_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A pivot of the balanced piece that is smaller leaves it open: a resistance so small, beside the
 * others, that the state moves in no time after all. */
static const long double least_pivot = 1e-6L;

/* Passes over the rows that look for given columns: in most circuits nothing is found in the second. */
enum { MOST = DALCS_STAGE_MOST_PIECE, BALANCING_ROUNDS = 3, PASSES = 4 };

/* The columns of a row of M. */
static const int *columns_of(const struct dalcs_stage_plan *plan, int row, int *n) {
    const struct dalcs_system *s = plan->stages->system;
    int n_equations = dalcs_stage_plan_n_equations(plan);
    const struct dalcs_csr *a = row < n_equations ? &s->A : &s->C;
    int from = row < n_equations ? row : row - n_equations;
    *n = a->p[from + 1] - a->p[from];
    return a->j + a->p[from];
}

/* The only column of a row that is not given yet, -1: none or several. */
static int only_open_column(const struct dalcs_stage_plan *plan, int row) {
    int only = -1;
    int n;
    const int *column = columns_of(plan, row, &n);
    for (int k = 0; k < n; k++) {
        if (!plan->freedom.is_given[column[k]]) {
            if (only >= 0) {
                return -1;
            }
            only = column[k];
        }
    }
    return only;
}

/* Rows with a single open column give it, in all modes; and so on. */
static void give_columns(struct dalcs_stage_plan *plan) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    int n_equations = dalcs_stage_plan_n_equations(plan);
    for (int pass = 0; pass < PASSES; pass++) {
        for (int r = plan->stages->system->n_x; r < n_equations; r++) {
            int column = f->is_used[r] ? -1 : only_open_column(plan, r);
            if (column >= 0 && column < n_equations) {
                f->is_given[column] = true;
                f->is_used[r] = true;
            }
        }
    }
}

enum dalcs_status dalcs_stage_freedom_setup(struct dalcs_stage_plan *plan) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    size_t n = (size_t)plan->n_rows;
    f->is_given = dalcs_alloc(n, sizeof(bool));
    f->is_used = dalcs_alloc(n, sizeof(bool));
    f->row_seen = dalcs_alloc(n, sizeof(int));
    f->column_seen = dalcs_alloc(n, sizeof(int));
    f->K = dalcs_alloc((size_t)MOST * MOST, sizeof(*f->K));
    if (f->is_given == NULL || f->is_used == NULL || f->row_seen == NULL ||
        f->column_seen == NULL || f->K == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < plan->stages->system->n_x; k++) {
        f->is_given[k] = true;
        f->is_used[k] = true;
    }
    give_columns(plan);
    return DALCS_OK;
}

void dalcs_stage_freedom_finish(struct dalcs_stage_freedom *freedom) {
    free(freedom->is_given);
    free(freedom->is_used);
    free(freedom->row_seen);
    free(freedom->column_seen);
    free(freedom->K);
    *freedom = (struct dalcs_stage_freedom){0};
}

/* ---- One piece --------------------------------------------------------------------------------- */

/* Equations are in K in every mode, pairs if they are closed. */
static bool is_present(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                       int i) {
    int n_equations = dalcs_stage_plan_n_equations(plan);
    return i < n_equations || dalcs_stage_is_on(entry, i - n_equations);
}

/* false: the piece is too large. */
static bool add_row(struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry, int row) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    if (f->row_seen[row] == f->search || f->is_used[row] || !is_present(plan, entry, row)) {
        return true;
    }
    f->row_seen[row] = f->search;
    if (f->n_rows == MOST) {
        return false;
    }
    f->row[f->n_rows++] = row;
    return true;
}

static bool add_column(struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                       int column) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    if (f->column_seen[column] == f->search || f->is_given[column] ||
        !is_present(plan, entry, column)) {
        return true;
    }
    f->column_seen[column] = f->search;
    if (f->n_columns == MOST) {
        return false;
    }
    f->column[f->n_columns++] = column;
    return true;
}

/* All rows and columns that hang together with those that are there. */
static bool complete(struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    const struct dalcs_csr *base = &plan->base;
    bool fits = true;
    int rows = 0;
    int columns = 0;
    while (fits && (rows < f->n_rows || columns < f->n_columns)) {
        if (rows < f->n_rows) {
            int n;
            const int *column = columns_of(plan, f->row[rows++], &n);
            for (int k = 0; k < n && fits; k++) {
                fits = add_column(plan, entry, column[k]);
            }
        } else {
            int c = f->column[columns++];
            for (int k = base->p[c]; k < base->p[c + 1] && fits; k++) {
                fits = add_row(plan, entry, base->j[k]);
            }
        }
    }
    return fits;
}

static int place_of(const struct dalcs_stage_freedom *f, int row) {
    for (int i = 0; i < f->n_rows; i++) {
        if (f->row[i] == row) {
            return i;
        }
    }
    return -1;
}

static void fill(struct dalcs_stage_plan *plan) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    const struct dalcs_csr *base = &plan->base;
    memset(f->K, 0, (size_t)(f->n_rows * f->n_rows) * sizeof(*f->K));
    for (int c = 0; c < f->n_columns; c++) {
        for (int k = base->p[f->column[c]]; k < base->p[f->column[c] + 1]; k++) {
            int row = place_of(f, base->j[k]);
            if (row >= 0) {
                f->K[row * f->n_rows + c] = base->x[k];
            }
        }
    }
}

/* Brings the largest element of row or column i, whose elements are `stride` apart, near 1. */
static void scale_line(int n, int stride, long double *line) {
    double largest = 0.0;
    for (int k = 0; k < n; k++) {
        largest = fmax(largest, fabs((double)line[k * stride]));
    }
    double scale = dalcs_stage_matrix_scale(largest);
    for (int k = 0; k < n; k++) {
        line[k * stride] *= scale;
    }
}

static void balance(struct dalcs_stage_freedom *f) {
    int n = f->n_rows;
    for (int round = 0; round < BALANCING_ROUNDS; round++) {
        for (int i = 0; i < n; i++) {
            scale_line(n, 1, f->K + i * n);
        }
        for (int i = 0; i < n; i++) {
            scale_line(n, n, f->K + i);
        }
    }
}

static void begin(struct dalcs_stage_freedom *f) {
    f->n_rows = 0;
    f->n_columns = 0;
}

static bool is_regular(struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    if (!complete(plan, entry) || f->n_rows != f->n_columns) {
        return false;
    }
    if (f->n_rows == 0) {
        return true;
    }
    fill(plan);
    balance(f);
    return dalcs_extended_solve(f->n_rows, 0, f->K, NULL) >= least_pivot;
}

/* The pieces that these rows and columns are in are regular. */
static bool are_regular(struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                        const int *row, int n_rows, const int *column, int n_columns) {
    struct dalcs_stage_freedom *f = &plan->freedom;
    for (int k = 0; k < n_rows; k++) {
        begin(f);
        if (!add_row(plan, entry, row[k]) || !is_regular(plan, entry)) {
            return false;
        }
    }
    for (int k = 0; k < n_columns; k++) {
        begin(f);
        if (!add_column(plan, entry, column[k]) || !is_regular(plan, entry)) {
            return false;
        }
    }
    return true;
}

bool dalcs_stage_freedom_of_mode(struct dalcs_stage_plan *plan,
                                 const struct dalcs_stage_entry *entry) {
    const struct dalcs_stage_rest *rest = &plan->rest;
    int n_equations = dalcs_stage_plan_n_equations(plan);
    plan->freedom.search++;
    if (!are_regular(plan, entry, rest->row, rest->n_awake, rest->column, rest->n_awake)) {
        return false;
    }
    for (int k = 0; k < entry->n_on; k++) {
        int at = n_equations + entry->on[k];
        if (!are_regular(plan, entry, &at, 1, &at, 1)) {
            return false;
        }
    }
    return true;
}

bool dalcs_stage_freedom_of_change(struct dalcs_stage_plan *plan,
                                   const struct dalcs_stage_entry *entry, int pair) {
    const struct dalcs_csr *lambda = &plan->base;
    int at = dalcs_stage_plan_n_equations(plan) + pair;
    plan->freedom.search++;
    if (dalcs_stage_is_on(entry, pair)) {
        return are_regular(plan, entry, &at, 1, &at, 1);
    }
    int n_columns;
    const int *column = columns_of(plan, at, &n_columns);
    return are_regular(plan, entry, lambda->j + lambda->p[at], lambda->p[at + 1] - lambda->p[at],
                       column, n_columns);
}
