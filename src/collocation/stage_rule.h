/* stage_rule.h - integrals of products of the stages' polynomials, over a step or the first part of it.
 *
 * Voltages and currents are taken as the polynomials through the stages, where they
 * obey Kirchhoff's laws at all times, as the equations do at the stages. Over a whole step the rule of
 * Radau's stages themselves is exact for products of two; else Gauss' rule with as many nodes is. */
#ifndef DALCS_STAGE_RULE_H
#define DALCS_STAGE_RULE_H

#include "collocation.h"

#include <stdbool.h>

/* Points by fours, as many as an instruction takes. */
typedef double dalcs_points __attribute__((vector_size(32), aligned(32)));

enum { DALCS_POINT_GROUPS = DALCS_MAX_NODES / 4 };

struct dalcs_stage_rule {
    int n_stages;
    bool is_whole;          /* a step of a method whose own rule is exact for products */
    const double *integral; /* [n_stages] of the stages' Lagrange polynomials over a whole step */

    /* The rest only where not. Points 0..n_stages-1 are those of the rule, the others the end. */
    dalcs_points weight[DALCS_POINT_GROUPS];                  /* 0 from point n_stages on */
    dalcs_points value[DALCS_MAX_STAGES][DALCS_POINT_GROUPS]; /* of the stages' polynomials */

    /* The polynomial with its zeros at the nodes that is 1 at the start: what states miss the one
     * through the stages by, over what they miss it by at the start. At the points, the derivative of
     * what has to be added to that one for the equations to hold at all times: itself, but where there is a
     * stage at the start the one with -1 over its weight there and 0 at the nodes (H. T. Huynh, AIAA
     * 2007-4079, sec. 3: flux reconstruction by lumping). */
    dalcs_points slope[DALCS_POINT_GROUPS];
    double miss_at_end;
};

/* Up to `end` (in steps, 0 to 1). */
void dalcs_stage_rule_set(struct dalcs_stage_rule *rule, const struct dalcs_collocation *method,
                          double end);

/* Integral of a, a b; each is its values at the stages [n_stages]. */
double dalcs_stage_rule_integral(const struct dalcs_stage_rule *rule, const double *a);
double dalcs_stage_rule_product(const struct dalcs_stage_rule *rule, const double *a,
                                const double *b);

/* What the method dissipates over what a state starts off by, `defect` in the metric of the storage
 * with defect' storage defect = square, where the states at the stages have storage products with it
 * `along`[n_stages], and their polynomial at the start `along_start`:
 *     -integral (x - x~)' storage dx,     x~ the polynomial through the stages. */
double dalcs_stage_rule_loss(const struct dalcs_stage_rule *rule, double square,
                             const double *along, double along_start);

#endif
