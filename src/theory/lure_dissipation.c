/* lure_dissipation.c - dissipation and rates of contraction. */
#include "lure_check.h"

#include "storage.h"

#include <math.h>
#include <string.h>

enum { MOST_CONTRACTION = 700 };

static const char no_states[] = "it has no states";
static const char not_decaying[] = "with its diodes still not all states decay";

/* 1/2 lambda_max(PA + A'P, P) */
static enum dalcs_status find_omega(const struct dalcs_lcs *l, const struct dalcs_matrix *P,
                                    double *omega, struct dalcs_arena *arena) {
    struct dalcs_matrix pa;
    struct dalcs_matrix vector;
    struct dalcs_matrix turned;
    struct dalcs_matrix left;
    struct dalcs_matrix product;
    double smallest;
    double *value = dalcs_arena_alloc(arena, (size_t)l->n + 1, sizeof(double));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_product(&pa, arena, P, &l->A));
    DALCS_TRY(dalcs_matrix_symmetric_eigen(P, value, &vector, arena));
    DALCS_TRY(dalcs_matrix_transpose(&turned, arena, &vector));
    DALCS_TRY(dalcs_matrix_product(&left, arena, &turned, &pa));
    DALCS_TRY(dalcs_matrix_product(&product, arena, &left, &vector));
    for (int j = 0; j < l->n; j++) {
        for (int i = 0; i < l->n; i++) {
            *dalcs_at(&product, i, j) /= sqrt(fmax(value[i] * value[j], 1e-300));
        }
    }
    DALCS_TRY(dalcs_matrix_symmetric_part(&product, &smallest, omega, arena));
    *omega *= 0.5;
    return DALCS_OK;
}

static enum dalcs_status try_metric(struct dalcs_lure_check *c, const struct dalcs_matrix *P,
                                    bool by_energy) {
    struct dalcs_lure *found = c->found;
    double excess;
    bool is_positive;
    if (found->is_dissipative) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_is_positive_definite(P, &is_positive, c->f->work));
    if (!is_positive) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_passivity_excess(c->l, P, 0.0, &excess, c->f->work));
    found->is_dissipative = dalcs_is_dissipative(excess);
    found->by_energy = by_energy;
    found->metric = *P;
    return dalcs_findings_condition(
        c->f, "K10", BG09 "definition 1, theorem 3",
        by_energy ? "the passivity inequality holds with the stored energy as P"
                  : "the passivity inequality holds with the P of P B = C'",
        dalcs_answer_of(found->is_dissipative), "largest eigenvalue (scaled): %.3g", excess);
}

/* All P, where the stored energy and P B = C' decide nothing. */
static enum dalcs_status try_all(struct dalcs_lure_check *c) {
    struct dalcs_lure *found = c->found;
    const struct dalcs_lcs *l = c->l;
    const struct dalcs_quadruple q = {l->A, l->B, l->C, l->D};
    struct dalcs_storage storage;
    if (found->is_dissipative || c->D_least < -dalcs_definite) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_storage_find(&q, &storage, c->f->work));
    found->is_dissipative = storage.is_found;
    found->is_refuted = storage.is_refuted;
    found->open = storage.why;
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K10", BG09 "definition 1, theorem 3",
        "some P > 0 makes the passivity inequality hold",
        storage.is_found     ? DALCS_YES
        : storage.is_refuted ? DALCS_NO
                             : DALCS_NOT_CHECKED,
        "%s",
        storage.is_found     ? "a semidefinite program found P"
        : storage.is_refuted ? "a semidefinite program found Z >= 0, which refutes every P"
                             : storage.why));
    if (storage.is_found) {
        found->by_energy = false;
        found->metric = storage.P;
        return dalcs_lure_metric_witness(c->f, l, &storage.P, false);
    }
    found->refutation = storage.Z;
    return storage.is_refuted ? dalcs_lure_refutation_witness(c->f, l, &storage.Z, false)
                              : DALCS_OK;
}

/* *eps of the metric, or a larger one of another P. */
static enum dalcs_status find_rate(struct dalcs_lure_check *c, double *eps) {
    const struct dalcs_lcs *l = c->l;
    const struct dalcs_quadruple q = {l->A, l->B, l->C, l->D};
    struct dalcs_arena *work = c->f->work;
    double *re = dalcs_arena_alloc(work, (size_t)l->n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(work, (size_t)l->n + 1, sizeof(double));
    double most = INFINITY; /* no difference of motions falls faster than the slowest mode */
    double other;
    struct dalcs_matrix P;
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_passivity_rate(l, &c->found->metric, eps, work));
    c->found->rate.metric = c->found->metric;
    DALCS_TRY(dalcs_matrix_eigen(&l->A, re, im, NULL, work));
    for (int i = 0; i < l->n; i++) {
        most = fmin(most, -2.0 * re[i]);
    }
    c->found->rate.open = l->n == 0 ? no_states : not_decaying;
    if (l->n == 0 || most <= *eps * 1.01) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_storage_rate(&q, most, &other, &P, &c->found->rate.open, work));
    if (other > *eps) {
        *eps = other;
        c->found->rate.metric = P;
    }
    return DALCS_OK;
}

/* Is there no rate, rather than none found? */
static bool has_no_rate(const struct dalcs_lure *found) {
    return found->rate.open == dalcs_no_rate || found->rate.open == not_decaying ||
           found->rate.open == no_states;
}

static enum dalcs_status check_rates(struct dalcs_lure_check *c) {
    struct dalcs_lure *found = c->found;
    found->lossless = -1;
    if (!found->is_dissipative) {
        return dalcs_findings_condition(
            c->f, "K11", BG09 "definition 2, theorem 3.2", "strictly passive: motions contract",
            found->is_refuted ? DALCS_NO : DALCS_UNDECIDED, "%s",
            found->is_refuted ? "no P makes it passive"
                              : "no P was found with which the circuit is passive");
    }
    if (c->l->n + c->l->m > MOST_CONTRACTION) {
        return dalcs_findings_condition(c->f, "K11", BG09 "definition 2, theorem 3.2",
                                        "strictly passive: motions contract", DALCS_NOT_CHECKED,
                                        "too large");
    }
    double eps;
    DALCS_TRY(find_rate(c, &eps));
    found->rate.value = 0.5 * eps;
    DALCS_TRY(find_omega(c->l, &found->rate.metric, &found->omega, c->f->work));
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K11", BG09 "definition 2, theorem 3.2", "strictly passive: motions contract",
        eps > 0.0            ? DALCS_YES
        : has_no_rate(found) ? DALCS_NO
                             : DALCS_NOT_CHECKED,
        eps > 0.0
            ? "the largest eps found is %.6g 1/s; differences fall as exp(-eps t/2) in the norm "
              "of its P"
            : "eps = %.6g 1/s for the P of K10; %s",
        eps, found->rate.open));
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K12", BG13 "assumption 5.2, (40) in the norm of P, proposition 7.3",
        "omega = 1/2 lambda_max(PA + A'P, P) < 0", dalcs_answer_of(found->omega < 0.0),
        "omega = %.6g 1/s", found->omega));
    if (eps == 0.0) {
        DALCS_TRY(dalcs_passivity_lossless(c->l, &found->metric, found->by_energy ? 1e-10 : 1e-8,
                                           &found->lossless, c->f->work));
    } else {
        found->lossless = 0;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_lure_check_dissipation(struct dalcs_lure_check *c,
                                               const struct dalcs_matrix *P) {
    DALCS_TRY(try_metric(c, &c->l->storage, true));
    if (c->found->is_coupled) {
        DALCS_TRY(try_metric(c, P, false));
    }
    DALCS_TRY(try_all(c));
    return check_rates(c);
}
