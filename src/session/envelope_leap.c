/* envelope_leap.c - powers of the map of a period, by squaring. */
#include "envelope.h"

#include <string.h>

bool dalcs_envelope_leap_setup(struct dalcs_envelope_leap *leap, struct dalcs_arena *arena, int n) {
    const size_t m = (size_t)n + 2;
    leap->n = n;
    leap->B = dalcs_arena_alloc(arena, m * m, sizeof(double));
    leap->S = dalcs_arena_alloc(arena, m * m, sizeof(double));
    leap->work = dalcs_arena_alloc(arena, m * m, sizeof(double));
    leap->F = dalcs_arena_alloc(arena, m, sizeof(double));
    return leap->B != NULL && leap->S != NULL && leap->work != NULL && leap->F != NULL;
}

/* out = a b, or out += a b; [m][m] column after column. */
static void multiply(int m, const double *a, const double *b, double *out, bool adds) {
    for (int c = 0; c < m; c++) {
        for (int r = 0; r < m && !adds; r++) {
            out[c * m + r] = 0.0;
        }
        for (int k = 0; k < m; k++) {
            const double factor = b[c * m + k];
            for (int r = 0; r < m && factor != 0.0; r++) {
                out[c * m + r] += a[k * m + r] * factor;
            }
        }
    }
}

void dalcs_envelope_leap_make(struct dalcs_envelope_leap *leap, const double *M, const double *g,
                              const double *h, const double *F, int level) {
    const int n = leap->n;
    const int m = n + 2;
    const size_t bytes = (size_t)m * (size_t)m * sizeof(double);
    memset(leap->B, 0, bytes);
    memset(leap->S, 0, bytes);
    for (int k = 0; k < n; k++) {
        memcpy(leap->B + (size_t)(k * m), M + (size_t)(k * n), (size_t)n * sizeof(double));
        leap->B[n * m + k] = g[k];
        leap->B[(n + 1) * m + k] = h[k];
        leap->F[k] = F[k];
        leap->S[k * m + k] = 1.0;
    }
    for (int k = n; k < m; k++) {
        leap->B[k * m + k] = leap->S[k * m + k] = 1.0;
    }
    leap->B[n * m + n + 1] = leap->F[n] = 1.0;
    leap->F[n + 1] = 0.0;
    for (int k = 0; k < level; k++) { /* S(2K) = S(K) + B^K S(K) */
        memcpy(leap->work, leap->S, bytes);
        multiply(m, leap->B, leap->work, leap->S, true);
        multiply(m, leap->B, leap->B, leap->work, false);
        memcpy(leap->B, leap->work, bytes);
    }
}

static void apply(const struct dalcs_envelope_leap *leap, const double *matrix, int n_columns,
                  const double *to, double *out) {
    for (int x = 0; x < leap->n; x++) {
        out[x] = 0.0;
        for (int k = 0; k < n_columns; k++) {
            out[x] += matrix[k * (leap->n + 2) + x] * to[k];
        }
    }
}

void dalcs_envelope_leap_go(const struct dalcs_envelope_leap *leap, double *by, double *then) {
    apply(leap, leap->S, leap->n + 2, leap->F, by);
    apply(leap, leap->B, leap->n + 2, leap->F, then);
}

void dalcs_envelope_leap_error(const struct dalcs_envelope_leap *leap, const double *off,
                               double *error) {
    apply(leap, leap->S, leap->n, off, error);
    for (int x = 0; x < leap->n; x++) {
        error[x] *= 0.5;
    }
}
