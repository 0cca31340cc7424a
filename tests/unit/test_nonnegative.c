/* test_nonnegative.c - least squares with signs: Karush, Kuhn and Tucker's conditions hold, exactly solvable ones too. */
#include "nonnegative.h"

#include "build_network.h"

#include <math.h>

enum { M = 7, N = 9 };

static double along(const struct dalcs_nonnegative *p, int column) {
    double sum = 0.0;
    for (int i = 0; i < p->m; i++) {
        sum += p->a[column * p->m + i] * p->rest[i];
    }
    return sum;
}

/* The rest is b - a q, perpendicular to what may move, at an obtuse angle to what is 0. */
static void check(const struct dalcs_nonnegative *p, int n) {
    for (int i = 0; i < p->m; i++) {
        double rest = p->b[i];
        for (int c = 0; c < n; c++) {
            rest -= p->a[c * p->m + i] * p->q[c];
        }
        ck_assert_double_le(fabs(rest - p->rest[i]), 1e-10);
    }
    for (int c = 0; c < n; c++) {
        ck_assert(p->is_free[c] || p->q[c] >= 0.0);
        bool moves = p->is_free[c] || p->q[c] > 0.0;
        ck_assert_double_le(moves ? fabs(along(p, c)) : along(p, c), 1e-10);
    }
}

START_TEST(test_random) {
    uint64_t random = 3;
    struct dalcs_arena arena = {0};
    struct dalcs_nonnegative p;
    ck_assert_int_eq(dalcs_nonnegative_setup(&p, &arena, M, N), DALCS_OK);
    for (int round = 0; round < 500; round++) {
        int n = 1 + round % N;
        double known[N];
        for (int c = 0; c < n; c++) {
            double pick = next_random(&random);
            for (int i = 0; i < M; i++) { /* small integers: many columns depend on others */
                p.a[c * M + i] = rint(1.4 * next_random(&random));
            }
            p.is_free[c] = pick > 0.5;
            known[c] = pick > 0.0 ? next_random(&random) : 0.0;
            known[c] = p.is_free[c] ? known[c] : fabs(known[c]);
        }
        bool is_solvable = round % 2 == 0;
        for (int i = 0; i < M; i++) {
            p.b[i] = is_solvable ? 0.0 : next_random(&random);
            for (int c = 0; c < n && is_solvable; c++) {
                p.b[i] += p.a[c * M + i] * known[c];
            }
        }
        dalcs_nonnegative_solve(&p, n);
        check(&p, n);
        for (int i = 0; i < M && is_solvable; i++) {
            ck_assert_double_le(fabs(p.rest[i]), 1e-11);
        }
    }
    dalcs_arena_finish(&arena);
}

END_TEST

RUN_TESTS("nonnegative", test_random)
