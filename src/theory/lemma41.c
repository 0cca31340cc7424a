/* lemma41.c - with D + D' = 0 the passivity inequality forces X Bbar_II = C_II', and condition c) is another
 * equation X A_II S Bbar_I = (C_I S B_I)', S = (P_I - h A_I)^-1: both are one P B = C'. In item 3 a) the
 * paper prints Bbar_I where the dimensions and the proof, from -X At - At'X >= 0, need B_I. */
#include "lemma41.h"

#include "coupling.h"
#include "passivity.h"

#include <math.h>
#include <string.h>

#define SOURCE(what) "Brogliato 2022, " what

struct lemma {
    const struct dalcs_blocks *b;
    struct dalcs_arena *work;
    struct dalcs_matrix through_z, through_lambda; /* S B_I, S Bbar_I */
    const char *why;                               /* b) or c) fails */
    bool is_only;                                  /* no other X has c) */
    struct dalcs_matrix X;
};

/* [left, right], of as many rows. */
static enum dalcs_status beside(struct dalcs_matrix *both, const struct dalcs_matrix *left,
                                const struct dalcs_matrix *right, struct dalcs_arena *arena) {
    size_t rows = (size_t)left->rows;
    DALCS_TRY(dalcs_matrix_new(both, arena, left->rows, left->columns + right->columns));
    memcpy(both->a, left->a, rows * (size_t)left->columns * sizeof(double));
    memcpy(both->a + rows * (size_t)left->columns, right->a,
           rows * (size_t)right->columns * sizeof(double));
    return DALCS_OK;
}

/* X for c) and the passivity inequality. */
static enum dalcs_status find_X(struct lemma *l) {
    const struct dalcs_blocks *b = l->b;
    struct dalcs_matrix at_lambda;
    struct dalcs_matrix at_z;
    struct dalcs_matrix turned[2];
    struct dalcs_matrix B;
    struct dalcs_matrix C_turned;
    struct dalcs_matrix C;
    bool holds;
    int rank;
    double margin;
    const struct dalcs_quadruple model = dalcs_model_quadruple(b);
    DALCS_TRY(dalcs_matrix_product(&at_lambda, l->work, &b->A_II, &l->through_lambda));
    DALCS_TRY(dalcs_matrix_product(&at_z, l->work, &b->C_I, &l->through_z));
    DALCS_TRY(dalcs_matrix_transpose(&turned[0], l->work, &b->C_II));
    DALCS_TRY(dalcs_matrix_transpose(&turned[1], l->work, &at_z));
    DALCS_TRY(beside(&B, &b->L_II, &at_lambda, l->work));
    DALCS_TRY(beside(&C_turned, &turned[0], &turned[1], l->work));
    DALCS_TRY(dalcs_matrix_transpose(&C, l->work, &C_turned));
    DALCS_TRY(dalcs_coupling_find(&l->X, &holds, &l->why, &B, &C, l->work));
    if (!holds) {
        l->why = "no X > 0 has X Bbar_II = C_II' and c)";
        l->is_only = true;
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_quadruple_margin(&model, &l->X, &margin, l->work));
    DALCS_TRY(dalcs_matrix_rank(&B, &rank, NULL, l->work));
    l->is_only = rank == b->p && dalcs_matrix_largest(&B) > 0.0;
    l->why = margin >= -dalcs_definite ? NULL
             : l->is_only ? "the only X with c) does not make (B_II, Bbar_II, C_II, D) passive"
                          : "the X tried does not make (B_II, Bbar_II, C_II, D) passive";
    return DALCS_OK;
}

static enum dalcs_status find_out(struct lemma *l) {
    struct dalcs_matrix sum;
    struct dalcs_matrix direct;
    double least;
    DALCS_TRY(dalcs_matrix_transpose(&sum, l->work, &l->b->D));
    dalcs_matrix_add(&sum, 1.0, &l->b->D);
    if (dalcs_matrix_largest(&sum) > 1e-12 * dalcs_matrix_largest(&l->b->D)) {
        l->why = "b) D + D' = 0 fails";
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_matrix_product(&direct, l->work, &l->b->C_I, &l->through_lambda));
    DALCS_TRY(dalcs_symmetric_part_least(&direct, &least, l->work));
    if (least < -dalcs_definite) {
        l->why = "b) C_I S Bbar_I + its transpose has a negative eigenvalue";
        return DALCS_OK;
    }
    return find_X(l);
}

enum dalcs_status dalcs_lemma41_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                      double h) {
    struct lemma l = {.b = b, .work = f->work, .is_only = true};
    struct dalcs_matrix step;
    struct dalcs_matrix half;
    struct dalcs_matrix product;
    double strength = 0.0;
    double least = 0.0;
    DALCS_TRY(dalcs_matrix_copy(&step, l.work, &b->P));
    dalcs_matrix_add(&step, -h, &b->A_I);
    DALCS_TRY(dalcs_matrix_copy(&l.through_z, l.work, &b->B_I));
    DALCS_TRY(dalcs_matrix_copy(&l.through_lambda, l.work, &b->L_I));
    DALCS_TRY(dalcs_matrix_solve(&step, &l.through_z, l.work));
    DALCS_TRY(dalcs_matrix_solve(&step, &l.through_lambda, l.work));
    DALCS_TRY(find_out(&l));
    if (l.why == NULL) {
        DALCS_TRY(dalcs_index_strength(&b->B_II, &l.X, &strength, l.work));
        DALCS_TRY(dalcs_matrix_product(&half, l.work, &b->A_II, &l.through_z));
        DALCS_TRY(dalcs_matrix_product(&product, l.work, &l.X, &half));
        for (size_t i = 0; i < (size_t)b->p * (size_t)b->p; i++) {
            product.a[i] = -product.a[i];
        }
        DALCS_TRY(dalcs_symmetric_part_least(&product, &least, l.work));
    }
    enum dalcs_answer failed = l.is_only ? DALCS_NO : DALCS_NOT_CHECKED;
    bool strict = strength > 1e-12 * dalcs_matrix_largest(&b->B_II);
    DALCS_TRY(dalcs_findings_condition(
        f, "L4.1.2", SOURCE("lemma 4.1 item 2"),
        "(B_II, Bbar_II, C_II, D) strictly state passive, b), c): so is the step for small h",
        l.why == NULL && strict ? DALCS_YES : failed, "%s",
        l.why != NULL ? l.why
        : strict      ? "-XB_II - B_II'X > 0, b) and c) hold"
                      : "-XB_II - B_II'X > 0 fails for the X of c)"));
    return dalcs_findings_condition(
        f, "L4.1.3", SOURCE("lemma 4.1 item 3"),
        "(B_II, Bbar_II, C_II, D) passive, a), b), c): so is the step",
        l.why == NULL && least > -dalcs_definite ? DALCS_YES : failed, "%s",
        l.why != NULL             ? l.why
        : least > -dalcs_definite ? "a), b) and c) hold at the step given"
                                  : "a) X A_II S B_I + its transpose <= 0 fails for the X of c)");
}
