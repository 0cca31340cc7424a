/* farkas.c - rows of a claim, and the combination of them. */
#include "farkas.h"

#include "rounding.h"

#include <math.h>
#include <string.h>

static void visit_row(const struct dalcs_csr *m, int row, double factor,
                      void (*add)(void *user, int column, double value), void *user) {
    for (int k = m->p[row]; k < m->p[row + 1]; k++) {
        add(user, m->j[k], factor * m->x[k]);
    }
}

/* The pair that a row belongs to behind the equations; *is_control: its control. */
static int pair_of_row(const struct dalcs_system *s, int row, bool *is_control) {
    int pair = row - dalcs_system_n_equations(s);
    *is_control = pair >= s->n_pairs;
    return *is_control ? pair - s->n_pairs : pair;
}

void dalcs_claim_visit(const struct dalcs_claim *claim, int row,
                       void (*add)(void *user, int column, double value), void *user) {
    const struct dalcs_system *s = claim->system;
    if (row < dalcs_system_n_equations(s)) {
        visit_row(&s->A, row, -1.0, add, user);
        if (s->A_rest.p !=
            NULL) { /* what rounding has left of the entries: it cancels along an island */
            visit_row(&s->A_rest, row, -1.0, add, user);
        }
        if (row < s->n_x) {
            visit_row(&s->P, row, claim->sigma, add, user);
        }
        return;
    }
    bool is_control;
    int pair = pair_of_row(s, row, &is_control);
    visit_row(is_control ? &s->control : &s->C, pair, 1.0, add, user);
}

double dalcs_claim_right(const struct dalcs_claim *claim, int row, double *size) {
    const struct dalcs_system *s = claim->system;
    const double *inputs = claim->u + s->n_x;
    bool is_equation = row < dalcs_system_n_equations(s);
    bool is_control = false;
    int pair = is_equation ? -1 : pair_of_row(s, row, &is_control);
    double sum = 0.0;
    *size = 0.0;
    if (is_control) {
        sum = claim->side[pair] == DALCS_CLOSED ? s->pair[pair].turn_off : s->pair[pair].turn_on;
        *size = fabs(sum);
        return sum;
    }
    const struct dalcs_csr *given = is_equation ? &s->E : &s->F;
    int of = is_equation ? row : pair;
    for (int k = given->p[of]; k < given->p[of + 1]; k++) {
        double term = (is_equation ? 1.0 : -1.0) * given->x[k] * inputs[given->j[k]];
        sum += term;
        *size += fabs(term);
    }
    for (int k = row < s->n_x ? s->P.p[row] : 0; row < s->n_x && k < s->P.p[row + 1]; k++) {
        double term = claim->sigma * s->P.x[k] * claim->u[s->P.j[k]];
        sum += term;
        *size += fabs(term);
    }
    return sum;
}

bool dalcs_claim_is_void(const struct dalcs_claim *claim, int column) {
    int pair = column - dalcs_system_n_equations(claim->system);
    return pair >= 0 ? claim->side[pair] == DALCS_OPENED
                     : claim->system->column[column].kind == DALCS_LABEL_REFERENCE;
}

static double at_least_0(double v) {
    return v > 0.0 ? v : 0.0;
}

/* Rows with a slack that may have either sign have no weight; with one that may not be negative, none that is. */
static void give_signs(const struct dalcs_claim *claim, double *v) {
    const struct dalcs_system *s = claim->system;
    double *of_pair = v + dalcs_system_n_equations(s);
    double *of_control = of_pair + s->n_pairs;
    for (int d = 0; d < s->n_pairs; d++) {
        bool is_switch = s->pair[d].kind == DALCS_PAIR_SWITCH;
        enum dalcs_side_claim side = claim->side[d];
        if (side != DALCS_CLOSED) {
            of_pair[d] = is_switch ? 0.0 : at_least_0(of_pair[d]);
        }
        bool is_told = dalcs_claim_follows(s, d) && side != DALCS_EITHER_SIDE;
        of_control[d] = !is_told               ? 0.0
                        : side == DALCS_CLOSED ? at_least_0(of_control[d])
                                               : -at_least_0(-of_control[d]);
    }
}

/* Sums of products in pairs of doubles, for what cancels must not hide what is small beside it. */
struct sums {
    double weight, *sum; /* [n_columns][3]: the sum in two parts, that of magnitudes */
};

static void add_to(void *user, int column, double value) {
    const struct sums *to = user;
    double *sum = to->sum + 3 * (size_t)column;
    double product = to->weight * value;
    double total = sum[0] + product;
    double back = total - sum[0];
    sum[1] += (sum[0] - (total - back)) + (product - back) + fma(to->weight, value, -product);
    sum[0] = total;
    sum[2] += fabs(product);
}

bool dalcs_claim_is_refuted(const struct dalcs_claim *claim, double *v, double *sum) {
    const struct dalcs_system *s = claim->system;
    struct sums to = {0.0, sum};
    double right = 0.0;
    double right_size = 0.0;
    give_signs(claim, v);
    memset(sum, 0, 3 * (size_t)dalcs_system_n_columns(s) * sizeof(double));
    for (int row = 0; row < dalcs_claim_n_rows(s); row++) {
        if (v[row] != 0.0) {
            double terms;
            right += v[row] * dalcs_claim_right(claim, row, &terms);
            right_size += fabs(v[row]) * terms;
            to.weight = v[row];
            dalcs_claim_visit(claim, row, add_to, &to);
        }
    }
    const double contradiction = right - dalcs_sum_rounded * right_size;
    if (!(contradiction > 0.0)) {
        return false;
    }
    double missed = 0.0; /* what the combination may come to beside 0, for answers within reach */
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int pair = c - dalcs_system_n_equations(s);
        bool has_sign = pair >= 0 && s->pair[pair].kind == DALCS_PAIR_DIODE;
        double total = sum[3 * c] + sum[3 * c + 1];
        double off = dalcs_claim_is_void(claim, c) ? 0.0
                     : has_sign                    ? at_least_0(total)
                                                   : fabs(total);
        /* A coefficient that nothing cancels is left whole, be it as small as it may, and so is what it could carry. */
        if (!(off <= dalcs_weight_rounded(sum[3 * c + 2]))) {
            return false;
        }
        missed += off * claim->reach[s->column_is_current[c]];
    }
    return missed < contradiction;
}
