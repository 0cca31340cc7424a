/* rcp.c - M(1/h), M(s) for large s, impulses. */
#include "rcp.h"

#include "passivity.h"

#include <math.h>

#define HSW99 "Heemels, Schumacher and Weiland 1999, "

enum { MOST_ROWS = 14, MOST_DEGREE = 2 };

static enum dalcs_status check_step(struct dalcs_findings *f, const struct dalcs_lcs *l, double h) {
    struct dalcs_matrix M;
    double least;
    enum dalcs_status status = dalcs_step_matrix(l, 1.0 / h, &M, f->work);
    if (status == DALCS_SINGULAR) {
        return dalcs_findings_condition(f, "M(1/h)", HSW99 "theorems 3.3 and 6.13",
                                        "M(1/h) + M(1/h)' >= 0: a monotone step", DALCS_NO,
                                        "1/h is an eigenvalue of A");
    }
    DALCS_TRY(status);
    DALCS_TRY(dalcs_symmetric_part_least(&M, &least, f->work));
    return dalcs_findings_condition(
        f, "M(1/h)", HSW99 "theorems 3.3 and 6.13", "M(1/h) + M(1/h)' >= 0: a monotone step",
        dalcs_answer_of(least > -dalcs_definite), "least eigenvalue (scaled): %.3g", least);
}

/* Without dynamics of its own, A = 0, M(s) = D + C B/s: monotone for every s when D and C B are, and then
 * what (D + D') d = (C B + B'C') d = 0 leaves of u must be in the kernel of B for B u to be unique. */
static enum dalcs_status check_still(struct dalcs_findings *f, const struct dalcs_lcs *l,
                                     bool *is_monotone) {
    struct dalcs_matrix cb;
    struct dalcs_matrix S;
    struct dalcs_matrix T;
    struct dalcs_matrix rows;
    double least[2];
    int rank[2];
    *is_monotone = false;
    if (l->n == 0 || dalcs_matrix_largest(&l->A) > 0.0) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_matrix_product(&cb, f->work, &l->C, &l->B));
    DALCS_TRY(dalcs_symmetric_part_least(&l->D, &least[0], f->work));
    DALCS_TRY(dalcs_symmetric_part_least(&cb, &least[1], f->work));
    DALCS_TRY(dalcs_matrix_transpose(&S, f->work, &l->D));
    dalcs_matrix_add(&S, 1.0, &l->D);
    DALCS_TRY(dalcs_matrix_transpose(&T, f->work, &cb));
    dalcs_matrix_add(&T, 1.0, &cb);
    for (int k = 0; k < 2; k++) { /* with B, and without */
        DALCS_TRY(dalcs_matrix_new(&rows, f->work, 2 * l->m + (k == 0 ? l->n : 0), l->m));
        for (int j = 0; j < l->m; j++) {
            for (int i = 0; i < rows.rows; i++) {
                *dalcs_at(&rows, i, j) = i < l->m       ? *dalcs_at(&S, i, j)
                                         : i < 2 * l->m ? *dalcs_at(&T, i - l->m, j)
                                                        : *dalcs_at(&l->B, i - 2 * l->m, j);
            }
        }
        DALCS_TRY(dalcs_matrix_rank(&rows, &rank[k], NULL, f->work));
    }
    bool holds = least[0] > -dalcs_definite && least[1] > -dalcs_definite;
    *is_monotone = holds && rank[0] == rank[1];
    return dalcs_findings_condition(
        f, "M(s)", HSW99 "theorem 4.9",
        "M(s) + M(s)' >= 0 for every s > 0, its kernel in that of B", dalcs_answer_of(*is_monotone),
        "A = 0; least eigenvalues (scaled) of D and C B: %.3g, %.3g%s", least[0], least[1],
        rank[0] == rank[1] ? "" : "; B is not 0 on the kernel");
}

static enum dalcs_status check_minors(struct dalcs_findings *f, const struct dalcs_modes *modes) {
    static const enum dalcs_answer answer[] = {[DALCS_MINORS_UNKNOWN] = DALCS_NOT_CHECKED,
                                               [DALCS_MINORS_POSITIVE] = DALCS_YES,
                                               [DALCS_MINORS_ZERO] = DALCS_NO,
                                               [DALCS_MINORS_NEGATIVE] = DALCS_NO};

    return modes->minors == DALCS_MINORS_UNKNOWN
               ? dalcs_findings_condition(f, "P", HSW99 "corollary 3.12",
                                          "M(s) a P-matrix for all large s", DALCS_NOT_CHECKED,
                                          "too many modes, or passive by its elements")
               : dalcs_findings_condition(f, "P", HSW99 "corollary 3.12",
                                          "M(s) a P-matrix for all large s", answer[modes->minors],
                                          "the least principal minor at s = %.4g is %.3g (scaled)",
                                          modes->bad_sigma, modes->bad_minor);
}

/* ---- Impulses ------------------------------------------------------------------------------- */

/* D, C B, C A B, by rows or columns until one is not 0; the degree is where. False when none is. */
static bool lead(const struct dalcs_matrix *markov, bool by_rows, int which,
                 struct dalcs_matrix *leading, int *degree) {
    for (int k = 0; k <= MOST_DEGREE; k++) {
        bool is_zero = true;
        for (int j = 0; j < leading->rows; j++) {
            double value =
                by_rows ? *dalcs_at(&markov[k], which, j) : *dalcs_at(&markov[k], j, which);
            is_zero = is_zero && fabs(value) <= 1e-10 * dalcs_matrix_largest(&markov[k]);
        }
        if (!is_zero) {
            for (int j = 0; j < leading->rows; j++) {
                double value =
                    by_rows ? *dalcs_at(&markov[k], which, j) : *dalcs_at(&markov[k], j, which);
                *(by_rows ? dalcs_at(leading, which, j) : dalcs_at(leading, j, which)) = value;
            }
            *degree = k > *degree ? k : *degree;
            return true;
        }
    }
    return false;
}

static bool is_P(const struct dalcs_matrix *m, double *work) {
    bool is = true;
    for (uint32_t on = 1; is && on < (uint32_t)1 << m->rows; on++) {
        is = dalcs_scaled_minor(m, on, work) > 0.0;
    }
    return is;
}

static enum dalcs_status add_impulses(struct dalcs_findings *f, enum dalcs_answer holds,
                                      const char *because) {
    return dalcs_findings_condition(f, "impulse", HSW99 "theorem 5.10, section 5.2",
                                    "a start causes at most an impulse, not its derivative", holds,
                                    "%s", because);
}

static enum dalcs_status check_impulses(struct dalcs_findings *f, const struct dalcs_lcs *l,
                                        bool is_passive) {
    struct dalcs_matrix markov[MOST_DEGREE + 1];
    struct dalcs_matrix power;
    struct dalcs_matrix leading[2];
    int degree = 0;
    bool known = l->m <= MOST_ROWS;
    double *work = dalcs_arena_alloc(f->work, (size_t)l->m * (size_t)l->m + 1, sizeof(*work));
    if (work == NULL) {
        return DALCS_E_NOMEM;
    }
    if (is_passive) {
        return add_impulses(f, DALCS_YES, "passive");
    }
    if (!known) {
        return add_impulses(f, DALCS_NOT_CHECKED, "too many principal minors");
    }
    markov[0] = l->D;
    power = l->B;
    for (int k = 1; k <= MOST_DEGREE; k++) {
        struct dalcs_matrix next;
        DALCS_TRY(dalcs_matrix_product(&markov[k], f->work, &l->C, &power));
        DALCS_TRY(dalcs_matrix_product(&next, f->work, &l->A, &power));
        power = next;
    }
    for (int side = 0; side < 2; side++) {
        DALCS_TRY(dalcs_matrix_new(&leading[side], f->work, l->m, l->m));
        for (int i = 0; i < l->m; i++) {
            known = known && lead(markov, side == 0, i, &leading[side], &degree);
        }
        known = known && is_P(&leading[side], work);
    }
    static const char *const text[] = {"none at all: D leads", "an impulse: C B leads",
                                       "the derivative of an impulse: C A B leads"};
    return known ? add_impulses(f, degree < 2 ? DALCS_YES : DALCS_NO, text[degree])
                 : add_impulses(f, DALCS_UNDECIDED,
                                "the leading coefficients of rows and columns are no P-matrices");
}

enum dalcs_status dalcs_rcp_check(struct dalcs_findings *f, const struct dalcs_lcs *l,
                                  const struct dalcs_modes *modes, double h, bool is_passive,
                                  bool *is_monotone) {
    DALCS_TRY(check_step(f, l, h));
    DALCS_TRY(check_still(f, l, is_monotone));
    DALCS_TRY(check_minors(f, modes));
    return check_impulses(f, l, is_passive);
}
