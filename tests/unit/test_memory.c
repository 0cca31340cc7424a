/* test_memory.c - allocation with overflow checks, growth and the arena. */
#include "memory.h"

#include "run_tests.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static bool all_zero(const void *memory, size_t n) {
    for (size_t k = 0; k < n; k++) {
        if (((const unsigned char *)memory)[k] != 0) {
            return false;
        }
    }
    return true;
}

START_TEST(test_alloc) {
    void *nothing = dalcs_alloc(0, 8);
    ck_assert_ptr_nonnull(nothing);
    free(nothing);
    double *x = dalcs_alloc(1000, sizeof *x);
    ck_assert_ptr_nonnull(x);
    ck_assert(all_zero(x, 1000 * sizeof *x));
    free(x);
    ck_assert_ptr_null(dalcs_alloc(SIZE_MAX / 4, 8));
    ck_assert_ptr_null(dalcs_alloc(SIZE_MAX, 1));
}

END_TEST

START_TEST(test_grow) {
    int *item = NULL;
    size_t capacity = 0;
    for (size_t n = 1; n <= 1000; n++) {
        const size_t before = capacity;
        ck_assert_int_eq(dalcs_grow(&item, &capacity, n, sizeof *item), DALCS_OK);
        ck_assert_uint_ge(capacity, n);
        ck_assert(all_zero(item + before, (capacity - before) * sizeof *item));
        ck_assert_int_eq(item[n - 1], 0);
        for (size_t k = before; k < capacity; k++) {
            item[k] = 0;
        }
        item[n - 1] = (int)n;
    }
    ck_assert_int_eq(item[384], 385);

    int *const same = item;
    const size_t capacity_before = capacity;
    ck_assert_int_eq(dalcs_grow(&item, &capacity, SIZE_MAX / 2, sizeof *item), DALCS_E_NOMEM);
    ck_assert_ptr_eq(item, same);
    ck_assert_uint_eq(capacity, capacity_before);
    free(item);
}

END_TEST

/* Objects of all sizes: aligned, zeroed, apart from each other. */
START_TEST(test_arena) {
    enum { N = 400 };
    struct dalcs_arena arena = {0};
    unsigned char *object[N];
    for (size_t k = 0; k < N; k++) {
        const size_t size = (k * 2385) % 9000 + 1;
        object[k] = dalcs_arena_alloc(&arena, 1, size);
        ck_assert_ptr_nonnull(object[k]);
        ck_assert_uint_eq((uintptr_t)object[k] % _Alignof(max_align_t), 0);
        ck_assert(all_zero(object[k], size));
        memset(object[k], (int)k % 255 + 1, size);
        /* Strings are packed between the objects and must not disturb the next one's alignment. */
        ck_assert_str_eq(dalcs_arena_copy(&arena, "between", 3), "bet");
    }
    for (size_t k = 0; k < N; k++) {
        const size_t size = (k * 2385) % 9000 + 1;
        ck_assert_uint_eq(object[k][0], k % 255 + 1);
        ck_assert_uint_eq(object[k][size - 1], k % 255 + 1);
    }
    ck_assert_ptr_null(dalcs_arena_alloc(&arena, SIZE_MAX / 2, 8));
    ck_assert_ptr_null(dalcs_arena_copy(&arena, "", SIZE_MAX));
    ck_assert_str_eq(dalcs_arena_printf(&arena, "%s %d", "c", 17), "c 17");
    dalcs_arena_finish(&arena);
    ck_assert_ptr_null(arena.head);
    dalcs_arena_finish(&arena);
}

END_TEST

/* What was reserved is one block, whatever was in that memory before. */
START_TEST(test_reserve) {
    enum { SMALL = 5000, LARGE = 1 << 20 };

    static const size_t sizes[] = {SMALL, LARGE};
    for (int round = 0; round < 4; round++) {
        struct dalcs_arena arena = {0};
        const size_t size = sizes[round % 2];
        ck_assert_int_eq(dalcs_arena_reserve(&arena, 2 * size), DALCS_OK);
        const struct dalcs_arena_block *block = arena.head;
        for (int k = 0; k < 2; k++) {
            unsigned char *object = dalcs_arena_alloc(&arena, 1, size - 16);
            ck_assert(object != NULL && all_zero(object, size - 16));
            memset(object, 255, size - 16);
        }
        ck_assert_ptr_eq(arena.head, block);
        dalcs_arena_finish(&arena);
    }
    struct dalcs_arena arena = {0};
    ck_assert_int_eq(dalcs_arena_reserve(&arena, SIZE_MAX), DALCS_E_NOMEM);
}

END_TEST

/* Places side by side, and the same bytes with and without storage. */
START_TEST(test_carve) {
    size_t used = 0;
    ck_assert_ptr_null(dalcs_carve(NULL, &used, 3, sizeof(int)));
    ck_assert_ptr_null(dalcs_carve(NULL, &used, 5, sizeof(double)));
    unsigned char *storage = dalcs_alloc(1, used);
    size_t again = 0;
    ck_assert_ptr_eq(dalcs_carve(storage, &again, 3, sizeof(int)), storage);
    unsigned char *second = dalcs_carve(storage, &again, 5, sizeof(double));
    ck_assert_uint_eq((uintptr_t)second % _Alignof(max_align_t), 0);
    ck_assert_uint_eq(again, used);
    ck_assert(second + 5 * sizeof(double) <= storage + used);
    free(storage);
}

END_TEST

RUN_TESTS("memory", test_alloc, test_grow, test_arena, test_reserve, test_carve)
