/* decided_quadrature.c - the energies of a part without states that smooth functions bend: its power at a time is that of the
 * one-step problem there, and the integral is found by Gauss's rule of seven points on halves of halves. */
#include "energy_entries.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>

/* At a point where a root begins halves go on. */
enum { MOST_HALVINGS = 24 };

/* Gauss and Legendre: abscissas of [-1, 1] and weights (Abramowitz and Stegun 1964, table 25.4). */
enum { POINTS = 7 };

static const double ABSCISSA[POINTS] = {
    -0.949107912342758524526, -0.741531185599394439864, -0.405845151377397166907, 0.0,
    0.405845151377397166907,  0.741531185599394439864,  0.949107912342758524526};
static const double WEIGHT[POINTS] = {0.129484966168869693271, 0.279705391489276667901,
                                      0.381830050505118944950, 0.417959183673469387755,
                                      0.381830050505118944950, 0.279705391489276667901,
                                      0.129484966168869693271};

struct quadrature {
    const struct dalcs_energy_part *part;
    struct dalcs_component *c;
    double most; /* J: what flows between two edges */
};

struct joules {
    double of[DALCS_N_POWER_ACCOUNTS];
};

static double difference(const double *y, const int *column) {
    return (column[0] >= 0 ? y[column[0]] : 0.0) - (column[1] >= 0 ? y[column[1]] : 0.0);
}

static double power_of(const struct dalcs_power_term *term, const double *y, const double *inputs) {
    const double first = difference(y, term->first);
    switch (term->factor) {
    case DALCS_POWER_SQUARE:
        return term->coefficient * first * first;
    case DALCS_POWER_PRODUCT:
        return term->coefficient * first * difference(y, term->second);
    case DALCS_POWER_INPUT:
        return term->coefficient * first * inputs[term->input];
    case DALCS_POWER_CONSTANT:
        break;
    }
    return term->coefficient * first;
}

/* Adds a weight times all powers at a time. */
static enum dalcs_status add_powers(const struct quadrature *q, double t, double weight,
                                    struct joules *sum) {
    struct dalcs_component *c = q->c;
    const struct dalcs_system *s = c->system;
    double *inputs = c->probe_u + s->n_x;
    inputs[0] = 1.0;
    for (int k = 1; k < s->n_inputs; k++) {
        inputs[k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, DALCS_RIGHT);
    }
    DALCS_TRY(dalcs_component_solve(c, 0.0, c->probe_u, c->scratch));
    for (int i = q->part->n_stepped; i < q->part->n_terms; i++) {
        const struct dalcs_power_term *term = &q->part->term[i];
        sum->of[term->account] += weight * power_of(term, c->scratch, inputs);
    }
    return DALCS_OK;
}

static enum dalcs_status apply_rule(const struct quadrature *q, double from, double to,
                                    struct joules *sum) {
    *sum = (struct joules){{0.0}};
    for (int k = 0; k < POINTS; k++) {
        const double t = 0.5 * (from + to) + 0.5 * (to - from) * ABSCISSA[k];
        DALCS_TRY(add_powers(q, t, 0.5 * (to - from) * WEIGHT[k], sum));
    }
    return DALCS_OK;
}

static double largest_of(const struct joules *sum) {
    double most = 0.0;
    for (int k = 0; k < DALCS_N_POWER_ACCOUNTS; k++) {
        most = fmax(most, fabs(sum->of[k]));
    }
    return most;
}

/* Do two halves tell as much as the whole, to what answers are known to? */
static bool agree(const struct quadrature *q, const struct joules *whole, const struct joules *a,
                  const struct joules *b) {
    struct joules off;
    for (int k = 0; k < DALCS_N_POWER_ACCOUNTS; k++) {
        off.of[k] = a->of[k] + b->of[k] - whole->of[k];
    }
    const double most = fmax(q->most, largest_of(whole));
    return largest_of(&off) <= dalcs_beyond * dalcs_answer_rounded * most;
}

static enum dalcs_status halve(const struct quadrature *q, double from, double to, int left,
                               const struct joules *whole, struct dalcs_energy *energy) {
    const double middle = 0.5 * (from + to);
    struct joules half[2];
    DALCS_TRY(apply_rule(q, from, middle, &half[0]));
    DALCS_TRY(apply_rule(q, middle, to, &half[1]));
    if (left > 0 && !agree(q, whole, &half[0], &half[1])) {
        DALCS_TRY(halve(q, from, middle, left - 1, &half[0], energy));
        return halve(q, middle, to, left - 1, &half[1], energy);
    }
    for (int k = 0; k < DALCS_N_POWER_ACCOUNTS; k++) {
        dalcs_energy_enter(energy, (enum dalcs_power_account)k, half[0].of[k] + half[1].of[k]);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_energy_enter_bent(struct dalcs_energy *energy,
                                          const struct dalcs_energy_part *part,
                                          struct dalcs_component *c, double stop) {
    struct quadrature q = {.part = part, .c = c};
    struct joules whole;
    for (double from = 0.0; from < stop;) {
        double to = stop;
        for (int k = 0; k < c->varying.n; k++) {
            const int stimulus = c->system->stimulus[c->varying.input[k]];
            to = fmin(to, dalcs_stimulus_next_edge(&c->circuit->stimulus[stimulus], from));
        }
        DALCS_TRY(apply_rule(&q, from, to, &whole));
        q.most = largest_of(&whole);
        DALCS_TRY(halve(&q, from, to, MOST_HALVINGS, &whole, energy));
        from = to;
    }
    return DALCS_OK;
}
