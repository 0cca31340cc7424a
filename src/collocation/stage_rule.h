/* stage_rule.h - integrals of products of the stages' polynomials, over a step or the first part of it.
 *
 * Voltages and currents are taken as the polynomials of degree s - 1 through the s stages, where they
 * obey Kirchhoff's laws at all times, as the equations do at the stages. Over a whole step the rule of
 * the stages themselves is exact for products of two; over a part of it Gauss' rule with s nodes is. */
#ifndef DALCS_STAGE_RULE_H
#define DALCS_STAGE_RULE_H

#include "collocation.h"

#include <stdbool.h>

/* Points by fours, as many as an instruction takes. */
typedef double dalcs_points __attribute__((vector_size(32), aligned(32)));

enum { DALCS_POINT_GROUPS = DALCS_MAX_NODES / 4 };

struct dalcs_stage_rule {
    int s;
    bool is_whole;
    const double *integral; /* [s] of the stages' Lagrange polynomials over a whole step */

    /* The rest only where the step is cut. Points 0..s-1 are those of the rule, the others the end. */
    dalcs_points weight[DALCS_POINT_GROUPS];                  /* 0 from point s on */
    dalcs_points value[DALCS_MAX_STAGES][DALCS_POINT_GROUPS]; /* of the stages' polynomials */

    /* The polynomial with its zeros at the stages that is 1 at the start: what states miss the one
     * through the stages by, over what they miss it by at the start. At the points, its derivative. */
    dalcs_points slope[DALCS_POINT_GROUPS];
    double miss_at_end;
};

/* Up to `end` (in steps, 0 to 1). */
void dalcs_stage_rule_set(struct dalcs_stage_rule *rule, const struct dalcs_collocation *method,
                          double end);

/* Integral of a, a b; each is its values at the stages [s]. */
double dalcs_stage_rule_integral(const struct dalcs_stage_rule *rule, const double *a);
double dalcs_stage_rule_product(const struct dalcs_stage_rule *rule, const double *a,
                                const double *b);

/* What the method dissipates over what a state starts off by, `defect` in the metric of the storage
 * with defect' storage defect = square, where the states at the stages have storage products with it
 * `along`[s], and their polynomial at the start `along_start`:
 *     -integral (x - x~)' storage dx,     x~ the polynomial through the stages. */
double dalcs_stage_rule_loss(const struct dalcs_stage_rule *rule, double square,
                             const double *along, double along_start);

#endif
