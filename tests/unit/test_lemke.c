/* test_lemke.c - problems of one solution, large and degenerate, with free pairs. */
#include "lemke.h"

#include "build_network.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* S becomes `less` times a product of reflections: |S v| = less |v|. */
static void reflect(struct dalcs_lemke *l, uint64_t *random, double less) {
    size_t n = (size_t)l->n;
    double *v = calloc(n, sizeof(double));
    ck_assert_ptr_nonnull(v);
    for (size_t i = 0; i < n; i++) {
        l->S[i * n + i] = less;
    }
    for (size_t round = 0; round < n / 2 + 1; round++) {
        double square = 0.0;
        for (size_t i = 0; i < n; i++) {
            v[i] = next_random(random) > 0.3 ? 0.0 : next_random(random);
            square += v[i] * v[i];
        }
        for (size_t k = 0; k < n && square > 0.0; k++) {
            double along = 0.0;
            for (size_t i = 0; i < n; i++) {
                along += v[i] * l->S[i * n + k];
            }
            for (size_t i = 0; i < n; i++) {
                l->S[i * n + k] -= 2.0 * along / square * v[i];
            }
        }
    }
    free(v);
}

/* Solves for the waves of the sides that are told, into wave[n]. */
static void solve_side(const struct dalcs_lemke *l, const double *S, const double *h,
                       double *wave) {
    size_t n = (size_t)l->n;
    double *m = calloc(n * n + 1, sizeof(double));
    ck_assert_ptr_nonnull(m);
    memcpy(wave, h, n * sizeof(double));
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            double unit = i == k ? (l->is_a[k] ? 1.0 : -1.0) : 0.0;
            m[i * n + k] = unit - S[i * n + k];
        }
    }
    for (size_t c = 0; c < n; c++) {
        size_t best = c;
        for (size_t i = c; i < n; i++) {
            best = fabs(m[i * n + c]) > fabs(m[best * n + c]) ? i : best;
        }
        for (size_t k = 0; k <= n; k++) {
            double *a = k < n ? &m[c * n + k] : &wave[c];
            double *b = k < n ? &m[best * n + k] : &wave[best];
            double swap = *a;
            *a = *b;
            *b = swap;
        }
        for (size_t i = 0; i < n; i++) {
            double factor = i == c ? 0.0 : m[i * n + c] / m[c * n + c];
            for (size_t k = c; k < n && factor != 0.0; k++) {
                m[i * n + k] -= factor * m[c * n + k];
            }
            wave[i] -= factor * wave[c];
        }
    }
    for (size_t i = 0; i < n; i++) {
        wave[i] /= m[i * n + i];
    }
    free(m);
}

static void check_random(int n, uint64_t random, double less, bool is_degenerate) {
    struct dalcs_lemke l;
    ck_assert_int_eq(dalcs_lemke_setup(&l, n), DALCS_OK);
    size_t m = (size_t)n;
    double *wave = calloc(m, sizeof(double));
    ck_assert_ptr_nonnull(wave);
    reflect(&l, &random, less);
    for (size_t i = 0; i < m; i++) {
        l.h[i] = is_degenerate ? rint(next_random(&random)) : next_random(&random);
        double law = next_random(&random);
        l.law[i] = law > 0.8   ? DALCS_LEMKE_A_FREE
                   : law > 0.6 ? DALCS_LEMKE_B_FREE
                               : DALCS_LEMKE_EITHER;
    }
    ck_assert_int_eq(dalcs_lemke_solve(&l, 100 + 10 * n), DALCS_OK);
    solve_side(&l, l.S, l.h, wave);
    for (size_t i = 0; i < m; i++) {
        if (l.law[i] == DALCS_LEMKE_EITHER) {
            ck_assert_double_ge(wave[i], -1e-9);
        } else {
            ck_assert_int_eq(l.is_a[i], l.law[i] == DALCS_LEMKE_A_FREE);
        }
    }
    free(wave);
    dalcs_lemke_finish(&l);
}

START_TEST(test_one_solution_is_found) {
    for (uint64_t seed = 1; seed <= 200; seed++) {
        check_random(1 + (int)(seed % 17), seed, 0.5, false);
        check_random(1 + (int)(seed % 23), seed, 0.9999, false);
    }
    check_random(150, 7, 0.999, false);
}

END_TEST

/* Ties everywhere: without a rule for them bases come again. */
START_TEST(test_ties_do_not_matter) {
    for (uint64_t seed = 1; seed <= 200; seed++) {
        check_random(1 + (int)(seed % 23), seed, 0.75, true);
    }
}

END_TEST

START_TEST(test_too_few_pivots_are_told) {
    struct dalcs_lemke l;
    ck_assert_int_eq(dalcs_lemke_setup(&l, 2), DALCS_OK);
    l.h[0] = -1.0; /* a of the first basis is -1 */
    l.h[1] = 1.0;
    ck_assert_int_eq(dalcs_lemke_solve(&l, 0), DALCS_NOT_CONVERGED);
    ck_assert_int_eq(dalcs_lemke_solve(&l, 2), DALCS_OK);
    ck_assert(!l.is_a[0] && l.is_a[1]);
    dalcs_lemke_finish(&l);
}

END_TEST

START_TEST(test_no_basis_is_told) {
    struct dalcs_lemke l;
    ck_assert_int_eq(dalcs_lemke_setup(&l, 1), DALCS_OK);
    l.law[0] = DALCS_LEMKE_A_FREE;
    l.S[0] = 1.0; /* whatever a is, it comes back */
    l.h[0] = 1.0;
    ck_assert_int_eq(dalcs_lemke_solve(&l, 100), DALCS_SINGULAR);
    dalcs_lemke_finish(&l);
}

END_TEST

RUN_TESTS("lemke", test_one_solution_is_found, test_ties_do_not_matter,
          test_too_few_pivots_are_told, test_no_basis_is_told)
