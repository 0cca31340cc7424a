/* euler_limit.c - propositions that use k15 (limit_constants.c). */
#include "limit_constants.h"

#include "coupling.h"

#include <math.h>

#define SOURCE(what) "Brogliato 2022, " what

/* ---- Norms ---------------------------------------------------------------------------------- */

enum dalcs_status dalcs_limit_norm(const struct dalcs_matrix *m, double *norm,
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

enum dalcs_status dalcs_limit_norm_of_product(const struct dalcs_matrix *left,
                                              const struct dalcs_matrix *right, double *norm,
                                              struct dalcs_arena *arena) {
    struct dalcs_matrix product;
    DALCS_TRY(dalcs_matrix_product(&product, arena, left, right));
    return dalcs_limit_norm(&product, norm, arena);
}

/* ---- The propositions ------------------------------------------------------------------------ */

/* A6 and A7 for every h, 0 included. */
static enum dalcs_status check_12(const struct dalcs_limit_case *l, bool *holds) {
    *holds = l->given->blocks && l->given->coupled;
    for (int k = 0; k < 5 && *holds; k++) {
        struct dalcs_limit_halves s;
        struct dalcs_matrix X;
        const char *why;
        bool coupled;
        DALCS_TRY(dalcs_limit_take_halves(l, k == 4 ? 0.0 : l->h * pow(10.0, -k), &s, holds));
        DALCS_TRY(dalcs_coupling_find(&X, &coupled, &why, &s.B2, &s.C2, l->work));
        *holds = *holds && coupled;
    }
    return dalcs_findings_condition(l->f, "A12", SOURCE("assumption 12"),
                                    "A6 and A7 for every h >= 0", dalcs_answer_of(*holds),
                                    *holds ? "at h = 0 and five steps up to the one given" : NULL);
}

/* The logarithmic norm of P_I^-1 A_I. */
static enum dalcs_status logarithmic_norm(const struct dalcs_limit_case *l, double *mu) {
    struct dalcs_matrix rate;
    double smallest;
    DALCS_TRY(dalcs_matrix_copy(&rate, l->work, &l->b->A_I));
    DALCS_TRY(dalcs_matrix_solve(&l->b->P, &rate, l->work));
    DALCS_TRY(dalcs_matrix_symmetric_part(&rate, &smallest, mu, l->work));
    *mu *= 0.5;
    return DALCS_OK;
}

static enum dalcs_status check_13(const struct dalcs_limit_case *l, enum dalcs_answer *answer) {
    static const char *const text = "|(P_I - h A_I)^-1 P_I| + h k15 < 1 for small h";
    struct dalcs_limit_constants at[2];
    double mu;
    DALCS_TRY(logarithmic_norm(l, &mu));
    for (int k = 0; k < 2; k++) {
        DALCS_TRY(dalcs_limit_find_constants(l, k == 0 ? 0.0 : l->h, &at[k]));
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
static const char *jumping(const struct dalcs_limit_case *l) {
    const struct dalcs_system *s = l->b->system;
    for (int j = 0; j < s->n_inputs; j++) {
        bool may_jump = l->given->jumps == NULL || l->given->jumps[j];
        if (may_jump && s->input_element[j] != NULL) {
            return dalcs_input_name(s, j);
        }
    }
    return NULL;
}

static enum dalcs_status check_52(const struct dalcs_limit_case *l, struct dalcs_brogliato *found) {
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
    const struct dalcs_limit_case l = {.f = f, .work = f->work, .b = b, .h = h, .given = given};
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
