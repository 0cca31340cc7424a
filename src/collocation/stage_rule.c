/* stage_rule.c - Lagrange's polynomials on the stages at Gauss' points, without a division. */
#include "stage_rule.h"

#include "wide_vectors.h"

#include <string.h>

/* Integral of what has these values at the points. */
static inline double weigh(const struct dalcs_stage_rule *rule, const dalcs_points *value) {
    double sum = 0.0;
    for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
        dalcs_points a = rule->weight[g] * value[g];
        sum += (a[0] + a[1]) + (a[2] + a[3]);
    }
    return sum;
}

DALCS_TWICE(void, set_cut,
            (struct dalcs_stage_rule * rule, const struct dalcs_collocation *m, double end),
            (rule, m, end)) {
    dalcs_points point[DALCS_POINT_GROUPS];
    dalcs_points before[DALCS_POINT_GROUPS]; /* products of the distances from the stages before */
    dalcs_points behind[DALCS_POINT_GROUPS];
    dalcs_points slope[DALCS_POINT_GROUPS];
    memcpy(point, m->quadrature.node, sizeof(point));
    memcpy(rule->weight, m->quadrature.weight, sizeof(rule->weight));
    for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
        point[g] *= end;
        rule->weight[g] *= end;
        before[g] = behind[g] = (dalcs_points){1.0, 1.0, 1.0, 1.0};
        slope[g] = (dalcs_points){0.0};
    }
    bool starts = m->n_stages > m->s;
    double start = 1.0;
    for (int j = 0; j < m->n_stages; j++) {
        for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
            rule->value[j][g] = before[g];
            before[g] *= point[g] - m->node[j + 1];
        }
        start *= -m->node[j + 1];
    }
    rule->miss_at_end = before[DALCS_POINT_GROUPS - 1][3] / start;
    for (int j = m->n_stages - 1; j >= 0; j--) {
        double scale = starts ? m->barycentric[(j + 1) % m->n_stages]
                              : m->barycentric[j + 1] * m->node[j + 1]; /* no node at the start */
        for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
            dalcs_points others = rule->value[j][g] * behind[g];
            behind[g] *= point[g] - m->node[j + 1];
            slope[g] += others;
            rule->value[j][g] = scale * others;
        }
    }
    for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
        rule->slope[g] = starts ? rule->value[m->s][g] / -m->weight[m->s] : slope[g] / start;
    }
    if (starts) {
        rule->miss_at_end = rule->value[m->s][DALCS_POINT_GROUPS - 1][3];
    }
}

void dalcs_stage_rule_set(struct dalcs_stage_rule *rule, const struct dalcs_collocation *m,
                          double end) {
    rule->n_stages = m->n_stages;
    rule->is_whole = end == 1.0 && m->family == DALCS_RADAU_IIA;
    rule->integral = m->weight;
    if (!rule->is_whole) {
        set_cut(rule, m, end);
    }
}

/* a at the points. */
static inline void spread(const struct dalcs_stage_rule *rule, const double *a,
                          dalcs_points *value) {
    dalcs_points sum[DALCS_POINT_GROUPS] = {{0.0}};
    for (int j = 0; j < rule->n_stages; j++) {
        for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
            sum[g] += a[j] * rule->value[j][g];
        }
    }
    memcpy(value, sum, sizeof(sum));
}

DALCS_TWICE(double, integral_of_cut, (const struct dalcs_stage_rule *rule, const double *a),
            (rule, a)) {
    dalcs_points at_points[DALCS_POINT_GROUPS];
    spread(rule, a, at_points);
    return weigh(rule, at_points);
}

DALCS_TWICE(double, product_of_cut,
            (const struct dalcs_stage_rule *rule, const double *a, const double *b), (rule, a, b)) {
    dalcs_points at_points[DALCS_POINT_GROUPS];
    dalcs_points other[DALCS_POINT_GROUPS];
    spread(rule, a, at_points);
    if (a == b) {
        memcpy(other, at_points, sizeof(other));
    } else {
        spread(rule, b, other);
    }
    for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
        at_points[g] *= other[g];
    }
    return weigh(rule, at_points);
}

double dalcs_stage_rule_integral(const struct dalcs_stage_rule *rule, const double *a) {
    if (!rule->is_whole) {
        return integral_of_cut(rule, a);
    }
    double sum = 0.0;
    for (int j = 0; j < rule->n_stages; j++) {
        sum += rule->integral[j] * a[j];
    }
    return sum;
}

double dalcs_stage_rule_product(const struct dalcs_stage_rule *rule, const double *a,
                                const double *b) {
    if (!rule->is_whole) {
        return product_of_cut(rule, a, b);
    }
    double sum = 0.0;
    for (int j = 0; j < rule->n_stages; j++) {
        sum += rule->integral[j] * a[j] * b[j];
    }
    return sum;
}

/* With x - x~ = miss(theta) defect, and by parts,
 *     integral of miss defect' storage (x~' + miss' defect)
 *         = [miss along] - integral of miss' along + 1/2 [miss^2] square. */
DALCS_TWICE(double, loss_of_cut,
            (const struct dalcs_stage_rule *rule, double square, const double *along,
             double along_start),
            (rule, square, along, along_start)) {
    dalcs_points at_points[DALCS_POINT_GROUPS];
    spread(rule, along, at_points);
    double sum = rule->miss_at_end * at_points[DALCS_POINT_GROUPS - 1][3] - along_start;
    for (int g = 0; g < DALCS_POINT_GROUPS; g++) {
        at_points[g] *= rule->slope[g];
    }
    sum -= weigh(rule, at_points);
    return -(sum + 0.5 * square * (rule->miss_at_end * rule->miss_at_end - 1.0));
}

double dalcs_stage_rule_loss(const struct dalcs_stage_rule *rule, double square,
                             const double *along, double along_start) {
    if (rule->is_whole) { /* miss is orthogonal to all of a lower degree than s - 1, and 0 at the end */
        return 0.5 * square;
    }
    return loss_of_cut(rule, square, along, along_start);
}
