/* lure.c - P B = C', block-diagonal, semidefinite and P-matrix D. */
#include "lure_check.h"

#include "coupling.h"
#include "storage.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MOST_MINORS = 14, MOST_WITNESS = 40 };

static enum dalcs_status name_states(const struct dalcs_lure_check *c, const char ***names) {
    *names = dalcs_arena_alloc(c->f->work, (size_t)c->l->n + 1, sizeof(**names));
    for (int i = 0; *names != NULL && i < c->l->n; i++) {
        (*names)[i] = dalcs_lcs_state_name(c->l, i, c->f->result);
        if ((*names)[i] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return *names == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_lure_metric_witness(struct dalcs_findings *f, const struct dalcs_lcs *l,
                                            const struct dalcs_matrix *P, bool of_verdict) {
    const struct dalcs_lure_check c = {.f = f, .l = l};
    const char **names;
    struct dalcs_evidence w;
    if (l->n == 0 || l->n > MOST_WITNESS) {
        return DALCS_OK;
    }
    DALCS_TRY(name_states(&c, &names));
    DALCS_TRY(dalcs_evidence_matrix(&w, f, "P", P, names));
    return dalcs_findings_witness(f, of_verdict, &w);
}

enum dalcs_status dalcs_lure_refutation_witness(struct dalcs_findings *f, const struct dalcs_lcs *l,
                                                const struct dalcs_matrix *Z, bool of_verdict) {
    const char **names = dalcs_arena_alloc(f->work, (size_t)(l->n + l->m) + 1, sizeof(*names));
    struct dalcs_evidence w;
    if (names == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < l->n + l->m; i++) {
        names[i] = i < l->n ? dalcs_lcs_state_name(l, i, f->result)
                            : dalcs_lcs_u_name(l, i - l->n, f->result);
        if (names[i] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    DALCS_TRY(dalcs_evidence_matrix(&w, f, "Z", Z, names));
    return dalcs_findings_witness(f, of_verdict, &w);
}

/* ---- D -------------------------------------------------------------------------------------- */

/* All principal minors positive? Of at most MOST_MINORS rows; a positive definite one is. */
static enum dalcs_status is_P_matrix(const struct dalcs_matrix *D, bool *is, bool *is_known,
                                     struct dalcs_arena *arena) {
    double least;
    DALCS_TRY(dalcs_symmetric_part_least(D, &least, arena));
    *is = least > dalcs_definite;
    *is_known = *is || D->rows <= MOST_MINORS;
    if (*is || !*is_known) {
        return DALCS_OK;
    }
    double *work = dalcs_arena_alloc(arena, (size_t)D->rows * (size_t)D->rows + 1, sizeof(*work));
    if (work == NULL) {
        return DALCS_E_NOMEM;
    }
    *is = true;
    for (uint32_t on = 1; *is && on < (uint32_t)1 << D->rows; on++) {
        *is = dalcs_scaled_minor(D, on, work) > 0.0;
    }
    return DALCS_OK;
}

static enum dalcs_status check_D(struct dalcs_lure_check *c) {
    struct dalcs_lure *found = c->found;
    const struct dalcs_matrix *D = &c->l->D;
    bool is_known;
    double smallest;
    double largest;
    DALCS_TRY(dalcs_symmetric_part_least(D, &c->D_least, c->f->work));
    DALCS_TRY(dalcs_matrix_symmetric_part(D, &smallest, &largest, c->f->work));
    found->D_is_zero = dalcs_matrix_largest(D) == 0.0;
    found->D_is_semidefinite = c->D_least > -dalcs_definite;
    found->D_is_definite = c->D_least > dalcs_definite;
    DALCS_TRY(is_P_matrix(D, &found->D_is_P, &is_known, c->f->work));
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K6", BT10 "appendix A.4; " BG09 "propositions 1 and 2",
        "D a P-matrix: lambda is a Lipschitz function of x, which never jumps",
        is_known ? dalcs_answer_of(found->D_is_P) : DALCS_NOT_CHECKED,
        found->D_is_definite ? "D + D' > 0, Lipschitz constant 2/lambda_min = %.6g"
        : is_known           ? "least eigenvalue of D + D' (scaled): %.3g"
                   : "too many principal minors; least eigenvalue of D + D' (scaled): %.3g",
        found->D_is_definite ? 2.0 / smallest : c->D_least));
    return dalcs_findings_condition(c->f, "PSD-D", BG13 "assumption 4.1", "D + D' >= 0",
                                    dalcs_answer_of(found->D_is_semidefinite),
                                    "least eigenvalue (scaled): %.3g", c->D_least);
}

/* ---- P B = C' ------------------------------------------------------------------------------- */

static enum dalcs_status check_coupling(struct dalcs_lure_check *c, struct dalcs_matrix *P) {
    const char *why;
    DALCS_TRY(dalcs_coupling_find(P, &c->found->is_coupled, &why, &c->l->B, &c->l->C, c->f->work));
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K1", BT10 "assumption 1.1; " BG09 "assumption 5(i); " BG13 "assumption 5.1",
        "some P > 0 has P B = C'", dalcs_answer_of(c->found->is_coupled), "%s",
        c->found->is_coupled ? "P = C'(CB)^+ C + a projector on the null space of B'" : why));
    return c->found->is_coupled ? dalcs_lure_metric_witness(c->f, c->l, P, false) : DALCS_OK;
}

static enum dalcs_status check_blocks(struct dalcs_lure_check *c) {
    const struct dalcs_lcs *l = c->l;
    struct dalcs_arena *work = c->f->work;
    int m = l->m;
    int n[2] = {0, 0};
    int *index[2];
    for (int k = 0; k < 2; k++) {
        index[k] = dalcs_arena_alloc(work, (size_t)m + 1, sizeof(int));
        if (index[k] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    for (int i = 0; i < m; i++) {
        bool is_zero = true;
        for (int j = 0; j < m; j++) {
            is_zero = is_zero && *dalcs_at(&l->D, i, j) == 0.0 && *dalcs_at(&l->D, j, i) == 0.0;
        }
        index[is_zero][n[is_zero]++] = i;
    }
    struct dalcs_matrix D1;
    struct dalcs_matrix B2;
    struct dalcs_matrix C2;
    struct dalcs_matrix P2;
    bool is_P;
    bool is_known;
    bool coupled;
    const char *why;
    DALCS_TRY(dalcs_matrix_part(&D1, work, &l->D, n[0], index[0], n[0], index[0]));
    DALCS_TRY(dalcs_matrix_part(&B2, work, &l->B, 0, NULL, n[1], index[1]));
    DALCS_TRY(dalcs_matrix_part(&C2, work, &l->C, n[1], index[1], 0, NULL));
    DALCS_TRY(is_P_matrix(&D1, &is_P, &is_known, work));
    DALCS_TRY(dalcs_coupling_find(&P2, &coupled, &why, &B2, &C2, work));
    c->found->is_block_coupled = is_P && coupled;
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K7", BT10 "section 3.3; " BG09 "theorem 1",
        "D = diag(D1, 0) with D1 a P-matrix and P2 B2 = C2'",
        !is_known ? DALCS_NOT_CHECKED : dalcs_answer_of(is_P && coupled), "%s",
        is_P ? coupled ? "both hold" : why : "D1 is not a P-matrix"));
    return is_P && coupled ? dalcs_lure_metric_witness(c->f, l, &P2, false) : DALCS_OK;
}

/* Proposition 3 with (21) put right: B lambda is a function of x. */
static enum dalcs_status check_semidefinite(struct dalcs_lure_check *c) {
    const struct dalcs_lcs *l = c->l;
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix S;
    struct dalcs_matrix both;
    struct dalcs_matrix null;
    struct dalcs_matrix seen;
    int rank[2];
    DALCS_TRY(dalcs_matrix_transpose(&S, work, &l->D));
    dalcs_matrix_add(&S, 1.0, &l->D);
    DALCS_TRY(dalcs_matrix_new(&both, work, l->m, l->m + l->n));
    memcpy(both.a, S.a, (size_t)l->m * (size_t)l->m * sizeof(double));
    memcpy(both.a + (size_t)l->m * (size_t)l->m, l->C.a,
           (size_t)l->m * (size_t)l->n * sizeof(double));
    DALCS_TRY(dalcs_matrix_rank(&S, &rank[0], &null, work));
    DALCS_TRY(dalcs_matrix_rank(&both, &rank[1], NULL, work));
    DALCS_TRY(dalcs_matrix_product(&seen, work, &l->B, &null));
    bool is_seen = dalcs_matrix_largest(&seen) > 1e-9 * dalcs_matrix_largest(&l->B);
    bool known = c->cones->is_solved;
    bool holds = c->found->D_is_semidefinite && known && !c->cones->has_constraints &&
                 rank[0] == rank[1] && !is_seen;
    c->found->value_is_unique = holds;
    return dalcs_findings_condition(
        c->f, "Prop3",
        BG09 "proposition 3, with (21) put right: R(C) in R(D + D'), ker(D + D') in "
             "ker(B)",
        "D semidefinite and LCP(0, D) has only 0: B lambda is a Lipschitz function of x",
        !c->found->D_is_semidefinite ? DALCS_NO
        : !known                     ? DALCS_NOT_CHECKED
                                     : dalcs_answer_of(holds),
        "%s",
        !c->found->D_is_semidefinite ? "D + D' has a negative eigenvalue"
        : !known                     ? "needs linear programs (GLPK)"
        : c->cones->has_constraints  ? "the states are bounded by the diodes"
        : rank[0] != rank[1]         ? "R(C) is not in R(D + D')"
        : is_seen                    ? "ker(D + D') is not in ker(B)"
                                     : "all three hold");
}

/* Sources beside C x can be moved into x when they are C times something: then y does not depend on
 * time but through x, as the theorems on Lur'e systems require. Constants do not matter. */
static enum dalcs_status find_shift(struct dalcs_lure_check *c) {
    const struct dalcs_lcs *l = c->l;
    const struct dalcs_system *s = l->blocks->system;
    struct dalcs_matrix both;
    int rank[2];
    DALCS_TRY(dalcs_matrix_new(&both, c->f->work, l->m, l->n + 2 * l->k));
    for (int i = 0; i < l->m; i++) {
        for (int j = 0; j < l->n; j++) {
            *dalcs_at(&both, i, j) = *dalcs_at(&l->C, i, j);
        }
    }
    double size = dalcs_matrix_largest(&both);
    for (int j = 0; j < 2 * l->k; j++) {
        double largest = 0.0;
        bool counts = s->input_element[j % l->k] != NULL;
        for (int i = 0; i < l->m; i++) {
            largest = fmax(largest, fabs(*dalcs_at(&l->F, i, j)));
        }
        for (int i = 0; counts && largest > 0.0 && i < l->m; i++) {
            *dalcs_at(&both, i, l->n + j) =
                *dalcs_at(&l->F, i, j) / largest * (size > 0.0 ? size : 1.0);
        }
    }
    DALCS_TRY(dalcs_matrix_rank(&both, &rank[1], NULL, c->f->work));
    DALCS_TRY(dalcs_matrix_rank(&l->C, &rank[0], NULL, c->f->work));
    c->found->can_shift = rank[0] == rank[1];
    return DALCS_OK;
}

/* ---- Kernel --------------------------------------------------------------------------------- */

/* Two solutions with one x differ by d with B d = 0 and (D + D') d = 0. */
static enum dalcs_status check_kernel(struct dalcs_lure_check *c) {
    const struct dalcs_lcs *l = c->l;
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix both;
    struct dalcs_matrix null;
    int rank;
    c->found->in_kernel = dalcs_arena_alloc(work, (size_t)l->m + 1, sizeof(bool));
    if (c->found->in_kernel == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_new(&both, work, l->n + l->m, l->m));
    for (int i = 0; i < l->n + l->m; i++) {
        double largest = 0.0;
        for (int j = 0; j < l->m; j++) {
            double *a = dalcs_at(&both, i, j);
            *a = i < l->n ? *dalcs_at(&l->B, i, j)
                          : *dalcs_at(&l->D, i - l->n, j) + *dalcs_at(&l->D, j, i - l->n);
            largest = fmax(largest, fabs(*a));
        }
        for (int j = 0; largest > 0.0 && j < l->m; j++) {
            *dalcs_at(&both, i, j) /= largest;
        }
    }
    DALCS_TRY(dalcs_matrix_rank(&both, &rank, &null, work));
    c->found->n_kernel = null.columns;
    for (int k = 0; k < null.columns; k++) {
        for (int i = 0; i < l->m; i++) {
            c->found->in_kernel[i] = c->found->in_kernel[i] || fabs(*dalcs_at(&null, i, k)) > 1e-9;
        }
    }
    DALCS_TRY(dalcs_findings_condition(
        c->f, "K13", BG09 "remarks 3 and 4", "[B; D + D'] has full column rank: lambda is unique",
        dalcs_answer_of(null.columns == 0), "rank %d of %d", rank, l->m));
    for (int k = 0; k < null.columns && k < 4; k++) {
        struct dalcs_evidence w;
        DALCS_TRY(dalcs_evidence_new(&w, c->f, "kernel", (size_t)l->m));
        for (int i = 0; i < l->m; i++) {
            if (fabs(*dalcs_at(&null, i, k)) > 1e-9) {
                const char *name = dalcs_lcs_u_name(l, i, c->f->result);
                if (name == NULL) {
                    return DALCS_E_NOMEM;
                }
                dalcs_evidence_put(&w, name, *dalcs_at(&null, i, k), 0.0);
            }
        }
        DALCS_TRY(dalcs_findings_witness(c->f, false, &w));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_lure_check(struct dalcs_findings *f, const struct dalcs_lcs *l,
                                   const struct dalcs_cones *cones, struct dalcs_lure *found) {
    struct dalcs_lure_check c = {.f = f, .l = l, .cones = cones, .found = found};
    struct dalcs_matrix P;
    *found = (struct dalcs_lure){0};
    DALCS_TRY(check_D(&c));
    DALCS_TRY(check_coupling(&c, &P));
    DALCS_TRY(check_blocks(&c));
    DALCS_TRY(check_semidefinite(&c));
    DALCS_TRY(check_kernel(&c));
    DALCS_TRY(dalcs_findings_condition(
        f, "K8", BG09 "theorem 2; " BG13 "theorem 5.6 (its (36) put right); " BT10 "(22) for D = 0",
        "some x and lambda >= 0 make C x + D lambda > 0",
        cones->is_solved ? dalcs_answer_of(cones->is_qualified) : DALCS_NOT_CHECKED, "%s",
        cones->is_solved
            ? cones->is_qualified ? "a point is found" : "a combination of diodes has none"
            : "needs a linear program (GLPK)"));
    DALCS_TRY(find_shift(&c));
    return dalcs_lure_check_dissipation(&c, &P);
}
