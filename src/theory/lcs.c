/* lcs.c - a DALCS as a dictionary: basic variables by the others, exchanged until only derivatives
 * and one variable of each pair are basic.
 *
 * Ranks decide what is exchanged, and circuits have 1e-12 beside 1e6. So each element carries the
 * size of what its rounding came from, and is 0 when it is below 1e-11 of that: this does not depend
 * on units. */
#include "lcs.h"

#include <math.h>

static const double noise = 1e-11;

enum kind { ZERO, DERIVATIVE, STATE, ALGEBRAIC, CURRENT, REVERSE, INPUT, INPUT_DERIVATIVE, GONE };

struct variable {
    enum kind kind;
    int index;
};

struct dictionary {
    int n_rows, n_columns;
    struct dalcs_matrix a, size; /* balanced: element * row_scale * column_scale */
    double *row_scale, *column_scale;
    struct variable *row, *column;
};

static bool is_pair(enum kind kind) {
    return kind == CURRENT || kind == REVERSE;
}

/* ---- Making it ------------------------------------------------------------------------------ */

static void put_block(struct dictionary *d, int row, int column, const struct dalcs_matrix *block) {
    for (int j = 0; j < block->columns; j++) {
        for (int i = 0; i < block->rows; i++) {
            *dalcs_at(&d->a, row + i, column + j) = *dalcs_at(block, i, j);
        }
    }
}

static void name_range(struct variable *v, int first, int n, enum kind kind) {
    for (int i = 0; i < n; i++) {
        v[first + i] = (struct variable){kind, i};
    }
}

static double power_of_2_near(double value) {
    int exponent;
    (void)frexp(value, &exponent);
    return ldexp(1.0, exponent);
}

static void balance(struct dictionary *d) {
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

static enum dalcs_status make(struct dictionary *d, struct dalcs_arena *arena,
                              const struct dalcs_blocks *b) {
    int n = b->n;
    int p = b->p;
    int m = b->m;
    int k = b->k;
    *d = (struct dictionary){.n_rows = n + p + m, .n_columns = n + p + m + 2 * k};
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
    struct dictionary rates = {.a = top};
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
    name_range(d->row, 0, n, DERIVATIVE);
    name_range(d->row, n, p, ZERO);
    name_range(d->row, n + p, m, REVERSE);
    name_range(d->column, 0, n, STATE);
    name_range(d->column, n, p, ALGEBRAIC);
    name_range(d->column, n + p, m, CURRENT);
    name_range(d->column, n + p + m, k, INPUT);
    name_range(d->column, n + p + m + k, k, INPUT_DERIVATIVE);
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

/* ---- Exchanges ------------------------------------------------------------------------------ */

/* a -= by, where by has rounding errors of the size given. */
static void subtract(struct dictionary *d, int i, int j, double by, double size) {
    double *a = dalcs_at(&d->a, i, j);
    double *s = dalcs_at(&d->size, i, j);
    *a -= by;
    *s = fmax(*s, fmax(fabs(by), size));
    if (fabs(*a) <= noise * *s) {
        *a = 0.0;
    }
}

static void swap_variables(struct dictionary *d, int r, int c) {
    struct variable v = d->row[r];
    d->row[r] = d->column[c];
    d->column[c] = v;
    double scale = d->row_scale[r];
    d->row_scale[r] = 1.0 / d->column_scale[c];
    d->column_scale[c] = 1.0 / scale;
}

/* Row r: basic = pivot column + rest, solved for the variable of column c. */
static void exchange(struct dictionary *d, int r, int c) {
    const double pivot = *dalcs_at(&d->a, r, c);
    const double pivot_error = *dalcs_at(&d->size, r, c) / fabs(pivot);
    for (int j = 0; j < d->n_columns; j++) {
        double *u = dalcs_at(&d->a, r, j);
        double *s = dalcs_at(&d->size, r, j);
        if (j != c && *u != 0.0) {
            *u = -*u / pivot;
            *s = fmax(*s / fabs(pivot), fabs(*u) * pivot_error);
        }
    }
    for (int j = 0; j < d->n_columns; j++) {
        const double u = *dalcs_at(&d->a, r, j);
        if (j == c || u == 0.0) {
            continue;
        }
        const double u_size = *dalcs_at(&d->size, r, j);
        for (int i = 0; i < d->n_rows; i++) {
            const double l = *dalcs_at(&d->a, i, c);
            if (i != r && l != 0.0) {
                subtract(d, i, j, -l * u,
                         fmax(fabs(l) * u_size, fabs(u) * *dalcs_at(&d->size, i, c)));
            }
        }
    }
    for (int i = 0; i < d->n_rows; i++) {
        double *l = dalcs_at(&d->a, i, c);
        if (i != r && *l != 0.0) {
            *l /= pivot;
            double *s = dalcs_at(&d->size, i, c);
            *s = fmax(*s / fabs(pivot), fabs(*l) * pivot_error);
        }
    }
    *dalcs_at(&d->a, r, c) = 1.0 / pivot;
    *dalcs_at(&d->size, r, c) = pivot_error / fabs(pivot);
    swap_variables(d, r, c);
    if (d->column[c].kind == ZERO) {
        d->column[c].kind = GONE;
        for (int i = 0; i < d->n_rows; i++) {
            *dalcs_at(&d->a, i, c) = 0.0;
        }
    }
}

/* The largest element of the rows and columns of a kind; false when all are 0. */
static bool find_pivot(const struct dictionary *d, enum kind row, enum kind column, int *r,
                       int *c) {
    double best = 0.0;
    for (int j = 0; j < d->n_columns; j++) {
        for (int i = 0; d->column[j].kind == column && i < d->n_rows; i++) {
            double value = d->row[i].kind == row ? fabs(*dalcs_at(&d->a, i, j)) : 0.0;
            if (value > best) {
                best = value;
                *r = i;
                *c = j;
            }
        }
    }
    return best > 0.0;
}

/* A row without algebraic unknowns tells one variable of a pair; the other then tells an unknown that
 * is left. */
static bool swap_pair(struct dictionary *d) {
    double best = 0.0;
    int at[4] = {0, 0, 0, 0};
    for (int c = 0; c < d->n_columns; c++) {
        if (!is_pair(d->column[c].kind)) {
            continue;
        }
        int r = 0;
        while (!(is_pair(d->row[r].kind) && d->row[r].index == d->column[c].index)) {
            r++;
        }
        double first = 0.0;
        double second = 0.0;
        int zero = 0;
        int unknown = 0;
        for (int i = 0; i < d->n_rows; i++) {
            double value = d->row[i].kind == ZERO ? fabs(*dalcs_at(&d->a, i, c)) : 0.0;
            zero = value > first ? i : zero;
            first = fmax(first, value);
        }
        for (int j = 0; j < d->n_columns; j++) {
            double value = d->column[j].kind == ALGEBRAIC ? fabs(*dalcs_at(&d->a, r, j)) : 0.0;
            unknown = value > second ? j : unknown;
            second = fmax(second, value);
        }
        if (first * second > best) {
            best = first * second;
            at[0] = zero;
            at[1] = c;
            at[2] = r;
            at[3] = unknown;
        }
    }
    if (best > 0.0) {
        exchange(d, at[0], at[1]);
        exchange(d, at[2], at[3]);
    }
    return best > 0.0;
}

/* ---- Hidden constraints --------------------------------------------------------------------- */

/* Row r is x_c = (a combination of states and inputs): its derivative takes the place of the row of
 * x_c'. False when it has derivatives of inputs already. */
static bool differentiate(struct dictionary *d, int r) {
    int state = d->row[r].index;
    int own = 0;
    while (!(d->row[own].kind == DERIVATIVE && d->row[own].index == state)) {
        own++;
    }
    for (int j = 0; j < d->n_columns; j++) {
        if (d->column[j].kind == INPUT_DERIVATIVE && *dalcs_at(&d->a, r, j) != 0.0) {
            return false;
        }
    }
    const double unit = d->row_scale[r];
    for (int j = 0; j < d->n_columns; j++) {
        const double g = *dalcs_at(&d->a, r, j) / (unit * d->column_scale[j]);
        if (g == 0.0) {
            continue;
        }
        for (int i = 0; i < d->n_rows; i++) {
            if (d->column[j].kind == STATE && d->row[i].kind == DERIVATIVE &&
                d->row[i].index == d->column[j].index) {
                double factor = g * d->row_scale[own] / d->row_scale[i];
                for (int q = 0; q < d->n_columns; q++) {
                    subtract(d, own, q, factor * *dalcs_at(&d->a, i, q),
                             fabs(factor) * *dalcs_at(&d->size, i, q));
                }
            }
        }
        for (int q = 0; d->column[j].kind == INPUT && q < d->n_columns; q++) {
            if (d->column[q].kind == INPUT_DERIVATIVE && d->column[q].index == d->column[j].index) {
                double by = g * d->row_scale[own] * d->column_scale[q];
                subtract(d, own, q, by, fabs(by));
            }
        }
    }
    d->row[own] = (struct variable){ZERO, 0};
    return true;
}

/* A row of states and inputs alone. */
static bool use_constraint(struct dictionary *d, int *steps, const char **obstacle) {
    int r;
    int c;
    for (int i = 0; i < d->n_rows; i++) {
        bool has_pair = false;
        for (int j = 0; d->row[i].kind == ZERO && j < d->n_columns; j++) {
            has_pair = has_pair || (is_pair(d->column[j].kind) && *dalcs_at(&d->a, i, j) != 0.0);
        }
        if (has_pair) {
            *obstacle = "an equation ties diodes to each other that no other unknown completes";
            return false;
        }
    }
    if (!find_pivot(d, ZERO, STATE, &r, &c)) {
        for (int i = 0; i < d->n_rows; i++) {
            d->row[i].kind = d->row[i].kind == ZERO ? GONE : d->row[i].kind; /* says it twice */
        }
        return true;
    }
    exchange(d, r, c);
    if (!differentiate(d, r)) {
        *obstacle = "the second derivative of a source would be needed";
        return false;
    }
    ++*steps;
    return true;
}

static const char *reduce(struct dictionary *d, int *steps) {
    const char *obstacle = NULL;
    for (;;) {
        int r;
        int c;
        bool is_left = false;
        while (find_pivot(d, ZERO, ALGEBRAIC, &r, &c)) {
            exchange(d, r, c);
        }
        for (int i = 0; i < d->n_rows; i++) {
            is_left = is_left || d->row[i].kind == ZERO;
        }
        if (!is_left) {
            break;
        }
        if (!swap_pair(d) && !use_constraint(d, steps, &obstacle)) {
            return obstacle;
        }
    }
    for (int j = 0; j < d->n_columns; j++) {
        for (int i = 0; i < d->n_rows; i++) {
            bool counts = d->row[i].kind == DERIVATIVE || is_pair(d->row[i].kind);
            if (d->column[j].kind == ALGEBRAIC && counts && *dalcs_at(&d->a, i, j) != 0.0) {
                return "fewer equations than unknowns determine the diodes";
            }
        }
    }
    return NULL;
}

/* ---- Reading it off ------------------------------------------------------------------------- */

static double value_at(const struct dictionary *d, int i, int j) {
    return *dalcs_at(&d->a, i, j) / (d->row_scale[i] * d->column_scale[j]);
}

/* Column of x, u or s among those of the result: [0, n), [n, n + m), [n + m, ...); -1: none. */
static int place_of(const struct dalcs_lcs *lcs, const int *number, struct variable v) {
    switch (v.kind) {
    case STATE:
        return number[v.index];
    case CURRENT:
    case REVERSE:
        return lcs->n + v.index;
    case INPUT:
        return lcs->n + lcs->m + v.index;
    case INPUT_DERIVATIVE:
        return lcs->n + lcs->m + lcs->k + v.index;
    default:
        return -1;
    }
}

static void put(struct dalcs_lcs *lcs, struct variable row, const int *number, int column,
                double value) {
    struct dalcs_matrix *x = row.kind == DERIVATIVE ? &lcs->A : &lcs->C;
    struct dalcs_matrix *u = row.kind == DERIVATIVE ? &lcs->B : &lcs->D;
    struct dalcs_matrix *s = row.kind == DERIVATIVE ? &lcs->E : &lcs->F;
    int i = row.kind == DERIVATIVE ? number[row.index] : row.index;
    if (row.kind == STATE || row.kind == ALGEBRAIC) {
        if (column < lcs->n + lcs->m) {
            *dalcs_at(row.kind == STATE ? &lcs->full_x : &lcs->full_z, row.index, column) = value;
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
                                  const struct dictionary *d) {
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
        struct variable v = d->column[j];
        if (v.kind == STATE) {
            number[v.index] = lcs->n;
            lcs->state[lcs->n++] = v.index;
        } else if (is_pair(v.kind)) {
            lcs->is_swapped[v.index] = v.kind == REVERSE;
        } else if (v.kind == ALGEBRAIC) {
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
        for (int j = 0; d->row[i].kind != GONE && j < d->n_columns; j++) {
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
    struct dictionary d;
    DALCS_TRY(make(&d, arena, blocks));
    lcs->obstacle = reduce(&d, &lcs->index_steps);
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
