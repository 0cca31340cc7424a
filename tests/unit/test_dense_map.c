/* test_dense_map.c - products against a plain loop, bit by bit. */
#include "dense_map.h"

#include "run_tests.h"

#include <stdint.h>
#include <stdlib.h>

START_TEST(test_rows) {
    ck_assert_int_eq(dalcs_dense_map_rows(0), 0);
    ck_assert_int_eq(dalcs_dense_map_rows(1), 8);
    ck_assert_int_eq(dalcs_dense_map_rows(8), 8);
    ck_assert_int_eq(dalcs_dense_map_rows(9), 16);
}

END_TEST

START_TEST(test_products) {
    uint64_t state = 11;
    for (int rows = 8; rows <= 64; rows += 8) {
        for (int columns = 0; columns <= 20; columns++) {
            double *map = dalcs_dense_map_alloc(rows, columns);
            double x[20];
            double y[64];
            ck_assert_ptr_nonnull(map);
            ck_assert((uintptr_t)map % 64 == 0);
            for (int k = 0; k < rows * columns; k++) {
                state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
                map[k] = (double)(int64_t)state / 0x1p63;
            }
            for (int j = 0; j < columns; j++) {
                x[j] = 1.0 / (3.0 + j);
            }
            dalcs_dense_map_apply(rows, columns, map, x, y);
            for (int i = 0; i < rows; i++) {
                double sum = 0.0;
                for (int j = 0; j < columns; j++) {
                    sum += map[j * rows + i] * x[j];
                }
                ck_assert_double_eq(y[i], sum);
            }
            free(map);
        }
    }
}

END_TEST

RUN_TESTS("dense_map", test_rows, test_products)
