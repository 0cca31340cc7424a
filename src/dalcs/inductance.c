/* inductance.c - rank-revealing split of coupled coils by pivoted Cholesky (LAPACK dpstrf) of the
 * matrix of coupling factors, whose diagonal is 1 so that the rank decision has no units. */
#include "inductance.h"

#include "rounding.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static double coupling(const double *L, int n, int i, int j) {
    return i == j ? 1.0 : L[i * n + j] / sqrt(L[i * n + i] * L[j * n + j]);
}

/* What dpstrf left out must vanish; a negative remainder is a coupling no coils can have. */
static bool vanishes(const struct dalcs_inductance *group, const double *L, const double *U) {
    const int n = group->n;
    bool vanishes = true;
    for (int a = group->rank; a < n; a++) {
        for (int b = group->rank; b < n; b++) {
            double rest = coupling(L, n, group->coil[a], group->coil[b]);
            for (int k = 0; k < group->rank; k++) {
                rest -= U[k * n + a] * U[k * n + b];
            }
            vanishes = vanishes && !(fabs(rest) > 1e-10);
        }
    }
    return vanishes;
}

/* N = U_II^-1 U_IJ for unit coils, by back substitution, then scaled by sqrt(L_J / L_I). */
static void find_ratio(struct dalcs_inductance *group, const double *L, const double *U) {
    const int n = group->n;
    const int rank = group->rank;
    const int n_dependent = n - rank;
    for (int b = 0; b < n_dependent; b++) {
        for (int i = rank - 1; i >= 0; i--) {
            double sum = U[i * n + rank + b];
            for (int k = i + 1; k < rank; k++) {
                sum -= U[i * n + k] * group->ratio[k * n_dependent + b];
            }
            group->ratio[i * n_dependent + b] = sum / U[i * n + i];
        }
    }
    for (int i = 0; i < rank; i++) {
        int ci = group->coil[i];
        for (int b = 0; b < n_dependent; b++) {
            int cj = group->coil[rank + b];
            group->ratio[i * n_dependent + b] *= sqrt(L[cj * n + cj] / L[ci * n + ci]);
        }
    }
}

/* U[n][n] and pivot[n] are work. */
static enum dalcs_status split(struct dalcs_inductance *group, const double *L, double *U,
                               lapack_int *pivot, bool *valid) {
    const int n = group->n;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            U[i * n + j] = coupling(L, n, i, j);
        }
    }
    lapack_int rank = 0;
    lapack_int info =
        LAPACKE_dpstrf(LAPACK_ROW_MAJOR, 'U', n, U, n, pivot, &rank, dalcs_answer_rounded);
    if (info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR) {
        return DALCS_E_NOMEM;
    }
    if (info < 0) { /* no numbers: inductances whose product leaves the range of doubles */
        *valid = false;
        return DALCS_OK;
    }
    group->rank = rank;
    for (int i = 0; i < n; i++) {
        group->coil[i] = pivot[i] - 1;
    }
    *valid = vanishes(group, L, U);
    group->ratio = dalcs_alloc((size_t)n * (size_t)n, sizeof(*group->ratio));
    if (group->ratio == NULL) {
        return DALCS_E_NOMEM;
    }
    find_ratio(group, L, U);
    return DALCS_OK;
}

enum dalcs_status dalcs_inductance_split(struct dalcs_inductance *group, int n, const double *L,
                                         bool *valid) {
    *group = (struct dalcs_inductance){.n = n};
    *valid = true;
    size_t order = (size_t)n;
    double *U = dalcs_alloc(order * order, sizeof(*U));
    lapack_int *pivot = dalcs_alloc(order, sizeof(*pivot));
    group->coil = dalcs_alloc(order, sizeof(*group->coil));
    const bool has_room = U != NULL && pivot != NULL && group->coil != NULL;
    enum dalcs_status status = has_room ? split(group, L, U, pivot, valid) : DALCS_E_NOMEM;
    free(U);
    free(pivot);
    if (status != DALCS_OK) {
        dalcs_inductance_finish(group);
    }
    return status;
}

void dalcs_inductance_finish(struct dalcs_inductance *group) {
    free(group->coil);
    free(group->ratio);
    *group = (struct dalcs_inductance){0};
}
