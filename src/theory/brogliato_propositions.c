/* brogliato_propositions.c - what rests on the assumptions: propositions 4.3 to 4.7. */
#include "brogliato_case.h"

#include <math.h>

/* Item 1: its range condition holds when Dt + Dt' > 0, or when Bt is square and regular. */
static enum dalcs_status check_431(struct dalcs_brogliato_case *c, bool is_definite) {
    int rank;
    DALCS_TRY(dalcs_matrix_rank(&c->step.B, &rank, NULL, c->f->work));
    bool is_regular = c->b->m > 0 && c->b->m == c->b->p && rank == c->b->p;
    bool passive = c->passive_step.is_passive;
    return dalcs_findings_condition(
        c->f, "P4.3.1", DALCS_BROGLIATO("proposition 4.3 item 1"),
        "A4 and a range condition: z -> -At z + Bt (..)^-1 Ct z is maximal monotone",
        !passive                    ? dalcs_brogliato_passive(&c->passive_step, false)
        : is_definite || is_regular ? DALCS_YES
                                    : DALCS_NOT_CHECKED,
        "%s",
        !passive      ? "assumption 4 is not shown"
        : is_definite ? "Dt + Dt' > 0"
        : is_regular  ? "Bt is square and regular"
                      : "the range condition depends on x and the sources");
}

enum dalcs_status dalcs_brogliato_433(struct dalcs_brogliato_case *c, bool coupled,
                                      const struct dalcs_matrix *X) {
    bool is_zero = dalcs_matrix_largest(&c->step.D) == 0.0;
    double strength = NAN;
    if (is_zero && coupled) {
        DALCS_TRY(dalcs_index_strength(&c->step.A, X, &strength, c->f->work));
    }
    double rounding = 1e-12 * dalcs_matrix_largest(&c->step.A);
    return dalcs_findings_condition(
        c->f, "P4.3.3", DALCS_BROGLIATO("proposition 4.3 item 3"),
        "Dt = 0, A2, -R At R^-1 >= 0, S of (4.6) is {0}: the step has a solution",
        !is_zero || !coupled || strength < -rounding ? DALCS_NO
        : strength > rounding                        ? DALCS_YES
                                                     : DALCS_NOT_CHECKED,
        isnan(strength) ? "the largest element of Dt is %.3g: Dt = 0 or assumption 2 fails"
                        : "the least eigenvalue of -R At R^-1 is %.3g",
        isnan(strength) ? dalcs_matrix_largest(&c->step.D) : strength);
}

enum dalcs_status dalcs_brogliato_43(struct dalcs_brogliato_case *c) {
    double least;
    double smallest;
    double largest;
    DALCS_TRY(dalcs_symmetric_part_least(&c->step.D, &least, c->f->work));
    DALCS_TRY(dalcs_matrix_symmetric_part(&c->step.D, &smallest, &largest, c->f->work));
    bool definite = c->b->m > 0 && least > dalcs_definite;
    DALCS_TRY(dalcs_findings_condition(
        c->f, "P4.3.2", DALCS_BROGLIATO("proposition 4.3 item 2"),
        "Dt + Dt' > 0: lambda is a Lipschitz function of z", dalcs_answer_of(definite),
        definite ? "Lipschitz constant 2/lambda_min(Dt + Dt') = %.6g"
                 : "the least eigenvalue of Dt + Dt' is %.3g (scaled)",
        definite ? 2.0 / smallest : least));
    DALCS_TRY(check_431(c, definite));
    bool strict = c->passive_step.is_strict;
    c->found->step_unique = strict;
    return dalcs_findings_condition(
        c->f, "C4.6.3", DALCS_BROGLIATO("corollary 4.6 item 3"),
        "(At, Bt, Ct, Dt) strictly passive: one (z, lambda), so one step",
        definite ? dalcs_brogliato_passive(&c->passive_step, strict) : DALCS_NO,
        definite ? "least eigenvalue %.3g (scaled)"
                 : "Dt + Dt' > 0 fails: its least eigenvalue is %.3g (scaled)",
        definite ? c->passive_step.margin : least);
}

/* Lemma 4.5: G2 is 0 when B1 is, monotone when X2 B1 = C1'. */
static enum dalcs_status find_monotone(const struct dalcs_brogliato_case *c,
                                       const struct dalcs_quadruple *q,
                                       const struct dalcs_matrix *X, const bool *is_second,
                                       bool *monotone) {
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix xb;
    DALCS_TRY(dalcs_matrix_product(&xb, work, X, &q->B));
    for (int j = 0; j < c->b->m && !is_second[j]; j++) {
        bool is_zero = true;
        bool matches = true;
        for (int i = 0; i < c->b->p; i++) {
            double left = *dalcs_at(&xb, i, j);
            double right = *dalcs_at(&q->C, j, i);
            is_zero = is_zero && left == 0.0;
            matches = matches && fabs(left - right) <= 1e-9 * (fabs(left) + fabs(right));
        }
        *monotone = *monotone && (is_zero || matches);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_brogliato_blocks(struct dalcs_brogliato_case *c, bool of_step, bool *blocks,
                                         bool *coupled, bool *monotone, double *strength) {
    const struct dalcs_quadruple *q = of_step ? &c->step : &c->model;
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix X;
    bool *is_second = dalcs_arena_alloc(work, (size_t)c->b->m + 1, sizeof(bool));
    if (is_second == NULL) {
        return DALCS_E_NOMEM;
    }
    *strength = NAN;
    DALCS_TRY(dalcs_block_diagonal(&q->D, blocks, is_second, work));
    DALCS_TRY(dalcs_findings_condition(
        c->f, of_step ? "A6" : "A8",
        of_step ? DALCS_BROGLIATO("assumption 6") : DALCS_BROGLIATO("assumption 8"),
        of_step ? "Dt = diag(D11, 0), D11 = D11' > 0" : "D = diag(D11, 0), D11 = D11' > 0",
        dalcs_answer_of(*blocks), NULL));
    DALCS_TRY(dalcs_brogliato_check_coupling(
        c, of_step ? "A7" : "A9",
        of_step ? DALCS_BROGLIATO("assumption 7") : DALCS_BROGLIATO("assumption 9"),
        of_step ? "some X2 > 0 has X2 Bt2 = Ct2'" : "some X2 > 0 has X2 Bbar_II2 = C_II2'", q,
        is_second, coupled, &X));
    *monotone = true;
    bool definite = false;
    if (*blocks && *coupled) {
        DALCS_TRY(dalcs_index_strength(&q->A, &X, strength, work));
        definite = *strength > 1e-12 * dalcs_matrix_largest(&q->A);
        DALCS_TRY(find_monotone(c, q, &X, is_second, monotone));
    }
    bool holds = *blocks && *coupled && definite && *monotone;
    c->found->step_unique = c->found->step_unique || (holds && of_step);
    return dalcs_findings_condition(
        c->f, of_step ? "P4.4.3" : "P4.8.3",
        of_step ? DALCS_BROGLIATO("proposition 4.4 item 3")
                : DALCS_BROGLIATO("proposition 4.8 item 3"),
        of_step ? "one z of the step: -R2 At R2^-1 > 0 and G2 monotone"
                : "one z for given x: -R2 B_II R2^-1 > 0 and G2 monotone",
        dalcs_answer_of(holds),
        !*blocks || !*coupled ? "its assumptions fail"
        : !definite           ? "the least eigenvalue of -R2 A R2^-1 is %.3g"
        : !*monotone          ? "G2 is not known to be monotone (lemma 4.5); least eigenvalue %.3g"
                              : "the least eigenvalue is %.3g",
        *strength);
}

enum dalcs_status dalcs_brogliato_qualification(struct dalcs_brogliato_case *c) {
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix C;
    bool holds;
    bool *is_second = dalcs_arena_alloc(work, (size_t)c->b->m + 1, sizeof(bool));
    int *index = dalcs_arena_alloc(work, (size_t)c->b->m + 1, sizeof(int));
    int n = 0;
    int rank;
    if (is_second == NULL || index == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_block_diagonal(&c->b->D, &holds, is_second, work));
    for (int i = 0; i < c->b->m; i++) {
        index[n] = i;
        n += is_second[i] ? 1 : 0;
    }
    DALCS_TRY(dalcs_matrix_part(&C, work, &c->b->C_II, n, index, 0, NULL));
    DALCS_TRY(dalcs_matrix_rank(&C, &rank, NULL, work));
    bool is_zero = dalcs_matrix_largest(&C) == 0.0;
    return dalcs_findings_condition(
        c->f, "P4.8.1", DALCS_BROGLIATO("propositions 4.7 and 4.8 item 1"),
        "Im(C_II2) meets K2 - C_I2 x - F2",
        n == 0 || (rank == n && !is_zero) ? DALCS_YES : DALCS_CONDITIONAL,
        n == 0 || (rank == n && !is_zero) ? "for all x and sources: C_II2 has full row rank"
        : is_zero ? "C_II2 = 0: only while C_I2 x + F2 >= 0, which the step does not ensure"
                  : "C_II2 lacks full row rank: it depends on x and the sources");
}

enum dalcs_status dalcs_brogliato_47(struct dalcs_brogliato_case *c, bool D_is_zero, bool coupled,
                                     const struct dalcs_matrix *X) {
    double strength = NAN;
    if (D_is_zero && coupled) {
        DALCS_TRY(dalcs_index_strength(&c->b->B_II, X, &strength, c->f->work));
    }
    bool holds = D_is_zero && coupled && strength > 1e-12 * dalcs_matrix_largest(&c->b->B_II);
    return dalcs_findings_condition(c->f, "P4.7.1", DALCS_BROGLIATO("proposition 4.7 item 1"),
                                    "D = 0, A3, -R B_II R^-1 > 0: one z for given x",
                                    dalcs_answer_of(holds),
                                    !D_is_zero ? "D is not 0"
                                    : !coupled ? "assumption 3 fails"
                                               : "the least eigenvalue of -R B_II R^-1 is %.3g",
                                    strength);
}

enum dalcs_status dalcs_brogliato_name_algebraic(struct dalcs_brogliato_case *c) {
    c->z_name = dalcs_arena_alloc(c->f->work, (size_t)c->b->p + 1, sizeof(*c->z_name));
    if (c->z_name == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->b->p; k++) {
        c->z_name[k] = dalcs_column_name(c->b->system, c->b->z_column[k], c->f->result);
        if (c->z_name[k] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}
