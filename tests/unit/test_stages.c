/* test_stages.c - steps in a given mode against a direct solution of the collocation equations, singular
 * modes against their closed forms, and the store of steps. */
#include "stages.h"

#include "build_network.h"
#include "extended.h"

#include <math.h>
#include <stdlib.h>

static struct text_network t;
static const struct dalcs_system *s;
static struct dalcs_excitation x;
static struct dalcs_stages stages;

static void start_with(const char *text, int n_stages, size_t most_bytes) {
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    s = &t.network.system[0];
    ck_assert_int_eq(dalcs_excitation_setup(&x, &t.circuit, s, NULL), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&stages, s, &x,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, n_stages),
                                        &(struct dalcs_stage_limits){64, 1e-14, most_bytes}),
                     DALCS_OK);
}

static void start(const char *text, int n_stages) {
    start_with(text, n_stages, (size_t)1 << 24);
}

static void finish(void) {
    dalcs_stages_finish(&stages);
    dalcs_excitation_finish(&x);
    text_network_finish(&t);
}

static struct dalcs_stage_entry *get(uint64_t mode, double h) {
    struct dalcs_stage_entry *entry;
    ck_assert_int_eq(dalcs_stages_get(&stages, &mode, h, &entry), DALCS_OK);
    return entry;
}

enum { MOST_OUT = 1000 };

static double out[MOST_OUT];

/* A step from `at` and state[n_x] to out; the number of clashes. */
static int step(uint64_t mode, double at, double h, const double *state) {
    double in[40];
    struct dalcs_stage_entry *entry = get(mode, h);
    int n_clashes = dalcs_stage_n_clashes(entry);
    ck_assert_int_le(stages.layout.n_fixed + n_clashes + 8, MOST_OUT);
    for (int k = 0; k < s->n_x; k++) {
        in[k] = state[k];
    }
    in[s->n_x] = 1.0;
    dalcs_excitation_enter(&x, at);
    dalcs_excitation_coefficients(&x, at, h, in + s->n_x + 1);
    ck_assert_int_eq(dalcs_stages_apply(&stages, entry, in, out), DALCS_OK);
    ck_assert(dalcs_stage_residual(entry) < 1e-12);
    return n_clashes;
}

static double column_at(int node, enum dalcs_label_kind kind, const char *name) {
    return out[node * stages.layout.stride + find_column(s, kind, name)];
}

/* lambda of a closed pair, w of an open one. */
static double pair_at(int node, const char *name) {
    return out[node * stages.layout.stride + dalcs_system_n_equations(s) + find_pair(s, name)];
}

/* ---- The equations themselves ---------------------------------------------------------------- */

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

/* ---- Closed forms --------------------------------------------------------------------------- */

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

/* ---- Singular modes ------------------------------------------------------------------------- */

#define DIODE(d) (UINT64_C(1) << find_pair(s, d))

/* 5 mA through two diodes in parallel: half each. */
START_TEST(test_parallel_diodes) {
    for (int n_stages = 1; n_stages <= DALCS_MAX_STAGES; n_stages += 2) {
        start("parallel\nV1 in 0 PWL(0 5 1 6)\nR1 in a 1k\nD1 a 0\nD2 a 0\n.tran 1 1\n", n_stages);
        int n = step(DIODE("d1") | DIODE("d2"), 0.0, 0.5, NULL);
        ck_assert_int_eq(n, n_stages);
        for (int k = 0; k <= n_stages; k++) {
            double half = 0.5e-3 * (5.0 + 0.5 * stages.method->node[k]);
            ck_assert_double_eq_tol(pair_at(k, "d1"), half, 1e-17);
            ck_assert_double_eq_tol(pair_at(k, "d2"), half, 1e-17);
        }
        for (int k = 0; k < n; k++) {
            ck_assert_double_eq_tol(out[stages.layout.n_fixed + k], 0.0, 1e-14);
        }
        finish();
    }
}

END_TEST

/* Two blocking diodes in a row: the middle floats, half of the voltage each. A bridge that blocks: its
 * DC side floats as a whole, and the capacitor keeps its voltage. */
START_TEST(test_floating) {
    start("stack\nV1 in 0 PWL(0 -10 1 -12)\nD1 in m\nD2 m 0\n.tran 1 1\n", 3);
    ck_assert_int_eq(step(0, 0.0, 0.5, NULL), 3);
    for (int k = 0; k <= 3; k++) {
        double half = 5.0 + 0.5 * stages.method->node[k];
        ck_assert_double_eq_tol(pair_at(k, "d1"), half, 1e-14);
        ck_assert_double_eq_tol(pair_at(k, "d2"), half, 1e-14);
        ck_assert_double_eq_tol(column_at(k, DALCS_LABEL_NODE, "m"), -half, 1e-14);
    }
    finish();
    const double state[] = {6.0};
    start("bridge\nV1 a b SIN(0 1 0.1)\nR0 b 0 1\nD1 a p\nD2 b p\nD3 m a\nD4 m b\nC1 p m 1\n"
          "R1 p m 4\n.tran 1 1\n",
          5);
    ck_assert_int_eq(step(0, 0.0, 0.5, state), 5);
    for (int k = 0; k <= 5; k++) {
        double time = 0.5 * stages.method->node[k];
        double v = 6.0 * exp(-time / 4.0);
        double source = sin(0.2 * acos(-1.0) * time);
        ck_assert_double_eq_tol(column_at(k, DALCS_LABEL_STATE, "c1"), v, 1e-9);
        /* symmetric about the middle of the source */
        ck_assert_double_eq_tol(pair_at(k, "d1"), 0.5 * (v - source), 1e-9);
        ck_assert_double_eq_tol(pair_at(k, "d2"), 0.5 * (v + source), 1e-9);
        ck_assert_double_eq_tol(pair_at(k, "d3"), 0.5 * (v + source), 1e-9);
        ck_assert_double_eq_tol(pair_at(k, "d4"), 0.5 * (v - source), 1e-9);
    }
    for (int k = 0; k < 5; k++) {
        ck_assert_double_eq_tol(out[stages.layout.n_fixed + k], 0.0, 1e-14);
    }
    finish();
}

END_TEST

/* A closed diode between two sources: no solution where they differ, no current where they agree. */
START_TEST(test_clash) {
    start("clash\nV1 a 0 PWL(0 1 1 1)\nD1 a b\nV2 b 0 PWL(0 1 1 3)\nR1 b 0 1\n.tran 1 1\n", 5);
    int n = step(DIODE("d1"), 0.0, 1.0, NULL);
    ck_assert_int_eq(n, 5);
    double size = fabs(out[stages.layout.n_fixed + n - 1]) / 2.0; /* of 1 V */
    ck_assert(size > 0.01 && size < 100.0);
    for (int k = 0; k < n; k++) {
        ck_assert_double_eq_tol(fabs(out[stages.layout.n_fixed + k]),
                                2.0 * size * stages.method->node[k + 1], 1e-12 * size);
    }
    finish();
    start("agree\nV1 a 0 PWL(0 1 1 2)\nD1 a b\nV2 b 0 PWL(0 1 1 2)\nR1 b 0 1\n.tran 1 1\n", 5);
    n = step(DIODE("d1"), 0.0, 1.0, NULL);
    ck_assert_int_eq(n, 5);
    for (int k = 0; k < n; k++) {
        ck_assert_double_eq_tol(out[stages.layout.n_fixed + k], 0.0, 1e-13);
    }
    ck_assert_double_eq_tol(pair_at(5, "d1"), 0.0, 1e-13);
    ck_assert_double_eq_tol(column_at(5, DALCS_LABEL_BRANCH, "v2"), -2.0, 1e-13);
    finish();
}

END_TEST

/* ---- Watched voltages, natural units, the store ---------------------------------------------- */

/* Coils in series with a diode and milliohms. In a short step they are next to open: of conductances of 1e4 S
 * and of h/L. That makes no mode singular, and two diodes side by side are as singular as in a long one. */
START_TEST(test_next_to_open) {
    const double state[] = {1.0, 1.0 + 1e-6};
    const double together = (3.0 * state[0] + 0.5 * state[1]) / 3.5;
    start("next to open\nL1 0 a 3m\nD1 a b\nD2 a b\nR1 b c 0.1m\nL2 c 0 0.5m\n.tran 1 1\n", 7);
    for (double h = 1e-4; h > 1e-20; h *= 1e-3) {
        for (int both = 0; both <= 1; both++) {
            uint64_t mode = DIODE("d1") | (both == 1 ? DIODE("d2") : 0);
            ck_assert_int_eq(step(mode, 0.0, h, state), both == 1 ? 7 : 0);
            const double *end = out + 7 * stages.layout.stride;
            for (int k = 0; k < 2; k++) {
                ck_assert_double_eq_tol(end[k], together, 1e-13 + h);
            }
        }
    }
    finish();
}

END_TEST

START_TEST(test_watched) {
    start("watched\nV1 a 0 SIN(0 1 0.1)\nR1 a b 1\nC1 b 0 1\nS1 b 0 b 0 sm\nS2 b 0 e 0 sm\n"
          "E1 e 0 b 0 2\nS3 b 0 g 0 sm\nS4 b 0 a 0 sm\nVg g 0 PULSE(0 1 0 0 0 1 2)\n.model sm "
          "SW(Vt=0.5 Roff=10 Ron=1)\n"
          ".tran 1 1\n",
          3);
    const double state[] = {0.25};
    ck_assert_int_eq(stages.n_watched, 2);
    (void)step(0, 0.0, 0.5, state);
    for (int i = 0; i < 2; i++) {
        bool on_state = stages.watched[i] == find_pair(s, "s1");
        ck_assert(on_state || stages.watched[i] == find_pair(s, "s2"));
        for (int k = 0; k <= 3; k++) {
            double v = out[k * stages.layout.stride + dalcs_system_n_columns(s) + i];
            double expected = column_at(k, DALCS_LABEL_NODE, on_state ? "b" : "e");
            ck_assert_double_eq_tol(v, expected, 1e-15);
        }
    }
    finish();
}

END_TEST

/* How far a mode moves states at once, of a capacitor of 1 and one of 3 that a closed diode joins: to where their
 * charge is the same. */
START_TEST(test_shift) {
    start("shift\nD1 a b\nC1 a 0 1\nC2 b 0 3\nV1 c 0 SIN(0 2 0.1)\nD2 c d\nC3 d 0 1\nR1 d b "
          "1\n.tran 1 1\n",
          5);
    const uint64_t both = 1u << find_pair(s, "d1") | 1u << find_pair(s, "d2");
    const int a = find_column(s, DALCS_LABEL_STATE, "c1");
    const int b = find_column(s, DALCS_LABEL_STATE, "c2");
    const int d = find_column(s, DALCS_LABEL_STATE, "c3");
    double in[40] = {0.0};
    struct dalcs_stage_entry *entry = get(both, 0.5);
    ck_assert(!dalcs_stage_frees_states(entry));
    in[a] = 1.0;
    in[s->n_x] = 1.0;
    dalcs_excitation_enter(&x, 1.0);
    dalcs_excitation_coefficients(&x, 1.0, 0.5, in + s->n_x + 1);
    ck_assert_double_eq_tol(dalcs_stage_shift(&stages, entry, a, in), -0.75, 1e-14);
    ck_assert_double_eq_tol(dalcs_stage_shift(&stages, entry, b, in), 0.25, 1e-14);
    double source = 2.0 * sin(acos(-1.0) * 0.2);
    ck_assert_double_eq_tol(dalcs_stage_shift(&stages, entry, d, in), source, 1e-14);
    in[a] = in[b] = 0.25; /* where they are allowed to be */
    in[d] = source;
    for (int k = 0; k < s->n_x; k++) {
        ck_assert_double_eq_tol(dalcs_stage_shift(&stages, entry, k, in), 0.0, 1e-15);
    }
    finish();
}

END_TEST

/* What a diode of so much resistance does to two capacitors of 2 in a step of 1 and at once, of 1 V between them. */
static double shift_by(double resistance) {
    char text[200];
    (void)snprintf(text, sizeof(text),
                   "shift\nD1 a b dm\nC1 a 0 2\nC2 b 0 2\n.model dm D(Ron=%.17g)\n.tran 1 1\n",
                   resistance);
    start(text, 5);
    double in[40] = {0.0};
    in[find_column(s, DALCS_LABEL_STATE, "c1")] = 1.0;
    in[s->n_x] = 1.0;
    struct dalcs_stage_entry *entry = get(1, 1.0);
    ck_assert(!dalcs_stage_frees_states(entry));
    double shift =
        dalcs_stage_shift(&stages, entry, find_column(s, DALCS_LABEL_STATE, "c2"), in) / 0.5;
    finish();
    return shift;
}

/* Faster than 2^-30 of a step is at once, with a time constant of 2^-38; slower, of 2^-25, is not. */
START_TEST(test_shift_in_a_moment) {
    ck_assert_double_gt(shift_by(ldexp(1.0, -38)), 0.9);
    ck_assert_double_le(shift_by(ldexp(1.0, -38)), 1.0);
    ck_assert_double_gt(shift_by(ldexp(1.0, -25)), 0.0);
    ck_assert_double_lt(shift_by(ldexp(1.0, -25)), 1e-4);
}

END_TEST

START_TEST(test_store) {
    static const char text[] = "store\nV1 a 0 1\nR1 a b 1\nD1 b c\nC1 c 0 1\nR2 b 0 5\n.tran 1 1\n";
    const uint64_t off = 0;
    const uint64_t on = 1;
    start(text, 5);
    const struct dalcs_stage_entry *first = get(off, 0.5);
    ck_assert_ptr_ne(first, get(on, 0.5));
    ck_assert_ptr_ne(first, get(off, 0.25));
    ck_assert_ptr_eq(first, get(off, 0.5));
    ck_assert_int_eq(stages.cache.factorizations, 3);
    ck_assert_int_eq(stages.cache.cache_hits, 1);
    ck_assert(dalcs_stages_find(&stages, &on, 0.5) && !dalcs_stages_find(&stages, &on, 0.25));
    const double *natural = dalcs_stage_natural_units(first);
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        ck_assert(natural[c] > 0.0);
        ck_assert_double_eq(natural[dalcs_system_n_equations(s) + c], 1.0 / natural[c]);
    }
    size_t bytes = stages.cache.bytes;
    finish();
    /* With room for about three, the one that was not asked for goes. */
    start_with(text, 5, bytes);
    for (int k = 0; k < 20; k++) {
        (void)get(off, ldexp(1.0, -k));
        (void)get(on, 0.5);
        ck_assert(dalcs_stages_find(&stages, &on, 0.5));
        ck_assert(stages.cache.bytes <= bytes);
    }
    ck_assert(!dalcs_stages_find(&stages, &off, 1.0));
    ck_assert(dalcs_stages_find(&stages, &off, ldexp(1.0, -19)));
    ck_assert_int_eq(stages.cache.factorizations, 21);
    finish();
    start_with(text, 5, 1); /* one there must be */
    (void)get(on, 0.5);
    ck_assert(dalcs_stages_find(&stages, &on, 0.5));
    (void)get(off, 0.5);
    ck_assert(!dalcs_stages_find(&stages, &on, 0.5));
    finish();
}

END_TEST

RUN_TESTS("stages", test_against_direct_solution, test_rc, test_index_two, test_parallel_diodes,
          test_floating, test_clash, test_next_to_open, test_watched, test_shift,
          test_shift_in_a_moment, test_store)
