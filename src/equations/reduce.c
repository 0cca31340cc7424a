/* reduce.c - z eliminated: where B_II is regular, z = -B_II^-1 (A_II x + Bbar_II lambda + E_II) and the
 * DALCS is an LCS (Brogliato 2022, remark 5.13):
 *
 *     P x' = (A_I - B_I R A_II) x + (Bbar_I - B_I R Bbar_II) lambda + ...,    R = B_II^-1,
 *        w = (C_I - C_II R A_II) x + (D - C_II R Bbar_II) lambda + ...
 *
 * What moves a switch is a sum of columns; where z put sources into it, that sum stays as an unknown with an
 * equation of its own. */
#include "eliminate.h"
#include "equations.h"
#include "reading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An entry of R A_II that is this part of what it is summed from is rounding. */
static const double rounding = 1e-15;

/* ---- The reduced system -------------------------------------------------------------------- */

/* A row of which columns are those of `from`, added to one of the reduced system. */
static void add_row(const struct dalcs_elimination *z, const struct dalcs_csr *a, int i,
                    const struct dalcs_csr *of_inputs, double *dense, double *size) {
    const struct dalcs_system *s = z->from;
    for (size_t j = 0; j < z->n_right; j++) {
        dense[j] = size[j] = 0.0;
    }
    for (int k = a->p[i]; k < a->p[i + 1]; k++) {
        int c = a->j[k];
        if (c < s->n_x || c >= dalcs_system_n_equations(s)) {
            size_t to = (size_t)(c < s->n_x ? c : c - s->n_z);
            dense[to] += a->x[k];
            size[to] = fmax(size[to], fabs(a->x[k]));
            continue;
        }
        for (size_t j = 0; j < z->n_right; j++) {
            double term = a->x[k] * z->Z[(size_t)(c - s->n_x) * z->n_right + j];
            dense[j] += term;
            size[j] = fmax(size[j], fabs(term));
        }
    }
    for (int k = of_inputs == NULL ? 0 : of_inputs->p[i];
         of_inputs != NULL && k < of_inputs->p[i + 1]; k++) {
        size_t to = (size_t)(s->n_x + s->n_pairs + of_inputs->j[k]);
        dense[to] += of_inputs->x[k];
        size[to] = fmax(size[to], fabs(of_inputs->x[k]));
    }
    for (size_t j = 0; j < z->n_right; j++) {
        dense[j] = fabs(dense[j]) <= rounding * size[j] ? 0.0 : dense[j];
    }
}

/* A matrix over the columns, and one over the inputs, that become rows of the reduced system. */
struct rows {
    struct dalcs_triplets columns, inputs;
};

static void rows_finish(struct rows *rows) {
    dalcs_triplets_finish(&rows->columns);
    dalcs_triplets_finish(&rows->inputs);
}

/* Row i of (a, of_inputs) without z becomes row `to`. */
static enum dalcs_status reduce_row(const struct dalcs_elimination *z, const struct dalcs_csr *a,
                                    int i, const struct dalcs_csr *of_inputs, double *dense, int to,
                                    struct rows *rows) {
    int n_columns = z->from->n_x + z->from->n_pairs;
    add_row(z, a, i, of_inputs, dense, dense + z->n_right);
    for (int j = 0; j < (int)z->n_right; j++) {
        if (dense[j] != 0.0) {
            DALCS_TRY(j < n_columns
                          ? dalcs_triplets_add(&rows->columns, to, dalcs_elimination_column(z, j),
                                               dense[j])
                          : dalcs_triplets_add(&rows->inputs, to, j - n_columns, dense[j]));
        }
    }
    return DALCS_OK;
}

/* Does the sum that moves switch d, without z, need a column of its own: because sources enter it, or because
 * its first column would give it another unit? */
static bool needs_unknown(const struct dalcs_elimination *z, int d, double *dense) {
    const struct dalcs_system *s = z->from;
    if (s->pair[d].is_direct) {
        return false;
    }
    add_row(z, &s->control, d, NULL, dense, dense + z->n_right);
    int n_columns = s->n_x + s->n_pairs;
    int first = 0;
    while (first < n_columns && dense[first] == 0.0) {
        first++;
    }
    bool needs =
        first < n_columns && s->column_is_current[first < s->n_x ? first : first + s->n_z] !=
                                 dalcs_system_control_is_current(s, d);
    for (int j = n_columns; j < (int)z->n_right && !needs; j++) {
        needs = dense[j] != 0.0;
    }
    return needs;
}

static enum dalcs_status find_controls(struct dalcs_elimination *z, double *dense) {
    const struct dalcs_system *s = z->from;
    z->control_of = dalcs_alloc((size_t)s->n_pairs, sizeof *z->control_of);
    if (z->control_of == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        z->control_of[d] = needs_unknown(z, d, dense) ? z->n_controls++ : -1;
    }
    return DALCS_OK;
}

static enum dalcs_status reduce_first(const struct dalcs_elimination *z, double *dense,
                                      struct rows *rows) {
    const struct dalcs_system *s = z->from;
    for (int i = 0; i < s->n_x; i++) {
        DALCS_TRY(reduce_row(z, &s->A, i, &s->E, dense, i, rows));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (z->control_of[d] >= 0) {
            int to = s->n_x + z->control_of[d];
            DALCS_TRY(reduce_row(z, &s->control, d, NULL, dense, to, rows));
            DALCS_TRY(dalcs_triplets_add(&rows->columns, to, to, -1.0));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status reduce_control(const struct dalcs_elimination *z, int d, double *dense,
                                        struct rows *rows) {
    const struct dalcs_system *s = z->from;
    if (z->control_of[d] >= 0) {
        return dalcs_triplets_add(&rows->columns, d, s->n_x + z->control_of[d], 1.0);
    }
    return reduce_row(z, &s->control, d, NULL, dense, d, rows); /* of a direct one: its unit */
}

static enum dalcs_status reduce_matrices(const struct dalcs_elimination *z, double *dense,
                                         struct rows *first, struct rows *w, struct rows *control,
                                         struct dalcs_system *to) {
    const struct dalcs_system *s = z->from;
    int n_columns = dalcs_system_n_columns(to);
    DALCS_TRY(reduce_first(z, dense, first));
    for (int d = 0; d < s->n_pairs; d++) {
        DALCS_TRY(reduce_row(z, &s->C, d, &s->F, dense, d, w));
        DALCS_TRY(reduce_control(z, d, dense, control));
    }
    DALCS_TRY(dalcs_csr_compress(&to->A, to->n_x + to->n_z, n_columns, &first->columns));
    DALCS_TRY(dalcs_csr_compress(&to->E, to->n_x + to->n_z, s->n_inputs, &first->inputs));
    DALCS_TRY(dalcs_csr_compress(&to->C, s->n_pairs, n_columns, &w->columns));
    DALCS_TRY(dalcs_csr_compress(&to->F, s->n_pairs, s->n_inputs, &w->inputs));
    return dalcs_csr_compress(&to->control, s->n_pairs, n_columns, &control->columns);
}

static enum dalcs_status copy_matrix(struct dalcs_csr *to, const struct dalcs_csr *from) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int i = 0; i < from->n_rows && status == DALCS_OK; i++) {
        for (int k = from->p[i]; k < from->p[i + 1] && status == DALCS_OK; k++) {
            status = dalcs_triplets_add(&t, i, from->j[k], from->x[k]);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(to, from->n_rows, from->n_columns, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

/* n of them, with room for more. */
static void *copy_array(const void *from, size_t n, size_t room, size_t size) {
    void *to = dalcs_alloc(room, size);
    return to == NULL || n == 0 ? to : memcpy(to, from, n * size);
}

/* Labels of n equations of `from`, with room for those that are left, and of its pairs and inputs. */
static enum dalcs_status copy_labels(struct dalcs_system *to, const struct dalcs_system *from,
                                     size_t n) {
    size_t room = (size_t)dalcs_system_n_equations(to);
    size_t n_pairs = (size_t)to->n_pairs;
    size_t n_inputs = (size_t)to->n_inputs;
    to->dual = copy_array(from->dual, n, room, sizeof *to->dual);
    to->forest_root = copy_array(from->forest_root, n, room, sizeof *to->forest_root);
    to->column_is_current =
        copy_array(from->column_is_current, n, room + n_pairs, sizeof *to->column_is_current);
    to->row_is_current = copy_array(from->row_is_current, n, room, sizeof *to->row_is_current);
    to->row = copy_array(from->row, n, room, sizeof *to->row);
    to->column = copy_array(from->column, n, room, sizeof *to->column);
    to->pair = copy_array(from->pair, n_pairs, n_pairs, sizeof *to->pair);
    to->stimulus = copy_array(from->stimulus, n_inputs, n_inputs, sizeof *to->stimulus);
    to->input_element =
        copy_array(from->input_element, n_inputs, n_inputs, sizeof *to->input_element);
    if (to->dual == NULL || to->forest_root == NULL || to->column_is_current == NULL ||
        to->row_is_current == NULL || to->row == NULL || to->column == NULL || to->pair == NULL ||
        to->stimulus == NULL || to->input_element == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t d = 0; d < n_pairs; d++) {
        to->column_is_current[room + d] = true;
    }
    return DALCS_OK;
}

/* The sums that move switches, as unknowns after the states; each equation is its own column's. */
static enum dalcs_status label_controls(const struct dalcs_elimination *z, struct dalcs_system *to,
                                        struct dalcs_arena *arena) {
    for (int d = 0; d < to->n_pairs; d++) {
        if (z->control_of[d] < 0) {
            continue;
        }
        int i = to->n_x + z->control_of[d];
        const char *name = dalcs_arena_printf(arena, "control.%s", to->pair[d].element);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        to->row[i] = to->column[i] = (struct dalcs_label){name, DALCS_LABEL_BRANCH};
        to->row_is_current[i] = to->column_is_current[i] =
            dalcs_system_control_is_current(z->from, d);
    }
    for (int i = 0; i < dalcs_system_n_equations(to); i++) {
        to->dual[i] = i; /* that of a voltage may have been among z */
        to->forest_root[i] = i;
    }
    return DALCS_OK;
}

static enum dalcs_status keep_system(const struct dalcs_system *s, struct dalcs_system *to) {
    to->n_z = s->n_z;
    DALCS_TRY(copy_labels(to, s, (size_t)dalcs_system_n_equations(s)));
    DALCS_TRY(copy_matrix(&to->A, &s->A));
    DALCS_TRY(copy_matrix(&to->E, &s->E));
    DALCS_TRY(copy_matrix(&to->C, &s->C));
    DALCS_TRY(copy_matrix(&to->F, &s->F));
    return copy_matrix(&to->control, &s->control);
}

static enum dalcs_status reduce_regular(struct dalcs_elimination *z, struct dalcs_system *to,
                                        struct dalcs_arena *arena) {
    struct rows first = {0};
    struct rows w = {0};
    struct rows control = {0};
    double *dense = dalcs_alloc(2 * z->n_right, sizeof *dense);
    enum dalcs_status status = dense == NULL ? DALCS_E_NOMEM : find_controls(z, dense);
    if (status == DALCS_OK) {
        to->n_z = z->n_controls;
        status = copy_labels(to, z->from, (size_t)to->n_x);
    }
    if (status == DALCS_OK) {
        status = label_controls(z, to, arena);
    }
    if (status == DALCS_OK) {
        status = reduce_matrices(z, dense, &first, &w, &control, to);
    }
    free(dense);
    rows_finish(&first);
    rows_finish(&w);
    rows_finish(&control);
    return status == DALCS_OK ? dalcs_system_prove_monotone(to, DALCS_CLAIM_NOTHING) : status;
}

static enum dalcs_status reduce_system(struct dalcs_elimination *z, struct dalcs_system *to,
                                       struct dalcs_arena *arena) {
    const struct dalcs_system *s = z->from;
    *to = (struct dalcs_system){
        .n_x = s->n_x, .n_pairs = s->n_pairs, .n_inputs = s->n_inputs, .monotone = s->monotone};
    DALCS_TRY(copy_matrix(&to->P, &s->P));
    DALCS_TRY(copy_matrix(&to->storage, &s->storage));
    DALCS_TRY(copy_matrix(&to->direct_control, &s->direct_control));
    return z->is_regular ? reduce_regular(z, to, arena) : keep_system(s, to);
}

/* ---- All together -------------------------------------------------------------------------- */

static enum dalcs_status reduce_all(struct dalcs_elimination *all,
                                    const struct dalcs_network *network,
                                    struct dalcs_network *reduced, struct dalcs_arena *arena,
                                    const char **because) {
    int n = network->n_systems;
    for (int k = 0; k < n; k++) {
        DALCS_TRY(dalcs_eliminate(&all[k], &network->system[k], arena));
        enum dalcs_status status = reduce_system(&all[k], &reduced->system[k], &reduced->arena);
        reduced->n_systems = k + 1;
        DALCS_TRY(status);
        size_t n_x = (size_t)network->system[k].n_x;
        reduced->initial[k] = copy_array(network->initial[k], n_x, n_x, sizeof(double));
        if (reduced->initial[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        if (!all[k].is_regular && *because == NULL) {
            *because = n == 1 ? all[k].because
                              : dalcs_arena_printf(arena, "part %d: %s", k + 1, all[k].because);
        }
    }
    return dalcs_eliminate_outputs(all, network, reduced);
}

enum dalcs_status dalcs_equations_reduce(const struct dalcs_network *network,
                                         struct dalcs_network *reduced, struct dalcs_arena *arena,
                                         const char **because) {
    size_t n = (size_t)network->n_systems;
    struct dalcs_elimination *all = dalcs_alloc(n, sizeof *all);
    *reduced = (struct dalcs_network){.n_nodes = network->n_nodes};
    reduced->system = dalcs_alloc(n, sizeof *reduced->system);
    reduced->initial = dalcs_alloc(n, sizeof *reduced->initial);
    *because = NULL;
    enum dalcs_status status = DALCS_E_NOMEM;
    if (all != NULL && reduced->system != NULL && reduced->initial != NULL) {
        status = reduce_all(all, network, reduced, arena, because);
    }
    for (size_t k = 0; all != NULL && k < n; k++) {
        free(all[k].Z);
        free(all[k].control_of);
    }
    free(all);
    if (status != DALCS_OK) {
        dalcs_network_finish(reduced);
    }
    return status;
}
