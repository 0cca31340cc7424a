/* test_collocation.c - the tables of the methods against closed forms and the conditions that define
 * them. */
#include "collocation.h"

#include "run_tests.h"

#include <float.h>
#include <math.h>

static const int STAGES[] = {1, 3, 5, 7, 9};

/* Radau IIA, then Lobatto IIIC. */
static const struct dalcs_collocation *next_method(const struct dalcs_collocation *c) {
    const struct dalcs_collocation *next = dalcs_collocation_of(c->family, c->n_stages + 2);
    return next == NULL && c->family == DALCS_RADAU_IIA
               ? dalcs_collocation_of(DALCS_LOBATTO_IIIC, 3)
               : next;
}

#define FOR_ALL_METHODS(c)                                                                         \
    for (const struct dalcs_collocation *c = dalcs_collocation_of(DALCS_RADAU_IIA, 1); c != NULL;  \
         c = next_method(c))

static void check_near(long double a, long double b, double tolerance) {
    ck_assert_msg(fabsl(a - b) <= tolerance, "%.21Lg is not %.21Lg to %g", a, b, tolerance);
}

/* Power series with coefficients of both signs. */
static long double polynomial(int degree, int seed, long double x) {
    long double sum = 0.0L;
    for (int k = degree; k >= 0; k--) {
        sum = sum * x + ((k * 7 + seed * 3) % 11 - 5) * 0.25L;
    }
    return sum;
}

START_TEST(test_closed_forms) {
    for (int k = 0; k < 4; k++) {
        const struct dalcs_collocation *c = dalcs_collocation_of(DALCS_RADAU_IIA, STAGES[k]);
        ck_assert_int_eq(c->s, STAGES[k]);
        ck_assert_int_eq(c->n_pairs, (STAGES[k] - 1) / 2);
        ck_assert_double_eq(c->node[0], 0.0);
        ck_assert_double_eq(c->node[c->s], 1.0);
        for (int i = 0; i < c->s; i++) {
            ck_assert(c->node[i] < c->node[i + 1]);
        }
    }
    const struct dalcs_collocation *euler = dalcs_collocation_of(DALCS_RADAU_IIA, 1);
    ck_assert_double_eq(euler->lambda, 1.0);
    ck_assert_double_eq(euler->exact.to[0].high[0], 1.0);
    ck_assert_double_eq(euler->exact.from[0].high[0], 1.0);
    /* Hairer and Wanner, Solving ODEs II, sec. IV.8 */
    const struct dalcs_collocation *three = dalcs_collocation_of(DALCS_RADAU_IIA, 3);
    double a = cbrt(81.0);
    double b = cbrt(9.0);
    double re = (12.0 - a + b) / 60.0;
    double im = (a + b) * sqrt(3.0) / 60.0;
    double square = re * re + im * im;
    check_near(three->node[1], (4.0L - sqrtl(6.0L)) / 10.0L, DBL_EPSILON);
    check_near(three->node[2], (4.0L + sqrtl(6.0L)) / 10.0L, DBL_EPSILON);
    check_near(three->lambda, 30.0 / (6.0 + a - b), 4 * DBL_EPSILON);
    check_near(creal(three->mu[0]), re / square, 8 * DBL_EPSILON);
    check_near(fabs(cimag(three->mu[0])), im / square, 8 * DBL_EPSILON);
}

END_TEST

/* What stage i takes of the pair's (re, im) parts is 2 Re(to W): the number `to`. */
static long double complex to_pair(const struct dalcs_collocation *c, int i, int p) {
    long double re = dalcs_extended_at(&c->exact.to[1 + 2 * p], i) / 2.0L;
    long double im = -dalcs_extended_at(&c->exact.to[2 + 2 * p], i) / 2.0L;
    return re + im * I;
}

static long double complex from_pair(const struct dalcs_collocation *c, int p, int j) {
    long double re = dalcs_extended_at(&c->exact.from[j], 1 + 2 * p);
    long double im = dalcs_extended_at(&c->exact.from[j], 2 + 2 * p);
    return re + im * I;
}

/* Node i as the table has it to the last digit: A 1 = c. */
static long double butcher(const struct dalcs_collocation *c, int i, int j) {
    long double sum = dalcs_extended_at(&c->exact.to[0], i) *
                      dalcs_extended_at(&c->exact.from[j], 0) / c->exact.lambda;
    for (int p = 0; p < c->n_pairs; p++) {
        sum += 2.0L * creall(to_pair(c, i, p) * from_pair(c, p, j) / c->exact.mu[p]);
    }
    return sum;
}

/* The matrix that the eigenvalues and vectors make satisfies A c^(k-1) = c^k / k for k up to s, which
 * is collocation, or with a stage at the start stage order s, and the row of the last node integrates up to
 * order 2s - 1, of Lobatto IIIC 2s: that is 2 less than two times its stages. */
START_TEST(test_order_conditions) {
    FOR_ALL_METHODS(c) {
        long double node[DALCS_MAX_STAGES] = {0.0L};
        for (int i = 0; i < c->n_stages; i++) {
            for (int j = 0; j < c->n_stages; j++) {
                node[i] += butcher(c, i, j);
            }
            check_near(node[i], i < c->s ? c->node[i + 1] : 0.0, 2 * DBL_EPSILON);
        }
        int beyond = c->n_stages + c->s;
        for (int k = 1; k <= beyond; k++) {
            for (int i = k <= c->s ? 0 : c->s - 1; i < (k <= c->s ? c->n_stages : c->s); i++) {
                long double sum = 0.0L;
                for (int j = 0; j < c->n_stages; j++) {
                    sum += butcher(c, i, j) * (k > 1 ? powl(node[j], k - 1) : 1.0L);
                }
                if (k < beyond) {
                    check_near(sum, powl(node[i], k) / k, 1e-15);
                } else {
                    ck_assert(fabsl(sum - 1.0L / k) > 9e-11L); /* 9.4e-11 with nine */
                }
            }
        }
    }
}

END_TEST

/* Hairer and Wanner, Solving ODEs II, table IV.5.12; the start is the last stage here. */
START_TEST(test_lobatto_of_three) {
    static const long double A[3][3] = {{5.0L / 12.0L, -1.0L / 12.0L, 1.0L / 6.0L},
                                        {2.0L / 3.0L, 1.0L / 6.0L, 1.0L / 6.0L},
                                        {-1.0L / 3.0L, 1.0L / 6.0L, 1.0L / 6.0L}};
    const struct dalcs_collocation *c = dalcs_collocation_of(DALCS_LOBATTO_IIIC, 3);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            check_near(butcher(c, i, j), A[i][j], 1e-17);
        }
    }
    ck_assert(dalcs_collocation_of(DALCS_LOBATTO_IIIC, 1) == NULL);
    ck_assert(dalcs_collocation_of(DALCS_RADAU_IIA, 4) == NULL);
}

END_TEST

START_TEST(test_coordinates) {
    FOR_ALL_METHODS(c) {
        for (int i = 0; i < c->n_stages; i++) {
            for (int j = 0; j < c->n_stages; j++) {
                long double exact =
                    dalcs_extended_at(&c->exact.to[0], i) * dalcs_extended_at(&c->exact.from[j], 0);
                for (int p = 0; p < c->n_pairs; p++) {
                    exact += 2.0L * creall(to_pair(c, i, p) * from_pair(c, p, j));
                }
                check_near(exact, i == j ? 1.0L : 0.0L, 1e-15);
            }
        }
        long double one = 0.0L;
        for (int i = 0; i < c->n_stages; i++) {
            one += dalcs_extended_at(&c->exact.from[i], 0);
        }
        check_near(one, 1.0L, 1e-17);
        check_near(c->exact.lambda, c->lambda, DBL_EPSILON * c->lambda);
        for (int p = 0; p < c->n_pairs; p++) {
            long double complex sum = 0.0L;
            for (int i = 0; i < c->n_stages; i++) {
                sum += from_pair(c, p, i);
            }
            check_near(cabsl(sum - 1.0L), 0.0L, 1e-17);
            check_near(cabsl(c->exact.mu[p] - c->mu[p]), 0.0L, DBL_EPSILON * cabs(c->mu[p]));
        }
    }
}

END_TEST

START_TEST(test_weights) {
    FOR_ALL_METHODS(c) {
        double weight[DALCS_MAX_NODES];
        for (int node = 0; node <= c->s; node++) {
            dalcs_collocation_weights(c, c->node[node], weight);
            for (int k = 0; k <= c->s; k++) {
                ck_assert_double_eq(weight[k], k == node ? 1.0 : 0.0);
            }
        }
        for (int at = -3; at <= 23; at++) {
            double theta = at / 20.0;
            for (int seed = 0; seed < 4; seed++) {
                long double sum = 0.0L;
                dalcs_collocation_weights(c, theta, weight);
                for (int k = 0; k <= c->s; k++) {
                    sum += weight[k] * polynomial(c->s, seed, c->node[k]);
                }
                check_near(sum, polynomial(c->s, seed, theta), 1e-12);
            }
        }
    }
}

END_TEST

/* Powers of time in Newton's form, and a constant, of which nothing but itself is left. */
START_TEST(test_newton) {
    FOR_ALL_METHODS(c) {
        for (int power = 0; power <= c->s; power++) {
            double value[DALCS_MAX_NODES] = {0.0};
            double coefficient[DALCS_MAX_NODES] = {0.0};
            for (int k = 0; k <= c->s; k++) {
                ck_assert_double_eq(c->differences.node[k], c->node[c->differences.order[k]]);
                value[k] = pow(c->differences.node[k], power);
                for (int i = k; i > 0 && i <= c->s; i++) {
                    coefficient[i] += c->differences.coefficient[k][i] * (value[k] - value[0]);
                }
            }
            coefficient[0] = value[0];
            for (double theta = 0.0; theta <= 1.0; theta += 0.0625) {
                double sum = coefficient[c->s];
                for (int k = c->s - 1; k >= 0; k--) {
                    sum = sum * (theta - c->differences.node[k]) + coefficient[k];
                }
                ck_assert_double_le(fabs(sum - pow(theta, power)), power == 0 ? 0.0 : 2e-15);
            }
        }
    }
}

END_TEST

/* Through the stages alone, one degree less, back to the start; and where the nodes see least. */
START_TEST(test_extrapolation) {
    FOR_ALL_METHODS(c) {
        for (int seed = 0; seed < 4; seed++) {
            long double start = 0.0L;
            long double exact = 0.0L;
            long double between = c->worst.value[0] * polynomial(c->s, seed, 0.0L);
            int degree = c->n_stages - 1;
            for (int k = 1; k <= c->n_stages; k++) {
                double node = k <= c->s ? c->node[k] : 0.0;
                exact += c->exact.back[k - 1] * polynomial(degree, seed, node);
                start += c->back[k - 1] * polynomial(degree, seed, node);
                between += k <= c->s ? c->worst.value[k] * polynomial(c->s, seed, node) : 0.0;
            }
            check_near(exact, polynomial(degree, seed, 0.0L), 1e-13); /* nodes are rounded */
            check_near(start, polynomial(degree, seed, 0.0L), 1e-13);
            check_near(between, polynomial(c->s, seed, c->worst.node), 1e-14);
        }
        for (int at = 0; at <= 1000; at++) {
            double product = 1.0;
            for (int k = 0; k <= c->s; k++) {
                product *= fabs(at / 1000.0 - c->node[k]);
            }
            ck_assert(product <= c->worst.size * (1.0 + 1e-12));
        }
        double product = 1.0;
        for (int k = 0; k <= c->s; k++) {
            product *= fabs(c->worst.node - c->node[k]);
        }
        check_near(product, c->worst.size, 1e-14 * c->worst.size);
        ck_assert(c->worst.factor >= 1.0);
    }
}

END_TEST

START_TEST(test_bernstein) {
    FOR_ALL_METHODS(c) {
        for (int seed = 0; seed < 4; seed++) {
            double coefficient[DALCS_MAX_NODES] = {0.0};
            double least = INFINITY;
            double most = -INFINITY;
            for (int k = 0; k <= c->s; k++) {
                double value = (double)polynomial(c->s, seed, c->node[k]);
                least = fmin(least, value);
                most = fmax(most, value);
                for (int i = 0; i <= c->s; i++) {
                    coefficient[i] += c->bernstein.from_nodes[k][i] * value;
                }
            }
            for (int i = 0; i <= c->s; i++) {
                double room = c->bernstein.spread * (most - least) + 1e-13;
                ck_assert(coefficient[i] >= least - room && coefficient[i] <= most + room);
            }
            for (int at = 0; at <= 20; at++) {
                double theta = at / 20.0;
                double sum = 0.0;
                double binomial = 1.0;
                for (int i = 0; i <= c->s; i++) {
                    sum += binomial * pow(theta, i) * pow(1.0 - theta, c->s - i) * coefficient[i];
                    binomial = binomial * (c->s - i) / (i + 1);
                }
                check_near(sum, polynomial(c->s, seed, theta), 1e-13);
            }
        }
        /* The spread is attained by values that alternate with a row of the conversion. */
        double worst = 0.0;
        for (int i = 0; i <= c->s; i++) {
            double sum = 0.0;
            for (int k = 0; k <= c->s; k++) {
                sum += fabs(c->bernstein.from_nodes[k][i]);
            }
            worst = fmax(worst, sum);
        }
        check_near(1.0 + 2.0 * c->bernstein.spread, worst, 1e-12 * worst);
    }
}

END_TEST

START_TEST(test_spread) {
    for (int s = 1; s <= DALCS_MAX_STAGES; s += 2) {
        const struct dalcs_collocation *c = dalcs_collocation_of(DALCS_RADAU_IIA, s);
        double worst = 0.0;
        for (int at = 0; at <= 997; at++) {
            double weight[DALCS_MAX_NODES];
            double sum = 0.0;
            dalcs_collocation_weights(c, at / 997.0, weight);
            for (int k = 0; k <= s; k++) {
                sum += fabs(weight[k]);
            }
            worst = fmax(worst, sum);
        }
        ck_assert_double_le(worst, 1.0 + 2.0 * c->spread);
        check_near(worst, 1.0 + 2.0 * c->spread, 2e-3 * worst);
    }
}

END_TEST

RUN_TESTS("collocation", test_closed_forms, test_order_conditions, test_lobatto_of_three,
          test_coordinates, test_weights, test_newton, test_extrapolation, test_bernstein,
          test_spread)
