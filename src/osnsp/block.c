/* block.c - the rows and columns of one block of a system, as a system that reads the blocks before it. */
#include "block.h"

#include <stdlib.h>
#include <string.h>

/* What the extraction of a block needs of the whole system. place: of a column of the block its number there, of another one
 * the input by which it is read, -1: none yet. */
struct extraction {
    const struct dalcs_system *from;
    const int *block_of; /* [n_columns] */
    int number;
    struct dalcs_block *to;
    int *place; /* [n_columns] */
};

static int row_block(const struct extraction *e, int row) {
    return e->block_of[e->from->dual[row]];
}

/* Counts what the block has, and gives each of its columns a place. */
static void count(struct extraction *e) {
    const struct dalcs_system *s = e->from;
    struct dalcs_system *to = &e->to->system;
    int n_equations = dalcs_system_n_equations(s);
    int n = 0;
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        bool is_in = e->block_of[c] == e->number;
        e->place[c] = is_in ? n++ : -1;
        to->n_x += is_in && c < s->n_x ? 1 : 0;
        to->n_z += is_in && c >= s->n_x && c < n_equations ? 1 : 0;
        to->n_pairs += is_in && c >= n_equations ? 1 : 0;
    }
}

/* The rows with derivatives come first, as many as states: else the block is no system. */
static bool has_rates_of_its_own(const struct extraction *e) {
    int n_rates = 0;
    for (int r = 0; r < e->from->n_x; r++) {
        bool is_in = row_block(e, r) == e->number;
        n_rates += is_in ? 1 : 0;
        for (int k = is_in ? e->from->P.p[r] : 0; is_in && k < e->from->P.p[r + 1]; k++) {
            if (e->block_of[e->from->P.j[k]] != e->number) {
                return false;
            }
        }
    }
    return n_rates == e->to->system.n_x;
}

static enum dalcs_status allocate(struct extraction *e) {
    const struct dalcs_system *s = e->from;
    struct dalcs_block *b = e->to;
    struct dalcs_system *to = &b->system;
    size_t n_equations = (size_t)dalcs_system_n_equations(to);
    size_t n_columns = (size_t)dalcs_system_n_columns(to);
    size_t n_inputs = (size_t)(s->n_inputs + dalcs_system_n_columns(s));
    b->column = dalcs_alloc(n_columns, sizeof(int));
    b->row = dalcs_alloc(n_equations, sizeof(int));
    b->read = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(int));
    b->u = dalcs_alloc((size_t)to->n_x + n_inputs, sizeof(double));
    b->y = dalcs_alloc(n_columns, sizeof(double));
    to->dual = dalcs_alloc(n_equations, sizeof(int));
    to->forest_root = dalcs_alloc(n_equations, sizeof(int));
    to->column_is_current = dalcs_alloc(n_columns, sizeof(bool));
    to->row_is_current = dalcs_alloc(n_equations, sizeof(bool));
    to->row = dalcs_alloc(n_equations, sizeof(*to->row));
    to->column = dalcs_alloc(n_equations, sizeof(*to->column));
    to->pair = dalcs_alloc((size_t)to->n_pairs, sizeof(*to->pair));
    to->stimulus = dalcs_alloc(n_inputs, sizeof(int));
    to->input_element = dalcs_alloc(n_inputs, sizeof(*to->input_element));
    bool complete = b->column != NULL && b->row != NULL && b->read != NULL && b->u != NULL &&
                    b->y != NULL && to->dual != NULL && to->forest_root != NULL &&
                    to->column_is_current != NULL && to->row_is_current != NULL &&
                    to->row != NULL && to->column != NULL && to->pair != NULL &&
                    to->stimulus != NULL && to->input_element != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static void copy_labels(struct extraction *e) {
    const struct dalcs_system *s = e->from;
    struct dalcs_system *to = &e->to->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int at = e->place[c];
        if (at < 0) {
            continue;
        }
        e->to->column[at] = c;
        to->column_is_current[at] = s->column_is_current[c];
        if (c >= n_equations) {
            to->pair[at - to->n_x - to->n_z] = s->pair[c - n_equations];
            continue;
        }
        int root = s->forest_root[c];
        to->column[at] = s->column[c];
        to->forest_root[at] = e->block_of[root] == e->number ? e->place[root] : at;
    }
    int n = 0;
    for (int r = 0; r < n_equations; r++) {
        if (row_block(e, r) == e->number) {
            e->to->row[n] = r;
            to->dual[n] = e->place[s->dual[r]];
            to->row_is_current[n] = s->row_is_current[r];
            to->row[n++] = s->row[r];
        }
    }
    to->n_inputs = s->n_inputs;
    memcpy(to->stimulus, s->stimulus, (size_t)s->n_inputs * sizeof(int));
    memcpy(to->input_element, s->input_element, (size_t)s->n_inputs * sizeof(*s->input_element));
}

/* Whose a column of an earlier block is to one that has it in this row: of what reads it, else its own. */
static const char *name_of(const struct dalcs_system *s, int row, int column) {
    for (int k = s->reads.p[row]; k < s->reads.p[row + 1]; k++) {
        if (s->reads.j[k] == column) {
            return s->reader[k];
        }
    }
    int pair = column - dalcs_system_n_equations(s);
    return pair >= 0 ? s->pair[pair].element : s->column[column].element;
}

/* The input by which row `row` of the whole, equations before pairs, reads a column of an earlier block. */
static int input_of(struct extraction *e, int row, int column) {
    struct dalcs_system *to = &e->to->system;
    int *place = &e->place[column];
    if (*place < 0) {
        *place = to->n_inputs++;
        to->stimulus[*place] = -1;
        to->input_element[*place] = name_of(e->from, row, column);
        e->to->read[e->to->n_read++] = column;
    }
    return *place;
}

/* Row `row` of the whole, row `from` of (A, E) or (C, F): what is in the block to `columns`, the rest to `inputs`. */
static enum dalcs_status split_row(struct extraction *e, int row, const struct dalcs_csr *A,
                                   const struct dalcs_csr *E, int to, struct dalcs_triplets *t) {
    struct dalcs_triplets *columns = &t[0];
    struct dalcs_triplets *inputs = &t[1];
    int n_equations = dalcs_system_n_equations(e->from);
    int from = row < n_equations ? row : row - n_equations;
    for (int k = A->p[from]; k < A->p[from + 1]; k++) {
        int c = A->j[k];
        bool is_in = e->block_of[c] == e->number;
        DALCS_TRY(dalcs_triplets_add(is_in ? columns : inputs, to,
                                     is_in ? e->place[c] : input_of(e, row, c), A->x[k]));
    }
    for (int k = E->p[from]; k < E->p[from + 1]; k++) {
        DALCS_TRY(dalcs_triplets_add(inputs, to, E->j[k], E->x[k]));
    }
    return DALCS_OK;
}

static enum dalcs_status split(struct extraction *e, struct dalcs_triplets t[5]) {
    const struct dalcs_system *s = e->from;
    struct dalcs_system *to = &e->to->system;
    int n_equations = dalcs_system_n_equations(to);
    for (int r = 0; r < n_equations; r++) {
        DALCS_TRY(split_row(e, e->to->row[r], &s->A, &s->E, r, &t[0]));
    }
    for (int d = 0; d < to->n_pairs; d++) {
        DALCS_TRY(split_row(e, e->to->column[n_equations + d], &s->C, &s->F, d, &t[2]));
    }
    for (int r = 0; r < to->n_x; r++) {
        int from = e->to->row[r];
        for (int k = s->P.p[from]; k < s->P.p[from + 1]; k++) {
            DALCS_TRY(dalcs_triplets_add(&t[4], r, e->place[s->P.j[k]], s->P.x[k]));
        }
    }
    int n_columns = dalcs_system_n_columns(to);
    DALCS_TRY(dalcs_csr_compress(&to->A, n_equations, n_columns, &t[0]));
    DALCS_TRY(dalcs_csr_compress(&to->E, n_equations, to->n_inputs, &t[1]));
    DALCS_TRY(dalcs_csr_compress(&to->C, to->n_pairs, n_columns, &t[2]));
    DALCS_TRY(dalcs_csr_compress(&to->F, to->n_pairs, to->n_inputs, &t[3]));
    return dalcs_csr_compress(&to->P, to->n_x, to->n_x, &t[4]);
}

enum dalcs_status dalcs_block_extract(struct dalcs_block *block, const struct dalcs_system *from,
                                      const int *block_of, int number, int *place) {
    struct extraction e = {
        .from = from, .block_of = block_of, .number = number, .to = block, .place = place};
    count(&e);
    if (!has_rates_of_its_own(&e)) {
        return DALCS_NOT_CONVERGED;
    }
    DALCS_TRY(allocate(&e));
    copy_labels(&e);
    struct dalcs_triplets t[5] = {0};
    enum dalcs_status status = split(&e, t);
    for (int k = 0; k < 5; k++) {
        dalcs_triplets_finish(&t[k]);
    }
    return status;
}

void dalcs_block_finish(struct dalcs_block *b) {
    if (b->osnsp.system != NULL) {
        dalcs_osnsp_finish(&b->osnsp);
    }
    dalcs_system_finish(&b->system);
    free(b->column);
    free(b->row);
    free(b->read);
    free(b->u);
    free(b->y);
}
