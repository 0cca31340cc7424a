/* workshop_equations.c - the equations of the stages in one mode, and their scales. */
#include "stage_workshop.h"

#include "extremes.h"
#include "stage_matrix.h"

#include <math.h>
#include <string.h>

enum { BALANCING_ROUNDS = 3 };

/* Column of a system's column in the unknowns; -1 for an open pair. */
static void place_columns(const struct dalcs_stage_workshop *b) {
    int n_equations = dalcs_system_n_equations(b->system);
    for (int c = 0; c < n_equations; c++) {
        b->place[c] = c;
    }
    for (int d = 0; d < b->system->n_pairs; d++) {
        b->place[n_equations + d] = -1;
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        b->place[n_equations + b->entry->on[k]] = n_equations + k;
    }
}

/* Adds sign * row of a matrix to a row of the base and, for its states, to the right-hand sides with
 * the opposite sign. */
static void add_row(const struct dalcs_stage_workshop *b, const struct dalcs_csr *a, int from,
                    int to, double sign) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int column = b->place[a->j[k]];
        if (column < 0) {
            continue;
        }
        b->eq.plain_base[column * b->n + to] += sign * a->x[k];
        if (column < b->n_x) {
            b->eq.plain_rhs[column * b->n + to] -= sign * a->x[k];
        }
    }
}

static void add_inputs(const struct dalcs_stage_workshop *b, const struct dalcs_csr *a, int from,
                       int to, double sign) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int wave = b->wave_column[a->j[k]];
        if (wave >= 0) {
            b->eq.plain_rhs[wave * b->n + to] += sign * a->x[k];
        } else {
            b->eq.plain_rhs[b->n_x * b->n + to] +=
                sign * a->x[k] * b->stages->excitation->constant[a->j[k]];
        }
    }
}

static void list_nonzeros(struct dalcs_stage_workshop *b) {
    int n = 0;
    b->eq.nonzero_p[0] = 0;
    for (int j = 0; j < b->n; j++) {
        const double *column = b->eq.plain_base + j * b->n;
        const double *of_rates = j < b->n_x ? b->eq.plain_P + j * b->n_x : NULL;
        for (int i = 0; i < b->n; i++) {
            b->eq.nonzero_i[n] = i;
            n += column[i] != 0.0 || (of_rates != NULL && i < b->n_x && of_rates[i] != 0.0) ? 1 : 0;
        }
        b->eq.nonzero_p[j + 1] = n;
    }
}

void dalcs_workshop_fill(struct dalcs_stage_workshop *b) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    memset(b->eq.plain_base, 0, (size_t)b->n * (size_t)b->n * sizeof(double));
    memset(b->eq.plain_P, 0, (size_t)b->n_x * (size_t)b->n_x * sizeof(double));
    memset(b->eq.plain_rhs, 0, (size_t)b->n * (size_t)b->n_rhs * sizeof(double));
    place_columns(b);
    for (int r = 0; r < n_equations; r++) {
        add_row(b, &s->A, r, r, -1.0);
        add_inputs(b, &s->E, r, r, 1.0);
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        add_row(b, &s->C, b->entry->on[k], n_equations + k, 1.0);
        add_inputs(b, &s->F, b->entry->on[k], n_equations + k, -1.0);
    }
    for (int i = 0; i < b->n_x; i++) {
        for (int k = s->P.p[i]; k < s->P.p[i + 1]; k++) {
            b->eq.plain_P[s->P.j[k] * b->n_x + i] = s->P.x[k];
        }
    }
    list_nonzeros(b);
}

static void balance_rows(const struct dalcs_stage_workshop *b) {
    memset(b->eq.row_scale, 0, (size_t)b->n * sizeof(double));
    for (int j = 0; j < b->n; j++) {
        for (int k = b->eq.nonzero_p[j]; k < b->eq.nonzero_p[j + 1]; k++) {
            double *largest = &b->eq.row_scale[b->eq.nonzero_i[k]];
            *largest = dalcs_larger(b->eq.size[k] * b->eq.column_scale[j], *largest);
        }
    }
    for (int i = 0; i < b->n; i++) {
        b->eq.row_scale[i] = dalcs_stage_matrix_scale(b->eq.row_scale[i]);
    }
}

static void balance_columns(const struct dalcs_stage_workshop *b) {
    for (int j = 0; j < b->n; j++) {
        double largest = 0.0;
        for (int k = b->eq.nonzero_p[j]; k < b->eq.nonzero_p[j + 1]; k++) {
            largest = dalcs_larger(b->eq.size[k] * b->eq.row_scale[b->eq.nonzero_i[k]], largest);
        }
        b->eq.column_scale[j] = dalcs_stage_matrix_scale(largest);
    }
}

/* Those of S at the real eigenvalue. */
static void find_sizes(const struct dalcs_stage_workshop *b) {
    double sigma = b->stages->method->lambda / b->entry->h;
    for (int j = 0; j < b->n; j++) {
        for (int k = b->eq.nonzero_p[j]; k < b->eq.nonzero_p[j + 1]; k++) {
            int i = b->eq.nonzero_i[k];
            double rate = i < b->n_x && j < b->n_x ? b->eq.plain_P[j * b->n_x + i] : 0.0;
            b->eq.size[k] = fabs(b->eq.plain_base[j * b->n + i] + sigma * rate);
        }
    }
}

void dalcs_workshop_balance(struct dalcs_stage_workshop *b) {
    int n = b->n;
    for (int i = 0; i < n; i++) {
        b->eq.column_scale[i] = 1.0;
    }
    find_sizes(b);
    for (int round = 0; round < BALANCING_ROUNDS; round++) {
        balance_rows(b);
        balance_columns(b);
    }
    for (int j = 0; j < n; j++) {
        for (int k = b->eq.nonzero_p[j]; k < b->eq.nonzero_p[j + 1]; k++) {
            int i = b->eq.nonzero_i[k];
            b->eq.base[k] =
                b->eq.plain_base[j * n + i] * (b->eq.row_scale[i] * b->eq.column_scale[j]);
        }
        for (int i = 0; i < b->n_x && j < b->n_x; i++) {
            b->eq.P[j * b->n_x + i] =
                b->eq.plain_P[j * b->n_x + i] * (b->eq.row_scale[i] * b->eq.column_scale[j]);
        }
    }
    memcpy(b->entry->natural, b->eq.column_scale,
           (size_t)dalcs_system_n_equations(b->system) * sizeof(double));
    for (int j = 0; j < b->n_rhs; j++) {
        for (int i = 0; i < n; i++) {
            b->eq.rhs[j * n + i] = b->eq.plain_rhs[j * n + i] * b->eq.row_scale[i];
        }
    }
}
