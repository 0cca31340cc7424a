/* stage_rule.c - Lagrange's polynomials on the stages at Gauss' points, without a division. */
#include "stage_rule.h"

/* Eight points at once, for the compiler to take two or four of them in one instruction. */
enum { POINTS = DALCS_MAX_NODES };

void dalcs_stage_rule_set(struct dalcs_stage_rule *rule, const struct dalcs_collocation *m,
                          double end) {
    int s = m->s;
    rule->s = s;
    rule->is_whole = end == 1.0;
    rule->integral = rule->is_whole ? m->weight : rule->own_integral;
    if (rule->is_whole) {
        return;
    }
    double distance[DALCS_MAX_STAGES][POINTS];
    double before[POINTS]; /* products of the distances from the stages before, from those behind */
    double behind[POINTS];
    double start = 1.0;
    for (int q = 0; q < POINTS; q++) {
        double point = q < s ? end * m->gauss[q] : end;
        rule->weight[q] = q < s ? end * m->gauss_weight[q] : 0.0;
        rule->slope[q] = 0.0;
        before[q] = 1.0;
        behind[q] = 1.0;
        for (int j = 0; j < s; j++) {
            distance[j][q] = point - m->node[j + 1];
        }
    }
    for (int j = 0; j < s; j++) {
        start *= -m->node[j + 1];
        for (int q = 0; q < POINTS; q++) {
            rule->value[j][q] = before[q];
            before[q] *= distance[j][q];
        }
    }
    rule->miss_at_end = before[s] / start;
    for (int j = s - 1; j >= 0; j--) {
        double scale = m->barycentric[j + 1] * m->node[j + 1]; /* without the node at the start */
        double sum = 0.0;
        for (int q = 0; q < POINTS; q++) {
            double others = rule->value[j][q] * behind[q];
            rule->slope[q] += others / start;
            rule->value[j][q] = scale * others;
            behind[q] *= distance[j][q];
        }
        for (int q = 0; q < POINTS; q++) {
            sum += rule->weight[q] * rule->value[j][q];
        }
        rule->own_integral[j] = sum;
    }
}

double dalcs_stage_rule_integral(const struct dalcs_stage_rule *rule, const double *a) {
    double sum = 0.0;
    for (int j = 0; j < rule->s; j++) {
        sum += rule->integral[j] * a[j];
    }
    return sum;
}

/* a at the points. */
static inline void spread(const struct dalcs_stage_rule *rule, const double *a, double *value) {
    for (int q = 0; q < POINTS; q++) {
        value[q] = 0.0;
    }
    for (int j = 0; j < rule->s; j++) {
        for (int q = 0; q < POINTS; q++) {
            value[q] += a[j] * rule->value[j][q];
        }
    }
}

double dalcs_stage_rule_product(const struct dalcs_stage_rule *rule, const double *a,
                                const double *b) {
    double sum = 0.0;
    if (rule->is_whole) {
        for (int j = 0; j < rule->s; j++) {
            sum += rule->integral[j] * a[j] * b[j];
        }
        return sum;
    }
    double at_points[2][POINTS];
    spread(rule, a, at_points[0]);
    if (a != b) {
        spread(rule, b, at_points[1]);
    }
    const double *other = at_points[a != b ? 1 : 0];
    for (int q = 0; q < POINTS; q++) {
        sum += rule->weight[q] * at_points[0][q] * other[q];
    }
    return sum;
}

/* With x - x~ = miss(theta) defect, and by parts,
 *     integral of miss defect' storage (x~' + miss' defect)
 *         = [miss along] - integral of miss' along + 1/2 [miss^2] square. */
double dalcs_stage_rule_loss(const struct dalcs_stage_rule *rule, double square,
                             const double *along, double along_start) {
    if (rule->is_whole) { /* miss is orthogonal to all of a lower degree than s - 1, and 0 at the end */
        return 0.5 * square;
    }
    double at_points[POINTS];
    spread(rule, along, at_points);
    double sum = rule->miss_at_end * at_points[rule->s] - along_start;
    for (int q = 0; q < POINTS; q++) {
        sum -= rule->weight[q] * rule->slope[q] * at_points[q];
    }
    return -(sum + 0.5 * square * (rule->miss_at_end * rule->miss_at_end - 1.0));
}
