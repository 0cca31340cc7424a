/* test_sparse.c - triplets to compressed rows, against a dense matrix. */
#include "sparse.h"

#include "build_network.h"

static void add(struct dalcs_triplets *t, int row, int column, double value) {
    ck_assert_int_eq(dalcs_triplets_add(t, row, column, value), DALCS_OK);
}

START_TEST(test_compress) {
    enum { ROWS = 17, COLUMNS = 11, ENTRIES = 400 };

    double dense[ROWS][COLUMNS] = {{0.0}};
    struct dalcs_triplets t = {0};
    uint64_t random = 1;
    for (int k = 0; k < ENTRIES; k++) {
        int i = (int)(ROWS * fabs(next_random(&random)));
        int j = (int)(COLUMNS * fabs(next_random(&random)));
        double value = (int)(8.0 * next_random(&random)); /* whole: any order of summing is exact */
        add(&t, i, j, value);
        dense[i][j] += value;
    }
    struct dalcs_csr a;
    ck_assert_int_eq(dalcs_csr_compress(&a, ROWS, COLUMNS, &t), DALCS_OK);
    int n_nonzero = 0;
    for (int i = 0; i < ROWS; i++) {
        for (int j = 0; j < COLUMNS; j++) {
            ck_assert_double_eq(entry_of(&a, i, j), dense[i][j]);
            n_nonzero += dense[i][j] != 0.0;
        }
        for (int k = a.p[i] + 1; k < a.p[i + 1]; k++) {
            ck_assert_int_lt(a.j[k - 1], a.j[k]);
        }
    }
    ck_assert_int_eq(a.p[ROWS], n_nonzero); /* what cancelled is gone */
    ck_assert_int_lt(n_nonzero, ROWS * COLUMNS);

    double v[COLUMNS];
    double y[ROWS];
    for (int j = 0; j < COLUMNS; j++) {
        v[j] = j - 4.0;
    }
    dalcs_csr_multiply(&a, v, y);
    for (int i = 0; i < ROWS; i++) {
        double sum = 0.0;
        for (int j = 0; j < COLUMNS; j++) {
            sum += dense[i][j] * v[j];
        }
        ck_assert_double_eq(y[i], sum);
    }
    dalcs_csr_finish(&a);
    dalcs_triplets_finish(&t);
}

END_TEST

/* Numbers that are rounded cancel but for that; what came twice with both signs leaves nothing, and does not hide the rest. */
START_TEST(test_cancelled) {
    const double scale[] = {1e-12, 1.0, 3e7};
    for (int k = 0; k < 3; k++) {
        struct dalcs_triplets t = {0};
        struct dalcs_csr a;
        for (int i = 0; i < 3; i++) {
            add(&t, 0, 0, scale[k] / 3.0);
            add(&t, 1, 0, scale[k] / 3.0);
        }
        add(&t, 0, 0, 0.5 * scale[k]);
        add(&t, 0, 0, -1.5 * scale[k]);
        add(&t, 1, 0, -scale[k] * (1.0 - 1e-12)); /* beyond rounding */
        for (int i = 0; i < 3; i++) {
            add(&t, 2, 0, 1e20 * scale[k] / (3.0 + i));
            add(&t, 2, 0, -1e20 * scale[k] / (3.0 + i));
        }
        add(&t, 2, 0, scale[k]);
        ck_assert_int_eq(dalcs_csr_compress_rounded(&a, 3, 1, &t), DALCS_OK);
        ck_assert_int_eq(a.p[1], 0);
        ck_assert_double_eq_tol(entry_of(&a, 1, 0), 1e-12 * scale[k], 1e-15 * scale[k]);
        ck_assert_double_eq(entry_of(&a, 2, 0), scale[k]);
        dalcs_csr_finish(&a);
        dalcs_triplets_finish(&t);
    }
}

END_TEST

START_TEST(test_empty) {
    struct dalcs_triplets t = {0};
    struct dalcs_csr a;
    ck_assert_int_eq(dalcs_csr_compress(&a, 0, 0, &t), DALCS_OK);
    ck_assert_int_eq(a.p[0], 0);
    dalcs_csr_finish(&a);
    ck_assert_ptr_null(a.p);
    ck_assert_int_eq(dalcs_csr_compress(&a, 3, 0, &t), DALCS_OK);
    ck_assert_int_eq(a.p[3], 0);
    dalcs_csr_finish(&a);
}

END_TEST

/* Only v[p] - v[m] with coefficients of exactly 1 may be taken for a difference. */
START_TEST(test_difference) {
    struct dalcs_triplets t = {0};
    add(&t, 0, 5, 1.0);
    add(&t, 0, 2, -1.0);
    add(&t, 1, 1, -1.0);
    add(&t, 1, 4, 1.0);
    add(&t, 2, 0, 1.0);
    add(&t, 2, 1, 1.0);
    add(&t, 3, 0, 2.0);
    add(&t, 3, 1, -0.5);
    add(&t, 4, 3, 1.0);
    add(&t, 5, 0, 1.0);
    add(&t, 5, 1, -1.0);
    add(&t, 5, 2, 1.0);
    struct dalcs_csr a;
    ck_assert_int_eq(dalcs_csr_compress(&a, 6, 6, &t), DALCS_OK);
    int ends[2];
    dalcs_csr_row_difference(&a, 0, ends);
    ck_assert_int_eq(ends[0], 5);
    ck_assert_int_eq(ends[1], 2);
    dalcs_csr_row_difference(&a, 1, ends);
    ck_assert_int_eq(ends[0], 4);
    ck_assert_int_eq(ends[1], 1);
    for (int row = 2; row < 6; row++) {
        dalcs_csr_row_difference(&a, row, ends);
        ck_assert_int_eq(ends[0], -1);
    }
    dalcs_csr_finish(&a);
    dalcs_triplets_finish(&t);
}

END_TEST

RUN_TESTS("sparse", test_compress, test_cancelled, test_empty, test_difference)
