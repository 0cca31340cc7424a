/* stage_matrix.c - picked from the plan, balanced, evaluated. */
#include "stage_matrix.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BALANCING_ROUNDS = 3 };

static void list_rows(struct dalcs_stage_matrix *m, const struct dalcs_stage_plan *plan,
                      const int *pair) {
    int n_equations = dalcs_stage_plan_n_equations(plan);
    for (int i = 0; i < m->n; i++) {
        m->row[i] = i < n_equations ? i : n_equations + pair[i - n_equations];
        m->column[i] = m->row[i];
    }
}

/* Row r of M, and choice r - n_rows, is row place[r] of the mode's, -1: none. */
static void place_rows(struct dalcs_stage_matrix *m, int n_rows,
                       const struct dalcs_stage_singular *choice, int *place) {
    for (int r = 0; r < n_rows + choice->n; r++) {
        place[r] = -1;
    }
    for (int i = 0; i < m->n; i++) {
        place[m->row[i]] = i;
    }
    for (int k = 0; k < choice->n; k++) {
        int at = place[choice->row[k]];
        place[choice->row[k]] = -1;
        place[n_rows + k] = at;
        m->row[at] = n_rows + k;
    }
}

/* Merges a column of the base and of P, and adds those of choices. */
static int put_column(struct dalcs_stage_matrix *m, const struct dalcs_stage_plan *plan,
                      const struct dalcs_stage_singular *choice, int c, const int *place, int out) {
    const struct dalcs_csr *b = &plan->base;
    const struct dalcs_csr *P = &plan->P;
    int k = b->p[c];
    int l = P->p[c];
    while (k < b->p[c + 1] || l < P->p[c + 1]) {
        int of_base = k < b->p[c + 1] ? b->j[k] : plan->n_rows;
        int of_P = l < P->p[c + 1] ? P->j[l] : plan->n_rows;
        int row = of_base < of_P ? of_base : of_P;
        double value = of_base == row ? b->x[k++] : 0.0;
        double rate = of_P == row ? P->x[l++] : 0.0;
        if (place[row] < 0) {
            continue;
        }
        m->i[out] = place[row];
        m->base[out] = value;
        m->P[out++] = rate;
    }
    const struct dalcs_csr *chosen = &choice->of_column;
    int end = choice->n > 0 ? chosen->p[c + 1] : 0;
    for (int e = choice->n > 0 ? chosen->p[c] : 0; e < end; e++) {
        m->i[out] = place[plan->n_rows + chosen->j[e]];
        m->base[out] = chosen->x[e];
        m->P[out++] = 0.0;
    }
    return out;
}

/* What ldexp and frexp make of it, by the bits, as this is done for all rows and columns of every
 * new mode. */
double dalcs_stage_matrix_scale(double largest) {
    uint64_t bits;
    memcpy(&bits, &largest, sizeof(bits));
    uint64_t exponent = bits >> 52;
    if (exponent - 1 >= 2044) { /* zero, denormal, infinite or nearly so */
        return 1.0;
    }
    bits = (2045 - exponent) << 52;
    memcpy(&largest, &bits, sizeof(bits));
    return largest;
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

static void balance(struct dalcs_stage_matrix *m, double sigma) {
    double *size = m->values;
    for (int k = 0; k < m->p[m->n]; k++) {
        size[k] = fabs(m->base[k] + sigma * m->P[k]);
    }
    for (int c = 0; c < m->n; c++) {
        m->column_scale[c] = 1.0;
    }
    for (int round = 0; round < BALANCING_ROUNDS; round++) {
        for (int r = 0; r < m->n; r++) {
            m->row_scale[r] = 0.0;
        }
        for (int c = 0; c < m->n; c++) {
            for (int k = m->p[c]; k < m->p[c + 1]; k++) {
                m->row_scale[m->i[k]] = larger(m->row_scale[m->i[k]], size[k] * m->column_scale[c]);
            }
        }
        for (int r = 0; r < m->n; r++) {
            m->row_scale[r] = dalcs_stage_matrix_scale(m->row_scale[r]);
        }
        for (int c = 0; c < m->n; c++) {
            double largest = 0.0;
            for (int k = m->p[c]; k < m->p[c + 1]; k++) {
                largest = larger(largest, size[k] * m->row_scale[m->i[k]]);
            }
            m->column_scale[c] = dalcs_stage_matrix_scale(largest);
        }
    }
    for (int c = 0; c < m->n; c++) {
        for (int k = m->p[c]; k < m->p[c + 1]; k++) {
            double scale = m->row_scale[m->i[k]] * m->column_scale[c];
            m->base[k] *= scale;
            m->P[k] *= scale;
        }
    }
}

static enum dalcs_status fill(struct dalcs_stage_matrix *m, const struct dalcs_stage_plan *plan,
                              const int *pair, const struct dalcs_stage_singular *choice,
                              double sigma) {
    size_t n = (size_t)m->n;
    size_t capacity = (size_t)plan->base.p[plan->n_rows] + (size_t)plan->P.p[plan->n_rows];
    if (choice->n > 0) {
        capacity += (size_t)choice->of_column.p[plan->n_rows];
    }
    int *place = dalcs_alloc((size_t)(plan->n_rows + choice->n), sizeof(*place));
    m->row = dalcs_alloc(n, sizeof(*m->row));
    m->column = dalcs_alloc(n, sizeof(*m->column));
    m->p = dalcs_alloc(n + 1, sizeof(*m->p));
    m->i = dalcs_alloc(capacity, sizeof(*m->i));
    m->base = dalcs_alloc(capacity, sizeof(double));
    m->P = dalcs_alloc(capacity, sizeof(double));
    m->values = dalcs_alloc(capacity, 2 * sizeof(double));
    m->row_scale = dalcs_alloc(n, sizeof(double));
    m->column_scale = dalcs_alloc(n, sizeof(double));
    if (place == NULL || m->row == NULL || m->column == NULL || m->p == NULL || m->i == NULL ||
        m->base == NULL || m->P == NULL || m->values == NULL || m->row_scale == NULL ||
        m->column_scale == NULL) {
        free(place);
        return DALCS_E_NOMEM;
    }
    list_rows(m, plan, pair);
    place_rows(m, plan->n_rows, choice, place);
    int out = 0;
    for (int c = 0; c < m->n; c++) {
        out = put_column(m, plan, choice, m->column[c], place, out);
        m->p[c + 1] = out;
    }
    free(place);
    balance(m, sigma);
    return DALCS_OK;
}

enum dalcs_status dalcs_stage_matrix_build(struct dalcs_stage_matrix *m,
                                           const struct dalcs_stage_plan *plan, int n_pairs,
                                           const int *pair,
                                           const struct dalcs_stage_singular *choice, double h) {
    *m = (struct dalcs_stage_matrix){.n = dalcs_stage_plan_n_equations(plan) + n_pairs,
                                     .n_pairs = n_pairs};
    enum dalcs_status status = fill(m, plan, pair, choice, plan->stages->method->lambda / h);
    if (status != DALCS_OK) {
        dalcs_stage_matrix_finish(m);
    }
    return status;
}

void dalcs_stage_matrix_at(struct dalcs_stage_matrix *m, double re, double im, bool is_complex) {
    int n_entries = m->p[m->n];
    for (int k = 0; k < n_entries; k++) {
        if (is_complex) {
            m->values[2 * k] = m->base[k] + re * m->P[k];
            m->values[2 * k + 1] = im * m->P[k];
        } else {
            m->values[k] = m->base[k] + re * m->P[k];
        }
    }
}

void dalcs_stage_matrix_finish(struct dalcs_stage_matrix *m) {
    free(m->row);
    free(m->column);
    free(m->p);
    free(m->i);
    free(m->base);
    free(m->P);
    free(m->values);
    free(m->row_scale);
    free(m->column_scale);
    *m = (struct dalcs_stage_matrix){0};
}
