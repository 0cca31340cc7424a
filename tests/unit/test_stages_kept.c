/* test_stages_kept.c - stages in singular modes, watched voltages, natural units, and the store of modes. */
#include "stage_store.h"
#include "start_stages.h"

#include <math.h>

/* lambda of a closed pair, w of an open one. */
static double pair_at(int node, const char *name) {
    return out[node * stages.layout.stride + dalcs_system_n_equations(s) + find_pair(s, name)];
}

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

/* With another constant input meanwhile. */
static void start_again(struct dalcs_stage_store *store, double constant) {
    dalcs_stage_store_put(store, 0, &stages);
    ck_assert_ptr_null(stages.system);
    x.constant[0] = constant;
    ck_assert_int_eq(dalcs_stages_setup(&stages, s, &x, dalcs_collocation_of(DALCS_RADAU_IIA, 5),
                                        &(struct dalcs_stage_limits){64, 1e-14, 1 << 24}),
                     DALCS_OK);
    dalcs_stage_store_take(store, 0, &stages);
}

/* The next run has the maps of the last one, with their answers; not where an input differs that is in them. */
START_TEST(test_next_run) {
    struct dalcs_stage_store store;
    const uint64_t off = 0;
    const double state[] = {6.0};
    start("next\nV1 a 0 SIN(1 2 0.1)\nV2 b 0 3\nR1 a c 1\nD1 c b\nC1 c 0 1\n.tran 1 1\n", 5);
    ck_assert_int_eq(dalcs_stage_store_setup(&store, 1), DALCS_OK);
    dalcs_stage_store_take(&store, 0, &stages); /* nothing */
    (void)step(off, 0.0, 0.5, state);
    const struct dalcs_stage_entry *entry = get(off, 0.5);
    const double answer = column_at(5, DALCS_LABEL_STATE, "c1");
    start_again(&store, 1.0);
    ck_assert_ptr_eq(get(off, 0.5), entry);
    ck_assert_int_eq(stages.cache.factorizations, 0);
    (void)step(off, 0.0, 0.5, state);
    ck_assert_double_eq(column_at(5, DALCS_LABEL_STATE, "c1"), answer);
    (void)get(DIODE("d1"), 0.25); /* the first run's means serve, too */
    start_again(&store, 1.0);
    ck_assert(dalcs_stages_find(&stages, &(uint64_t){DIODE("d1")}, 0.25));
    start_again(&store, 2.0);
    ck_assert(dalcs_stages_find(&stages, &off, 0.5) == NULL);
    (void)get(off, 0.5);
    dalcs_stage_store_put(&store, 0, &stages);
    dalcs_stage_store_finish(&store);
    finish();
}

END_TEST

RUN_TESTS("stages that are kept", test_parallel_diodes, test_floating, test_clash,
          test_next_to_open, test_watched, test_shift, test_shift_in_a_moment, test_store,
          test_next_run)
