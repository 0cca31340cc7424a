/* stage_map.c - a step of a small system in one mode as one dense matrix: its columns are combinations
 * of the few solutions that the workshop has for unit states and unit inputs. */
#include "dense_map.h"
#include "extremes.h"
#include "stage_column.h"
#include "stage_shift.h"

#include <math.h>
#include <string.h>

static int n_columns(const struct dalcs_stage_workshop *b) {
    return b->has_constants ? b->stages->n_in : b->stages->n_in - 1;
}

static void fill_map(struct dalcs_stage_workshop *b, const struct dalcs_stage_function *function) {
    const struct dalcs_excitation *e = b->stages->excitation;
    const struct dalcs_collocation *m = b->stages->method;
    static const struct dalcs_extended_row one = {
        .high = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0}};
    double share[DALCS_LANES] = {0.0};
    const struct dalcs_stage_drive constant = {share, &one, m->exact.to};
    struct dalcs_map_column to = {b->entry->map, b->entry->maps.current};
    memset(b->column.lanes, 0, (size_t)(b->n * DALCS_LANES) * sizeof(double));
    for (int x = 0; x < b->n_x; x++) {
        dalcs_stage_column_fill(b, x, x, &constant, &to);
        dalcs_stage_column_check(b, x, x, 0.0);
    }
    if (b->has_constants) {
        for (int k = 0; k <= m->n_stages; k++) {
            share[k] = 1.0;
        }
        dalcs_stage_column_fill(b, b->n_x, b->n_x, &constant, &to);
        dalcs_stage_column_check(b, b->n_x, b->n_x, 1.0);
    }
    for (int f = 0; f < e->n_functions; f++) {
        const struct dalcs_stage_drive of = {function[f].share, &function[f].stages,
                                             function[f].of_part};
        int rhs_column = b->wave_column[e->function[f].input];
        dalcs_stage_column_fill(b, b->n_x + 1 + f, rhs_column, &of, &to);
        dalcs_stage_column_check(b, b->n_x + 1 + f, rhs_column, of.share[m->s]);
    }
}

enum dalcs_status dalcs_stage_map_build(struct dalcs_stages *stages,
                                        struct dalcs_stage_entry *entry) {
    if (stages->workshop == NULL) {
        DALCS_TRY(dalcs_stage_workshop_create(&stages->workshop, stages));
    }
    struct dalcs_stage_workshop *b = stages->workshop;
    const struct dalcs_stage_function *function =
        dalcs_stage_functions_get(&b->functions, stages, entry->h);
    if (function == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_stage_workshop_solve(b, entry));
    entry->n_clashes = b->open.nullity * stages->method->s;
    entry->gives_rows_up = b->open.nullity > 0 && b->open.given_up != NULL;
    entry->rows = dalcs_dense_map_rows(stages->layout.n_fixed + entry->n_clashes);
    entry->maps.current_rows = dalcs_dense_map_rows(stages->n_levered);
    int all_rows = entry->rows + entry->maps.current_rows + (entry->frees_states ? 0 : b->n_x);
    entry->map = dalcs_dense_map_alloc(all_rows, n_columns(b));
    if (entry->map == NULL) {
        return DALCS_E_NOMEM;
    }
    entry->maps.current = entry->map + entry->rows * n_columns(b);
    entry->maps.shift = entry->maps.current + entry->maps.current_rows * n_columns(b);
    entry->bytes += (size_t)all_rows * (size_t)n_columns(b) * sizeof(double);
    fill_map(b, function);
    if (!entry->frees_states) {
        dalcs_stage_shift_fill(b, function);
    }
    return DALCS_OK;
}

int dalcs_stage_map_columns(const struct dalcs_stages *stages) {
    return n_columns(stages->workshop);
}

const double *dalcs_stage_map_input(const struct dalcs_stages *stages, const double *in) {
    const struct dalcs_stage_workshop *b = stages->workshop;
    if (b->has_constants) {
        return in;
    }
    for (int k = 0; k < b->n_x; k++) {
        b->column.in[k] = in[k];
    }
    for (int k = b->n_x + 1; k < stages->n_in; k++) {
        b->column.in[k - 1] = in[k];
    }
    return b->column.in;
}

void dalcs_stage_map_apply(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                           const double *in, double *out) {
    dalcs_dense_map_apply(entry->rows, n_columns(stages->workshop), entry->map,
                          dalcs_stage_map_input(stages, in), out);
}

void dalcs_stage_map_currents(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, const double *in,
                              double *drift) {
    dalcs_dense_map_apply(entry->maps.current_rows, n_columns(stages->workshop),
                          entry->maps.current, dalcs_stage_map_input(stages, in), drift);
}

bool dalcs_stage_has_map(const struct dalcs_stage_entry *entry) {
    return entry->map != NULL;
}

/* What an input is known to a rounding of. A source that passes through 0 is known to one of what it swings to, for its time
 * is rounded: the cosine's part as well as the sine's, which comes behind it. */
static double input_size(const struct dalcs_stages *stages, const double *in, int k) {
    const struct dalcs_excitation *e = stages->excitation;
    const int f = k - stages->workshop->n_x - 1;
    const bool swings = f >= 0 && f + 1 < e->n_functions &&
                        e->function[f].shape == DALCS_EXCITATION_COSINE &&
                        e->function[f].omega != 0.0;
    return swings ? dalcs_larger(fabs(in[k]), fabs(in[k + 1])) : fabs(in[k]);
}

/* Of a row of a map. */
static double spread(const struct dalcs_stages *stages, const double *element, int rows,
                     const double *in, const double *scale) {
    const struct dalcs_stage_workshop *b = stages->workshop;
    double sum = 0.0;
    for (int k = 0; k < stages->n_in; k++) {
        if (k == b->n_x && !b->has_constants) {
            continue;
        }
        double size = input_size(stages, in, k);
        sum += fabs(*element) * (k < b->n_x ? dalcs_larger(scale[k], size) : size);
        element += rows;
    }
    return sum;
}

double dalcs_stage_spread(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                          int row, const double *in, const double *scale) {
    return spread(stages, entry->map + row, entry->rows, in, scale);
}

double dalcs_stage_spread_of_current(const struct dalcs_stages *stages,
                                     const struct dalcs_stage_entry *entry, int k, const double *in,
                                     const double *scale) {
    return spread(stages, entry->maps.current + k, entry->maps.current_rows, in, scale);
}
