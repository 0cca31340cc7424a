/* stage_singular.c - which equations of a mode follow from others, and what is chosen instead.
 *
 * Equations that follow are found among those without derivatives, in all columns; what is open among
 * the columns without memory, in all rows (dalcs_null_space). stage_traces.c chooses. */
#include "stage_singular.h"

#include "null_space.h"
#include "stage_search.h"
#include "stages_internal.h"

#include <math.h>
#include <stdlib.h>

/* Adds row `from` of a, its columns from `first` on. Of columns: what a block reads of others is given there, it leaves
 * nothing open (stage_choice.h). */
static enum dalcs_status add_row(const struct dalcs_stage_search *s, const struct dalcs_csr *a,
                                 int from, int first, int row, struct dalcs_triplets *t) {
    const int *block = s->plan->stages->block_of;
    int own = from < dalcs_system_n_equations(s->system) ? s->system->dual[from] : from;
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int column = dalcs_stage_search_place(s, a->j[k], first);
        bool is_read = first == 0 && !s->within_blocks;
        bool is_own = block == NULL || is_read || block[own] == block[a->j[k]];
        if (column >= 0 && is_own) {
            DALCS_TRY(dalcs_triplets_add(t, row, column, a->x[k]));
        }
    }
    return DALCS_OK;
}

/* The null space of the equations from `first_row` on and the closed pairs, in the columns from
 * first_column on. */
static enum dalcs_status find_null_space(const struct dalcs_stage_search *s, int first_row,
                                         int first_column, struct dalcs_null_space *space) {
    const struct dalcs_system *of = s->system;
    const struct dalcs_csr *drive = &s->plan->drive;
    int n_equations = dalcs_system_n_equations(of);
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int r = first_row; status == DALCS_OK && r < n_equations; r++) {
        status = add_row(s, drive, r, first_column, r - first_row, &t);
    }
    for (int k = 0; status == DALCS_OK && k < s->entry->n_on; k++) {
        status = add_row(s, drive, n_equations + s->entry->on[k], first_column,
                         n_equations - first_row + k, &t);
    }
    if (status == DALCS_OK) {
        status = dalcs_null_space_find(space, n_equations - first_row + s->entry->n_on,
                                       n_equations - first_column + s->entry->n_on, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

static enum dalcs_status list_redundant(struct dalcs_stage_singular *g,
                                        const struct dalcs_stage_search *s,
                                        const struct dalcs_null_space *rows) {
    int n_z = s->system->n_z;
    g->n = rows->n_redundant;
    g->row = dalcs_alloc((size_t)g->n, sizeof(int));
    g->scale = dalcs_alloc((size_t)g->n, sizeof(double));
    if (g->row == NULL || g->scale == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < g->n; k++) {
        int r = rows->redundant[k];
        g->row[k] = s->system->n_x + (r < n_z ? r : n_z + s->entry->on[r - n_z]);
    }
    return DALCS_OK;
}

static enum dalcs_status fill(struct dalcs_stage_singular *g, struct dalcs_stage_search *s,
                              const struct dalcs_null_space *rows,
                              const struct dalcs_null_space *columns) {
    if (rows->n_redundant != columns->n_free) {
        return DALCS_SINGULAR;
    }
    if (rows->n_redundant == 0) {
        return DALCS_OK;
    }
    DALCS_TRY(list_redundant(g, s, rows));
    size_t n = (size_t)g->n;
    s->n_open = g->n;
    s->vector = dalcs_arena_alloc(&s->arena, n * (size_t)s->n_columns, sizeof(double));
    s->error = dalcs_arena_alloc(&s->arena, (size_t)s->n_columns, sizeof(double));
    s->trace = dalcs_arena_alloc(&s->arena, n, sizeof(*s->trace));
    s->of_pair = dalcs_arena_alloc(&s->arena, (size_t)s->system->n_pairs, sizeof(double));
    if (s->vector == NULL || s->error == NULL || s->trace == NULL || s->of_pair == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < g->n; k++) {
        dalcs_null_space_vector(columns, k, s->vector + k * s->n_columns);
        for (int c = 0; c < s->n_columns; c++) {
            s->error[c] = fmax(s->error[c], columns->error[c]);
        }
    }
    DALCS_TRY(dalcs_stage_traces_find(s));
    for (int k = 0; k < g->n; k++) {
        DALCS_TRY(dalcs_stage_traces_choose(s, k));
    }
    int n_rows = dalcs_system_n_columns(s->system);
    DALCS_TRY(dalcs_csr_compress(&g->choice, g->n, n_rows, &s->choice));
    DALCS_TRY(dalcs_csr_compress(&g->of_column, n_rows, g->n, &s->of_column));
    return dalcs_csr_compress(&g->shore, g->n, s->system->n_pairs, &s->shore);
}

/* Rows that follow from others; where these are too few, from others of their blocks (stage_choice.c). */
static enum dalcs_status find_rows(struct dalcs_stage_search *s, int n_wanted,
                                   struct dalcs_null_space *rows) {
    DALCS_TRY(find_null_space(s, s->system->n_x, 0, rows));
    if (rows->n_redundant >= n_wanted) {
        return DALCS_OK;
    }
    dalcs_null_space_finish(rows);
    s->within_blocks = true;
    return find_null_space(s, s->system->n_x, 0, rows);
}

static enum dalcs_status find(struct dalcs_stage_singular *g, struct dalcs_stage_search *s) {
    s->closed = dalcs_arena_alloc(&s->arena, (size_t)s->system->n_pairs, sizeof(int));
    if (s->closed == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < s->entry->n_on; k++) {
        s->closed[s->entry->on[k]] = k;
    }
    struct dalcs_null_space rows;
    struct dalcs_null_space columns;
    DALCS_TRY(find_null_space(s, 0, s->system->n_x, &columns));
    enum dalcs_status status = find_rows(s, columns.n_free, &rows);
    if (status == DALCS_OK) {
        status = fill(g, s, &rows, &columns);
        g->within_blocks = s->within_blocks;
        dalcs_null_space_finish(&rows);
    }
    dalcs_null_space_finish(&columns);
    return status;
}

enum dalcs_status dalcs_stage_singular_find(struct dalcs_stage_singular *g,
                                            const struct dalcs_stage_plan *plan,
                                            const struct dalcs_stage_entry *entry) {
    const struct dalcs_system *system = plan->stages->system;
    struct dalcs_stage_search s = {
        .plan = plan, .system = system, .entry = entry, .n_columns = system->n_z + entry->n_on};
    *g = (struct dalcs_stage_singular){0};
    enum dalcs_status status = find(g, &s);
    dalcs_triplets_finish(&s.choice);
    dalcs_triplets_finish(&s.of_column);
    dalcs_triplets_finish(&s.shore);
    dalcs_arena_finish(&s.arena);
    if (status != DALCS_OK) {
        dalcs_stage_singular_finish(g);
    }
    return status;
}

void dalcs_stage_singular_finish(struct dalcs_stage_singular *g) {
    free(g->row);
    free(g->scale);
    dalcs_csr_finish(&g->choice);
    dalcs_csr_finish(&g->of_column);
    dalcs_csr_finish(&g->shore);
    *g = (struct dalcs_stage_singular){0};
}

size_t dalcs_stage_singular_bytes(const struct dalcs_stage_singular *g) {
    if (g->n == 0) {
        return 0;
    }
    const struct dalcs_csr *part[] = {&g->choice, &g->of_column, &g->shore};
    size_t bytes = (size_t)g->n * (sizeof(int) + sizeof(double));
    for (int k = 0; k < 3; k++) {
        size_t n_rows = (size_t)part[k]->n_rows;
        bytes += (n_rows + 1) * sizeof(int) +
                 (size_t)part[k]->p[n_rows] * (sizeof(int) + sizeof(double));
    }
    return bytes;
}
