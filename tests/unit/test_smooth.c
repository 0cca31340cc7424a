/* test_smooth.c - derivatives of smooth functions against differences, and where their tangents are taken. */
#include "run_tests.h"
#include "smooth.h"

#include <math.h>
#include <string.h>

static const char *const ONE[] = {"exp",      "ln",       "log10",    "sqrt",  "cbrt",  "sqr",
                                  "sin",      "cos",      "tan",      "asin",  "acos",  "atan",
                                  "sinh",     "cosh",     "tanh",     "asinh", "acosh", "atanh",
                                  "logistic", "softplus", "bernoulli"};
static const char *const TWO[] = {"*", "/", "pow", "pwr", "pwrs", "hypot", "atan2"};

static double difference(enum dalcs_smooth_kind kind, const double *x, int k) {
    const double h = 1e-5 * fabs(x[k]);
    double low[2] = {x[0], x[1]};
    double high[2] = {x[0], x[1]};
    low[k] -= h;
    high[k] += h;
    return (dalcs_smooth_value(kind, high) - dalcs_smooth_value(kind, low)) / (high[k] - low[k]);
}

static void check_gradient(const char *name, int n, const double *x) {
    enum dalcs_smooth_kind kind;
    double gradient[2];
    ck_assert_msg(dalcs_smooth_find(name, n, &kind), "%s", name);
    dalcs_smooth_gradient(kind, x, gradient);
    for (int k = 0; k < n && isfinite(dalcs_smooth_value(kind, x)); k++) {
        double wanted = difference(kind, x, k);
        ck_assert_msg(fabs(gradient[k] - wanted) <= 1e-8 * fmax(1.0, fabs(wanted)),
                      "%s by argument %d at %g, %g: %g, not %g", name, k, x[0], x[1], gradient[k],
                      wanted);
    }
}

START_TEST(test_gradients) {
    for (size_t i = 0; i < sizeof ONE / sizeof *ONE; i++) {
        for (int k = 1; k < 40; k++) {
            double x = strcmp(ONE[i], "asin") == 0 || strcmp(ONE[i], "acos") == 0 ||
                               strcmp(ONE[i], "atanh") == 0 || strcmp(ONE[i], "tan") == 0
                           ? 0.024 * k
                           : 0.17 * k;
            x = strcmp(ONE[i], "acosh") == 0 ? 1.0 + 0.1 * k : x;
            check_gradient(ONE[i], 1, (const double[]){x, 0.0});
        }
    }
    for (size_t i = 0; i < sizeof TWO / sizeof *TWO; i++) {
        for (int k = 1; k < 40; k++) {
            check_gradient(TWO[i], 2, (const double[]){0.17 * k, 2.5 - 0.11 * k});
            if (i != 2) {
                check_gradient(TWO[i], 2, (const double[]){-0.17 * k, 1.5 + 0.07 * k});
            }
        }
    }
}

END_TEST

/* On the way up an exponential is met by steps that grow its value by what a tangent can tell. */
START_TEST(test_tangent_points) {
    ck_assert(dalcs_smooth_tangent_point(DALCS_SMOOTH_EXP, -300.0, -20.0) == -20.0);
    ck_assert(dalcs_smooth_tangent_point(DALCS_SMOOTH_EXP, 30.0, -20.0) == -20.0);
    ck_assert(dalcs_smooth_tangent_point(DALCS_SMOOTH_EXP, 30.0, 30.5) == 30.5);
    ck_assert(dalcs_smooth_tangent_point(DALCS_SMOOTH_EXP, 0.0, 400.0) == log1p(400.0));
    ck_assert(dalcs_smooth_tangent_point(DALCS_SMOOTH_SINH, 0.0, -400.0) == -log1p(400.0));
    ck_assert(dalcs_smooth_tangent_point(DALCS_SMOOTH_PRODUCT, 0.0, 400.0) == 400.0);
}

END_TEST

/* Lines to begin with are neither flat nor infinite. */
START_TEST(test_nominal_gradients) {
    for (size_t i = 0; i < sizeof ONE / sizeof *ONE + sizeof TWO / sizeof *TWO; i++) {
        const int n = i < sizeof ONE / sizeof *ONE ? 1 : 2;
        const char *name = n == 1 ? ONE[i] : TWO[i - sizeof ONE / sizeof *ONE];
        enum dalcs_smooth_kind kind;
        double gradient[2];
        ck_assert(dalcs_smooth_find(name, n, &kind));
        dalcs_smooth_nominal_gradient(kind, (const double[]){0.0, 0.0},
                                      (const bool[]){false, n < 2}, gradient);
        ck_assert_msg(isfinite(gradient[0]) && gradient[0] != 0.0, "%s: %g", name, gradient[0]);
    }
}

END_TEST

RUN_TESTS("smooth", test_gradients, test_tangent_points, test_nominal_gradients)
