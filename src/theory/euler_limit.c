/* euler_limit.c - k15, and the propositions that use it.
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
#include "euler_limit.h"

#include "coupling.h"
#include "passivity.h"
#include "step_blocks.h"

#include <math.h>

#define SOURCE(what) "Brogliato 2022, " what

struct limit {
    struct dalcs_findings *f;
    struct dalcs_arena *work;
    const struct dalcs_blocks *b;
    double h;
    const struct dalcs_limit_given *given;
};

/* ---- Norms ---------------------------------------------------------------------------------- */

/* The largest singular value. */
static enum dalcs_status norm_of(const struct dalcs_matrix *m, double *norm,
                                 struct dalcs_arena *arena) {
    int n = m->rows < m->columns ? m->rows : m->columns;
    double *value = dalcs_arena_alloc(arena, (size_t)n + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_singular_values(m, value, NULL, arena));
    *norm = n > 0 ? value[0] : 0.0;
    return DALCS_OK;
}

static enum dalcs_status norm_of_product(const struct dalcs_matrix *left,
                                         const struct dalcs_matrix *right, double *norm,
                                         struct dalcs_arena *arena) {
    struct dalcs_matrix product;
    DALCS_TRY(dalcs_matrix_product(&product, arena, left, right));
    return norm_of(&product, norm, arena);
}

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

/* ---- k15 ------------------------------------------------------------------------------------ */

struct constants {
    bool are_known;
    const char *why;  /* not */
    double k15, norm; /* 1/s; |S P_I| */
};

/* The step's matrices by D11 (pairs 1) and its zero block (pairs 2). */
struct halves {
    struct dalcs_quadruple q;
    struct dalcs_matrix S, SP;              /* S and S P_I */
    struct dalcs_matrix D1, B1, B2, C1, C2; /* of the step */
    struct dalcs_matrix L1, L2, C_I1;       /* of the model */
};

static enum dalcs_status take_halves(const struct limit *l, double h, struct halves *s,
                                     bool *are_blocks) {
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
static enum dalcs_status eliminated(const struct limit *l, const struct halves *s,
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
static enum dalcs_status add_up(const struct limit *l, const struct halves *s,
                                const struct dalcs_matrix *X, const struct dalcs_matrix *through,
                                double strength, double *k15) {
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
    DALCS_TRY(norm_of_product(&R, &m, &to_xi, work));
    DALCS_TRY(norm_of_product(&R, &s->B1, &b1, work));
    DALCS_TRY(norm_of_product(&s->C1, &inverse, &c1, work));
    DALCS_TRY(norm_of_product(&s->C_I1, &s->SP, &c_I1, work));
    if (s->D1.rows > 0) {
        DALCS_TRY(dalcs_matrix_symmetric_part(&s->D1, &smallest, &largest, work));
        smallest *= 0.5;
    }
    DALCS_TRY(eliminated(l, s, &l->b->B_I, through, &s->q.A, &half));
    DALCS_TRY(norm_of_product(&half, &inverse, &z, work));
    DALCS_TRY(eliminated(l, s, &s->L1, through, &s->B1, &half));
    DALCS_TRY(norm_of(&half, &lambda, work));
    DALCS_TRY(dalcs_matrix_product(&half, work, through, &m));
    DALCS_TRY(norm_of_product(&s->S, &half, &x, work));
    double beta = (to_xi + b1 * c_I1 / smallest) / strength;
    double ell = (c1 * beta + c_I1) / smallest;
    *k15 = z * beta + lambda * ell + x;
    return DALCS_OK;
}

static enum dalcs_status find_constants(const struct limit *l, double h, struct constants *k) {
    struct dalcs_arena *work = l->work;
    struct halves s;
    struct dalcs_matrix X;
    struct dalcs_matrix inverse;
    struct dalcs_matrix through;
    bool are_blocks;
    bool coupled;
    bool is_told;
    double strength = 0.0;
    *k = (struct constants){0};
    DALCS_TRY(take_halves(l, h, &s, &are_blocks));
    DALCS_TRY(norm_of(&s.SP, &k->norm, work));
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

/* ---- The propositions ------------------------------------------------------------------------ */

/* A6 and A7 for every h, 0 included. */
static enum dalcs_status check_12(const struct limit *l, bool *holds) {
    *holds = l->given->blocks && l->given->coupled;
    for (int k = 0; k < 5 && *holds; k++) {
        struct halves s;
        struct dalcs_matrix X;
        const char *why;
        bool coupled;
        DALCS_TRY(take_halves(l, k == 4 ? 0.0 : l->h * pow(10.0, -k), &s, holds));
        DALCS_TRY(dalcs_coupling_find(&X, &coupled, &why, &s.B2, &s.C2, l->work));
        *holds = *holds && coupled;
    }
    return dalcs_findings_condition(l->f, "A12", SOURCE("assumption 12"),
                                    "A6 and A7 for every h >= 0", dalcs_answer_of(*holds),
                                    *holds ? "at h = 0 and five steps up to the one given" : NULL);
}

/* The logarithmic norm of P_I^-1 A_I. */
static enum dalcs_status logarithmic_norm(const struct limit *l, double *mu) {
    struct dalcs_matrix rate;
    double smallest;
    DALCS_TRY(dalcs_matrix_copy(&rate, l->work, &l->b->A_I));
    DALCS_TRY(dalcs_matrix_solve(&l->b->P, &rate, l->work));
    DALCS_TRY(dalcs_matrix_symmetric_part(&rate, &smallest, mu, l->work));
    *mu *= 0.5;
    return DALCS_OK;
}

static enum dalcs_status check_13(const struct limit *l, enum dalcs_answer *answer) {
    static const char *const text = "|(P_I - h A_I)^-1 P_I| + h k15 < 1 for small h";
    struct constants at[2];
    double mu;
    DALCS_TRY(logarithmic_norm(l, &mu));
    for (int k = 0; k < 2; k++) {
        DALCS_TRY(find_constants(l, k == 0 ? 0.0 : l->h, &at[k]));
    }
    *answer = mu >= 0.0                                     ? DALCS_NO
              : !at[0].are_known                            ? DALCS_NOT_CHECKED
              : mu + at[0].k15 < -dalcs_definite * fabs(mu) ? DALCS_YES
                                                            : DALCS_UNDECIDED;
    if (mu >= 0.0) {
        return dalcs_findings_condition(
            l->f, "A13", SOURCE("assumption 13"), text, *answer,
            "the logarithmic norm of P_I^-1 A_I is %.6g 1/s, and k15 >= 0", mu);
    }
    if (!at[0].are_known) {
        return dalcs_findings_condition(l->f, "A13", SOURCE("assumption 13"), text, *answer,
                                        "there is no k15: %s", at[0].why);
    }
    if (!at[1].are_known) {
        return dalcs_findings_condition(
            l->f, "A13", SOURCE("assumption 13"), text, *answer,
            "logarithmic norm %.6g 1/s, k15 = %.6g 1/s at h = 0; none at "
            "the step given: %s",
            mu, at[0].k15, at[1].why);
    }
    return dalcs_findings_condition(
        l->f, "A13", SOURCE("assumption 13"), text, *answer,
        "logarithmic norm %.6g 1/s, k15 = %.6g 1/s at h = 0; at the step given the left side is "
        "%.6g",
        mu, at[0].k15, at[1].norm + l->h * at[1].k15);
}

/* A source that jumps is not Lipschitz; its name, or NULL. */
static const char *jumping(const struct limit *l) {
    const struct dalcs_system *s = l->b->system;
    for (int j = 0; j < s->n_inputs; j++) {
        bool may_jump = l->given->jumps == NULL || l->given->jumps[j];
        if (may_jump && s->input_element[j] != NULL) {
            return dalcs_input_name(s, j);
        }
    }
    return NULL;
}

static enum dalcs_status check_52(const struct limit *l, struct dalcs_brogliato *found) {
    const struct dalcs_limit_given *given = l->given;
    bool holds = given->uniform == DALCS_YES && given->contracts;
    found->converges_52 = !holds                   ? DALCS_NO
                          : found->jumping != NULL ? DALCS_CONDITIONAL
                                                   : DALCS_YES;
    return dalcs_findings_condition(
        l->f, "P5.2", SOURCE("proposition 5.2"),
        "A10, A11, Lipschitz sources: implicit Euler converges to a continuous solution",
        holds               ? found->converges_52
        : !given->contracts ? DALCS_NO
                            : given->uniform,
        "%s%s",
        !given->contracts                          ? "assumption 11 fails"
        : given->uniform == DALCS_NO               ? "assumption 10 fails"
        : given->uniform != DALCS_YES              ? "assumption 10 is not shown"
        : found->converges_52 == DALCS_CONDITIONAL ? "between the jumps of "
                                                   : "the sources have no jumps",
        holds && found->jumping != NULL ? found->jumping : "");
}

enum dalcs_status dalcs_euler_limit_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                          double h, const struct dalcs_limit_given *given,
                                          struct dalcs_brogliato *found) {
    const struct limit l = {.f = f, .work = f->work, .b = b, .h = h, .given = given};
    bool all;
    enum dalcs_answer bounded;
    found->jumping = jumping(&l);
    DALCS_TRY(check_52(&l, found));
    DALCS_TRY(check_12(&l, &all));
    bool strong = all && given->strength > 1.5 && given->monotone;
    DALCS_TRY(dalcs_findings_condition(
        f, "L5.4", SOURCE("lemma 5.4"), "-R2 At R2^-1 > 3/2, G2 monotone", dalcs_answer_of(strong),
        isnan(given->strength) ? NULL
        : given->monotone      ? "the least eigenvalue is %.6g"
                               : "the least eigenvalue is %.6g; G2 is not known to be monotone",
        given->strength));
    DALCS_TRY(check_13(&l, &bounded));
    bool jumps = found->jumping != NULL;
    found->converges_59 = !strong                ? DALCS_NO
                          : bounded != DALCS_YES ? bounded
                          : jumps                ? DALCS_CONDITIONAL
                                                 : DALCS_YES;
    return dalcs_findings_condition(
        f, "P5.9", SOURCE("propositions 5.6 and 5.9"),
        "lemmas 5.3 and 5.4, A12, A13, Lipschitz sources: implicit Euler converges",
        found->converges_59, "%s%s",
        !strong                ? "lemma 5.4 or assumption 12 fails"
        : bounded == DALCS_NO  ? "assumption 13 fails"
        : bounded != DALCS_YES ? "assumption 13 is not shown"
        : jumps                ? "between the jumps of "
                               : "the sources have no jumps",
        strong && bounded == DALCS_YES && jumps ? found->jumping : "");
}
