/* test_stage_rule.c - integrals of products and losses against those of the polynomials themselves. */
#include "stage_rule.h"

#include "run_tests.h"

#include <math.h>

static const int STAGES[] = {1, 3, 5, 7, 9};
static const double ENDS[] = {1.0, 0.9999, 0.7, 0.25, 1e-3, 0.0};

enum { N_ENDS = sizeof ENDS / sizeof ENDS[0] };

static void check_near(double a, double b) {
    ck_assert_msg(fabs(a - b) <= 4e-14 * fmax(1.0, fabs(b)), "%.17g is not %.17g", a, b);
}

/* x^p at the stages. */
static void powers(const struct dalcs_collocation *m, int p, double *value) {
    for (int i = 0; i < m->s; i++) {
        value[i] = pow(m->node[i + 1], p);
    }
}

/* x^p x^q with p, q < s: exactly end^(p + q + 1) / (p + q + 1). */
START_TEST(test_products) {
    for (int k = 0; k < 4; k++) {
        const struct dalcs_collocation *m = dalcs_collocation_of(DALCS_RADAU_IIA, STAGES[k]);
        for (int e = 0; e < N_ENDS; e++) {
            struct dalcs_stage_rule rule;
            dalcs_stage_rule_set(&rule, m, ENDS[e]);
            for (int p = 0; p < m->s; p++) {
                double a[DALCS_MAX_STAGES];
                powers(m, p, a);
                check_near(dalcs_stage_rule_integral(&rule, a), pow(ENDS[e], p + 1) / (p + 1));
                for (int q = 0; q < m->s; q++) {
                    double b[DALCS_MAX_STAGES];
                    powers(m, q, b);
                    double exact = pow(ENDS[e], p + q + 1) / (p + q + 1);
                    check_near(dalcs_stage_rule_product(&rule, a, p == q ? a : b), exact);
                    check_near(dalcs_stage_rule_product(&rule, a, b), exact);
                }
            }
        }
    }
}

END_TEST

/* A state x^s + 2 x - 3, storage 5: the loss closes the balance between what is stored and the integral
 * of x~ x', x~ of degree s - 1 through the stages. */
START_TEST(test_loss) {
    for (int k = 0; k < 4; k++) {
        const struct dalcs_collocation *m = dalcs_collocation_of(DALCS_RADAU_IIA, STAGES[k]);
        for (int e = 0; e < N_ENDS; e++) {
            const double storage = 5.0;
            struct dalcs_stage_rule rule;
            double x[DALCS_MAX_STAGES];
            double slope[DALCS_MAX_STAGES];
            double along[DALCS_MAX_STAGES];
            double start = 0.0;
            dalcs_stage_rule_set(&rule, m, ENDS[e]);
            for (int i = 0; i < m->s; i++) {
                double c = m->node[i + 1];
                x[i] = pow(c, m->s) + 2.0 * c - 3.0;
                slope[i] = m->s * pow(c, m->s - 1) + 2.0;
                start += m->back[i] * x[i];
            }
            double defect = -3.0 - start;
            for (int i = 0; i < m->s; i++) {
                along[i] = storage * defect * x[i];
            }
            double at_end = pow(ENDS[e], m->s) + 2.0 * ENDS[e] - 3.0;
            double stored = 0.5 * storage * (at_end * at_end - 9.0);
            double given = storage * dalcs_stage_rule_product(&rule, x, slope);
            double loss = dalcs_stage_rule_loss(&rule, storage * defect * defect, along,
                                                storage * defect * start);
            ck_assert(fabs(defect) > 1e-4);
            check_near(given, stored + loss);
            if (ENDS[e] == 1.0) {
                check_near(loss, 0.5 * storage * defect * defect);
            }
        }
    }
}

END_TEST

/* With a stage at the start: v, of degree s, through the stages, which starts 0.1 beside the state. The equations hold
 * as v' and, at the start alone, what pulls it to the state (SBP form of Lobatto IIIC): -0.1 / weight. */
START_TEST(test_loss_with_start) {
    for (int n = 3; n <= DALCS_MAX_STAGES; n += 2) {
        const struct dalcs_collocation *m = dalcs_collocation_of(DALCS_LOBATTO_IIIC, n);
        for (int e = 0; e < N_ENDS; e++) {
            const double storage = 5.0;
            const double defect = 0.1;
            struct dalcs_stage_rule rule;
            double v[DALCS_MAX_STAGES];
            double slope[DALCS_MAX_STAGES];
            double along[DALCS_MAX_STAGES];
            double weight[DALCS_MAX_NODES];
            dalcs_stage_rule_set(&rule, m, ENDS[e]);
            for (int i = 0; i < n; i++) {
                double c = i < m->s ? m->node[i + 1] : 0.0;
                v[i] = pow(c, m->s) + 2.0 * c - 3.0;
                slope[i] =
                    m->s * pow(c, m->s - 1) + 2.0 - (i == m->s ? defect / m->weight[i] : 0.0);
                along[i] = storage * defect * v[i];
            }
            dalcs_collocation_weights(m, ENDS[e], weight);
            double at_end = pow(ENDS[e], m->s) + 2.0 * ENDS[e] - 3.0 + defect * weight[0];
            double stored = 0.5 * storage * (at_end * at_end - 2.9 * 2.9);
            double given = storage * dalcs_stage_rule_product(&rule, v, slope);
            double loss = dalcs_stage_rule_loss(&rule, storage * defect * defect, along,
                                                storage * defect * -3.0);
            check_near(given, stored + loss);
        }
    }
}

END_TEST

RUN_TESTS("stage_rule", test_products, test_loss, test_loss_with_start)
