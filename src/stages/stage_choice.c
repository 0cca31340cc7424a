/* stage_choice.c - of a small system in a singular mode: which rows follow from others, and what is asked instead of
 * them. */
#include "stage_choice.h"

#include "least_norm.h"
#include "null_space.h"
#include "partition.h"
#include "rounding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int column_of(const struct dalcs_stage_workshop *b, int unknown) {
    int n_equations = dalcs_system_n_equations(b->system);
    return unknown < n_equations ? unknown : n_equations + b->entry->on[unknown - n_equations];
}

/* Are row and unknown of one block? What a block reads of others is given there: it leaves nothing open. That a row follows
 * from others is so of all columns, or it is not so. */
static bool is_within_block(const struct dalcs_stage_workshop *b, int row, int unknown) {
    const int *block = b->stages->block_of;
    int n_equations = dalcs_system_n_equations(b->system);
    int own = row < n_equations ? b->system->dual[row] : column_of(b, row);
    return block == NULL || block[own] == block[column_of(b, unknown)];
}

/* Whose null space it is: that of the columns, or else of the rows, of what has no memory; of each block alone, or of all
 * that it reads. */
struct side {
    bool of_columns, within_blocks;
};

static enum dalcs_status find_null_space(const struct dalcs_stage_workshop *b, struct side side,
                                         struct dalcs_null_space *space) {
    int n = b->n;
    int n_x = b->n_x;
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int i = 0; i < n; i++) {
        for (int j = n_x; j < n && status == DALCS_OK; j++) {
            int row = side.of_columns ? i : j;
            int unknown = side.of_columns ? j : i;
            double a = b->eq.plain_base[unknown * n + row];
            bool counts = a != 0.0 && (!side.within_blocks || is_within_block(b, row, unknown));
            status = counts ? dalcs_triplets_add(&t, i, j - n_x, a) : DALCS_OK;
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(space, n, n - n_x, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

/* The null vectors: *vector[*nullity][n], over the scales of all unknowns and of length 1, with 0 in the places of states. */
static enum dalcs_status find_null_vectors(struct dalcs_stage_workshop *b, struct side side,
                                           int *nullity, double **vector) {
    int n = b->n;
    int n_x = b->n_x;
    const double *scale = side.of_columns ? b->eq.column_scale : b->eq.row_scale;
    struct dalcs_null_space space;
    DALCS_TRY(find_null_space(b, side, &space));
    *nullity = space.n_free;
    *vector = dalcs_stage_workshop_reals(&b->arena, n * *nullity);
    for (int k = 0; k < *nullity && *vector != NULL; k++) {
        double *v = *vector + k * n;
        double square = 0.0;
        dalcs_null_space_vector(&space, k, v + n_x);
        for (int i = n_x; i < n; i++) {
            v[i] /= scale[i];
            square += v[i] * v[i];
        }
        for (int i = n_x; i < n; i++) {
            v[i] /= sqrt(square);
        }
    }
    dalcs_null_space_finish(&space);
    return *vector != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* The other sides of the pairs of one kind in a null vector: lambda of closed ones, w of open ones; of pairs of any kind
 * those count that it reaches first. Returns the norm of their terms' sizes. */
static double find_other_sides(const struct dalcs_stage_workshop *b, enum dalcs_pair_kind kind,
                               const double *vector, double *of_pair) {
    const struct dalcs_csr *C = &b->system->C;
    int n_equations = dalcs_system_n_equations(b->system);
    double square = 0.0;
    for (int d = 0; d < b->system->n_pairs; d++) {
        int closed = b->place[n_equations + d];
        bool counts = !b->system->pair[d].is_left_out[closed >= 0 ? 1 : 0];
        double side = counts && closed >= 0 ? vector[closed] * b->eq.column_scale[closed] : 0.0;
        double size = fabs(side);
        for (int k = C->p[d]; counts && closed < 0 && k < C->p[d + 1]; k++) {
            int c = b->place[C->j[k]];
            double term = c >= 0 ? C->x[k] * vector[c] * b->eq.column_scale[c] : 0.0;
            side += term;
            size += fabs(term);
        }
        of_pair[d] = fabs(side) > dalcs_sum_rounded * size ? side : 0.0;
        square += size * size;
    }
    dalcs_partition_keep_first(b->stages->block_of, b->system, kind, of_pair);
    return sqrt(square);
}

/* Row k: the sum of weight[n_pairs] times the other sides of the pairs is 0, with reverse voltages over their knees. */
static void choose_in_pairs(const struct dalcs_stage_workshop *b, int k, const double *weight) {
    const struct dalcs_system *s = b->system;
    const double *constant = b->stages->excitation->constant;
    int n_equations = dalcs_system_n_equations(s);
    double *row = b->open.choice + k * b->n;
    double *chosen = b->open.chosen + k * b->n_rhs;
    for (int d = 0; d < s->n_pairs; d++) {
        int closed = b->place[n_equations + d];
        if (closed >= 0) {
            row[closed] += weight[d];
            continue;
        }
        for (int e = s->C.p[d]; e < s->C.p[d + 1]; e++) {
            int c = b->place[s->C.j[e]];
            if (c >= 0) {
                row[c] += weight[d] * s->C.x[e];
            }
            if (c >= 0 && c < b->n_x) { /* unknowns are increments of states */
                chosen[c] -= weight[d] * s->C.x[e];
            }
        }
        for (int e = s->F.p[d]; e < s->F.p[d + 1]; e++) {
            int wave = b->wave_column[s->F.j[e]];
            chosen[wave >= 0 ? wave : b->n_x] -=
                weight[d] * s->F.x[e] * (wave >= 0 ? 1.0 : constant[s->F.j[e]]);
        }
        chosen[b->n_x] += weight[d] * dalcs_system_knee(s, d);
    }
}

/* Balances row k and makes it of length 1, as null vectors are. */
static void balance_choice(const struct dalcs_stage_workshop *b, int k) {
    double *row = b->open.choice + k * b->n;
    double *chosen = b->open.chosen + k * b->n_rhs;
    double square = 0.0;
    for (int i = 0; i < b->n; i++) {
        row[i] *= b->eq.column_scale[i];
        square += row[i] * row[i];
    }
    for (int i = 0; i < b->n; i++) {
        row[i] /= sqrt(square);
    }
    for (int j = 0; j < b->n_rhs; j++) {
        chosen[j] /= sqrt(square);
    }
}

/* Row k is null vector k itself: the least of all unknowns. */
static void choose_in_all(const struct dalcs_stage_workshop *b, int k, const double *vector) {
    for (int i = 0; i < b->n; i++) {
        b->open.choice[k * b->n + i] = vector[i] / b->eq.column_scale[i];
    }
}

/* The rows of null vectors from `first` on that pairs of one kind see; returns the first that they do not. */
static int choose_in_kind(const struct dalcs_stage_workshop *b, enum dalcs_pair_kind kind,
                          const struct dalcs_least_norm *all, int first) {
    struct dalcs_least_norm open = *all;
    open.n -= first;
    open.vector = dalcs_least_norm_vector(all, first);
    for (int k = 0; k < open.n; k++) {
        open.size[k] = find_other_sides(b, kind, dalcs_least_norm_vector(&open, k),
                                        dalcs_least_norm_part(&open, k));
    }
    int n_seen = dalcs_least_norm_separate(&open);
    for (int k = 0; k < n_seen; k++) {
        choose_in_pairs(b, first + k, dalcs_least_norm_part(&open, k));
    }
    return first + n_seen;
}

static enum dalcs_status choose(struct dalcs_stage_workshop *b, double *null_vectors) {
    int n = b->open.nullity;
    struct dalcs_least_norm open = {
        .n = n, .n_columns = b->n, .n_parts = b->system->n_pairs, .vector = null_vectors};
    open.part = dalcs_stage_workshop_reals(&b->arena, n * open.n_parts);
    open.size = dalcs_stage_workshop_reals(&b->arena, n);
    b->open.choice = dalcs_stage_workshop_reals(&b->arena, n * b->n);
    b->open.chosen = dalcs_stage_workshop_reals(&b->arena, n * b->n_rhs);
    if (open.part == NULL || open.size == NULL || b->open.choice == NULL ||
        b->open.chosen == NULL) {
        return DALCS_E_NOMEM;
    }
    int n_seen = choose_in_kind(b, DALCS_PAIR_DIODE, &open, 0);
    n_seen = choose_in_kind(b, DALCS_PAIR_SWITCH, &open, n_seen);
    for (int k = 0; k < n; k++) {
        if (k >= n_seen) {
            choose_in_all(b, k, dalcs_least_norm_vector(&open, k));
        }
        balance_choice(b, k);
    }
    return DALCS_OK;
}

/* Rows that follow from others of their block, whatever they read of blocks before it: a comparison of what only a rate
 * tells asks that this be 0, and says nothing of its own output. The choice stands in their places, and what they miss is the clash. */
static enum dalcs_status give_rows_up(struct dalcs_stage_workshop *b, int *n_of_rows) {
    const struct side rows = {.within_blocks = true};
    struct dalcs_null_space space;
    DALCS_TRY(find_null_space(b, rows, &space));
    int n = *n_of_rows = space.n_free;
    b->open.given_up = dalcs_arena_alloc(&b->arena, (size_t)n, sizeof(int));
    b->open.left = dalcs_stage_workshop_reals(&b->arena, n * b->n);
    bool has_room = b->open.given_up != NULL && b->open.left != NULL;
    for (int k = 0; k < n && has_room; k++) {
        b->open.given_up[k] = b->n_x + space.free_column[k];
        memset(b->open.left + k * b->n, 0, (size_t)b->n * sizeof(double));
        b->open.left[k * b->n + b->open.given_up[k]] = 1.0;
    }
    dalcs_null_space_finish(&space);
    return has_room ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_stage_choice_find(struct dalcs_stage_workshop *b) {
    const struct side columns = {.of_columns = true, .within_blocks = true};
    const struct side rows = {0};
    int n_of_rows;
    double *null_vectors;
    b->open.given_up = NULL;
    DALCS_TRY(find_null_vectors(b, columns, &b->open.nullity, &null_vectors));
    DALCS_TRY(find_null_vectors(b, rows, &n_of_rows, &b->open.left));
    if (n_of_rows < b->open.nullity) {
        DALCS_TRY(give_rows_up(b, &n_of_rows));
    }
    if (n_of_rows != b->open.nullity) {
        return DALCS_SINGULAR;
    }
    return b->open.nullity > 0 ? choose(b, null_vectors) : DALCS_OK;
}
