/* brogliato.c - assumptions 1 to 13 and what rests on them.
 *
 * The printed slips of the examples of section 6 play no part here: a system is judged by its own
 * matrices. */
#include "brogliato.h"

#include "coupling.h"
#include "euler_limit.h"
#include "lemma41.h"
#include "passivity.h"
#include "step_blocks.h"

#include <math.h>

#define SOURCE(what) "Brogliato 2022, " what

struct check {
    struct dalcs_findings *f;
    const struct dalcs_blocks *b;
    double h;
    struct dalcs_brogliato *found;
    const char **z_name; /* [p] */
    struct dalcs_quadruple model, step;
    struct dalcs_passive_quadruple passive_model, passive_step;
};

/* ---- The differential rows ------------------------------------------------------------------ */

static enum dalcs_status check_step_defined(struct check *c) {
    struct dalcs_matrix a;
    struct dalcs_arena *work = c->f->work;
    int n = c->b->n;
    double *re = dalcs_arena_alloc(work, (size_t)n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(work, (size_t)n + 1, sizeof(double));
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_copy(&a, work, &c->b->A_I));
    DALCS_TRY(dalcs_matrix_solve(&c->b->P, &a, work));
    DALCS_TRY(dalcs_matrix_eigen(&a, re, im, NULL, work));
    double fastest = 0.0;
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
        fastest = fmax(fastest, hypot(re[i], im[i]));
    }
    for (int i = 0; i < n; i++) {
        bool counts = im[i] == 0.0 && re[i] > 1e-10 * fastest;
        largest = counts ? fmax(largest, re[i]) : largest;
    }
    c->found->h_defined = largest > 0.0 ? 1.0 / largest : INFINITY;
    bool holds = c->h < c->found->h_defined;
    return largest > 0.0
               ? dalcs_findings_condition(c->f, "A1", SOURCE("assumption 1"),
                                          "P_I - h A_I is regular", dalcs_answer_of(holds),
                                          "for h < %.6g s: P_I^-1 A_I has the eigenvalue %.6g 1/s",
                                          1.0 / largest, largest)
               : dalcs_findings_condition(c->f, "A1", SOURCE("assumption 1"),
                                          "P_I - h A_I is regular", DALCS_YES,
                                          "for every h: P_I^-1 A_I has no positive eigenvalue");
}

/* |(P - hA)v| >= |Pv| for all h >= 0 and v exactly when P'A + A'P <= 0; in the norm of the energy of a
 * symmetric P exactly when A + A' <= 0. */
static enum dalcs_status check_contraction(struct check *c, bool *holds) {
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix transposed;
    struct dalcs_matrix product;
    double plain;
    double energy;
    bool is_symmetric = true;
    DALCS_TRY(dalcs_matrix_transpose(&transposed, work, &c->b->P));
    DALCS_TRY(dalcs_matrix_product(&product, work, &transposed, &c->b->A_I));
    DALCS_TRY(dalcs_symmetric_part_least(&product, &plain, work)); /* of -: see below */
    for (size_t i = 0; i < (size_t)c->b->n * (size_t)c->b->n; i++) {
        is_symmetric = is_symmetric && c->b->P.a[i] == transposed.a[i];
        product.a[i] = -product.a[i];
    }
    DALCS_TRY(dalcs_symmetric_part_least(&product, &plain, work));
    struct dalcs_matrix minus;
    bool is_positive;
    DALCS_TRY(dalcs_matrix_new(&minus, work, c->b->n, c->b->n));
    dalcs_matrix_add(&minus, -1.0, &c->b->A_I);
    DALCS_TRY(dalcs_symmetric_part_least(&minus, &energy, work));
    DALCS_TRY(dalcs_is_positive_definite(&c->b->P, &is_positive, work));
    bool by_energy = is_symmetric && is_positive && energy > -dalcs_definite;
    *holds = plain > -dalcs_definite || by_energy;
    return dalcs_findings_condition(
        c->f, "A11", SOURCE("assumption 11"), "sigma_max((P_I - h A_I)^-1 P_I) <= 1 for all h",
        dalcs_answer_of(*holds),
        plain > -dalcs_definite ? "-(P_I' A_I + A_I' P_I) has the least eigenvalue %.3g (scaled)"
        : by_energy
            ? "in the norm of P_I, where it means A_I + A_I' <= 0; in the Euclidean norm it "
              "fails (least eigenvalue %.3g, scaled)"
            : "-(P_I' A_I + A_I' P_I) has the eigenvalue %.3g (scaled)",
        plain);
}

/* ---- P B = C' on the algebraic rows ---------------------------------------------------------- */

/* `id` of assumption 2 or 3 (all pairs), 7 or 9 (those of the zero block). */
static enum dalcs_status check_coupling(struct check *c, const char *id, const char *source,
                                        const char *text, const struct dalcs_quadruple *q,
                                        const bool *is_member, bool *holds,
                                        struct dalcs_matrix *X) {
    struct dalcs_arena *work = c->f->work;
    struct dalcs_matrix B;
    struct dalcs_matrix C;
    const char *why;
    int m = c->b->m;
    int n = 0;
    int *index = dalcs_arena_alloc(work, (size_t)m + 1, sizeof(int));
    if (index == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < m; i++) {
        index[n] = i;
        n += is_member == NULL || is_member[i] ? 1 : 0;
    }
    DALCS_TRY(dalcs_matrix_part(&B, work, &q->B, 0, NULL, n, index));
    DALCS_TRY(dalcs_matrix_part(&C, work, &q->C, n, index, 0, NULL));
    DALCS_TRY(dalcs_coupling_find(X, holds, &why, &B, &C, work));
    bool is_empty = dalcs_matrix_largest(&B) == 0.0 && dalcs_matrix_largest(&C) == 0.0;
    DALCS_TRY(dalcs_findings_condition(c->f, id, source, text, dalcs_answer_of(*holds), "%s",
                                       !*holds    ? why
                                       : is_empty ? "trivially: both sides are 0"
                                                  : "X = C'(CB)^+ C + a projector"));
    if (*holds && c->b->p > 0 && c->b->p <= 40) {
        struct dalcs_evidence w;
        DALCS_TRY(dalcs_evidence_matrix(&w, c->f, "X", X, c->z_name));
        DALCS_TRY(dalcs_findings_witness(c->f, false, &w));
    }
    return DALCS_OK;
}

/* ---- Passivity of the two quadruples --------------------------------------------------------- */

static enum dalcs_answer passive_answer(const struct dalcs_passive_quadruple *p, bool holds) {
    return holds ? DALCS_YES : p->is_exhaustive ? DALCS_NO : DALCS_NOT_CHECKED;
}

static enum dalcs_status check_passive(struct check *c, const char *id, const char *source,
                                       const char *text, const struct dalcs_passive_quadruple *p) {
    DALCS_TRY(dalcs_findings_condition(
        c->f, id, source, text, passive_answer(p, p->is_passive),
        p->is_strict ? "strictly: the matrix inequality has the least eigenvalue %.3g (scaled)"
        : p->is_passive
            ? "not strictly: the matrix inequality has the least eigenvalue %.1g (scaled)"
        : p->is_exhaustive
            ? "for no X > 0: the least eigenvalue is %.3g (scaled) at best"
            : "the best X tried leaves the eigenvalue %.3g (scaled); for all others: %s",
        p->margin, p->why == NULL ? "not checked" : p->why));
    if (p->is_passive && c->b->p > 0 && c->b->p <= 40) {
        struct dalcs_evidence w;
        DALCS_TRY(dalcs_evidence_matrix(&w, c->f, "X", &p->X, c->z_name));
        DALCS_TRY(dalcs_findings_witness(c->f, false, &w));
    }
    return DALCS_OK;
}

/* The same X for the steps h, h/10, ... and 0. */
static enum dalcs_status check_uniform(struct check *c, bool *holds, enum dalcs_answer *answer) {
    double least = c->passive_model.margin;
    *holds = c->passive_model.is_strict;
    for (int k = 0; k < 6 && *holds; k++) {
        struct dalcs_quadruple q;
        double margin;
        enum dalcs_status status = dalcs_step_quadruple(&q, c->b, c->h * pow(10.0, -k), c->f->work);
        if (status != DALCS_OK && status != DALCS_SINGULAR) {
            return status;
        }
        *holds = status == DALCS_OK;
        if (*holds) {
            DALCS_TRY(dalcs_quadruple_margin(&q, &c->passive_model.X, &margin, c->f->work));
            least = fmin(least, margin);
            *holds = margin > dalcs_definite;
        }
    }
    double D_least;
    DALCS_TRY(dalcs_symmetric_part_least(&c->b->D, &D_least, c->f->work));
    *answer = *holds                       ? DALCS_YES
              : D_least <= dalcs_definite  ? DALCS_NO
              : c->passive_model.is_strict ? DALCS_NO
                                           : passive_answer(&c->passive_model, false);
    DALCS_TRY(dalcs_findings_condition(
        c->f, "L4.1", SOURCE("lemma 4.1 item 1"),
        "(B_II, Bbar_II, C_II, D) strictly passive, so the step is for small h",
        D_least <= dalcs_definite ? DALCS_NO
                                  : passive_answer(&c->passive_model, c->passive_model.is_strict),
        c->passive_model.is_strict
            ? *holds ? "with one X for all h from 0 to the step: least eigenvalue %.3g (scaled)"
                     : "for small h; at the step the least eigenvalue is %.3g (scaled)"
        : D_least <= dalcs_definite ? "D + D' > 0 fails: its least eigenvalue is %.3g (scaled)"
                                    : "no X found",
        c->passive_model.is_strict ? least : D_least));
    return dalcs_findings_condition(
        c->f, "A10", SOURCE("assumption 10"),
        "(At, Bt, Ct, Dt) strictly passive uniformly in h >= 0", *answer,
        D_least <= dalcs_definite
            ? "D + D' > 0 fails, so Dt + Dt' does as h -> 0: least eigenvalue %.3g (scaled)"
            : "least eigenvalue %.3g (scaled) over h from 0 to the step",
        D_least <= dalcs_definite ? D_least : least);
}

/* ---- The propositions ------------------------------------------------------------------------ */

/* Item 1: its range condition holds when Dt + Dt' > 0, or when Bt is square and regular. */
static enum dalcs_status check_431(struct check *c, bool is_definite) {
    int rank;
    DALCS_TRY(dalcs_matrix_rank(&c->step.B, &rank, NULL, c->f->work));
    bool is_regular = c->b->m > 0 && c->b->m == c->b->p && rank == c->b->p;
    bool passive = c->passive_step.is_passive;
    return dalcs_findings_condition(
        c->f, "P4.3.1", SOURCE("proposition 4.3 item 1"),
        "A4 and a range condition: z -> -At z + Bt (..)^-1 Ct z is maximal monotone",
        !passive                    ? passive_answer(&c->passive_step, false)
        : is_definite || is_regular ? DALCS_YES
                                    : DALCS_NOT_CHECKED,
        "%s",
        !passive      ? "assumption 4 is not shown"
        : is_definite ? "Dt + Dt' > 0"
        : is_regular  ? "Bt is square and regular"
                      : "the range condition depends on x and the sources");
}

/* Item 3: the set S of (4.6) is {0} when -At is positive definite in the metric of X. */
static enum dalcs_status check_433(struct check *c, bool coupled, const struct dalcs_matrix *X) {
    bool is_zero = dalcs_matrix_largest(&c->step.D) == 0.0;
    double strength = NAN;
    if (is_zero && coupled) {
        DALCS_TRY(dalcs_index_strength(&c->step.A, X, &strength, c->f->work));
    }
    double rounding = 1e-12 * dalcs_matrix_largest(&c->step.A);
    return dalcs_findings_condition(
        c->f, "P4.3.3", SOURCE("proposition 4.3 item 3"),
        "Dt = 0, A2, -R At R^-1 >= 0, S of (4.6) is {0}: the step has a solution",
        !is_zero || !coupled || strength < -rounding ? DALCS_NO
        : strength > rounding                        ? DALCS_YES
                                                     : DALCS_NOT_CHECKED,
        isnan(strength) ? "the largest element of Dt is %.3g: Dt = 0 or assumption 2 fails"
                        : "the least eigenvalue of -R At R^-1 is %.3g",
        isnan(strength) ? dalcs_matrix_largest(&c->step.D) : strength);
}

static enum dalcs_status check_43(struct check *c) {
    double least;
    double smallest;
    double largest;
    DALCS_TRY(dalcs_symmetric_part_least(&c->step.D, &least, c->f->work));
    DALCS_TRY(dalcs_matrix_symmetric_part(&c->step.D, &smallest, &largest, c->f->work));
    bool definite = c->b->m > 0 && least > dalcs_definite;
    DALCS_TRY(dalcs_findings_condition(
        c->f, "P4.3.2", SOURCE("proposition 4.3 item 2"),
        "Dt + Dt' > 0: lambda is a Lipschitz function of z", dalcs_answer_of(definite),
        definite ? "Lipschitz constant 2/lambda_min(Dt + Dt') = %.6g"
                 : "the least eigenvalue of Dt + Dt' is %.3g (scaled)",
        definite ? 2.0 / smallest : least));
    DALCS_TRY(check_431(c, definite));
    bool strict = c->passive_step.is_strict;
    c->found->step_unique = strict;
    return dalcs_findings_condition(
        c->f, "C4.6.3", SOURCE("corollary 4.6 item 3"),
        "(At, Bt, Ct, Dt) strictly passive: one (z, lambda), so one step",
        definite ? passive_answer(&c->passive_step, strict) : DALCS_NO,
        definite ? "least eigenvalue %.3g (scaled)"
                 : "Dt + Dt' > 0 fails: its least eigenvalue is %.3g (scaled)",
        definite ? c->passive_step.margin : least);
}

/* Propositions 4.4 (q of the step) and 4.8 (q of the model). */
static enum dalcs_status check_blocks(struct check *c, bool of_step, bool *blocks, bool *coupled,
                                      bool *monotone, double *strength) {
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
        c->f, of_step ? "A6" : "A8", of_step ? SOURCE("assumption 6") : SOURCE("assumption 8"),
        of_step ? "Dt = diag(D11, 0), D11 = D11' > 0" : "D = diag(D11, 0), D11 = D11' > 0",
        dalcs_answer_of(*blocks), NULL));
    DALCS_TRY(check_coupling(
        c, of_step ? "A7" : "A9", of_step ? SOURCE("assumption 7") : SOURCE("assumption 9"),
        of_step ? "some X2 > 0 has X2 Bt2 = Ct2'" : "some X2 > 0 has X2 Bbar_II2 = C_II2'", q,
        is_second, coupled, &X));
    *monotone = true; /* lemma 4.5: G2 is 0 when B1 is, monotone when X2 B1 = C1' */
    bool definite = false;
    if (*blocks && *coupled) {
        DALCS_TRY(dalcs_index_strength(&q->A, &X, strength, work));
        definite = *strength > 1e-12 * dalcs_matrix_largest(&q->A);
        struct dalcs_matrix xb;
        DALCS_TRY(dalcs_matrix_product(&xb, work, &X, &q->B));
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
    }
    bool holds = *blocks && *coupled && definite && *monotone;
    c->found->step_unique = c->found->step_unique || (holds && of_step);
    return dalcs_findings_condition(
        c->f, of_step ? "P4.4.3" : "P4.8.3",
        of_step ? SOURCE("proposition 4.4 item 3") : SOURCE("proposition 4.8 item 3"),
        of_step ? "one z of the step: -R2 At R2^-1 > 0 and G2 monotone"
                : "one z for given x: -R2 B_II R2^-1 > 0 and G2 monotone",
        dalcs_answer_of(holds),
        !*blocks || !*coupled ? "its assumptions fail"
        : !definite           ? "the least eigenvalue of -R2 A R2^-1 is %.3g"
        : !*monotone          ? "G2 is not known to be monotone (lemma 4.5); least eigenvalue %.3g"
                              : "the least eigenvalue is %.3g",
        *strength);
}

/* Im(C_II2) meets K2 - C_I2 x - F2 for all x and sources when C_II2 has full row rank. */
static enum dalcs_status check_qualification(struct check *c) {
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
        c->f, "P4.8.1", SOURCE("propositions 4.7 and 4.8 item 1"),
        "Im(C_II2) meets K2 - C_I2 x - F2",
        n == 0 || (rank == n && !is_zero) ? DALCS_YES : DALCS_CONDITIONAL,
        n == 0 || (rank == n && !is_zero) ? "for all x and sources: C_II2 has full row rank"
        : is_zero ? "C_II2 = 0: only while C_I2 x + F2 >= 0, which the step does not ensure"
                  : "C_II2 lacks full row rank: it depends on x and the sources");
}

static enum dalcs_status check_47(struct check *c, bool D_is_zero, bool coupled,
                                  const struct dalcs_matrix *X) {
    double strength = NAN;
    if (D_is_zero && coupled) {
        DALCS_TRY(dalcs_index_strength(&c->b->B_II, X, &strength, c->f->work));
    }
    bool holds = D_is_zero && coupled && strength > 1e-12 * dalcs_matrix_largest(&c->b->B_II);
    return dalcs_findings_condition(c->f, "P4.7.1", SOURCE("proposition 4.7 item 1"),
                                    "D = 0, A3, -R B_II R^-1 > 0: one z for given x",
                                    dalcs_answer_of(holds),
                                    !D_is_zero ? "D is not 0"
                                    : !coupled ? "assumption 3 fails"
                                               : "the least eigenvalue of -R B_II R^-1 is %.3g",
                                    strength);
}

static enum dalcs_status name_algebraic(struct check *c) {
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

enum dalcs_status dalcs_brogliato_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                        double h, const bool *jumps,
                                        struct dalcs_brogliato *found) {
    struct check c = {.f = f, .b = b, .h = h, .found = found};
    struct dalcs_matrix X;
    bool contracts;
    bool is_uniform;
    enum dalcs_answer uniform;
    bool coupled[4];
    bool blocks[2];
    bool monotone[2];
    double strength[2];
    *found = (struct dalcs_brogliato){.converges_52 = DALCS_NO, .converges_59 = DALCS_NO};
    DALCS_TRY(name_algebraic(&c));
    DALCS_TRY(check_step_defined(&c));
    c.model = dalcs_model_quadruple(b);
    enum dalcs_status status = dalcs_step_quadruple(&c.step, b, h, f->work);
    if (status == DALCS_SINGULAR) {
        return DALCS_OK; /* by A1 */
    }
    DALCS_TRY(status);
    DALCS_TRY(dalcs_quadruple_passive(&c.model, &c.passive_model, f->work));
    DALCS_TRY(dalcs_quadruple_passive(&c.step, &c.passive_step, f->work));
    bool D_is_zero = dalcs_matrix_largest(&b->D) == 0.0;
    DALCS_TRY(check_coupling(&c, "A2", SOURCE("assumption 2"), "some X > 0 has X Bt = Ct'", &c.step,
                             NULL, &coupled[0], &X));
    DALCS_TRY(check_433(&c, coupled[0], &X));
    DALCS_TRY(check_coupling(&c, "A3", SOURCE("assumption 3"), "some X > 0 has X Bbar_II = C_II'",
                             &c.model, NULL, &coupled[1], &X));
    DALCS_TRY(check_47(&c, D_is_zero, coupled[1], &X));
    DALCS_TRY(check_passive(&c, "A4", SOURCE("assumption 4"), "(At, Bt, Ct, Dt) passive",
                            &c.passive_step));
    DALCS_TRY(check_passive(&c, "A5", SOURCE("assumption 5"), "(B_II, Bbar_II, C_II, D) passive",
                            &c.passive_model));
    DALCS_TRY(check_43(&c));
    DALCS_TRY(check_blocks(&c, true, &blocks[0], &coupled[2], &monotone[0], &strength[0]));
    DALCS_TRY(check_blocks(&c, false, &blocks[1], &coupled[3], &monotone[1], &strength[1]));
    DALCS_TRY(check_qualification(&c));
    DALCS_TRY(check_uniform(&c, &is_uniform, &uniform));
    DALCS_TRY(dalcs_lemma41_check(f, b, h));
    DALCS_TRY(check_contraction(&c, &contracts));
    const struct dalcs_limit_given given = {.uniform = uniform,
                                            .contracts = contracts,
                                            .blocks = blocks[0],
                                            .coupled = coupled[2],
                                            .monotone = monotone[0],
                                            .strength = strength[0],
                                            .jumps = jumps};
    return dalcs_euler_limit_check(f, b, h, &given, found);
}
