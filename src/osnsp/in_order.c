/* in_order.c - the systems of the blocks, and their answers put together. */
#include "in_order.h"

#include <stdlib.h>
#include <string.h>

/* One block: columns, rows and pairs ascend as they do in the whole system. */
struct dalcs_block {
    struct dalcs_system
        system; /* its inputs are those of the whole, then the columns that it reads */
    struct dalcs_osnsp osnsp;
    int *column; /* [n_columns] of the whole system */
    int *row;    /* [n_equations] */
    int *read;   /* [n_read] columns of the whole system */
    int n_read;
    double *u, *y;
};

struct dalcs_ordered_blocks {
    int n;
    struct dalcs_block *block;
};

/* What extracting a block needs to know of the whole. */
struct extraction {
    const struct dalcs_system *from;
    const int *block_of; /* [n_columns] */
    int number;
    struct dalcs_block *to;
    int *
        place; /* [n_columns] column of the block; of others the input by which they are read, -1: none yet */
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
                                   const struct dalcs_csr *E, int to,
                                   struct dalcs_triplets *columns, struct dalcs_triplets *inputs) {
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
        DALCS_TRY(split_row(e, e->to->row[r], &s->A, &s->E, r, &t[0], &t[1]));
    }
    for (int d = 0; d < to->n_pairs; d++) {
        DALCS_TRY(split_row(e, e->to->column[n_equations + d], &s->C, &s->F, d, &t[2], &t[3]));
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

static enum dalcs_status extract(struct extraction *e) {
    count(e);
    if (!has_rates_of_its_own(e)) {
        return DALCS_NOT_CONVERGED;
    }
    DALCS_TRY(allocate(e));
    copy_labels(e);
    struct dalcs_triplets t[5] = {0};
    enum dalcs_status status = split(e, t);
    for (int k = 0; k < 5; k++) {
        dalcs_triplets_finish(&t[k]);
    }
    return status;
}

static enum dalcs_status build_all(struct dalcs_osnsp *p, int *place) {
    for (int k = 0; k < p->blocks->n; k++) {
        struct dalcs_block *b = &p->blocks->block[k];
        struct extraction e = {.from = p->system,
                               .block_of = p->partition.block_of,
                               .number = k,
                               .to = b,
                               .place = place};
        b->system.monotone = p->partition.is_monotone[k];
        DALCS_TRY(extract(&e));
        DALCS_TRY(dalcs_osnsp_setup(&b->osnsp, &b->system, &p->options));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_in_order_build(struct dalcs_osnsp *p) {
    int n = p->partition.n_blocks;
    int *place = dalcs_alloc((size_t)dalcs_system_n_columns(p->system), sizeof(*place));
    enum dalcs_status status = DALCS_E_NOMEM;
    p->blocks = dalcs_alloc(1, sizeof(*p->blocks));
    if (p->blocks != NULL) {
        p->blocks->block = dalcs_alloc((size_t)n, sizeof(*p->blocks->block));
        p->blocks->n = p->blocks->block != NULL ? n : 0;
    }
    if (place != NULL && p->blocks != NULL && p->blocks->block != NULL) {
        status = build_all(p, place);
    }
    free(place);
    if (status != DALCS_OK) {
        dalcs_in_order_finish(p);
    }
    return status;
}

static void block_finish(struct dalcs_block *b) {
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

void dalcs_in_order_finish(struct dalcs_osnsp *p) {
    for (int k = 0; p->blocks != NULL && k < p->blocks->n; k++) {
        block_finish(&p->blocks->block[k]);
    }
    if (p->blocks != NULL) {
        free(p->blocks->block);
    }
    free(p->blocks);
    p->blocks = NULL;
}

bool dalcs_osnsp_acts_on_what_it_reads(const struct dalcs_osnsp *p, const char *element) {
    const struct dalcs_system *s = p->system;
    const int *block_of = p->partition.block_of;
    int n_equations = dalcs_system_n_equations(s);
    bool acts = false;
    for (int r = 0; block_of != NULL && r < s->reads.n_rows && !acts; r++) {
        int block = block_of[r < n_equations ? s->dual[r] : r];
        for (int k = s->reads.p[r]; k < s->reads.p[r + 1] && !acts; k++) {
            acts = !p->partition.is_monotone[block] && block_of[s->reads.j[k]] == block &&
                   strcmp(s->reader[k], element) == 0;
        }
    }
    return acts;
}

/* ---- Solving ------------------------------------------------------------------------------- */

/* The pair of the whole system that pair d of the block is. */
static int whole_pair(const struct dalcs_osnsp *p, const struct dalcs_block *b, int d) {
    return b->column[dalcs_system_n_equations(&b->system) + d] -
           dalcs_system_n_equations(p->system);
}

static void go_in(const struct dalcs_osnsp *p, struct dalcs_block *b, const double *u,
                  const double *y) {
    const struct dalcs_system *s = &b->system;
    const double *inputs = u + p->system->n_x;
    int n_inputs = p->system->n_inputs;
    for (int x = 0; x < s->n_x; x++) {
        b->u[x] = u[b->column[x]];
    }
    memcpy(b->u + s->n_x, inputs, (size_t)n_inputs * sizeof(double));
    for (int k = 0; k < b->n_read; k++) {
        b->u[s->n_x + n_inputs + k] = y[b->read[k]];
    }
    for (int d = 0; d < s->n_pairs; d++) {
        dalcs_osnsp_command(&b->osnsp, d, dalcs_osnsp_is_on(p, whole_pair(p, b, d)));
    }
    b->osnsp.refines = p->refines;
    b->osnsp.is_passing = p->is_passing;
}

static void come_back(struct dalcs_osnsp *p, const struct dalcs_block *b, double *y) {
    for (int c = 0; c < dalcs_system_n_columns(&b->system); c++) {
        y[b->column[c]] = b->y[c];
    }
    for (int d = 0; d < b->system.n_pairs; d++) {
        dalcs_osnsp_command(p, whole_pair(p, b, d), dalcs_osnsp_is_on(&b->osnsp, d));
    }
    p->least_norm = p->least_norm || b->osnsp.least_norm;
    bool is_unique = b->system.n_pairs == 0 || dalcs_osnsp_is_unique(&b->osnsp);
    p->form[0]->answers = is_unique ? p->form[0]->answers : DALCS_UNKNOWN;
}

/* What the block's counters grew by. */
static void add_counters(struct dalcs_osnsp *p, const struct dalcs_osnsp_counters *before,
                         const struct dalcs_osnsp_counters *now) {
    p->counters.pivots += now->pivots - before->pivots;
    p->counters.factorizations += now->factorizations - before->factorizations;
    p->counters.cache_hits += now->cache_hits - before->cache_hits;
    p->counters.singular += now->singular - before->singular;
}

static void take_witness(struct dalcs_osnsp *p, const struct dalcs_block *b) {
    const struct dalcs_witness *from = &b->osnsp.witness;
    dalcs_witness_copy(p, from);
    p->witness.has_ray =
        from->has_ray && b->n_read == 0; /* else what it reads does work along it, too */
    memset(p->witness.ray, 0, (size_t)dalcs_system_n_columns(p->system) * sizeof(double));
    for (int c = 0; c < dalcs_system_n_columns(&b->system); c++) {
        p->witness.ray[b->column[c]] = from->ray[c];
    }
}

static enum dalcs_status solve_all(struct dalcs_osnsp *p, double sigma, const double *u,
                                   double *y) {
    p->least_norm = false;
    p->form[0]->answers = dalcs_osnsp_is_monotone(p) ? DALCS_UNIQUE : DALCS_UNKNOWN;
    for (int k = 0; k < p->blocks->n; k++) {
        struct dalcs_block *b = &p->blocks->block[k];
        struct dalcs_osnsp_counters before = b->osnsp.counters;
        go_in(p, b, u, y);
        enum dalcs_status status = dalcs_osnsp_solve(&b->osnsp, sigma, b->u, b->y);
        add_counters(p, &before, &b->osnsp.counters);
        if (status == DALCS_INFEASIBLE) {
            take_witness(p, b);
        }
        if (status != DALCS_OK) {
            return status;
        }
        come_back(p, b, y);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_in_order_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                       double *y) {
    bool sources_clash;
    DALCS_TRY(solve_all(p, sigma, u, y));
    p->keeps_states = true; /* blocks may have solved for them, which condensing would undo */
    dalcs_certificate_evaluate(p, u, y, &sources_clash);
    p->keeps_states = false;
    return dalcs_certificate_holds(p, sources_clash) ? DALCS_OK : DALCS_NOT_CONVERGED;
}
