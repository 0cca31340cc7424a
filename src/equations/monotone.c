/* monotone.c - is the OSNSP of a system monotone for every step?
 *
 * With its rows in the order of their duals, the problem's matrix is sigma (P 0; 0 0) + N, where N is
 * (-A; C). Where the symmetric parts of P and N are positive semidefinite, it is monotone for every
 * sigma >= 0: solvable if and only if feasible (Cottle, Pang and Stone 1992, thm 3.1.2). That is not
 * necessary: a circuit of passive elements is monotone although its rows, of which some stand for whole
 * trees of capacitors, need not show it. What a file says of itself is believed; it decides how a step
 * is solved, and what is certified of an answer does not depend on it. */
#include "reading.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Columns up to which eigenvalues are worked out. */
enum { MOST_COLUMNS = 500 };

/* A least eigenvalue above minus this part of the largest is 0. */
static const double rounding = 1e-13;

/* The least eigenvalue of the symmetric part of m[n][n], row by row, over the largest; m is
 * overwritten. */
static enum dalcs_status find_least(double *m, size_t n, double *least) {
    double *eigenvalue = dalcs_alloc(n, sizeof *eigenvalue);
    if (eigenvalue == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < i; j++) {
            double mean = 0.5 * m[i * n + j] + 0.5 * m[j * n + i];
            m[i * n + j] = m[j * n + i] = mean;
        }
    }
    /* A congruence by powers of 2 changes no sign, and makes farads and ohms comparable. */
    for (size_t i = 0; i < n; i++) {
        int power;
        double scale =
            m[i * n + i] > 0.0 ? ldexp(1.0, -(frexp(m[i * n + i], &power), power / 2)) : 1.0;
        for (size_t j = 0; j < n; j++) {
            m[i * n + j] *= scale;
            m[j * n + i] *= scale;
        }
    }
    enum dalcs_status status = DALCS_OK;
    *least = 0.0;
    if (n > 0) {
        lapack_int info =
            LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'L', (lapack_int)n, m, (lapack_int)n, eigenvalue);
        status = info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR
                     ? DALCS_E_NOMEM
                     : DALCS_OK;
        double largest = fmax(fabs(eigenvalue[0]), fabs(eigenvalue[n - 1]));
        *least = info != 0 ? -1.0 : largest > 0.0 ? eigenvalue[0] / largest : 0.0;
    }
    free(eigenvalue);
    return status;
}

static void add_row(double *m, size_t n, int row, const struct dalcs_csr *from, int i,
                    double factor) {
    for (int k = from->p[i]; k < from->p[i + 1]; k++) {
        m[(size_t)row * n + (size_t)from->j[k]] += factor * from->x[k];
    }
}

enum dalcs_status dalcs_system_prove_monotone(struct dalcs_system *s, enum dalcs_claim claim) {
    size_t n = (size_t)dalcs_system_n_columns(s);
    int n_equations = dalcs_system_n_equations(s);
    s->monotone = claim == DALCS_CLAIM_YES;
    if (n > MOST_COLUMNS || claim != DALCS_CLAIM_NOTHING) {
        return DALCS_OK;
    }
    double *N = dalcs_alloc(n * n, sizeof *N);
    double *P = dalcs_alloc(n * n, sizeof *P);
    enum dalcs_status status = N == NULL || P == NULL ? DALCS_E_NOMEM : DALCS_OK;
    double least[2] = {-1.0, -1.0};
    if (status == DALCS_OK) {
        for (int r = 0; r < n_equations; r++) {
            add_row(N, n, s->dual[r], &s->A, r, -1.0);
        }
        for (int r = 0; r < s->n_x; r++) {
            add_row(P, n, s->dual[r], &s->P, r, 1.0);
        }
        for (int d = 0; d < s->n_pairs; d++) {
            add_row(N, n, n_equations + d, &s->C, d, 1.0);
        }
        status = find_least(P, n, &least[0]);
    }
    if (status == DALCS_OK) {
        status = find_least(N, n, &least[1]);
    }
    s->monotone = least[0] >= -rounding && least[1] >= -rounding;
    free(N);
    free(P);
    return status;
}
