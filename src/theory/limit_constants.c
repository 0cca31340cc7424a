/* limit_constants.c - k15 of Brogliato 2022.
 *
 * The proof of proposition 5.6 takes two steps of (5.25) apart,
 *     |x_{k+1} - x_{p+1}| <= (|S P_I| + h k15) |x_k - x_p| + h k16 |t_k - t_p| + h k17,   S = (P_I - h A_I)^-1,
 * and names its constants without giving them. The Lipschitz constants of sources are in k16 and k17;
 * k15 is made of matrices alone. With R R = X2, s the least eigenvalue of -R At R^-1, d that of Dt11:
 *     |xi_{k+1} - xi_{p+1}| <= beta |x_k - x_p|,   beta = (|R A_II S P_I| + |R Bt1| |C_I1 S P_I|/d)/s
 *     |lambda1 ...|         <= ell |x_k - x_p|,    ell = (|Ct1 R^-1| beta + |C_I1 S P_I|)/d
 *     lambda2 = -Bt2^+ (At z + Bt1 lambda1 + A_II S P_I x + ...)     where Bt2 has full column rank
 * (the first from (5.18) by Cauchy and Schwarz, where the paper's Young asks for 3/2 more of s), so
 *     k15 = |S (B_I - L Bt2^+ At) R^-1| beta + |S (Bbar_I1 - L Bt2^+ Bt1)| ell + |S L Bt2^+ A_II S P_I|,
 * L = Bbar_I2. |S P_I| = 1 + h mu + O(h^2) with mu the logarithmic norm of P_I^-1 A_I: assumption 13
 * asks for mu + k15 < 0 at h = 0. */
#include "limit_constants.h"

#include "coupling.h"

#include <math.h>

/* R and R^-1, symmetric, of X > 0. */
static enum dalcs_status roots(const struct dalcs_matrix *X, struct dalcs_matrix *R,
                               struct dalcs_matrix *inverse, struct dalcs_arena *arena) {
    struct dalcs_matrix vector;
    int n = X->rows;
    double *value = dalcs_arena_alloc(arena, (size_t)n + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_symmetric_eigen(X, value, &vector, arena));
    DALCS_TRY(dalcs_matrix_new(R, arena, n, n));
    DALCS_TRY(dalcs_matrix_new(inverse, arena, n, n));
    for (int k = 0; k < n; k++) {
        for (int j = 0; j < n; j++) {
            for (int i = 0; i < n; i++) {
                double part = *dalcs_at(&vector, i, k) * *dalcs_at(&vector, j, k);
                *dalcs_at(R, i, j) += part * sqrt(fmax(value[k], 0.0));
                *dalcs_at(inverse, i, j) += part / sqrt(fmax(value[k], 1e-300));
            }
        }
    }
    return DALCS_OK;
}

/* B^+ of full column rank; false otherwise. */
static enum dalcs_status left_inverse(const struct dalcs_matrix *B, bool *exists,
                                      struct dalcs_matrix *inverse, struct dalcs_arena *arena) {
    struct dalcs_matrix gram;
    int rank;
    DALCS_TRY(dalcs_matrix_rank(B, &rank, NULL, arena));
    *exists = B->columns == 0 || (rank == B->columns && dalcs_matrix_largest(B) > 0.0);
    DALCS_TRY(dalcs_matrix_transpose(inverse, arena, B));
    if (!*exists) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_matrix_product(&gram, arena, inverse, B));
    return dalcs_matrix_solve(&gram, inverse, arena);
}

enum dalcs_status dalcs_limit_take_halves(const struct dalcs_limit_case *l, double h,
                                          struct dalcs_limit_halves *s, bool *are_blocks) {
    const struct dalcs_blocks *b = l->b;
    struct dalcs_arena *work = l->work;
    struct dalcs_matrix step;
    bool *is_second = dalcs_arena_alloc(work, (size_t)b->m + 1, sizeof(bool));
    int *all = dalcs_arena_alloc(work, (size_t)(b->n + b->p) + 1, sizeof(int));
    int *index[2] = {dalcs_arena_alloc(work, (size_t)b->m + 1, sizeof(int)),
                     dalcs_arena_alloc(work, (size_t)b->m + 1, sizeof(int))};
    int n[2] = {0, 0};
    if (is_second == NULL || all == NULL || index[0] == NULL || index[1] == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_step_quadruple(&s->q, b, h, work));
    DALCS_TRY(dalcs_block_diagonal(&s->q.D, are_blocks, is_second, work));
    for (int i = 0; i < b->m; i++) {
        index[is_second[i]][n[is_second[i]]++] = i;
    }
    for (int i = 0; i < b->n + b->p; i++) {
        all[i] = i;
    }
    DALCS_TRY(dalcs_matrix_part(&s->D1, work, &s->q.D, n[0], index[0], n[0], index[0]));
    DALCS_TRY(dalcs_matrix_part(&s->B1, work, &s->q.B, b->p, all, n[0], index[0]));
    DALCS_TRY(dalcs_matrix_part(&s->B2, work, &s->q.B, b->p, all, n[1], index[1]));
    DALCS_TRY(dalcs_matrix_part(&s->C1, work, &s->q.C, n[0], index[0], b->p, all));
    DALCS_TRY(dalcs_matrix_part(&s->C2, work, &s->q.C, n[1], index[1], b->p, all));
    DALCS_TRY(dalcs_matrix_part(&s->L1, work, &b->L_I, b->n, all, n[0], index[0]));
    DALCS_TRY(dalcs_matrix_part(&s->L2, work, &b->L_I, b->n, all, n[1], index[1]));
    DALCS_TRY(dalcs_matrix_part(&s->C_I1, work, &b->C_I, n[0], index[0], b->n, all));
    DALCS_TRY(dalcs_matrix_copy(&step, work, &b->P));
    dalcs_matrix_add(&step, -h, &b->A_I);
    DALCS_TRY(dalcs_matrix_new(&s->S, work, b->n, b->n));
    for (int i = 0; i < b->n; i++) {
        *dalcs_at(&s->S, i, i) = 1.0;
    }
    DALCS_TRY(dalcs_matrix_solve(&step, &s->S, work));
    return dalcs_matrix_product(&s->SP, work, &s->S, &b->P);
}

/* *sum = S (base - through of), the way over lambda2. */
static enum dalcs_status eliminated(const struct dalcs_limit_case *l,
                                    const struct dalcs_limit_halves *s,
                                    const struct dalcs_matrix *base,
                                    const struct dalcs_matrix *through,
                                    const struct dalcs_matrix *of, struct dalcs_matrix *sum) {
    struct dalcs_matrix way;
    struct dalcs_matrix rest;
    DALCS_TRY(dalcs_matrix_product(&way, l->work, through, of));
    DALCS_TRY(dalcs_matrix_copy(&rest, l->work, base));
    dalcs_matrix_add(&rest, -1.0, &way);
    return dalcs_matrix_product(sum, l->work, &s->S, &rest);
}

/* Every norm that k15 is made of. */
static enum dalcs_status add_up(const struct dalcs_limit_case *l,
                                const struct dalcs_limit_halves *s, const struct dalcs_matrix *X,
                                const struct dalcs_matrix *through, double strength, double *k15) {
    struct dalcs_arena *work = l->work;
    struct dalcs_matrix R;
    struct dalcs_matrix inverse;
    struct dalcs_matrix m;
    struct dalcs_matrix half;
    double to_xi;
    double b1;
    double c1;
    double c_I1;
    double z;
    double lambda;
    double x;
    double smallest = 1.0;
    double largest;
    DALCS_TRY(roots(X, &R, &inverse, work));
    DALCS_TRY(dalcs_matrix_product(&m, work, &l->b->A_II, &s->SP));
    DALCS_TRY(dalcs_limit_norm_of_product(&R, &m, &to_xi, work));
    DALCS_TRY(dalcs_limit_norm_of_product(&R, &s->B1, &b1, work));
    DALCS_TRY(dalcs_limit_norm_of_product(&s->C1, &inverse, &c1, work));
    DALCS_TRY(dalcs_limit_norm_of_product(&s->C_I1, &s->SP, &c_I1, work));
    if (s->D1.rows > 0) {
        DALCS_TRY(dalcs_matrix_symmetric_part(&s->D1, &smallest, &largest, work));
        smallest *= 0.5;
    }
    DALCS_TRY(eliminated(l, s, &l->b->B_I, through, &s->q.A, &half));
    DALCS_TRY(dalcs_limit_norm_of_product(&half, &inverse, &z, work));
    DALCS_TRY(eliminated(l, s, &s->L1, through, &s->B1, &half));
    DALCS_TRY(dalcs_limit_norm(&half, &lambda, work));
    DALCS_TRY(dalcs_matrix_product(&half, work, through, &m));
    DALCS_TRY(dalcs_limit_norm_of_product(&s->S, &half, &x, work));
    double beta = (to_xi + b1 * c_I1 / smallest) / strength;
    double ell = (c1 * beta + c_I1) / smallest;
    *k15 = z * beta + lambda * ell + x;
    return DALCS_OK;
}

enum dalcs_status dalcs_limit_find_constants(const struct dalcs_limit_case *l, double h,
                                             struct dalcs_limit_constants *k) {
    struct dalcs_arena *work = l->work;
    struct dalcs_limit_halves s;
    struct dalcs_matrix X;
    struct dalcs_matrix inverse;
    struct dalcs_matrix through;
    bool are_blocks;
    bool coupled;
    bool is_told;
    double strength = 0.0;
    *k = (struct dalcs_limit_constants){0};
    DALCS_TRY(dalcs_limit_take_halves(l, h, &s, &are_blocks));
    DALCS_TRY(dalcs_limit_norm(&s.SP, &k->norm, work));
    DALCS_TRY(dalcs_coupling_find(&X, &coupled, &k->why, &s.B2, &s.C2, work));
    if (!are_blocks || !coupled) {
        k->why = "assumption 12 fails";
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_index_strength(&s.q.A, &X, &strength, work));
    DALCS_TRY(left_inverse(&s.B2, &is_told, &inverse, work));
    if (strength <= 0.0 || (!is_told && dalcs_matrix_largest(&s.L2) > 0.0)) {
        k->why = strength <= 0.0
                     ? "-R2 At R2^-1 > 0 fails"
                     : "x depends on multipliers that z does not determine: Bt2 lacks full "
                       "column rank";
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_matrix_product(&through, work, &s.L2, &inverse));
    enum dalcs_status status = add_up(l, &s, &X, &through, strength, &k->k15);
    k->are_known = status == DALCS_OK;
    k->why = "its numbers are too far apart";
    return status == DALCS_SINGULAR ? DALCS_OK : status;
}
