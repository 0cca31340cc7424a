/* stage_rule.c - Lagrange's polynomials on the stages at Gauss' points, without a division. */
#include "stage_rule.h"

#include <string.h>

/* Integral of what has these values at the points. */
static inline double weigh(const struct dalcs_stage_rule *rule, const dalcs_points *value) {
    dalcs_points a = rule->weight * *value;
    return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

void dalcs_stage_rule_set(struct dalcs_stage_rule *rule, const struct dalcs_collocation *m,
                          double end) {
    int s = m->s;
    rule->s = s;
    rule->is_whole = end == 1.0;
    rule->integral = rule->is_whole ? m->weight : rule->own_integral;
    if (rule->is_whole) {
        return;
    }
    dalcs_points point;
    dalcs_points weight;
    memcpy(&point, m->gauss, sizeof(point));
    memcpy(&weight, m->gauss_weight, sizeof(weight));
    point *= end;
    weight *= end;
    rule->weight = weight;
    dalcs_points before = {1.0, 1.0, 1.0, 1.0, 1.0,
                           1.0, 1.0, 1.0}; /* products of the distances from the stages before */
    double start = 1.0;
    for (int j = 0; j < s; j++) {
        rule->value[j] = before;
        before *= point - m->node[j + 1];
        start *= -m->node[j + 1];
    }
    rule->miss_at_end = before[s] / start;
    dalcs_points behind = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    dalcs_points slope = {0.0};
    for (int j = s - 1; j >= 0; j--) {
        double scale = m->barycentric[j + 1] * m->node[j + 1]; /* without the node at the start */
        dalcs_points others = rule->value[j] * behind;
        behind *= point - m->node[j + 1];
        slope += others;
        rule->value[j] = scale * others;
        rule->own_integral[j] = weigh(rule, &rule->value[j]);
    }
    rule->slope = slope / start;
}

double dalcs_stage_rule_integral(const struct dalcs_stage_rule *rule, const double *a) {
    double sum = 0.0;
    for (int j = 0; j < rule->s; j++) {
        sum += rule->integral[j] * a[j];
    }
    return sum;
}

/* a at the points. */
static inline void spread(const struct dalcs_stage_rule *rule, const double *a,
                          dalcs_points *value) {
    dalcs_points sum = a[0] * rule->value[0];
    for (int j = 1; j < rule->s; j++) {
        sum += a[j] * rule->value[j];
    }
    *value = sum;
}

double dalcs_stage_rule_product(const struct dalcs_stage_rule *rule, const double *a,
                                const double *b) {
    if (rule->is_whole) {
        double sum = 0.0;
        for (int j = 0; j < rule->s; j++) {
            sum += rule->integral[j] * a[j] * b[j];
        }
        return sum;
    }
    dalcs_points at_points;
    dalcs_points other;
    spread(rule, a, &at_points);
    if (a == b) {
        other = at_points;
    } else {
        spread(rule, b, &other);
    }
    at_points *= other;
    return weigh(rule, &at_points);
}

/* With x - x~ = miss(theta) defect, and by parts,
 *     integral of miss defect' storage (x~' + miss' defect)
 *         = [miss along] - integral of miss' along + 1/2 [miss^2] square. */
double dalcs_stage_rule_loss(const struct dalcs_stage_rule *rule, double square,
                             const double *along, double along_start) {
    if (rule->is_whole) { /* miss is orthogonal to all of a lower degree than s - 1, and 0 at the end */
        return 0.5 * square;
    }
    dalcs_points at_points;
    spread(rule, along, &at_points);
    double sum = rule->miss_at_end * at_points[rule->s] - along_start;
    at_points *= rule->slope;
    sum -= weigh(rule, &at_points);
    return -(sum + 0.5 * square * (rule->miss_at_end * rule->miss_at_end - 1.0));
}
