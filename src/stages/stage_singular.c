/* stage_singular.c - which equations of a mode follow from others, and what is chosen instead.
 *
 * Equations that follow are found among those without derivatives, in all columns; what is open among
 * the columns without memory, in all rows (dalcs_null_space). Least norm is that of least_norm.h, for
 * the diodes, then the switches, then all unknowns. In each, those count that are open
 * first: what later blocks read of them (partition.h) follows. */
#include "stage_singular.h"

#include "magnitudes.h"
#include "null_space.h"
#include "partition.h"
#include "rounding.h"
#include "stages_internal.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* What a solution that is 0 on every right-hand side has in pairs of one kind. */
struct trace {
    int n;
    int *pair;
    double *value;
};

struct search {
    const struct dalcs_stage_plan *plan;
    const struct dalcs_system *system;
    const struct dalcs_stage_entry *entry;
    struct dalcs_arena arena;
    int *closed;         /* [n_pairs] which of entry->on a closed pair is */
    int n_columns;       /* without memory: z, then lambda of closed pairs */
    bool within_blocks;  /* of rows, what they read of other blocks does not count */
    int n_open;          /* solutions */
    double *vector;      /* [n_open][n_columns] */
    struct trace *trace; /* [n_open] */
    double *of_pair;     /* [n_pairs] work */
    struct dalcs_triplets choice, of_column, shore;
};

/* The place of column c of M among those from `first` on, which closed pairs follow closely; -1: none. */
static int place_of(const struct search *s, int c, int first) {
    int pair = c - dalcs_system_n_equations(s->system);
    if (c < first || (pair >= 0 && !dalcs_stage_is_on(s->entry, pair))) {
        return -1;
    }
    return pair < 0 ? c - first : c - pair - first + s->closed[pair];
}

/* Adds row `from` of a, its columns from `first` on. Of columns: what a block reads of others is given there, it leaves
 * nothing open (stage_choice.h). */
static enum dalcs_status add_row(const struct search *s, const struct dalcs_csr *a, int from,
                                 int first, int row, struct dalcs_triplets *t) {
    const int *block = s->plan->stages->block_of;
    int own = from < dalcs_system_n_equations(s->system) ? s->system->dual[from] : from;
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int column = place_of(s, a->j[k], first);
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
static enum dalcs_status find_null_space(const struct search *s, int first_row, int first_column,
                                         struct dalcs_null_space *space) {
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

/* w of an open pair, or lambda of a closed one, in a solution without states. */
static double other_side(const struct search *s, int pair, const double *vector) {
    const struct dalcs_csr *C = &s->system->C;
    int n_x = s->system->n_x;
    if (dalcs_stage_is_on(s->entry, pair)) {
        return vector[place_of(s, dalcs_system_n_equations(s->system) + pair, n_x)];
    }
    double sum = 0.0;
    double size = 0.0;
    for (int k = C->p[pair]; k < C->p[pair + 1]; k++) {
        int at = place_of(s, C->j[k], n_x);
        double term = at >= 0 ? C->x[k] * vector[at] : 0.0;
        sum += term;
        size += fabs(term);
    }
    return fabs(sum) > dalcs_sum_rounded * size ? sum : 0.0;
}

static enum dalcs_status keep_trace(struct search *s, struct trace *trace) {
    int n_pairs = s->system->n_pairs;
    int n = 0;
    for (int d = 0; d < n_pairs; d++) {
        n += s->of_pair[d] != 0.0;
    }
    trace->pair = dalcs_arena_alloc(&s->arena, (size_t)n, sizeof(int));
    trace->value = dalcs_arena_alloc(&s->arena, (size_t)n, sizeof(double));
    if (trace->pair == NULL || trace->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < n_pairs; d++) {
        if (s->of_pair[d] != 0.0) {
            trace->pair[trace->n] = d;
            trace->value[trace->n++] = s->of_pair[d];
        }
    }
    return DALCS_OK;
}

static double norm_of(const double *v, int n) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        sum += v[k] * v[k];
    }
    return sqrt(sum);
}

static double product(const struct trace *trace, const double *of_pair) {
    double sum = 0.0;
    for (int k = 0; k < trace->n; k++) {
        sum += trace->value[k] * of_pair[trace->pair[k]];
    }
    return sum;
}

/* The block of a column that has no memory. */
static int block_of(const struct search *s, int column) {
    const int *block = s->plan->stages->block_of;
    int n_z = s->system->n_z;
    if (block == NULL) {
        return 0;
    }
    int n_equations = dalcs_system_n_equations(s->system);
    return block[column < n_z ? s->system->n_x + column : n_equations + s->entry->on[column - n_z]];
}

/* Of solution k, what pairs of one kind have; orthogonal to what those before have (Gram and Schmidt, twice). Empty where
 * it vanishes. */
static enum dalcs_status find_trace(struct search *s, enum dalcs_pair_kind kind, int k) {
    int n_pairs = s->system->n_pairs;
    double *vector = s->vector + k * s->n_columns;
    for (int d = 0; d < n_pairs; d++) {
        bool counts = !s->system->pair[d].is_left_out[dalcs_stage_is_on(s->entry, d)];
        s->of_pair[d] = counts ? other_side(s, d, vector) : 0.0;
    }
    dalcs_partition_keep_first(s->plan->stages->block_of, s->system, kind, s->of_pair);
    double before = norm_of(s->of_pair, n_pairs);
    for (int i = 0; i < 2 * k; i++) {
        const struct trace *other = &s->trace[i % k];
        double share = product(other, s->of_pair);
        for (int e = 0; share != 0.0 && e < other->n; e++) {
            s->of_pair[other->pair[e]] -= share * other->value[e];
        }
        for (int c = 0; share != 0.0 && c < s->n_columns; c++) {
            vector[c] -= share * s->vector[i % k * s->n_columns + c];
        }
    }
    double norm = norm_of(s->of_pair, n_pairs);
    if (!(norm > dalcs_alike * before)) {
        return DALCS_OK; /* what rounding left of it */
    }
    for (int d = 0; d < n_pairs; d++) {
        s->of_pair[d] = fabs(s->of_pair[d]) > dalcs_alike * norm ? s->of_pair[d] / norm : 0.0;
    }
    for (int c = 0; c < s->n_columns; c++) {
        vector[c] /= norm;
    }
    return keep_trace(s, &s->trace[k]);
}

/* What no diode sees of the solutions comes after what diodes see: a trace of one kind is 0 in the other, so that those of
 * both are orthogonal. */
static enum dalcs_status find_traces(struct search *s) {
    for (int k = 0; k < s->n_open; k++) {
        DALCS_TRY(find_trace(s, DALCS_PAIR_DIODE, k));
        if (s->trace[k].n == 0) {
            DALCS_TRY(find_trace(s, DALCS_PAIR_SWITCH, k));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status put(struct search *s, int k, int column, double value) {
    DALCS_TRY(dalcs_triplets_add(&s->choice, k, column, value));
    return dalcs_triplets_add(&s->of_column, column, k, value);
}

/* The choice that is orthogonal to solution k in its pairs. */
static enum dalcs_status choose_in_pairs(struct search *s, int k) {
    const struct dalcs_csr *C = &s->system->C;
    const struct trace *trace = &s->trace[k];
    int n_equations = dalcs_system_n_equations(s->system);
    for (int e = 0; e < trace->n; e++) {
        int d = trace->pair[e];
        if (dalcs_stage_is_on(s->entry, d)) {
            DALCS_TRY(put(s, k, n_equations + d, trace->value[e]));
            continue;
        }
        DALCS_TRY(dalcs_triplets_add(&s->shore, k, d, trace->value[e]));
        for (int i = C->p[d]; i < C->p[d + 1]; i++) {
            int c = C->j[i];
            if (c < n_equations || dalcs_stage_is_on(s->entry, c - n_equations)) {
                DALCS_TRY(put(s, k, c, trace->value[e] * C->x[i]));
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status choose_in_all(struct search *s, int k) {
    int n_z = s->system->n_z;
    int n_equations = dalcs_system_n_equations(s->system);
    const double *vector = s->vector + k * s->n_columns;
    int first = INT_MAX;
    for (int c = 0; c < s->n_columns; c++) {
        first = vector[c] != 0.0 && block_of(s, c) < first ? block_of(s, c) : first;
    }
    for (int c = 0; c < s->n_columns; c++) {
        int column = c < n_z ? s->system->n_x + c : n_equations + s->entry->on[c - n_z];
        double value = vector[c];
        if (value != 0.0 && block_of(s, c) == first) {
            DALCS_TRY(put(s, k, column, value));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status list_redundant(struct dalcs_stage_singular *g, const struct search *s,
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

static enum dalcs_status fill(struct dalcs_stage_singular *g, struct search *s,
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
    s->trace = dalcs_arena_alloc(&s->arena, n, sizeof(*s->trace));
    s->of_pair = dalcs_arena_alloc(&s->arena, (size_t)s->system->n_pairs, sizeof(double));
    if (s->vector == NULL || s->trace == NULL || s->of_pair == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < g->n; k++) {
        dalcs_null_space_vector(columns, k, s->vector + k * s->n_columns);
    }
    DALCS_TRY(find_traces(s));
    for (int k = 0; k < g->n; k++) {
        DALCS_TRY(s->trace[k].n > 0 ? choose_in_pairs(s, k) : choose_in_all(s, k));
    }
    int n_rows = dalcs_system_n_columns(s->system);
    DALCS_TRY(dalcs_csr_compress(&g->choice, g->n, n_rows, &s->choice));
    DALCS_TRY(dalcs_csr_compress(&g->of_column, n_rows, g->n, &s->of_column));
    return dalcs_csr_compress(&g->shore, g->n, s->system->n_pairs, &s->shore);
}

/* Rows that follow from others; where these are too few, from others of their blocks (stage_choice.c). */
static enum dalcs_status find_rows(struct search *s, int n_wanted, struct dalcs_null_space *rows) {
    DALCS_TRY(find_null_space(s, s->system->n_x, 0, rows));
    if (rows->n_redundant >= n_wanted) {
        return DALCS_OK;
    }
    dalcs_null_space_finish(rows);
    s->within_blocks = true;
    return find_null_space(s, s->system->n_x, 0, rows);
}

static enum dalcs_status find(struct dalcs_stage_singular *g, struct search *s) {
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
    struct search s = {
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
