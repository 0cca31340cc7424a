/* whole_solve.c - answers of a mode with the states kept, refined. */
#include "whole.h"

#include "osnsp_internal.h"

#include <string.h>

/* Each gains the digits that the factors have; two more than a condition of 1e12 asks for. */
enum { REFINEMENTS = 4 };

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
