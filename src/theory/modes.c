/* modes.c - enumeration of modes. */
#include "modes.h"

#include <math.h>
#include <string.h>

/* Work that is worth it: modes * (unknowns)^3. */
static const double most_work = 3e9;

/* Below this share of the fastest motion an eigenvalue is rounding of 0. */
static const double noise = 1e-8;

struct visit {
    struct dalcs_modes *modes;
    struct dalcs_arena *arena;
    const struct dalcs_blocks *b;
    enum dalcs_hold *hold; /* [n_pairs] of the mode */
    bool *is_on;           /* [m] the same */
};

/* The eigenvalue `which` of lcs with u = 0, and all that its motion makes flow. */
static void keep(const struct visit *v, struct dalcs_mode *mode, const struct dalcs_lcs *lcs,
                 const struct dalcs_matrix *vector, const double *re, const double *im, int which) {
    const struct dalcs_system *s = v->b->system;
    int n_equations = dalcs_system_n_equations(s);
    mode->value[0] = re[which];
    mode->value[1] = im[which];
    memset(mode->y, 0, 2 * (size_t)dalcs_system_n_columns(s) * sizeof(double));
    for (int j = 0; j < lcs->n; j++) {
        /* a complex pair is two columns: real part, imaginary part, of the one with im > 0 */
        bool second = im[which] < 0.0;
        int column = second ? which - 1 : which;
        double part[2] = {*dalcs_at(vector, j, column),
                          im[which] == 0.0 ? 0.0 : *dalcs_at(vector, j, column + 1)};
        part[1] = second ? -part[1] : part[1];
        for (int q = 0; q < 2; q++) {
            for (int i = 0; i < lcs->blocks->n; i++) {
                mode->y[2 * i + q] += *dalcs_at(&lcs->full_x, i, j) * part[q];
            }
            for (int k = 0; k < lcs->blocks->p; k++) {
                mode->y[2 * lcs->blocks->z_column[k] + q] +=
                    *dalcs_at(&lcs->full_z, k, j) * part[q];
            }
            for (int i = 0; i < lcs->m; i++) {
                mode->y[2 * (n_equations + lcs->blocks->pair[i]) + q] +=
                    lcs->is_swapped[i] ? *dalcs_at(&lcs->C, i, j) * part[q] : 0.0;
            }
        }
    }
}

/* Looks at the motions of lcs with u = 0, a mode with these pairs on. */
static enum dalcs_status look(const struct visit *v, const struct dalcs_lcs *lcs, const bool *is_on,
                              struct dalcs_arena *work) {
    struct dalcs_modes *modes = v->modes;
    struct dalcs_matrix vector;
    double *re = dalcs_arena_alloc(work, (size_t)lcs->n + 1, sizeof(double));
    double *im = dalcs_arena_alloc(work, (size_t)lcs->n + 1, sizeof(double));
    if (re == NULL || im == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_eigen(&lcs->A, re, im, &vector, work));
    double fastest = 0.0;
    for (int i = 0; i < lcs->n; i++) {
        fastest = fmax(fastest, hypot(re[i], im[i]));
    }
    for (int i = 0; i < lcs->n; i++) {
        bool is_zero = re[i] <= noise * fastest;
        modes->slowest = fmax(modes->slowest, is_zero && re[i] > -noise * fastest ? 0.0 : re[i]);
        struct dalcs_mode *mode[2] = {&modes->growing, im[i] == 0.0 ? &modes->fastest : NULL};
        for (int k = 0; k < 2; k++) {
            if (!is_zero && mode[k] != NULL && re[i] > mode[k]->value[0]) {
                keep(v, mode[k], lcs, &vector, re, im, i);
                memcpy(mode[k]->is_on, is_on, (size_t)v->b->m * sizeof(bool));
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status visit(struct visit *v, uint32_t on, struct dalcs_arena *work) {
    struct dalcs_modes *modes = v->modes;
    struct dalcs_blocks blocks;
    struct dalcs_lcs lcs;
    for (int i = 0; i < v->b->m; i++) {
        v->is_on[i] = (on >> i & 1) != 0;
        v->hold[v->b->pair[i]] = v->is_on[i] ? DALCS_HELD_CLOSED : DALCS_HELD_OPEN;
    }
    DALCS_TRY(dalcs_blocks_build(&blocks, work, v->b->system, v->hold));
    DALCS_TRY(dalcs_lcs_build(&lcs, work, &blocks));
    if (lcs.obstacle != NULL) {
        modes->n_singular++;
        return DALCS_OK;
    }
    return look(v, &lcs, v->is_on, work);
}

/* ---- Principal minors ----------------------------------------------------------------------- */

enum dalcs_status dalcs_step_matrix(const struct dalcs_lcs *l, double sigma, struct dalcs_matrix *M,
                                    struct dalcs_arena *arena) {
    struct dalcs_matrix resolvent;
    struct dalcs_matrix x;
    DALCS_TRY(dalcs_matrix_copy(&resolvent, arena, &l->A));
    DALCS_TRY(dalcs_matrix_copy(&x, arena, &l->B));
    for (size_t i = 0; i < (size_t)l->n * (size_t)l->n; i++) {
        resolvent.a[i] = -resolvent.a[i];
    }
    for (int i = 0; i < l->n; i++) {
        *dalcs_at(&resolvent, i, i) += sigma;
    }
    DALCS_TRY(dalcs_matrix_solve(&resolvent, &x, arena));
    DALCS_TRY(dalcs_matrix_product(M, arena, &l->C, &x));
    dalcs_matrix_add(M, 1.0, &l->D);
    return DALCS_OK;
}

double dalcs_scaled_minor(const struct dalcs_matrix *M, uint32_t on, double *work) {
    int n = 0;
    double minor = 1.0;
    int index[32];
    for (int i = 0; i < M->rows; i++) {
        if (on >> i & 1) {
            index[n++] = i;
        }
    }
    for (int i = 0; i < n; i++) {
        double norm = 0.0;
        for (int j = 0; j < n; j++) {
            work[i * n + j] = *dalcs_at(M, index[i], index[j]);
            norm = hypot(norm, work[i * n + j]);
        }
        for (int j = 0; norm > 0.0 && j < n; j++) {
            work[i * n + j] /= norm;
        }
    }
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k; i < n; i++) {
            best = fabs(work[i * n + k]) > fabs(work[best * n + k]) ? i : best;
        }
        double pivot = work[best * n + k];
        minor *= best == k ? pivot : -pivot;
        for (int j = 0; j < n; j++) {
            double swap = work[k * n + j];
            work[k * n + j] = work[best * n + j];
            work[best * n + j] = swap;
        }
        for (int i = k + 1; pivot != 0.0 && i < n; i++) {
            double factor = work[i * n + k] / pivot;
            for (int j = k; j < n; j++) {
                work[i * n + j] -= factor * work[k * n + j];
            }
        }
    }
    return fabs(minor) < 1e-11 ? 0.0 : minor;
}

static enum dalcs_status find_minors(const struct visit *v, const struct dalcs_lcs *l) {
    struct dalcs_modes *modes = v->modes;
    struct dalcs_matrix M;
    double norm = dalcs_matrix_largest(&l->A);
    double sigma = modes->fastest.value[0] > 0.0 ? 2.0 * modes->fastest.value[0]
                   : norm > 0.0                  ? norm
                                                 : 1.0;
    enum dalcs_status status = dalcs_step_matrix(l, sigma, &M, v->arena);
    if (status != DALCS_OK) {
        return status == DALCS_SINGULAR ? DALCS_OK : status;
    }
    double *work = dalcs_arena_alloc(v->arena, (size_t)l->m * (size_t)l->m + 1, sizeof(*work));
    if (work == NULL) {
        return DALCS_E_NOMEM;
    }
    modes->minors = DALCS_MINORS_POSITIVE;
    modes->bad_sigma = sigma;
    for (uint32_t on = 1; on < (uint32_t)1 << l->m; on++) {
        double minor = dalcs_scaled_minor(&M, on, work);
        enum dalcs_minors found = minor > 0.0    ? DALCS_MINORS_POSITIVE
                                  : minor == 0.0 ? DALCS_MINORS_ZERO
                                                 : DALCS_MINORS_NEGATIVE;
        if (found > modes->minors) {
            modes->minors = found;
            modes->bad_minor = minor;
            for (int i = 0; i < l->m; i++) {
                modes->bad[i] = (on >> i & 1) != 0;
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status allocate(struct visit *v) {
    struct dalcs_modes *modes = v->modes;
    size_t m = (size_t)v->b->m + 1;
    size_t n = 2 * (size_t)dalcs_system_n_columns(v->b->system) + 1;
    size_t n_pairs = (size_t)v->b->system->n_pairs + 1;
    v->hold = dalcs_arena_alloc(v->arena, n_pairs, sizeof(*v->hold));
    v->is_on = dalcs_arena_alloc(v->arena, m, sizeof(bool));
    modes->bad = dalcs_arena_alloc(v->arena, m, sizeof(bool));
    modes->fastest.is_on = dalcs_arena_alloc(v->arena, m, sizeof(bool));
    modes->fastest.y = dalcs_arena_alloc(v->arena, n, sizeof(double));
    modes->growing.is_on = dalcs_arena_alloc(v->arena, m, sizeof(bool));
    modes->growing.y = dalcs_arena_alloc(v->arena, n, sizeof(double));
    return v->hold == NULL || v->is_on == NULL || modes->bad == NULL ||
                   modes->fastest.is_on == NULL || modes->fastest.y == NULL ||
                   modes->growing.is_on == NULL || modes->growing.y == NULL
               ? DALCS_E_NOMEM
               : DALCS_OK;
}

enum dalcs_status dalcs_modes_find(struct dalcs_modes *modes, struct dalcs_arena *arena,
                                   const struct dalcs_lcs *l) {
    const struct dalcs_blocks *b = l->blocks;
    *modes = (struct dalcs_modes){.slowest = -INFINITY};
    struct visit v = {.modes = modes, .arena = arena, .b = b};
    double size = b->n + b->p + b->m + 1;
    DALCS_TRY(allocate(&v));
    if (b->m > 20 || ldexp(size * size * size, b->m) > most_work) {
        return l->obstacle == NULL ? look(&v, l, l->is_swapped, arena) : DALCS_OK;
    }
    for (int i = 0; i < b->system->n_pairs; i++) {
        v.hold[i] = b->hold[i];
    }
    for (uint32_t on = 0; on < (uint32_t)1 << b->m; on++) {
        struct dalcs_arena work = {0};
        enum dalcs_status status = visit(&v, on, &work);
        dalcs_arena_finish(&work);
        if (status != DALCS_OK && status != DALCS_SINGULAR) {
            return status;
        }
    }
    modes->is_checked = true;
    return l->obstacle == NULL ? find_minors(&v, l) : DALCS_OK;
}
