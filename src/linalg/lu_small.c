/* lu_small.c - factors of a matrix of a few rows, without an analysis: that alone takes ten times as long. */
#include "lu_internal.h"

#include "extremes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The matrix by rows, then L below its diagonal and U. */
struct dense {
    int n;
    int row[DALCS_LU_SMALL]; /* of the matrix, that is now the k-th */
    double a[DALCS_LU_SMALL][DALCS_LU_SMALL];
};

static void spread_out(struct dense *m, const struct dalcs_columns *a) {
    const int n = a->n;
    m->n = n;
    for (int r = 0; r < n; r++) {
        m->row[r] = r;
        memset(m->a[r], 0, (size_t)n * sizeof(double));
    }
    for (int c = 0; c < n; c++) {
        for (int k = a->p[c]; k < a->p[c + 1]; k++) {
            m->a[a->i[k]][c] = a->x[k];
        }
    }
}

static void swap_rows(struct dense *m, int k, int with) {
    int row = m->row[k];
    m->row[k] = m->row[with];
    m->row[with] = row;
    for (int c = 0; c < m->n; c++) {
        double a = m->a[k][c];
        m->a[k][c] = m->a[with][c];
        m->a[with][c] = a;
    }
}

/* False: a pivot is 0, or not a number. */
static bool eliminate(struct dense *m) {
    for (int k = 0; k < m->n; k++) {
        int pivot = k;
        for (int r = k + 1; r < m->n; r++) {
            pivot = fabs(m->a[r][k]) > fabs(m->a[pivot][k]) ? r : pivot;
        }
        if (!(fabs(m->a[pivot][k]) > 0.0)) {
            return false;
        }
        if (pivot != k) {
            swap_rows(m, k, pivot);
        }
        for (int r = k + 1; r < m->n; r++) {
            if (m->a[r][k] == 0.0) {
                continue;
            }
            m->a[r][k] /= m->a[k][k];
            for (int c = k + 1; c < m->n; c++) {
                m->a[r][c] -= m->a[r][k] * m->a[k][c];
            }
        }
    }
    return true;
}

static double least_over_largest(const struct dense *m) {
    double least = INFINITY;
    double largest = 0.0;
    for (int k = 0; k < m->n; k++) {
        double pivot = fabs(m->a[k][k]);
        least = dalcs_smaller(least, pivot);
        largest = dalcs_larger(largest, pivot);
    }
    return least / largest;
}

/* Row r of the matrix in columns [from, to) behind those of a triangle that are there already. */
static void append(const struct dense *m, int r, int from, int to, int *row_p, int *row_j,
                   double *row_x) {
    int out = row_p[r];
    for (int c = from; c < to; c++) {
        if (m->a[r][c] != 0.0) {
            row_j[out] = c;
            row_x[out++] = m->a[r][c];
        }
    }
    row_p[r + 1] = out;
}

enum dalcs_status dalcs_lu_factor_small(struct dalcs_lu *lu, const struct dalcs_columns *a,
                                        double apart) {
    const int n = a->n;
    struct dense m;
    *lu = (struct dalcs_lu){.n = n, .n_blocks = n > 0 ? 1 : 0};
    if (n == 0) {
        return DALCS_OK;
    }
    spread_out(&m, a);
    if (!eliminate(&m) || !(least_over_largest(&m) >= apart)) {
        *lu = (struct dalcs_lu){0};
        return DALCS_SINGULAR;
    }
    size_t half = (size_t)n * (size_t)(n - 1) / 2;
    lu->storage = malloc(dalcs_lu_lay_out(lu, half, half));
    if (lu->storage == NULL) {
        *lu = (struct dalcs_lu){0};
        return DALCS_E_NOMEM;
    }
    dalcs_lu_lay_out(lu, half, half);
    lu->lower_p[0] = lu->upper_p[0] = 0;
    lu->block[0] = 0;
    lu->block[1] = n;
    for (int r = 0; r < n; r++) {
        append(&m, r, 0, r, lu->lower_p, lu->lower_j, lu->lower_x);
        append(&m, r, r + 1, n, lu->upper_p, lu->upper_j, lu->upper_x);
        lu->pivot_inverse[r] = 1.0 / m.a[r][r];
        lu->from[r] = m.row[r];
        lu->to[r] = r;
    }
    return DALCS_OK;
}
