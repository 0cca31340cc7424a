/* test_null_space.c - ranks that are known: of graphs, resistors and products. */
#include "null_space.h"
#include "redundant_rows.h"

#include "build_network.h"

#include <math.h>
#include <stdlib.h>

static void add(struct dalcs_triplets *t, int row, int column, double value) {
    ck_assert_int_eq(dalcs_triplets_add(t, row, column, value), DALCS_OK);
}

/* The null space; each vector, and no row but those that follow from others, is checked. */
static void find(struct dalcs_null_space *s, int n_rows, int n_columns, struct dalcs_triplets *t,
                 double tolerance) {
    struct dalcs_csr a;
    ck_assert_int_eq(dalcs_csr_compress(&a, n_rows, n_columns, t), DALCS_OK);
    ck_assert_int_eq(dalcs_null_space_find(s, n_rows, n_columns, t), DALCS_OK);
    ck_assert_int_eq(s->rank + s->n_redundant, n_rows);
    ck_assert_int_eq(s->rank + s->n_free, n_columns);
    double *vector = calloc((size_t)n_columns + 1, sizeof(double));
    for (int k = 0; k < s->n_free; k++) {
        dalcs_null_space_vector(s, k, vector);
        ck_assert_double_eq(vector[s->free_column[k]], 1.0);
        for (int r = 0; r < n_rows; r++) {
            double size = 0.0;
            for (int e = a.p[r]; e < a.p[r + 1]; e++) {
                size = fmax(size, fabs(a.x[e] * vector[a.j[e]]));
            }
            ck_assert_double_le(fabs(dalcs_csr_row_dot(&a, r, vector)), tolerance * size);
        }
    }
    free(vector);
    dalcs_csr_finish(&a);
    dalcs_triplets_finish(t);
}

/* Rows are nodes, columns branches between random ones: what is open are loops, exactly. */
START_TEST(test_loops) {
    enum { NODES = 60, BRANCHES = 90 };

    uint64_t random = 5;
    struct dalcs_triplets t = {0};
    int root[NODES];
    int n_parts = NODES;
    for (int k = 0; k < NODES; k++) {
        root[k] = k;
    }
    for (int b = 0; b < BRANCHES; b++) {
        int from = (int)((next_random(&random) + 1.0) * 0.5 * NODES) % NODES;
        int to = (from + 1 + (int)((next_random(&random) + 1.0) * 0.5 * (NODES - 1))) % NODES;
        if (from == to) {
            continue;
        }
        add(&t, from, b, 1.0);
        add(&t, to, b, -1.0);
        int old = root[to];
        n_parts -= old != root[from];
        for (int k = 0; k < NODES; k++) {
            root[k] = root[k] == old ? root[from] : root[k];
        }
    }
    struct dalcs_null_space s;
    find(&s, NODES, BRANCHES, &t, 0.0);
    ck_assert_int_eq(s.rank, NODES - n_parts);
    double vector[BRANCHES];
    for (int k = 0; k < s.n_free; k++) {
        dalcs_null_space_vector(&s, k, vector);
        for (int b = 0; b < BRANCHES; b++) {
            ck_assert(vector[b] == 0.0 || fabs(vector[b]) == 1.0);
        }
    }
    dalcs_null_space_finish(&s);
}

END_TEST

static void add_resistor(struct dalcs_triplets *t, int a, int b, double ohms) {
    add(t, a, a, 1.0 / ohms);
    add(t, b, b, 1.0 / ohms);
    add(t, a, b, -1.0 / ohms);
    add(t, b, a, -1.0 / ohms);
}

/* Two chains of resistors over six decades, whose sums are rounded: they float, or the last node of one is
 * grounded. (valgrind cuts long double to double.) */
START_TEST(test_resistors) {
    enum { N = 500 };

    for (int grounded = 0; grounded < 3; grounded++) {
        uint64_t random = 7;
        struct dalcs_triplets t = {0};
        for (int chain = 0; chain < 2; chain++) {
            for (int k = 0; k < N - 1; k++) {
                add_resistor(&t, chain * N + k, chain * N + k + 1,
                             pow(10.0, 3.0 * next_random(&random)));
            }
            if (chain < grounded) {
                add(&t, chain * N + N - 1, chain * N + N - 1, 1e-3);
            }
        }
        struct dalcs_null_space s;
        find(&s, 2 * N, 2 * N, &t, 1e-6);
        ck_assert_int_eq(s.n_free, 2 - grounded);
        double vector[2 * N];
        for (int k = 0; k < s.n_free; k++) {
            dalcs_null_space_vector(&s, k, vector);
            int chain = s.free_column[k] / N;
            for (int i = 0; i < 2 * N; i++) {
                const double exact = i / N == chain ? 1.0 : 0.0;
                ck_assert_double_eq_tol(vector[i], exact, 1e-6);
                ck_assert(fabs(vector[i] - exact) <= s.error[i]);
            }
        }
        dalcs_null_space_finish(&s);
    }
}

END_TEST

/* A product of random matrices, neither symmetric nor of integers. */
START_TEST(test_product) {
    enum { ROWS = 30, COLUMNS = 24, RANK = 17 };

    uint64_t random = 11;
    double left[ROWS * RANK];
    double right[RANK * COLUMNS];
    for (int k = 0; k < ROWS * RANK; k++) {
        left[k] = next_random(&random);
    }
    for (int k = 0; k < RANK * COLUMNS; k++) {
        right[k] = next_random(&random);
    }
    struct dalcs_triplets t = {0};
    for (int r = 0; r < ROWS; r++) {
        for (int c = 0; c < COLUMNS; c++) {
            double sum = 0.0;
            for (int k = 0; k < RANK; k++) {
                sum += left[r * RANK + k] * right[k * COLUMNS + c];
            }
            add(&t, r, c, sum);
        }
    }
    struct dalcs_null_space s;
    find(&s, ROWS, COLUMNS, &t, 1e-11);
    ck_assert_int_eq(s.rank, RANK);
    dalcs_null_space_finish(&s);
}

END_TEST

/* Two islands: a triangle of ohms with a chain of gigohms behind it, and a pair of milliohms; an empty row besides. Left
 * out is the row of the largest terms in each. */
START_TEST(test_largest_are_left_out) {
    enum { N = 8 };

    struct dalcs_triplets t = {0};
    add_resistor(&t, 0, 3, 1e9);
    add_resistor(&t, 3, 5, 2.0);
    add_resistor(&t, 5, 6, 0.5);
    add_resistor(&t, 6, 3, 3.0);
    add_resistor(&t, 0, 1, 1e9);
    add_resistor(&t, 2, 7, 1e-3);
    const double size[N] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    struct dalcs_null_space s;
    ck_assert_int_eq(dalcs_null_space_find(&s, N, N, &t), DALCS_OK);
    ck_assert_int_eq(s.n_redundant, 3);
    struct dalcs_dependencies d;
    ck_assert_int_eq(dalcs_dependencies_setup(&d, &s.arena, s.n_redundant, N), DALCS_OK);
    ck_assert_int_eq(dalcs_redundant_rows_choose(&s, &t, size, s.n_rows, &d), DALCS_OK);
    bool is_left_out[N] = {false};
    for (int k = 0; k < s.n_redundant; k++) {
        is_left_out[s.redundant[k]] = true;
    }
    ck_assert(is_left_out[2] || is_left_out[7]);
    ck_assert(is_left_out[4]);
    ck_assert(is_left_out[5]); /* 1/2 + 1/0.5 S */
    dalcs_null_space_finish(&s);
    dalcs_triplets_finish(&t);
}

END_TEST

/* Of the nodes of a ring, and of two that a resistor ties, those are left out whose terms are the largest; where nothing is known
 * of them, none. */
START_TEST(test_largest_terms_are_left_out) {
    enum { N = 5 };

    struct dalcs_triplets t = {0};
    add_resistor(&t, 0, 1, 1.0);
    add_resistor(&t, 1, 2, 2.0);
    add_resistor(&t, 2, 0, 3.0);
    add_resistor(&t, 3, 4, 4.0);
    const double size[N] = {1.0, 1.0, 1.0, 1.0, 1.0};
    struct dalcs_null_space s;
    struct dalcs_dependencies d;
    ck_assert_int_eq(dalcs_null_space_find(&s, N, N, &t), DALCS_OK);
    ck_assert_int_eq(s.n_redundant, 2);
    ck_assert_int_eq(dalcs_dependencies_setup(&d, &s.arena, s.n_redundant, N), DALCS_OK);
    ck_assert(!dalcs_dependencies_choose(&d, N));
    ck_assert_int_eq(dalcs_redundant_rows_choose(&s, &t, size, N, &d), DALCS_OK);
    for (int largest = 0; largest < 3; largest++) {
        for (int r = 0; r < N; r++) {
            d.size[r] = r == largest ? 300.0 : r == 4 ? 2.0 : 1e-3;
        }
        ck_assert(dalcs_dependencies_choose(&d, N));
        ck_assert_int_eq(d.chosen[0], largest);
        ck_assert_int_eq(d.chosen[1], 4);
    }
    ck_assert(!dalcs_dependencies_choose(&d, 3));
    dalcs_null_space_finish(&s);
    dalcs_triplets_finish(&t);
}

END_TEST

START_TEST(test_empty) {
    struct dalcs_triplets t = {0};
    struct dalcs_null_space s;
    find(&s, 0, 0, &t, 0.0);
    ck_assert_int_eq(s.rank, 0);
    dalcs_null_space_finish(&s);
    add(&t, 1, 2, 1e-300);
    find(&s, 3, 4, &t, 0.0);
    ck_assert_int_eq(s.rank, 1);
    ck_assert_int_eq(s.redundant[0], 0);
    ck_assert_int_eq(s.redundant[1], 2);
    ck_assert_int_eq(s.free_column[2], 3);
    dalcs_null_space_finish(&s);
}

END_TEST

RUN_TESTS("null space", test_loops, test_resistors, test_product, test_largest_are_left_out,
          test_largest_terms_are_left_out, test_empty)
