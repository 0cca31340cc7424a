/* coupling.c - P B = C'. */
#include "coupling.h"

#include <math.h>

static const double tolerance = 1e-9;

/* The state in units in which row i of B and column i of C are of one size: the metric that a
 * diagonal P would give. */
static double unit_of(const struct dalcs_matrix *B, const struct dalcs_matrix *C, int i) {
    double b = 0.0;
    double c = 0.0;
    for (int j = 0; j < B->columns; j++) {
        b = fmax(b, fabs(*dalcs_at(B, i, j)));
        c = fmax(c, fabs(*dalcs_at(C, j, i)));
    }
    return b > 0.0 && c > 0.0 ? sqrt(c / b) : 1.0;
}

static void scale(struct dalcs_matrix *m, bool by_rows, const double *unit, bool inverse) {
    for (int j = 0; j < m->columns; j++) {
        for (int i = 0; i < m->rows; i++) {
            double u = unit[by_rows ? i : j];
            *dalcs_at(m, i, j) *= inverse ? 1.0 / u : u;
        }
    }
}

/* (C B)^+ of a symmetric C B, from its eigenvalues. */
static enum dalcs_status pseudo_inverse(struct dalcs_matrix *inverse, const struct dalcs_matrix *cb,
                                        const double *value, const struct dalcs_matrix *vector,
                                        struct dalcs_arena *arena) {
    int m = cb->rows;
    double largest = m > 0 ? fmax(fabs(value[0]), fabs(value[m - 1])) : 0.0;
    DALCS_TRY(dalcs_matrix_new(inverse, arena, m, m));
    for (int k = 0; k < m; k++) {
        if (value[k] > tolerance * largest) {
            for (int j = 0; j < m; j++) {
                for (int i = 0; i < m; i++) {
                    *dalcs_at(inverse, i, j) +=
                        *dalcs_at(vector, i, k) * *dalcs_at(vector, j, k) / value[k];
                }
            }
        }
    }
    return DALCS_OK;
}

/* What C B alone refuses; NULL: nothing. */
static const char *refusal(const struct dalcs_matrix *cb, const double *value) {
    int m = cb->rows;
    double largest = dalcs_matrix_largest(cb);
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < j; i++) {
            if (fabs(*dalcs_at(cb, i, j) - *dalcs_at(cb, j, i)) > tolerance * largest) {
                return "C B is not symmetric";
            }
        }
    }
    return m > 0 && value[0] < -tolerance * largest ? "C B has a negative eigenvalue" : NULL;
}

static enum dalcs_status build(struct dalcs_matrix *P, const struct dalcs_matrix *inverse,
                               const struct dalcs_matrix *B, const struct dalcs_matrix *C,
                               struct dalcs_arena *arena) {
    struct dalcs_matrix transposed;
    struct dalcs_matrix null;
    struct dalcs_matrix part;
    int rank;
    DALCS_TRY(dalcs_matrix_transpose(&transposed, arena, C));
    DALCS_TRY(dalcs_matrix_product(&part, arena, &transposed, inverse));
    DALCS_TRY(dalcs_matrix_product(P, arena, &part, C));
    DALCS_TRY(dalcs_matrix_transpose(&transposed, arena, B));
    DALCS_TRY(dalcs_matrix_rank(&transposed, &rank, &null, arena));
    double size = dalcs_matrix_largest(P);
    for (int k = 0; k < null.columns; k++) {
        for (int j = 0; j < P->rows; j++) {
            for (int i = 0; i < P->rows; i++) {
                *dalcs_at(P, i, j) +=
                    (size > 0.0 ? size : 1.0) * *dalcs_at(&null, i, k) * *dalcs_at(&null, j, k);
            }
        }
    }
    return DALCS_OK;
}

/* P B = C' and P > 0 to rounding. */
static enum dalcs_status verify(bool *holds, const struct dalcs_matrix *P,
                                const struct dalcs_matrix *B, const struct dalcs_matrix *C,
                                struct dalcs_arena *arena) {
    struct dalcs_matrix residual;
    double smallest;
    double largest;
    DALCS_TRY(dalcs_matrix_product(&residual, arena, P, B));
    for (int j = 0; j < B->columns; j++) {
        for (int i = 0; i < B->rows; i++) {
            *dalcs_at(&residual, i, j) -= *dalcs_at(C, j, i);
        }
    }
    DALCS_TRY(dalcs_matrix_symmetric_part(P, &smallest, &largest, arena));
    *holds = dalcs_matrix_largest(&residual) <= 1e-7 * dalcs_matrix_largest(C) &&
             (P->rows == 0 || smallest > 1e-12 * largest);
    return DALCS_OK;
}

/* Have B, C and C B one rank? */
static enum dalcs_status compare_ranks(const struct dalcs_matrix *cb, const struct dalcs_matrix *B,
                                       const struct dalcs_matrix *C, bool *is_one,
                                       struct dalcs_arena *arena) {
    int rank[3];
    DALCS_TRY(dalcs_matrix_rank(cb, &rank[0], NULL, arena));
    DALCS_TRY(dalcs_matrix_rank(B, &rank[1], NULL, arena));
    DALCS_TRY(dalcs_matrix_rank(C, &rank[2], NULL, arena));
    if (dalcs_matrix_largest(cb) <= tolerance * dalcs_matrix_largest(B) * dalcs_matrix_largest(C)) {
        rank[0] = 0; /* what products that cancel leave */
    }
    *is_one = rank[0] == rank[1] && rank[0] == rank[2];
    return DALCS_OK;
}

enum dalcs_status dalcs_coupling_find(struct dalcs_matrix *P, bool *holds, const char **why,
                                      const struct dalcs_matrix *given_B,
                                      const struct dalcs_matrix *given_C,
                                      struct dalcs_arena *arena) {
    int n = given_B->rows;
    int m = given_B->columns;
    struct dalcs_matrix B;
    struct dalcs_matrix C;
    struct dalcs_matrix cb;
    struct dalcs_matrix vector;
    struct dalcs_matrix inverse;
    double *unit = dalcs_arena_alloc(arena, (size_t)n + 1, sizeof(double));
    double *value = dalcs_arena_alloc(arena, (size_t)m + 1, sizeof(double));
    *holds = false;
    *why = NULL;
    if (unit == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_copy(&B, arena, given_B));
    DALCS_TRY(dalcs_matrix_copy(&C, arena, given_C));
    for (int i = 0; i < n; i++) {
        unit[i] = unit_of(&B, &C, i);
    }
    scale(&B, true, unit, false);
    scale(&C, false, unit, true);
    DALCS_TRY(dalcs_matrix_product(&cb, arena, &C, &B));
    DALCS_TRY(dalcs_matrix_symmetric_eigen(&cb, value, &vector, arena));
    *why = refusal(&cb, value);
    if (*why != NULL) {
        return DALCS_OK;
    }
    bool is_one;
    DALCS_TRY(compare_ranks(&cb, &B, &C, &is_one, arena));
    if (!is_one) {
        *why = "C B has not the rank of B and of C";
        return DALCS_OK;
    }
    DALCS_TRY(pseudo_inverse(&inverse, &cb, value, &vector, arena));
    DALCS_TRY(build(P, &inverse, &B, &C, arena));
    DALCS_TRY(verify(holds, P, &B, &C, arena));
    *why = *holds ? NULL : "the P that C B gives does not verify";
    scale(P, true, unit, false);
    scale(P, false, unit, false);
    return DALCS_OK;
}
