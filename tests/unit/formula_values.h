/* formula_values.h - the value of a formula's pairs at given voltages. */
#ifndef DALCS_TEST_FORMULA_VALUES_H
#define DALCS_TEST_FORMULA_VALUES_H

#include "build_circuit.h"

#include <math.h>
#include <stdio.h>

enum { MOST_PAIRS = 400 };

struct point {
    double v[4]; /* of ground and of the nodes a, b, c, which come first in every netlist here */
    double t;
};

static inline double sum_of(const struct dalcs_circuit *circuit, const struct dalcs_affine *a,
                            const struct point *point, const double *lambda) {
    double sum = a->constant;
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        const double x =
            term->kind == DALCS_QUANTITY_VOLTAGE ? point->v[term->index]
            : term->kind == DALCS_QUANTITY_PAIR
                ? lambda[term->index]
                : dalcs_stimulus_value(&circuit->stimulus[term->index], point->t, DALCS_RIGHT);
        sum += term->coefficient * x;
    }
    return sum;
}

/* The coefficient of a lambda in w. */
static inline double coefficient_of(const struct dalcs_affine *w, int pair) {
    double coefficient = 0;
    for (int k = 0; k < w->n; k++) {
        const bool is_it = w->term[k].kind == DALCS_QUANTITY_PAIR && w->term[k].index == pair;
        coefficient = is_it ? w->term[k].coefficient : coefficient;
    }
    return coefficient;
}

/* Solves the pairs one cell after the other: a cell's argument is known by those before it. */
static inline double output_at(const struct dalcs_circuit *circuit, const struct dalcs_behaviour *b,
                               const struct point *point) {
    double lambda[MOST_PAIRS] = {0};
    ck_assert_int_le(b->n_pairs, MOST_PAIRS);
    for (int k = 0; k < b->n_pairs; k++) {
        const double argument = -sum_of(circuit, &b->w[k], point, lambda);
        const double resistance = coefficient_of(&b->w[k], k);
        const bool is_box = k + 1 < b->n_pairs && coefficient_of(&b->w[k], k + 1) == 1;
        if (!is_box) {
            lambda[k] = fmax(argument / resistance, 0);
            continue;
        }
        const double height = b->w[k + 1].constant;
        const double through = resistance > 0 ? argument / resistance
                               : argument > 0 ? (double)INFINITY
                                              : -(double)INFINITY;
        lambda[k] = fmin(fmax(through, 0), height);
        lambda[k + 1] = fmax(argument - resistance * height, 0);
        k++;
    }
    /* Whatever made them, they are complementary. */
    for (int k = 0; k < b->n_pairs; k++) {
        const double w = sum_of(circuit, &b->w[k], point, lambda);
        ck_assert_double_ge(w, -1e-9 * (1 + lambda[k]));
        ck_assert_double_ge(lambda[k], 0);
        ck_assert_double_le(fmin(fabs(w), lambda[k]), 1e-9 * (1 + fabs(w)));
    }
    return sum_of(circuit, &b->output, point, lambda);
}

static const char NODES[] = "t\nVa a 0 0\nVb b 0 0\nVc c 0 0\nRa a 0 1\nRb b 0 1\nRc c 0 1\n.op\n";

static inline void build_formula(struct dalcs_circuit *circuit, const char *formula) {
    char netlist[20000];
    snprintf(netlist, sizeof netlist,
             "%s.param k=3\n.func f(x) {x+abs(x)}\nB1 q 0 V=%s\nRq q 0 1\n", NODES, formula);
    build_good_circuit(circuit, netlist);
}

#endif
