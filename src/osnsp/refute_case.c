/* refute_case.c - is one case contradictory? By least squares with signs (nonnegative.h). */
#include "refute_case.h"

#include "osnsp_internal.h"

#include <math.h>
#include <string.h>

/* Passes of scaling by powers of 2. */
enum { SCALING_PASSES = 6 };

static void add_dense(void *user, int column, double value) {
    double *row = user;
    row[column] += value;
}

static double power_of_2(double size) {
    int exponent;
    (void)frexp(size, &exponent);
    return size > 0.0 ? ldexp(1.0, -(exponent / 2)) : 1.0;
}

/* Rows and columns of about the same size (D. Ruiz, RAL-TR-2001-034). */
static void balance(struct dalcs_refutation *r) {
    size_t m = (size_t)r->n_rows;
    for (int pass = 0; pass < SCALING_PASSES; pass++) {
        for (int row = 0; row < r->n_rows; row++) {
            double most = 0.0;
            for (int c = 0; c < r->n_columns; c++) {
                most = fmax(most, fabs(r->dense[(size_t)c * m + (size_t)row]));
            }
            double by = power_of_2(most);
            r->row_scale[row] *= by;
            for (int c = 0; c < r->n_columns; c++) {
                r->dense[(size_t)c * m + (size_t)row] *= by;
            }
        }
        for (int c = 0; c < r->n_columns; c++) {
            double *column = r->dense + (size_t)c * m;
            double most = 0.0;
            for (int row = 0; row < r->n_rows; row++) {
                most = fmax(most, fabs(column[row]));
            }
            double by = power_of_2(most);
            r->column_scale[c] *= by;
            for (int row = 0; row < r->n_rows; row++) {
                column[row] *= by;
            }
        }
    }
}

enum dalcs_status dalcs_refutation_make_dense(struct dalcs_refutation *r) {
    size_t m = (size_t)r->n_rows;
    size_t n = (size_t)r->n_columns;
    double *row = dalcs_arena_alloc(&r->work, n, sizeof(double));
    r->dense = dalcs_arena_alloc(&r->work, m * n, sizeof(double));
    r->row_scale = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->column_scale = dalcs_arena_alloc(&r->work, n, sizeof(double));
    r->lambda = dalcs_arena_alloc(&r->work, m, sizeof(int));
    r->slack = dalcs_arena_alloc(&r->work, m, sizeof(int));
    if (row == NULL || r->dense == NULL || r->row_scale == NULL || r->column_scale == NULL ||
        r->lambda == NULL || r->slack == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < m; i++) {
        memset(row, 0, n * sizeof(double));
        dalcs_claim_visit(&r->claim, (int)i, add_dense, row);
        for (size_t c = 0; c < n; c++) {
            r->dense[c * m + i] = row[c];
        }
        r->row_scale[i] = 1.0;
    }
    for (size_t c = 0; c < n; c++) {
        r->column_scale[c] = 1.0;
    }
    balance(r);
    return dalcs_nonnegative_setup(&r->least, &r->work, r->n_rows, r->n_columns + r->n_rows);
}

static int put_slack(struct dalcs_refutation *r, int n, int row, double sign, bool is_free) {
    double *column = r->least.a + (size_t)n * (size_t)r->n_rows;
    memset(column, 0, (size_t)r->n_rows * sizeof(double));
    column[row] = sign;
    r->least.is_free[n] = is_free;
    return n + 1;
}

/* Does a resistance stand in this branch equation? What refutes a passive circuit dissipates nothing, so that such an
 * equation needs no weight (Cottle, Pang and Stone 1992, thm 3.1.2). */
static bool is_resistive(const struct dalcs_system *s, int row) {
    bool is = false;
    for (int k = s->A.p[row]; k < s->A.p[row + 1] && !is; k++) {
        is =
            s->row[row].kind == DALCS_LABEL_BRANCH && s->A.j[k] == s->dual[row] && s->A.x[k] != 0.0;
    }
    return is;
}

/* Is the problem but one of a passive circuit? Where a control says on which side a switch is, a current through a resistor
 * may contradict it. */
static bool is_passive(const struct dalcs_system *s) {
    bool is = s->monotone;
    for (int d = 0; d < s->n_pairs && is; d++) {
        is = !dalcs_claim_follows(s, d);
    }
    return is;
}

/* The columns of the present case; how many. */
static int put_columns(struct dalcs_refutation *r) {
    const struct dalcs_system *s = r->claim.system;
    size_t m = (size_t)r->n_rows;
    int n_equations = dalcs_system_n_equations(s);
    int n = 0;
    for (int c = 0; c < r->n_columns; c++) {
        int d = c - n_equations;
        bool is_diode = d >= 0 && s->pair[d].kind == DALCS_PAIR_DIODE;
        if (d >= 0) {
            r->lambda[d] = dalcs_claim_is_void(&r->claim, c) ? -1 : n;
        }
        if (!dalcs_claim_is_void(&r->claim, c)) {
            r->least.is_free[n] = !is_diode;
            memcpy(r->least.a + (size_t)n++ * m, r->dense + (size_t)c * m, m * sizeof(double));
        }
    }
    bool needs_no_resistor = is_passive(s);
    for (int row = 0; row < n_equations && needs_no_resistor; row++) {
        n = is_resistive(s, row) ? put_slack(r, n, row, 1.0, true) : n;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        enum dalcs_side_claim side = r->claim.side[d];
        bool is_told = dalcs_claim_follows(s, d) && side != DALCS_EITHER_SIDE;
        r->slack[d] = side == DALCS_CLOSED ? -1 : n;
        if (side != DALCS_CLOSED) {
            n = put_slack(r, n, n_equations + d, -1.0, s->pair[d].kind == DALCS_PAIR_SWITCH);
        }
        n = put_slack(r, n, n_equations + s->n_pairs + d, side == DALCS_CLOSED ? -1.0 : 1.0,
                      !is_told);
    }
    return n;
}

static void put_right(struct dalcs_refutation *r) {
    double most = 0.0;
    for (int row = 0; row < r->n_rows; row++) {
        double size;
        r->least.b[row] = r->row_scale[row] * dalcs_claim_right(&r->claim, row, &size);
        most = fmax(most, fabs(r->least.b[row]));
    }
    for (int row = 0; row < r->n_rows && most > 0.0; row++) {
        r->least.b[row] /= most;
    }
}

/* The weights as they are, without rounding, and rounded off: is one of these a contradiction? */
static bool is_refuted(struct dalcs_refutation *r) {
    double most = 0.0;
    double largest = 0.0;
    for (int row = 0; row < r->n_rows; row++) {
        most = fmax(most, fabs(r->least.rest[row]));
    }
    for (int row = 0; row < r->n_rows; row++) {
        bool is_zero = !(fabs(r->least.rest[row]) > dalcs_weight_rounded(most));
        r->v[row] = r->row_scale[row] * r->least.rest[row];
        r->clean[row] = is_zero ? 0.0 : r->v[row];
        largest = fmax(largest, fabs(r->clean[row]));
    }
    r->proof = r->v;
    if (dalcs_claim_is_refuted(&r->claim, r->v, r->sum)) {
        return true;
    }
    r->proof = r->clean;
    if (dalcs_claim_is_refuted(&r->claim, r->clean, r->sum)) {
        return true;
    }
    for (int row = 0; row < r->n_rows && largest > 0.0; row++) {
        int exponent;
        double digits = frexp(r->clean[row] / largest, &exponent);
        r->clean[row] = ldexp(rint(ldexp(digits, DALCS_WEIGHT_BITS)), exponent - DALCS_WEIGHT_BITS);
    }
    return dalcs_claim_is_refuted(&r->claim, r->clean, r->sum);
}

bool dalcs_refutation_closes(struct dalcs_refutation *r) {
    int n = put_columns(r);
    put_right(r);
    dalcs_nonnegative_solve(&r->least, n);
    return is_refuted(r);
}
