/* test_stages.c - steps in a given mode against a direct solution of the collocation equations, singular
 * modes against their closed forms, and the store of steps. */
#include "start_stages.h"

#include <math.h>
#include <stdlib.h>

static double inputs_at(const double *u, const struct dalcs_csr *a, int row) {
    return dalcs_csr_row_dot(a, row, u);
}

/* The derivative at node i of the polynomial that is 1 at node j and 0 at the others. */
static long double derivative(const double *node, int n, int i, int j) {
    long double sum = 0.0L;
    for (int m = 0; m < n; m++) {
        long double product = m != j ? 1.0L / ((long double)node[j] - node[m]) : 0.0L;
        for (int k = 0; k < n; k++) {
            product *= k != j && k != m
                           ? ((long double)node[i] - node[k]) / ((long double)node[j] - node[k])
                           : 1.0L;
        }
        sum += product;
    }
    return sum;
}

/* All columns at the stages from one system for everything: expected[s][n_columns]. */
static void solve_directly(uint64_t mode, double at, double h, const double *state,
                           double *expected) {
    const double *node = stages.method->node;
    int n_stages = stages.method->s;
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    int n = n_stages * n_columns;
    double u[10] = {1.0};
    long double *a = calloc((size_t)n * (size_t)(n + 1), sizeof(*a));
    ck_assert_ptr_nonnull(a);
    for (int i = 0; i < n_stages; i++) {
        for (int k = 1; k < s->n_inputs; k++) {
            u[k] = dalcs_stimulus_value(&t.circuit.stimulus[s->stimulus[k]], at + node[i + 1] * h,
                                        DALCS_LEFT);
        }
        for (int r = 0; r < n_equations; r++) {
            long double *row = a + (size_t)(i * n_columns + r) * (size_t)(n + 1);
            for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
                row[i * n_columns + s->A.j[k]] -= s->A.x[k];
            }
            row[n] = inputs_at(u, &s->E, r);
            for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
                for (int j = 0; j <= n_stages; j++) {
                    long double value = s->P.x[k] * derivative(node, n_stages + 1, i + 1, j) / h;
                    if (j > 0) {
                        row[(j - 1) * n_columns + s->P.j[k]] += value;
                    } else {
                        row[n] -= value * state[s->P.j[k]];
                    }
                }
            }
        }
        for (int d = 0; d < s->n_pairs; d++) {
            long double *row = a + (size_t)(i * n_columns + n_equations + d) * (size_t)(n + 1);
            if ((mode >> d & 1) == 0) {
                row[i * n_columns + n_equations + d] = 1.0L;
                continue;
            }
            for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
                row[i * n_columns + s->C.j[k]] += s->C.x[k];
            }
            row[n] = -inputs_at(u, &s->F, d);
        }
    }
    ck_assert(dalcs_extended_solve(n, 1, a, NULL) > 0.0L);
    for (int k = 0; k < n; k++) {
        expected[k] = (double)a[(size_t)k * (size_t)(n + 1) + (size_t)n];
    }
    for (int i = 0; i < n_stages; i++) {
        double *y = expected + i * n_columns;
        double w[64];
        for (int k = 1; k < s->n_inputs; k++) {
            u[k] = dalcs_stimulus_value(&t.circuit.stimulus[s->stimulus[k]], at + node[i + 1] * h,
                                        DALCS_LEFT);
        }
        for (int d = 0; d < s->n_pairs; d++) {
            w[d] = dalcs_csr_row_dot(&s->C, d, y) + inputs_at(u, &s->F, d);
        }
        for (int d = 0; d < s->n_pairs; d++) {
            bool open = (mode >> d & 1) == 0 && s->pair[d].kind == DALCS_PAIR_DIODE;
            y[n_equations + d] = open ? w[d] : y[n_equations + d];
        }
    }
    free(a);
}

/* false: a singular mode, which has more than one solution or none. */
static bool check_stages(uint64_t mode, double at, double h, const double *state) {
    int n_columns = dalcs_system_n_columns(s);
    double expected[DALCS_MAX_STAGES * 40];
    ck_assert_int_le(n_columns, 40);
    if (step(mode, at, h, state) > 0) {
        return false;
    }
    solve_directly(mode, at, h, state, expected);
    double largest = 0.0;
    for (int k = 0; k < stages.method->s * n_columns; k++) {
        largest = fmax(largest, fabs(expected[k]));
    }
    bool bystands[40] = {false};
    for (int k = 0; k < x.bystanders.n; k++) {
        bystands[x.bystanders.column[k]] = true;
    }
    for (int i = 0; i < stages.method->s; i++) {
        for (int c = 0; c < n_columns; c++) {
            if (bystands[c]) {
                continue; /* its source may be left out */
            }
            double y = out[(i + 1) * stages.layout.stride + c];
            double e = expected[i * n_columns + c];
            ck_assert_msg(fabs(y - e) <= 3e-13 * largest, "stage %d of %d, column %d: %.17g, %.17g",
                          i + 1, stages.method->s, c, y, e);
        }
    }
    for (int c = 0; c < s->n_x; c++) {
        ck_assert_double_eq(out[c], state[c]);
    }
    return true;
}

/* Index 1, index 2, coupled, switched, with every kind of source and in every mode; and with one step length
 * after the other, whose maps share what does not depend on it. */
START_TEST(test_against_direct_solution) {
    static const char *const text[] = {
        "rc\nV1 a 0 SIN(1 2 0.2 0 0 30)\nR1 a b 1\nC1 b 0 1\n.tran 1 1\n",
        "rlc\nV1 a 0 EXP(0 1 0.1 0.3 0.2 0.5)\nR1 a b 0.3\nL1 b c 0.5\nC1 c 0 0.25\n.tran 1 1\n",
        "loop\nV1 a 0 SIN(0 1 0.1)\nC1 a b 1\nC2 b 0 2\nC3 a 0 1\nR1 b 0 3\n.tran 1 1\n",
        "cut\nI1 0 a PWL(0 0 9 3)\nL1 a b 1\nL2 b 0 2\nR2 b 0 2\nK1 L1 L2 0.5\n.tran 1 1\n",
        "diodes\nV1 a b SIN(0 1 0.1)\nR0 b 0 1\nD1 a p DM\nD2 b p\nD3 m a\nD4 m b\nC1 p m 1\n"
        "R1 p m 4\nR2 m 0 9\n.model DM D(Ron=0.1 Vfwd=0.7)\n.tran 1 1\n",
        "controlled\nV1 a 0 1\nVg g 0 PULSE(0 1 0 1 1 1 4)\nR1 a b 1\nC1 b 0 1\nE1 e 0 b 0 3\n"
        "L1 e f 2\nR2 f 0 1\nF1 b 0 V1 0.5\nS1 f 0 g 0 sm\n.model sm SW(Vt=0.5)\n.tran 1 1\n",
    };
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) {
        for (int n_stages = 1; n_stages <= DALCS_MAX_STAGES; n_stages += 2) {
            const double state[4] = {0.5, -0.25, 1.0, 0.75};
            start(text[k], n_stages);
            int n_checked = 0;
            for (uint64_t mode = 0; mode < UINT64_C(1) << s->n_pairs; mode++) {
                (void)get(mode, 1e-17); /* so short that states hide what depends on them */
                n_checked += check_stages(mode, 0.0, 0.01, state) ? 1 : 0;
                n_checked += check_stages(mode, 0.375, 0.0625, state) ? 1 : 0;
                n_checked += check_stages(mode, 0.5, 0.125, state) ? 1 : 0;
            }
            ck_assert_int_ge(n_checked, s->n_pairs == 4 ? 36 : 3 << s->n_pairs);
            finish();
        }
    }
}

END_TEST

static double exact_rc(double time) { /* v' = sin(w t) - v, v(0) = 0.5 */
    const double w = 2.0 * acos(-1.0) * 0.2;
    double c = w / (1.0 + w * w);
    return (0.5 + c) * exp(-time) + (sin(w * time) - w * cos(w * time)) / (1.0 + w * w);
}

START_TEST(test_rc) {
    static const double error[] = {0.0, 2e-2, 0.0, 3e-7, 0.0, 1e-11, 0.0, 1e-14, 0.0, 1e-15};
    const double state[] = {0.5};
    const double h = 0.125;
    for (int n_stages = 1; n_stages <= DALCS_MAX_STAGES; n_stages += 2) {
        start("rc\nV1 a 0 SIN(0 1 0.2)\nR1 a b 1\nC1 b 0 1\n.tran 1 1\n", n_stages);
        ck_assert_int_eq(step(0, 0.0, h, state), 0);
        double v = column_at(n_stages, DALCS_LABEL_STATE, "c1");
        ck_assert_msg(fabs(v - exact_rc(h)) <= error[n_stages], "%d stages: off by %g", n_stages,
                      fabs(v - exact_rc(h)));
        /* The start is that of the polynomial, up to its error. */
        ck_assert_double_eq_tol(column_at(0, DALCS_LABEL_NODE, "a"), 0.0, error[n_stages]);
        ck_assert_double_eq_tol(column_at(0, DALCS_LABEL_BRANCH, "v1"), 0.5, error[n_stages]);
        /* The drift is of the size of what the method of one order less is off by. */
        double drift = fabs(out[stages.layout.drift]);
        ck_assert(drift >= fabs(v - exact_rc(h)) - 1e-15 && drift < 0.1 * pow(0.2, n_stages - 1));
        finish();
    }
}

END_TEST

/* The current of a source across a capacitor is its derivative. */
START_TEST(test_index_two) {
    const double state[] = {0.0};
    start("index 2\nV1 a 0 SIN(0 1 0.2)\nC1 a 0 3\n.tran 1 1\n", 7);
    ck_assert_int_eq(step(0, 0.0, 0.25, state), 0);
    const double w = 2.0 * acos(-1.0) * 0.2;
    for (int k = 1; k <= 7; k++) {
        double time = 0.25 * stages.method->node[k];
        ck_assert_double_eq_tol(column_at(k, DALCS_LABEL_STATE, "c1"), sin(w * time), 1e-15);
        ck_assert_double_eq_tol(column_at(k, DALCS_LABEL_BRANCH, "v1"), -3 * w * cos(w * time),
                                1e-8);
    }
    finish();
}

END_TEST

RUN_TESTS("stages", test_against_direct_solution, test_rc, test_index_two)
