/* brogliato.c - assumptions 1 to 13.
 *
 * The printed slips of the examples of section 6 play no part here: a system is judged by its own
 * matrices. */
#include "brogliato_case.h"

#include "coupling.h"
#include "euler_limit.h"
#include "lemma41.h"

#include <math.h>

/* ---- The differential rows ------------------------------------------------------------------ */

static enum dalcs_status check_step_defined(struct dalcs_brogliato_case *c) {
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
               ? dalcs_findings_condition(c->f, "A1", DALCS_BROGLIATO("assumption 1"),
                                          "P_I - h A_I is regular", dalcs_answer_of(holds),
                                          "for h < %.6g s: P_I^-1 A_I has the eigenvalue %.6g 1/s",
                                          1.0 / largest, largest)
               : dalcs_findings_condition(c->f, "A1", DALCS_BROGLIATO("assumption 1"),
                                          "P_I - h A_I is regular", DALCS_YES,
                                          "for every h: P_I^-1 A_I has no positive eigenvalue");
}

/* |(P - hA)v| >= |Pv| for all h >= 0 and v exactly when P'A + A'P <= 0; in the norm of the energy of a
 * symmetric P exactly when A + A' <= 0. */
static enum dalcs_status check_contraction(struct dalcs_brogliato_case *c, bool *holds) {
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
        c->f, "A11", DALCS_BROGLIATO("assumption 11"),
        "sigma_max((P_I - h A_I)^-1 P_I) <= 1 for all h", dalcs_answer_of(*holds),
        plain > -dalcs_definite ? "-(P_I' A_I + A_I' P_I) has the least eigenvalue %.3g (scaled)"
        : by_energy
            ? "in the norm of P_I, where it means A_I + A_I' <= 0; in the Euclidean norm it "
              "fails (least eigenvalue %.3g, scaled)"
            : "-(P_I' A_I + A_I' P_I) has the eigenvalue %.3g (scaled)",
        plain);
}

/* ---- P B = C' on the algebraic rows ---------------------------------------------------------- */

enum dalcs_status dalcs_brogliato_check_coupling(struct dalcs_brogliato_case *c, const char *id,
                                                 const char *source, const char *text,
                                                 const struct dalcs_quadruple *q,
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

enum dalcs_answer dalcs_brogliato_passive(const struct dalcs_passive_quadruple *p, bool holds) {
    return holds ? DALCS_YES : p->is_exhaustive ? DALCS_NO : DALCS_NOT_CHECKED;
}

static enum dalcs_status check_passive(struct dalcs_brogliato_case *c, const char *id,
                                       const char *source, const char *text,
                                       const struct dalcs_passive_quadruple *p) {
    DALCS_TRY(dalcs_findings_condition(
        c->f, id, source, text, dalcs_brogliato_passive(p, p->is_passive),
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
static enum dalcs_status check_uniform(struct dalcs_brogliato_case *c, bool *holds,
                                       enum dalcs_answer *answer) {
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
                                           : dalcs_brogliato_passive(&c->passive_model, false);
    DALCS_TRY(dalcs_findings_condition(
        c->f, "L4.1", DALCS_BROGLIATO("lemma 4.1 item 1"),
        "(B_II, Bbar_II, C_II, D) strictly passive, so the step is for small h",
        D_least <= dalcs_definite
            ? DALCS_NO
            : dalcs_brogliato_passive(&c->passive_model, c->passive_model.is_strict),
        c->passive_model.is_strict
            ? *holds ? "with one X for all h from 0 to the step: least eigenvalue %.3g (scaled)"
                     : "for small h; at the step the least eigenvalue is %.3g (scaled)"
        : D_least <= dalcs_definite ? "D + D' > 0 fails: its least eigenvalue is %.3g (scaled)"
                                    : "no X found",
        c->passive_model.is_strict ? least : D_least));
    return dalcs_findings_condition(
        c->f, "A10", DALCS_BROGLIATO("assumption 10"),
        "(At, Bt, Ct, Dt) strictly passive uniformly in h >= 0", *answer,
        D_least <= dalcs_definite
            ? "D + D' > 0 fails, so Dt + Dt' does as h -> 0: least eigenvalue %.3g (scaled)"
            : "least eigenvalue %.3g (scaled) over h from 0 to the step",
        D_least <= dalcs_definite ? D_least : least);
}

/* ---- The propositions ------------------------------------------------------------------------ */

enum dalcs_status dalcs_brogliato_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                        double h, const bool *jumps,
                                        struct dalcs_brogliato *found) {
    struct dalcs_brogliato_case c = {.f = f, .b = b, .h = h, .found = found};
    struct dalcs_matrix X;
    bool contracts;
    bool is_uniform;
    enum dalcs_answer uniform;
    bool coupled[4];
    bool blocks[2];
    bool monotone[2];
    double strength[2];
    *found = (struct dalcs_brogliato){.converges_52 = DALCS_NO, .converges_59 = DALCS_NO};
    DALCS_TRY(dalcs_brogliato_name_algebraic(&c));
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
    DALCS_TRY(dalcs_brogliato_check_coupling(&c, "A2", DALCS_BROGLIATO("assumption 2"),
                                             "some X > 0 has X Bt = Ct'", &c.step, NULL,
                                             &coupled[0], &X));
    DALCS_TRY(dalcs_brogliato_433(&c, coupled[0], &X));
    DALCS_TRY(dalcs_brogliato_check_coupling(&c, "A3", DALCS_BROGLIATO("assumption 3"),
                                             "some X > 0 has X Bbar_II = C_II'", &c.model, NULL,
                                             &coupled[1], &X));
    DALCS_TRY(dalcs_brogliato_47(&c, D_is_zero, coupled[1], &X));
    DALCS_TRY(check_passive(&c, "A4", DALCS_BROGLIATO("assumption 4"), "(At, Bt, Ct, Dt) passive",
                            &c.passive_step));
    DALCS_TRY(check_passive(&c, "A5", DALCS_BROGLIATO("assumption 5"),
                            "(B_II, Bbar_II, C_II, D) passive", &c.passive_model));
    DALCS_TRY(dalcs_brogliato_43(&c));
    DALCS_TRY(
        dalcs_brogliato_blocks(&c, true, &blocks[0], &coupled[2], &monotone[0], &strength[0]));
    DALCS_TRY(
        dalcs_brogliato_blocks(&c, false, &blocks[1], &coupled[3], &monotone[1], &strength[1]));
    DALCS_TRY(dalcs_brogliato_qualification(&c));
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
