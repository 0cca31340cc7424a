/* lcs.c - a DALCS as a dictionary: basic variables by the others, exchanged until only derivatives
 * and one variable of each pair are basic. */
#include "lcs.h"

#include "dictionary.h"

#include <math.h>

bool dalcs_variable_is_of_pair(enum dalcs_variable_kind kind) {
    return kind == DALCS_VARIABLE_CURRENT || kind == DALCS_VARIABLE_REVERSE;
}

/* ---- Making it ------------------------------------------------------------------------------ */

static void put_block(struct dalcs_dictionary *d, int row, int column,
                      const struct dalcs_matrix *block) {
    for (int j = 0; j < block->columns; j++) {
        for (int i = 0; i < block->rows; i++) {
            *dalcs_at(&d->a, row + i, column + j) = *dalcs_at(block, i, j);
        }
    }
}

static void name_range(struct dalcs_variable *v, int first, int n, enum dalcs_variable_kind kind) {
    for (int i = 0; i < n; i++) {
        v[first + i] = (struct dalcs_variable){kind, i};
    }
}

static double power_of_2_near(double value) {
    int exponent;
    (void)frexp(value, &exponent);
    return ldexp(1.0, exponent);
}

static void balance(struct dalcs_dictionary *d) {
    for (int sweep = 0; sweep < 4; sweep++) {
        for (int side = 0; side < 2; side++) {
            int n = side == 0 ? d->n_rows : d->n_columns;
            int other = side == 0 ? d->n_columns : d->n_rows;
            for (int i = 0; i < n; i++) {
                double largest = 0.0;
                for (int j = 0; j < other; j++) {
                    largest = fmax(
                        largest, fabs(side == 0 ? *dalcs_at(&d->a, i, j) : *dalcs_at(&d->a, j, i)));
                }
                double scale = largest > 0.0 ? 1.0 / power_of_2_near(largest) : 1.0;
                *(side == 0 ? &d->row_scale[i] : &d->column_scale[i]) *= scale;
                for (int j = 0; j < other; j++) {
                    *(side == 0 ? dalcs_at(&d->a, i, j) : dalcs_at(&d->a, j, i)) *= scale;
                }
            }
        }
    }
}

static void name_all(struct dalcs_dictionary *d, const struct dalcs_blocks *b) {
    const int n = b->n;
    const int p = b->p;
    const int m = b->m;
    const int k = b->k;
    name_range(d->row, 0, n, DALCS_VARIABLE_DERIVATIVE);
    name_range(d->row, n, p, DALCS_VARIABLE_ZERO);
    name_range(d->row, n + p, m, DALCS_VARIABLE_REVERSE);
    name_range(d->column, 0, n, DALCS_VARIABLE_STATE);
    name_range(d->column, n, p, DALCS_VARIABLE_ALGEBRAIC);
    name_range(d->column, n + p, m, DALCS_VARIABLE_CURRENT);
    name_range(d->column, n + p + m, k, DALCS_VARIABLE_INPUT);
    name_range(d->column, n + p + m + k, k, DALCS_VARIABLE_INPUT_DERIVATIVE);
}

static enum dalcs_status make(struct dalcs_dictionary *d, struct dalcs_arena *arena,
                              const struct dalcs_blocks *b) {
    int n = b->n;
    int p = b->p;
    int m = b->m;
    int k = b->k;
    *d = (struct dalcs_dictionary){.n_rows = n + p + m, .n_columns = n + p + m + 2 * k};
    struct dalcs_matrix top;
    DALCS_TRY(dalcs_matrix_new(&d->a, arena, d->n_rows, d->n_columns));
    DALCS_TRY(dalcs_matrix_new(&d->size, arena, d->n_rows, d->n_columns));
    DALCS_TRY(dalcs_matrix_new(&top, arena, n, n + p + m + k));
    d->row_scale = dalcs_arena_alloc(arena, (size_t)d->n_rows + 1, sizeof(double));
    d->column_scale = dalcs_arena_alloc(arena, (size_t)d->n_columns + 1, sizeof(double));
    d->row = dalcs_arena_alloc(arena, (size_t)d->n_rows + 1, sizeof(*d->row));
    d->column = dalcs_arena_alloc(arena, (size_t)d->n_columns + 1, sizeof(*d->column));
    if (d->row_scale == NULL || d->column_scale == NULL || d->row == NULL || d->column == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_dictionary rates = {.a = top};
    put_block(&rates, 0, 0, &b->A_I);
    put_block(&rates, 0, n, &b->B_I);
    put_block(&rates, 0, n + p, &b->L_I);
    put_block(&rates, 0, n + p + m, &b->E_I);
    DALCS_TRY(dalcs_matrix_solve(&b->P, &top, arena));
    put_block(d, 0, 0, &top);
    put_block(d, n, 0, &b->A_II);
    put_block(d, n, n, &b->B_II);
    put_block(d, n, n + p, &b->L_II);
    put_block(d, n, n + p + m, &b->E_II);
    put_block(d, n + p, 0, &b->C_I);
    put_block(d, n + p, n, &b->C_II);
    put_block(d, n + p, n + p, &b->D);
    put_block(d, n + p, n + p + m, &b->F);
    name_all(d, b);
    for (int i = 0; i < d->n_rows; i++) {
        d->row_scale[i] = 1.0;
    }
    for (int j = 0; j < d->n_columns; j++) {
        d->column_scale[j] = 1.0;
    }
    balance(d);
    for (int j = 0; j < d->n_columns; j++) {
        for (int i = 0; i < d->n_rows; i++) {
            *dalcs_at(&d->size, i, j) = fabs(*dalcs_at(&d->a, i, j));
        }
    }
    return DALCS_OK;
}

/* ---- Reading it off ------------------------------------------------------------------------- */

static double value_at(const struct dalcs_dictionary *d, int i, int j) {
    return *dalcs_at(&d->a, i, j) / (d->row_scale[i] * d->column_scale[j]);
}

/* Column of x, u or s among those of the result: [0, n), [n, n + m), [n + m, ...); -1: none. */
static int place_of(const struct dalcs_lcs *lcs, const int *number, struct dalcs_variable v) {
    switch (v.kind) {
    case DALCS_VARIABLE_STATE:
        return number[v.index];
    case DALCS_VARIABLE_CURRENT:
    case DALCS_VARIABLE_REVERSE:
        return lcs->n + v.index;
    case DALCS_VARIABLE_INPUT:
        return lcs->n + lcs->m + v.index;
    case DALCS_VARIABLE_INPUT_DERIVATIVE:
        return lcs->n + lcs->m + lcs->k + v.index;
    default:
        return -1;
    }
}

static void put(struct dalcs_lcs *lcs, struct dalcs_variable row, const int *number, int column,
                double value) {
    struct dalcs_matrix *x = row.kind == DALCS_VARIABLE_DERIVATIVE ? &lcs->A : &lcs->C;
    struct dalcs_matrix *u = row.kind == DALCS_VARIABLE_DERIVATIVE ? &lcs->B : &lcs->D;
    struct dalcs_matrix *s = row.kind == DALCS_VARIABLE_DERIVATIVE ? &lcs->E : &lcs->F;
    int i = row.kind == DALCS_VARIABLE_DERIVATIVE ? number[row.index] : row.index;
    if (row.kind == DALCS_VARIABLE_STATE || row.kind == DALCS_VARIABLE_ALGEBRAIC) {
        if (column < lcs->n + lcs->m) {
            *dalcs_at(row.kind == DALCS_VARIABLE_STATE ? &lcs->full_x : &lcs->full_z, row.index,
                      column) = value;
        }
    } else if (column < lcs->n) {
        *dalcs_at(x, i, column) = value;
    } else if (column < lcs->n + lcs->m) {
        *dalcs_at(u, i, column - lcs->n) = value;
    } else {
        *dalcs_at(s, i, column - lcs->n - lcs->m) = value;
    }
}

static enum dalcs_status read_off(struct dalcs_lcs *lcs, struct dalcs_arena *arena,
                                  const struct dalcs_dictionary *d) {
    const struct dalcs_blocks *b = lcs->blocks;
    int *number = dalcs_arena_alloc(arena, (size_t)b->n + 1, sizeof(int));
    lcs->state = dalcs_arena_alloc(arena, (size_t)b->n + 1, sizeof(int));
    lcs->is_swapped = dalcs_arena_alloc(arena, (size_t)b->m + 1, sizeof(bool));
    lcs->z_is_free = dalcs_arena_alloc(arena, (size_t)b->p + 1, sizeof(bool));
    if (number == NULL || lcs->state == NULL || lcs->is_swapped == NULL || lcs->z_is_free == NULL) {
        return DALCS_E_NOMEM;
    }
    lcs->m = b->m;
    lcs->k = b->k;
    for (int j = 0; j < d->n_columns; j++) {
        struct dalcs_variable v = d->column[j];
        if (v.kind == DALCS_VARIABLE_STATE) {
            number[v.index] = lcs->n;
            lcs->state[lcs->n++] = v.index;
        } else if (dalcs_variable_is_of_pair(v.kind)) {
            lcs->is_swapped[v.index] = v.kind == DALCS_VARIABLE_REVERSE;
        } else if (v.kind == DALCS_VARIABLE_ALGEBRAIC) {
            lcs->z_is_free[v.index] = true;
        }
    }
    DALCS_TRY(dalcs_matrix_new(&lcs->A, arena, lcs->n, lcs->n));
    DALCS_TRY(dalcs_matrix_new(&lcs->B, arena, lcs->n, lcs->m));
    DALCS_TRY(dalcs_matrix_new(&lcs->C, arena, lcs->m, lcs->n));
    DALCS_TRY(dalcs_matrix_new(&lcs->D, arena, lcs->m, lcs->m));
    DALCS_TRY(dalcs_matrix_new(&lcs->E, arena, lcs->n, 2 * lcs->k));
    DALCS_TRY(dalcs_matrix_new(&lcs->F, arena, lcs->m, 2 * lcs->k));
    DALCS_TRY(dalcs_matrix_new(&lcs->full_x, arena, b->n, lcs->n + lcs->m));
    DALCS_TRY(dalcs_matrix_new(&lcs->full_z, arena, b->p, lcs->n + lcs->m));
    for (int i = 0; i < lcs->n; i++) {
        *dalcs_at(&lcs->full_x, lcs->state[i], i) = 1.0;
    }
    for (int i = 0; i < d->n_rows; i++) {
        for (int j = 0; d->row[i].kind != DALCS_VARIABLE_GONE && j < d->n_columns; j++) {
            int column = place_of(lcs, number, d->column[j]);
            if (column >= 0) {
                put(lcs, d->row[i], number, column, value_at(d, i, j));
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_lcs_build(struct dalcs_lcs *lcs, struct dalcs_arena *arena,
                                  const struct dalcs_blocks *blocks) {
    *lcs = (struct dalcs_lcs){.blocks = blocks};
    struct dalcs_dictionary d;
    DALCS_TRY(make(&d, arena, blocks));
    lcs->obstacle = dalcs_dictionary_reduce(&d, &lcs->index_steps);
    if (lcs->obstacle != NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(read_off(lcs, arena, &d));
    struct dalcs_matrix x;
    struct dalcs_matrix transposed;
    struct dalcs_matrix half;
    DALCS_TRY(dalcs_matrix_new(&x, arena, blocks->n, lcs->n));
    for (int j = 0; j < lcs->n; j++) {
        for (int i = 0; i < blocks->n; i++) {
            *dalcs_at(&x, i, j) = *dalcs_at(&lcs->full_x, i, j);
        }
    }
    DALCS_TRY(dalcs_matrix_transpose(&transposed, arena, &x));
    DALCS_TRY(dalcs_matrix_product(&half, arena, &transposed, &blocks->storage));
    return dalcs_matrix_product(&lcs->storage, arena, &half, &x);
}

const char *dalcs_lcs_u_name(const struct dalcs_lcs *lcs, int i, struct dalcs_arena *arena) {
    const struct dalcs_system *s = lcs->blocks->system;
    int pair = lcs->blocks->pair[i];
    return lcs->is_swapped[i] ? dalcs_reverse_name(s, pair, arena)
                              : dalcs_column_name(s, dalcs_system_n_equations(s) + pair, arena);
}

const char *dalcs_lcs_state_name(const struct dalcs_lcs *lcs, int i, struct dalcs_arena *arena) {
    return dalcs_column_name(lcs->blocks->system, lcs->state[i], arena);
}
