/* blocks.c - from compressed rows to dense blocks. */
#include "blocks.h"

#include <string.h>

static const char *pair_suffix(const struct dalcs_system *s, int pair) {
    return s->pair[pair].is_breakdown ? " breakdown" : "";
}

/* A system that was given by its matrices may call its unknowns "v(out)" already. */
static bool is_whole_name(const char *element) {
    return strchr(element, '(') != NULL;
}

const char *dalcs_column_name(const struct dalcs_system *s, int column, struct dalcs_arena *arena) {
    int n = dalcs_system_n_equations(s);
    const char *element = column < n ? s->column[column].element : s->pair[column - n].element;
    if (element == NULL) {
        return dalcs_arena_printf(arena, "unknown %d", column + 1);
    }
    if (is_whole_name(element)) {
        return element;
    }
    const char *suffix = column < n ? "" : pair_suffix(s, column - n);
    if (column < n && s->column[column].kind == DALCS_LABEL_REFERENCE) {
        suffix = " reference";
    }
    return dalcs_arena_printf(arena, "%s(%s%s)", s->column_is_current[column] ? "i" : "v", element,
                              suffix);
}

const char *dalcs_reverse_name(const struct dalcs_system *s, int pair, struct dalcs_arena *arena) {
    const char *element = s->pair[pair].element;
    if (element == NULL) {
        return dalcs_arena_printf(arena, "w %d", pair + 1);
    }
    bool is_voltage = s->column_is_current[dalcs_system_n_equations(s) + pair];
    return is_whole_name(element) ? dalcs_arena_printf(arena, "w of %s", element)
                                  : dalcs_arena_printf(arena, is_voltage ? "-v(%s%s)" : "i(%s%s)",
                                                       element, pair_suffix(s, pair));
}

const char *dalcs_input_name(const struct dalcs_system *s, int input) {
    return s->input_element[input] == NULL ? "1" : s->input_element[input];
}

/* Where the rows and columns of the system go: place[] or -1. */
struct places {
    int *row;       /* [equations + pairs] in I (0..n-1), in II (n..n+p-1) or in W (n+p..) */
    int *column;    /* [columns] likewise x, z, lambda */
    bool *is_taken; /* [p] work */
};

static void place_columns(struct dalcs_blocks *b, struct places *at) {
    const struct dalcs_system *s = b->system;
    int n = dalcs_system_n_equations(s);
    for (int c = 0; c < s->n_x; c++) {
        at->column[c] = c;
    }
    int p = 0;
    for (int c = s->n_x; c < n; c++) {
        b->z_column[p] = c;
        at->column[c] = b->n + p++;
    }
    int m = 0;
    for (int i = 0; i < s->n_pairs; i++) {
        at->column[n + i] = -1;
        if (b->hold[i] == DALCS_HELD_CLOSED) {
            b->z_column[p] = n + i;
            at->column[n + i] = b->n + p++;
        } else if (b->hold[i] == DALCS_NOT_HELD) {
            b->pair[m] = i;
            at->column[n + i] = b->n + b->p + m++;
        }
    }
}

/* Rows II in the order of their dual columns. One whose dual is a state takes a place that is left:
 * the alias of a capacitor that of a node voltage whose KCL is in I. */
static void place_rows(struct dalcs_blocks *b, struct places *at) {
    const struct dalcs_system *s = b->system;
    int n = dalcs_system_n_equations(s);
    for (int r = 0; r < s->n_x; r++) {
        at->row[r] = r;
    }
    for (int r = s->n_x; r < n; r++) {
        at->row[r] = -1;
        int place = s->dual[r] - s->n_x;
        if (place >= 0 && place < s->n_z && !at->is_taken[place]) {
            at->row[r] = b->n + place;
            at->is_taken[place] = true;
        }
    }
    int next = 0;
    for (int r = s->n_x; r < n; r++) {
        while (next < s->n_z && at->is_taken[next]) {
            next++;
        }
        if (at->row[r] < 0) {
            at->row[r] = b->n + next;
            at->is_taken[next] = true;
        }
    }
    for (int i = 0; i < s->n_pairs; i++) {
        int place = at->column[n + i];
        at->row[n + i] = place;
    }
}

static enum dalcs_status allocate(struct dalcs_blocks *b, struct dalcs_arena *arena) {
    const struct {
        struct dalcs_matrix *matrix;
        int rows, columns;
    } block[] = {{&b->P, b->n, b->n},    {&b->A_I, b->n, b->n},    {&b->B_I, b->n, b->p},
                 {&b->L_I, b->n, b->m},  {&b->A_II, b->p, b->n},   {&b->B_II, b->p, b->p},
                 {&b->L_II, b->p, b->m}, {&b->C_I, b->m, b->n},    {&b->C_II, b->m, b->p},
                 {&b->D, b->m, b->m},    {&b->E_I, b->n, b->k},    {&b->E_II, b->p, b->k},
                 {&b->F, b->m, b->k},    {&b->storage, b->n, b->n}};

    for (size_t i = 0; i < sizeof block / sizeof block[0]; i++) {
        DALCS_TRY(dalcs_matrix_new(block[i].matrix, arena, block[i].rows, block[i].columns));
    }
    return DALCS_OK;
}

/* The block and the place in it of an element at (row, column), both counted over I, II, W. */
static double *element(struct dalcs_blocks *b, int row, int column) {
    struct dalcs_matrix *block[3][3] = {
        {&b->A_I, &b->B_I, &b->L_I}, {&b->A_II, &b->B_II, &b->L_II}, {&b->C_I, &b->C_II, &b->D}};
    const int start[4] = {0, b->n, b->n + b->p, b->n + b->p + b->m};
    int i = row < start[1] ? 0 : row < start[2] ? 1 : 2;
    int j = column < start[1] ? 0 : column < start[2] ? 1 : 2;
    return dalcs_at(block[i][j], row - start[i], column - start[j]);
}

static void scatter(struct dalcs_blocks *b, const struct places *at, const struct dalcs_csr *rows,
                    int first) {
    for (int r = 0; r < rows->n_rows; r++) {
        for (int q = rows->p[r]; q < rows->p[r + 1]; q++) {
            int column = at->column[rows->j[q]];
            if (at->row[first + r] >= 0 && column >= 0) {
                *element(b, at->row[first + r], column) = rows->x[q];
            }
        }
    }
}

static void scatter_inputs(struct dalcs_blocks *b, const struct places *at,
                           const struct dalcs_csr *rows, int first) {
    struct dalcs_matrix *block[3] = {&b->E_I, &b->E_II, &b->F};
    const int start[3] = {0, b->n, b->n + b->p};
    for (int r = 0; r < rows->n_rows; r++) {
        int row = at->row[first + r];
        int i = row < start[1] ? 0 : row < start[2] ? 1 : 2;
        for (int q = rows->p[r]; row >= 0 && q < rows->p[r + 1]; q++) {
            *dalcs_at(block[i], row - start[i], rows->j[q]) = rows->x[q];
        }
    }
}

enum dalcs_status dalcs_blocks_build(struct dalcs_blocks *b, struct dalcs_arena *arena,
                                     const struct dalcs_system *s, const enum dalcs_hold *hold) {
    int n = dalcs_system_n_equations(s);
    *b = (struct dalcs_blocks){
        .system = s, .hold = hold, .n = s->n_x, .p = s->n_z, .k = s->n_inputs};
    for (int i = 0; i < s->n_pairs; i++) {
        b->p += hold[i] == DALCS_HELD_CLOSED ? 1 : 0;
        b->m += hold[i] == DALCS_NOT_HELD ? 1 : 0;
    }
    struct places at = {
        dalcs_arena_alloc(arena, (size_t)(n + s->n_pairs) + 1, sizeof(int)),
        dalcs_arena_alloc(arena, (size_t)(n + s->n_pairs) + 1, sizeof(int)),
        dalcs_arena_alloc(arena, (size_t)b->p + 1, sizeof(bool)),
    };
    b->z_column = dalcs_arena_alloc(arena, (size_t)b->p + 1, sizeof(int));
    b->pair = dalcs_arena_alloc(arena, (size_t)b->m + 1, sizeof(int));
    if (at.row == NULL || at.column == NULL || at.is_taken == NULL || b->z_column == NULL ||
        b->pair == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(allocate(b, arena));
    place_columns(b, &at);
    place_rows(b, &at);
    scatter(b, &at, &s->A, 0);
    scatter(b, &at, &s->C, n);
    scatter_inputs(b, &at, &s->E, 0);
    scatter_inputs(b, &at, &s->F, n);
    for (int r = 0; r < b->n; r++) {
        for (int q = s->P.p[r]; q < s->P.p[r + 1]; q++) {
            *dalcs_at(&b->P, r, s->P.j[q]) = s->P.x[q];
        }
        for (int q = s->storage.p[r]; q < s->storage.p[r + 1]; q++) {
            *dalcs_at(&b->storage, r, s->storage.j[q]) = s->storage.x[q];
        }
    }
    return DALCS_OK;
}
