/* test_inductance.c - coupled coils as independent states and ideal transformers. */
#include "inductance.h"

#include "build_network.h"

/* L_JJ = N' L_II N and L_IJ = L_II N for the coils that were split off. The threshold of perfect
 * coupling, 1e-13, is what the split itself neglects. */
static void check_split(const struct dalcs_inductance *g, const double *L) {
    int n = g->n;
    int n_dependent = n - g->rank;
    bool seen[8] = {false};
    for (int k = 0; k < n; k++) {
        ck_assert(!seen[g->coil[k]]);
        seen[g->coil[k]] = true;
    }
    for (int b = 0; b < n_dependent; b++) {
        int j = g->coil[g->rank + b];
        for (int i = 0; i < g->rank; i++) {
            double sum = 0.0;
            for (int k = 0; k < g->rank; k++) {
                sum += L[g->coil[i] * n + g->coil[k]] * g->ratio[k * n_dependent + b];
            }
            double size = sqrt(L[g->coil[i] * (n + 1)] * L[j * (n + 1)]);
            ck_assert_double_le(fabs(sum - L[g->coil[i] * n + j]), 1e-12 * size);
        }
    }
}

static struct dalcs_inductance split(int n, const double *L) {
    struct dalcs_inductance g;
    bool valid = false;
    ck_assert_int_eq(dalcs_inductance_split(&g, n, L, &valid), DALCS_OK);
    ck_assert(valid);
    check_split(&g, L);
    return g;
}

START_TEST(test_independent) {
    const double L[] = {1e-3, 0.9e-5, 0.9e-5, 1e-7}; /* k = 0.9 */
    struct dalcs_inductance g = split(2, L);
    ck_assert_int_eq(g.rank, 2);
    dalcs_inductance_finish(&g);
    const double close[] = {1.0, 1.0 - 1e-9, 1.0 - 1e-9, 1.0}; /* tight is not perfect */
    g = split(2, close);
    ck_assert_int_eq(g.rank, 2);
    dalcs_inductance_finish(&g);
}

END_TEST

START_TEST(test_perfect) {
    const double L[] = {4e-3, -6e-3, -6e-3, 9e-3}; /* k = -1, turns 2 : -3 */
    struct dalcs_inductance g = split(2, L);
    ck_assert_int_eq(g.rank, 1);
    double expected = g.coil[0] == 0 ? -1.5 : -1.0 / 1.5;
    ck_assert_double_eq_tol(g.ratio[0], expected, 1e-15);
    dalcs_inductance_finish(&g);
}

END_TEST

/* Three windings on one core of which two are perfectly coupled, whatever their order. */
START_TEST(test_partly_perfect) {
    for (int order = 0; order < 3; order++) {
        const double turns[] = {1.0, 2.0, 5.0};
        double L[9];
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                double k = i == j || (i != order && j != order) ? 1.0 : 0.5;
                L[3 * i + j] = k * turns[i] * turns[j] * 1e-6;
            }
        }
        struct dalcs_inductance g = split(3, L);
        ck_assert_int_eq(g.rank, 2);
        ck_assert_int_ne(g.coil[2], order);
        dalcs_inductance_finish(&g);
    }
}

END_TEST

START_TEST(test_impossible) {
    /* Each pair may be coupled so, all three may not. */
    const double minus[] = {1.0, -0.9, -0.9, -0.9, 1.0, -0.9, -0.9, -0.9, 1.0};
    const double broken[] = {1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0};
    const double *const L[] = {minus, broken};
    for (int k = 0; k < 2; k++) {
        struct dalcs_inductance g;
        bool valid = true;
        ck_assert_int_eq(dalcs_inductance_split(&g, 3, L[k], &valid), DALCS_OK);
        ck_assert(!valid);
        dalcs_inductance_finish(&g);
    }
}

END_TEST

/* In a circuit: one state for two perfectly coupled coils, and the voltages in the ratio 1 : 3. */
START_TEST(test_transformer) {
    struct text_network t;
    build_good_network(&t, "ideal transformer\n"
                           "V1 a 0 2\n"
                           "L1 a 0 1m IC=1\n"
                           "L2 b 0 9m IC=2\n"
                           "R2 b 0 6\n"
                           "K1 L1 L2 1\n"
                           ".tran 1u 1m uic\n");
    const struct dalcs_system *s = &t.network.system[0];
    ck_assert_int_eq(s->n_x, 1);
    struct dalcs_osnsp p;
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_osnsp_setup(&p, s, &options), DALCS_OK);
    double u[3];
    double y[16];
    text_network_inputs(&t, 0, u);
    const char *independent = s->column[0].element;
    /* i1 + 3 i2 = 7 A magnetises l1, a third of it l2. */
    ck_assert_double_eq_tol(u[0], strcmp(independent, "l1") == 0 ? 7.0 : 7.0 / 3.0, 1e-14);
    double h = 1e-6;
    ck_assert_int_eq(dalcs_osnsp_solve(&p, 1.0 / h, u, y), DALCS_OK);
    ck_assert_double_eq_tol(y[find_column(s, DALCS_LABEL_NODE, "b")], 6.0, 1e-13);
    /* States by element: l2 carries 6 V / 6 ohm out of its dot, l1 what is left of 7 A + 2 V h / L. */
    double current[2];
    for (int i = 0; i < t.network.n_states; i++) {
        current[i] = dalcs_probe_value(&t.network.state[i].probe, y, u + s->n_x);
    }
    ck_assert_double_eq_tol(current[1], -1.0, 1e-12);
    ck_assert_double_eq_tol(current[0], 7.0 + 2.0 * h / 1e-3 + 3.0, 1e-12);
    dalcs_osnsp_finish(&p);
    text_network_finish(&t);
}

END_TEST

RUN_TESTS("inductance", test_independent, test_perfect, test_partly_perfect, test_impossible,
          test_transformer)
