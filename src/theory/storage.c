/* storage.c - the semidefinite program over the P that are left, and the verification of its answer. */
#include "storage.h"

#include "passivity.h"
#include "sdpa.h"
#include "storage_face.h"

#include <math.h>

const char *const dalcs_no_rate = "no P gives one above 1e-4 of the slowest mode's";

/* P, scaled, is looked for up to this. */
static const double most_P = 1e3;

/* ---- The program ---------------------------------------------------------------------------- */

/* The blocks V'Q(P)V, P and most_P - P of a P and, for the constant, most_P. */
static enum dalcs_status put_blocks(const struct dalcs_face *s, struct dalcs_sdpa *program,
                                    int variable, const struct dalcs_matrix *P,
                                    struct dalcs_arena *work) {
    struct dalcs_matrix Q;
    struct dalcs_matrix half;
    struct dalcs_matrix turned;
    struct dalcs_matrix face;
    struct dalcs_matrix rest;
    bool is_constant = variable == 0;
    DALCS_TRY(dalcs_face_dissipation(s, P, is_constant, &Q, work));
    DALCS_TRY(dalcs_matrix_transpose(&turned, work, &s->complement));
    DALCS_TRY(dalcs_matrix_product(&half, work, &turned, &Q));
    DALCS_TRY(dalcs_matrix_product(&face, work, &half, &s->complement));
    DALCS_TRY(dalcs_matrix_new(&rest, work, s->n, s->n));
    dalcs_matrix_add(&rest, -1.0, P);
    for (int i = 0; i < s->n; i++) {
        *dalcs_at(&rest, i, i) += is_constant ? most_P : 0.0;
    }
    dalcs_sdpa_put(program, variable, 0, P);
    dalcs_sdpa_put(program, variable, 1, &rest);
    if (face.rows > 0) {
        dalcs_sdpa_put(program, variable, 2, &face);
    }
    return DALCS_OK;
}

/* -I in the blocks that are to be larger than t. */
static enum dalcs_status put_margin(const struct dalcs_face *s, struct dalcs_sdpa *program,
                                    struct dalcs_arena *work) {
    for (int block = 0; block < 3; block += 2) {
        int n = block == 0 ? s->n : s->complement.columns;
        struct dalcs_matrix minus;
        DALCS_TRY(dalcs_matrix_new(&minus, work, n, n));
        for (int i = 0; i < n; i++) {
            *dalcs_at(&minus, i, i) = -1.0;
        }
        if (n > 0) {
            dalcs_sdpa_put(program, s->n_free + 1, block, &minus);
        }
    }
    return DALCS_OK;
}

/* maximise t such that V'Q(P)V >= t I, P >= t I, P <= most_P I */
static enum dalcs_status ask(const struct dalcs_face *s, struct dalcs_sdpa *program,
                             struct dalcs_sdpa_answer *answer) {
    int size[3] = {s->n, s->n, s->complement.columns};
    double *cost = dalcs_arena_alloc(s->arena, (size_t)s->n_free + 1, sizeof(double));
    if (cost == NULL) {
        return DALCS_E_NOMEM;
    }
    cost[s->n_free] = -1.0;
    DALCS_TRY(dalcs_sdpa_begin(program, s->arena, s->n_free + 1, cost, size[2] > 0 ? 3 : 2, size));
    for (int k = -1; k < s->n_free; k++) {
        struct dalcs_arena work = {0};
        struct dalcs_matrix P = s->base;
        enum dalcs_status status = k < 0 ? DALCS_OK : dalcs_face_direction(s, k, &P, &work);
        status = status == DALCS_OK ? put_blocks(s, program, k + 1, &P, &work) : status;
        dalcs_arena_finish(&work);
        DALCS_TRY(status);
    }
    DALCS_TRY(put_margin(s, program, s->arena));
    return dalcs_sdpa_solve(program, answer);
}

/* ---- Verification --------------------------------------------------------------------------- */

static enum dalcs_status verify_P(const struct dalcs_face *s, const struct dalcs_matrix *scaled,
                                  struct dalcs_storage *found) {
    const struct dalcs_lcs lcs = {.n = s->n,
                                  .m = s->m,
                                  .A = s->given->A,
                                  .B = s->given->B,
                                  .C = s->given->C,
                                  .D = s->given->D};
    bool is_positive;
    double excess;
    DALCS_TRY(dalcs_matrix_copy(&found->P, s->arena, scaled));
    for (int j = 0; j < s->n; j++) {
        for (int i = 0; i < s->n; i++) {
            *dalcs_at(&found->P, i, j) *= s->time / (s->unit[i] * s->unit[j]);
        }
    }
    DALCS_TRY(dalcs_is_positive_definite(&found->P, &is_positive, s->arena));
    DALCS_TRY(dalcs_passivity_excess(&lcs, &found->P, 0.0, &excess, s->arena));
    found->is_found = is_positive && dalcs_is_dissipative(excess);
    return DALCS_OK;
}

/* R, in scaled units, and the size of what its elements are made of. */
static enum dalcs_status growth(const struct dalcs_face *s, const struct dalcs_matrix *Z,
                                struct dalcs_matrix *R, struct dalcs_matrix *size) {
    DALCS_TRY(dalcs_matrix_new(R, s->arena, s->n, s->n));
    DALCS_TRY(dalcs_matrix_new(size, s->arena, s->n, s->n));
    for (int i = 0; i < s->n; i++) {
        for (int j = 0; j < s->n; j++) {
            for (int k = 0; k < s->n + s->m; k++) {
                double left = k < s->n ? *dalcs_at(&s->q.A, i, k) : *dalcs_at(&s->q.B, i, k - s->n);
                double right =
                    k < s->n ? *dalcs_at(&s->q.A, j, k) : *dalcs_at(&s->q.B, j, k - s->n);
                double first = left * *dalcs_at(Z, k, j);
                double second = right * *dalcs_at(Z, i, k);
                *dalcs_at(R, i, j) += first + second;
                *dalcs_at(size, i, j) = fmax(*dalcs_at(size, i, j), fabs(first) + fabs(second));
            }
        }
    }
    return DALCS_OK;
}

/* The power that Z stands for, over the sum of what it is made of: what goes in, negative. */
static double gain_of(const struct dalcs_face *s, const struct dalcs_matrix *Z) {
    double gain = 0.0;
    double size = 0.0;
    for (int i = 0; i < s->m; i++) {
        for (int k = 0; k < s->n + s->m; k++) {
            double y = k < s->n ? *dalcs_at(&s->q.C, i, k) : *dalcs_at(&s->q.D, i, k - s->n);
            double part = 2.0 * y * *dalcs_at(Z, k, s->n + i);
            gain -= part;
            size += fabs(part);
        }
    }
    return size > 0.0 ? gain / size : 0.0;
}

/* Z = V face V', of which V is `vectors`. */
static enum dalcs_status verify_Z(const struct dalcs_face *s, const struct dalcs_matrix *vectors,
                                  const struct dalcs_matrix *face, struct dalcs_storage *found) {
    struct dalcs_matrix half;
    struct dalcs_matrix turned;
    struct dalcs_matrix R;
    struct dalcs_matrix size;
    double least[2];
    DALCS_TRY(dalcs_matrix_product(&half, s->arena, vectors, face));
    DALCS_TRY(dalcs_matrix_transpose(&turned, s->arena, vectors));
    DALCS_TRY(dalcs_matrix_product(&found->Z, s->arena, &half, &turned));
    DALCS_TRY(growth(s, &found->Z, &R, &size));
    DALCS_TRY(dalcs_scaled_least(&R, &size, &least[0], s->arena));
    DALCS_TRY(dalcs_matrix_copy(&size, s->arena, &found->Z));
    for (size_t i = 0; i < (size_t)size.rows * (size_t)size.rows; i++) {
        size.a[i] = fabs(size.a[i]);
    }
    DALCS_TRY(dalcs_scaled_least(&found->Z, &size, &least[1], s->arena));
    found->gain = gain_of(s, &found->Z);
    found->is_refuted =
        least[0] > -dalcs_definite && least[1] > -dalcs_definite && found->gain > 1e-7;
    dalcs_face_scale(&found->Z, s->unit, false, s->unit, 1.0);
    return DALCS_OK;
}

static enum dalcs_status judge(const struct dalcs_face *s, const struct dalcs_sdpa_answer *answer,
                               struct dalcs_storage *found) {
    struct dalcs_matrix P;
    DALCS_TRY(dalcs_matrix_copy(&P, s->arena, &s->base));
    for (int k = 0; k < s->n_free; k++) {
        struct dalcs_matrix more;
        DALCS_TRY(dalcs_face_direction(s, k, &more, s->arena));
        dalcs_matrix_add(&P, answer->x[k], &more);
    }
    DALCS_TRY(verify_P(s, &P, found));
    bool is_whole = s->complement.columns == s->n + s->m; /* else Z speaks of a face only */
    if (!found->is_found && is_whole && answer->x[s->n_free] < 0.0) {
        DALCS_TRY(verify_Z(s, &s->complement, &answer->dual[2], found));
    }
    found->why = found->is_found || found->is_refuted
                     ? NULL
                     : "what the semidefinite program gave did not verify";
    return DALCS_OK;
}

static const char gains_in_the_limit[] = "it gives energy in the limit of fast motions";

/* A motion that the system gives energy to. */
static enum dalcs_status judge_motion(const struct dalcs_face *s, struct dalcs_storage *found) {
    struct dalcs_matrix one;
    int n = s->gaining.columns;
    DALCS_TRY(dalcs_matrix_new(&one, s->arena, n, n));
    for (int i = 0; i < n; i++) {
        *dalcs_at(&one, i, i) = 1.0;
    }
    if (n > 0) {
        DALCS_TRY(verify_Z(s, &s->gaining, &one, found));
    }
    found->why = found->is_refuted ? NULL : gains_in_the_limit;
    return DALCS_OK;
}

static enum dalcs_status search(struct dalcs_face *s, struct dalcs_storage *found) {
    bool exists;
    DALCS_TRY(dalcs_face_kernel(s));
    if (s->is_gaining) {
        return judge_motion(s, found);
    }
    DALCS_TRY(dalcs_face_find(s, &exists));
    if (!exists) {
        found->why = "no P has the kernel that its lossless motions require";
        return DALCS_OK;
    }
    struct dalcs_sdpa program = {0};
    struct dalcs_sdpa_answer answer;
    enum dalcs_status status = ask(s, &program, &answer);
    dalcs_sdpa_finish(&program);
    DALCS_TRY(status);
    found->why = answer.why;
    return answer.is_solved ? judge(s, &answer, found) : DALCS_OK;
}

enum dalcs_status dalcs_storage_find(const struct dalcs_quadruple *q, struct dalcs_storage *found,
                                     struct dalcs_arena *arena) {
    struct dalcs_face s = {.arena = arena, .given = q, .n = q->A.rows, .m = q->D.rows};
    *found = (struct dalcs_storage){.why = dalcs_sdpa_missing()};
    if (s.n == 0 || s.n > DALCS_MOST_STORAGE || s.m > 2 * DALCS_MOST_STORAGE) {
        found->why = "it is too large for a semidefinite program";
    }
    if (found->why != NULL) {
        return DALCS_OK;
    }
    enum dalcs_status status = search(&s, found);
    if (status == DALCS_SINGULAR) { /* numbers that LAPACK finds no answer to */
        found->why = "its numbers are too far apart";
        return DALCS_OK;
    }
    return status;
}

enum dalcs_status dalcs_storage_rate(const struct dalcs_quadruple *q, double most, double *eps,
                                     struct dalcs_matrix *P, const char **why,
                                     struct dalcs_arena *arena) {
    double high = most;
    *eps = 0.0;
    for (int step = 0; step < 20 && high > 1.001 * *eps && high > 1e-4 * most; step++) {
        struct dalcs_arena work = {0};
        struct dalcs_quadruple faster = *q;
        struct dalcs_storage found = {0};
        double middle = step == 0 ? 0.9999 * most : *eps == 0.0 ? 0.1 * high : 0.5 * (*eps + high);
        enum dalcs_status status = dalcs_matrix_copy(&faster.A, &work, &q->A);
        for (int i = 0; status == DALCS_OK && i < q->A.rows; i++) {
            *dalcs_at(&faster.A, i, i) += 0.5 * middle;
        }
        status = status == DALCS_OK ? dalcs_storage_find(&faster, &found, &work) : status;
        if (status == DALCS_OK && found.is_found) {
            *eps = middle;
            status = dalcs_matrix_copy(P, arena, &found.P);
        } else {
            high = middle;
        }
        *why = found.why == NULL ? dalcs_no_rate
               : found.why == gains_in_the_limit /* that of a circuit with faster motions */
                   ? "for a rate, motions would have to lose more in the limit of fast ones"
                   : found.why;
        dalcs_arena_finish(&work);
        DALCS_TRY(status);
    }
    return DALCS_OK;
}
